"""The numerical core: pure numpy, no ROS, no clock, no I/O."""
