"""
The parameters of the node and the simulated base as data, and the reader of their files.

Needs no ROS.
"""
