"""swerve_check: what is wrong with a base, from a drive, on blocks or on the floor."""
