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

"""
What messages say, as plain numbers and arrays.

Needs the fields of a message, whoever has made it: rclpy, or a reader of bags without ROS.
"""

from typing import Any, NamedTuple, Protocol, Sequence

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.rotations import Rotation, yaw_of
from swerve_kinematics.ros.stamps import nanoseconds_of


class Vector(Protocol):
    """A geometry_msgs/Vector3 or Point."""

    x: float
    y: float
    z: float


class Quaternion(Protocol):
    """A geometry_msgs/Quaternion."""

    x: float
    y: float
    z: float
    w: float


class Pose(Protocol):
    """A geometry_msgs/Pose."""

    position: Vector
    orientation: Quaternion


class Header(Protocol):
    """A std_msgs/Header."""

    stamp: Any
    frame_id: str


class Imu(Protocol):
    """A sensor_msgs/Imu."""

    header: Header
    orientation: Quaternion
    orientation_covariance: Sequence[float]
    angular_velocity: Vector
    angular_velocity_covariance: Sequence[float]
    linear_acceleration: Vector
    linear_acceleration_covariance: Sequence[float]


class StampedNumbers(NamedTuple):
    """
    What a message says that is a header and numbers.

    Attributes
    ----------
    stamp : int
        [ns]; 0 where the sender gave none.
    frame : str
        In which the numbers are given.
    numbers : tuple of float
        All numbers of the message, in its order.

    """

    stamp: int
    frame: str
    numbers: tuple[float, ...]


def rotation_of(quaternion: Quaternion) -> Rotation:
    """Return a geometry_msgs/Quaternion as the core takes it."""
    return Rotation(quaternion.x, quaternion.y, quaternion.z, quaternion.w)


def imu_numbers(imu: Imu) -> StampedNumbers:
    """Return a sensor_msgs/Imu as `read_imu` does its bytes."""
    rate, force = imu.angular_velocity, imu.linear_acceleration
    return StampedNumbers(nanoseconds_of(imu.header.stamp), imu.header.frame_id, (
        *rotation_of(imu.orientation), *imu.orientation_covariance,
        rate.x, rate.y, rate.z, *imu.angular_velocity_covariance,
        force.x, force.y, force.z, *imu.linear_acceleration_covariance))


def planar_pose(pose: Pose) -> NDArray[np.float64]:
    """Return a geometry_msgs/Pose as `[x, y, yaw]` (3,) [m, m, rad], yaw in (-pi, pi]."""
    return np.array([pose.position.x, pose.position.y, yaw_of(rotation_of(pose.orientation))])
