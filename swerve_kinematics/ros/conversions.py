"""
What messages say, as plain numbers and arrays.

Needs the fields of a message, whoever has made it: rclpy, or a reader of bags without ROS.
"""

import math
from typing import Protocol, Sequence

import numpy as np
from numpy.typing import NDArray


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


class Imu(Protocol):
    """A sensor_msgs/Imu."""

    orientation: Quaternion
    orientation_covariance: Sequence[float]
    angular_velocity: Vector
    angular_velocity_covariance: Sequence[float]


def yaw_of(quaternion: Quaternion) -> float:
    """Return the yaw [rad] of a geometry_msgs/Quaternion, NaN if it is no rotation."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    if not x * x + y * y + z * z + w * w > 0.0:
        return math.nan
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def imu_yaw_and_rate(imu: Imu) -> tuple[float, float]:
    """
    Return yaw [rad] and yaw rate [rad/s] of a sensor_msgs/Imu, NaN for what it lacks.

    A covariance that begins with -1 says that the quantity is not measured.
    """
    yaw = yaw_of(imu.orientation) if imu.orientation_covariance[0] != -1.0 else math.nan
    rate = imu.angular_velocity.z if imu.angular_velocity_covariance[0] != -1.0 else math.nan
    return yaw, rate


def planar_pose(pose: Pose) -> NDArray[np.float64]:
    """Return a geometry_msgs/Pose as `[x, y, yaw]` (3,) [m, m, rad], yaw in (-pi, pi]."""
    return np.array([pose.position.x, pose.position.y, yaw_of(pose.orientation)])
