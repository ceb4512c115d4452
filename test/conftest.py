"""Settings for the whole suite: seeded properties, and a ROS graph of its own."""

import os

from hypothesis import settings

# Traffic stays on this machine, and apart from other graphs on it. Must be set before rclpy
# is loaded; the processes that tests start inherit it. Domains up to 101 are safe on Linux.
os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
os.environ['ROS_DOMAIN_ID'] = str(1 + os.getpid() % 100)

settings.register_profile('suite', derandomize=True, deadline=None)
settings.load_profile('suite')
