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

"""Between ROS messages and the numbers of the core: twists, poses and the odometry."""

from array import array
import math
from typing import Any, Sequence

from geometry_msgs.msg import PoseWithCovariance, Quaternion, TransformStamped, Twist
from nav_msgs.msg import Odometry
import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node

from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.core.odometry.views import Estimate
from swerve_kinematics.ros.conversions import planar_pose
from swerve_kinematics.ros.qos import publisher
from swerve_kinematics.ros.serialized import SerializedMessage
from swerve_kinematics.ros.serialized_reading import read_twist, read_twist_stamped
from swerve_kinematics.ros.stamps import seconds_and_nanoseconds, set_stamp

# Variance of what a planar base does not measure, by the convention of robot_localization.
UNKNOWN_VARIANCE = 1e6
# What a damaged twist says.
NO_TWIST = (math.nan, math.nan, math.nan)
# Where x, y and yaw stand among x, y, z, roll, pitch, yaw.
PLANAR_AXES = (0, 1, 5)
# The 9 places of the planar block in the row-major 6x6 covariance.
PLANAR_BLOCK = [6 * row + column for row in PLANAR_AXES for column in PLANAR_AXES]


def planar_twist(twist: Twist) -> tuple[float, float, float]:
    """
    Return a geometry_msgs/Twist as `(vx, vy, omega)` [m/s, m/s, rad/s].

    A twist that is not finite in an axis of no use here is not to be trusted in the others.
    """
    linear, angular = twist.linear, twist.angular
    return _planar(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)


def _planar(vx: float, vy: float, vz: float, omega_x: float, omega_y: float,
            omega: float) -> tuple[float, float, float]:
    """Return `(vx, vy, omega)`, with NaN for vx where an unused axis is not finite."""
    return vx + 0.0 * (vz + omega_x + omega_y), vy, omega


def set_planar_twist(twist: Twist, values: Sequence[float]) -> None:
    """Write `(vx, vy, omega)` [m/s, m/s, rad/s], Python's floats, to a geometry_msgs/Twist."""
    twist.linear.x, twist.linear.y, twist.angular.z = values


def serialized_planar_twist(data: bytes) -> tuple[float, float, float]:
    """Return a serialized geometry_msgs/Twist as `planar_twist` does; NaN if it is damaged."""
    numbers = read_twist(data)
    return NO_TWIST if numbers is None else _planar(*numbers)


def serialized_stamped_twist(data: bytes) -> tuple[tuple[float, float, float], int, str]:
    """Return twist, stamp [ns] and frame of a serialized TwistStamped; NaN if it is damaged."""
    read = read_twist_stamped(data)
    if read is None:
        return NO_TWIST, 0, ''
    return _planar(*read.numbers), read.stamp, read.frame


def rotation_about_z(yaw: float) -> tuple[float, float]:
    """Return z and w of the quaternion of a rotation by `yaw` [rad]; its x and y are 0."""
    return math.sin(0.5 * yaw), math.cos(0.5 * yaw)


def set_yaw(quaternion: Quaternion, yaw: float) -> None:
    """Write a rotation about z by `yaw` [rad] to a geometry_msgs/Quaternion."""
    quaternion.z, quaternion.w = rotation_about_z(yaw)


def planar_pose_and_covariance(
        pose: PoseWithCovariance) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return a geometry_msgs/PoseWithCovariance as arrays (3,) and (3, 3) [m, m, rad]."""
    return (planar_pose(pose.pose),
            np.asarray(pose.covariance)[PLANAR_BLOCK].reshape(3, 3))


def set_planar_block(covariance: 'memoryview[float]', block: Sequence[float]) -> None:
    """Write a planar covariance (9,), row by row [m, m, rad], to that of a message (36,)."""
    # Place by place: a loop over PLANAR_BLOCK takes three times as long.
    c = covariance
    c[0], c[1], c[5], c[6], c[7], c[11], c[30], c[31], c[35] = block


def transform_broadcaster(node: Node) -> Any:
    """Return a broadcaster for /tf, None where tf2_ros is not installed."""
    try:
        from tf2_ros import TransformBroadcaster
    except ImportError:
        node.get_logger().warning(
            'tf2_ros is not installed: no odom transform on /tf '
            '(sudo apt install ros-$ROS_DISTRO-tf2-ros-py)')
        return None
    return TransformBroadcaster(node)


class OdometryMessages:
    """
    The odometry as a message and, where a broadcaster is given, as a transform.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publisher.
    layout : Layout
        Gives the names of the frames.
    broadcaster : tf2_ros.TransformBroadcaster or None
        Sends odom -> base_link; None for no transform.

    """

    def __init__(self, node: Node, layout: Layout, broadcaster: Any) -> None:
        """Create the publisher and the messages."""
        message = Odometry(child_frame_id=layout.base_frame)
        message.header.frame_id = layout.odom_frame
        unknown = array('d', np.diag([UNKNOWN_VARIANCE] * 6).ravel())
        message.pose.covariance = message.twist.covariance = unknown
        pose, twist = [0.0] * 6 + [1.0], [0.0] * 6
        self._message = SerializedMessage(
            publisher(node, Odometry, 'odom'), message, [*pose, *unknown, *twist, *unknown])
        self._stamp, numbers = self._message.stamp, self._message.numbers
        self._pose, self._pose_covariance = numbers[:7], numbers[7:43]
        self._twist, self._twist_covariance = numbers[43:49], numbers[49:]
        self._broadcaster = broadcaster
        self._transform = TransformStamped(child_frame_id=layout.base_frame)
        self._transform.header.frame_id = layout.odom_frame

    def publish(self, stamp: int, estimate: Estimate) -> None:
        """
        Publish the state of the odometry.

        Parameters
        ----------
        stamp : int
            Time [ns] of the measurement it rests on.
        estimate : Estimate
            Pose, twist and their covariances.

        """
        x, y, yaw = estimate.pose
        self._stamp[0], self._stamp[1] = seconds_and_nanoseconds(stamp)
        self._pose[0], self._pose[1] = x, y
        self._pose[5], self._pose[6] = rotation_about_z(yaw)
        self._twist[0], self._twist[1], self._twist[5] = estimate.twist
        set_planar_block(self._pose_covariance, estimate.pose_covariance)
        set_planar_block(self._twist_covariance, estimate.twist_covariance)
        self._message.publish()
        if self._broadcaster is not None:
            self._broadcast(stamp, x, y, yaw)

    def _broadcast(self, stamp: int, x: float, y: float, yaw: float) -> None:
        """Send the pose as a transform."""
        transform = self._transform.transform
        set_stamp(self._transform.header.stamp, stamp)
        transform.translation.x, transform.translation.y = x, y
        set_yaw(transform.rotation, yaw)
        self._broadcaster.sendTransform(self._transform)
