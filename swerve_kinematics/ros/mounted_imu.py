"""What an IMU says of the base that carries it, however it is mounted."""

import math
from typing import Sequence

from swerve_kinematics.core.geometry.rotations import (
    from_roll_pitch_yaw, IDENTITY, inverse, product, Rotation, up, yaw_of)
from swerve_kinematics.ros.conversions import Imu, rotation_of


class MountedImu:
    """
    Turns what an IMU measures in its own frame into the yaw and the yaw rate of the base.

    Parameters
    ----------
    orientation : sequence of float (3,)
        Roll, pitch and yaw of the sensor in the frame of the base [rad]; empty if it lies
        along the axes of the base, or is to be told otherwise.
    use : str
        `orientation` leaves its rates out, `rate` its orientation, `auto` nothing.

    """

    def __init__(self, orientation: Sequence[float], use: str) -> None:
        """Take the mounting."""
        self._has_yaw, self._has_rate = use != 'rate', use != 'orientation'
        self.mount(from_roll_pitch_yaw(*orientation) if len(orientation) else IDENTITY)

    def mount(self, rotation: Rotation) -> None:
        """Take the orientation of the sensor in the frame of the base."""
        self._back, self._up = inverse(rotation), up(rotation)

    def yaw_and_rate(self, imu: Imu) -> tuple[float, float]:
        """
        Return yaw [rad] and yaw rate [rad/s] of the base, NaN for what it lacks.

        A covariance that begins with -1 says that the quantity is not measured.
        """
        yaw = rate = math.nan
        if self._has_yaw and imu.orientation_covariance[0] != -1.0:
            yaw = yaw_of(product(rotation_of(imu.orientation), self._back))
        if self._has_rate and imu.angular_velocity_covariance[0] != -1.0:
            omega, (x, y, z) = imu.angular_velocity, self._up
            # What is not measured at all, as NaN, must not spoil what the yaw needs.
            rate = sum(share * value for share, value in (
                (x, omega.x), (y, omega.y), (z, omega.z)) if abs(share) > 1e-9)
        return yaw, rate
