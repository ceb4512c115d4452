# Copyright 2026 swerve_kinematics maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""ROS messages for a collector, whoever has made them: rclpy, or a reader of bags without ROS."""

from collections.abc import Callable
from typing import Any

from swerve_kinematics.ros.conversions import planar_pose
from swerve_kinematics.ros.stamps import nanoseconds_of
from swerve_kinematics.tools.recordings.collector import Collector

# Hands a message to a collector, with the time [ns] at which it was received.
Taker = Callable[[Collector, Any, int], None]


def take_joints(collector: Collector, message: Any, received: int) -> None:
    """Hand a sensor_msgs/JointState to the collector."""
    stamp = collector.joint_clock.stamp_of(
        nanoseconds_of(message.header.stamp), received, collector.restamps)
    collector.add_joints(stamp, message.name, message.position, message.velocity)


def take_imu(collector: Collector, message: Any, received: int) -> None:
    """Hand a sensor_msgs/Imu to the collector."""
    stamp = collector.imu_clock.stamp_of(
        nanoseconds_of(message.header.stamp), received, collector.restamps)
    collector.add_imu(stamp, message)


def take_truth(collector: Collector, message: Any, received: int) -> None:
    """Hand a pose, with or without covariance and twist, to the collector."""
    pose = getattr(message.pose, 'pose', message.pose)
    collector.add_truth(nanoseconds_of(message.header.stamp) or received, *planar_pose(pose))


def take_drive_commands(collector: Collector, message: Any, received: int) -> None:
    """Hand a std_msgs/Float64MultiArray for the drives to the collector."""
    collector.add_drive_commands(message.data.tolist())


def take_steering_commands(collector: Collector, message: Any, received: int) -> None:
    """Hand a std_msgs/Float64MultiArray for the steering to the collector."""
    collector.add_steering_commands(message.data.tolist())


def take_joint_commands(collector: Collector, message: Any, received: int) -> None:
    """Hand a sensor_msgs/JointState of commands to the collector."""
    collector.add_joint_commands(message.name, message.velocity, message.position)


# The types of the messages that each takes.
KINDS: dict[Taker, tuple[str, ...]] = {
    take_joints: ('sensor_msgs/msg/JointState',),
    take_imu: ('sensor_msgs/msg/Imu',),
    take_truth: ('nav_msgs/msg/Odometry', 'geometry_msgs/msg/PoseStamped',
                 'geometry_msgs/msg/PoseWithCovarianceStamped'),
    take_drive_commands: ('std_msgs/msg/Float64MultiArray',),
    take_steering_commands: ('std_msgs/msg/Float64MultiArray',),
    take_joint_commands: ('sensor_msgs/msg/JointState',)}
