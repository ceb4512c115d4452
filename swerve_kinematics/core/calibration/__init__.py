"""
Wheel radii, steering offsets and gyro scale, from a recorded drive.

Pure functions of the recording.
"""
