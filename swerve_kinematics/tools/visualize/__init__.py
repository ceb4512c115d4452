"""
swerve_visualize: pictures of what every module does for a twist.

Needs no ROS.
"""
