"""The ROS 2 shell: convert, call the core, publish."""
