"""A simulated swerve base: actuators, a rigid body on rolling wheels, and faulty sensors."""
