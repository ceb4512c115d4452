"""
swerve_calibrate: calibration from a recorded drive.

Needs no ROS; bags are read with rosbags.
"""
