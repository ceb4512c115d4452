"""
swerve_demo: the node drives a simulated base, and a picture of how well.

A ROS process that starts the others.
"""
