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

"""What an IMU says of the base that carries it, however it is mounted."""

import math
from typing import Sequence

from swerve_kinematics.core.geometry.rotations import (
    from_roll_pitch_yaw, IDENTITY, inverse, level_axes, product, Rotation, up, yaw_of)
from swerve_kinematics.ros.accelerometer import InertialSample
from swerve_kinematics.ros.conversions import StampedNumbers

# A covariance that begins with this says that the quantity is not measured.
NOT_MEASURED = -1.0
# An axis of the sensor that shows no more than this share of x and of y of the base tells nothing
# of them, so it may be stuck.
NOTEWORTHY = 0.1
# At rest, on any floor on which a base stands, this share of the force points up.
UPRIGHT = 0.9

# Which of a vector's three numbers count, by their place, and for what share each.
Shares = tuple[tuple[int, float], ...]


class MountedImu:
    """
    Turns what an IMU measures in its own frame into what the base does.

    What it measures are the numbers of a sensor_msgs/Imu, as `read_imu` gives them: the
    orientation from 0 and its covariance from 4, the rates from 13 and theirs from 16, the force
    from 25 and its covariance from 28.

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
        self._back, self._up = inverse(rotation), _shares(up(rotation))
        ahead, left = level_axes(rotation)
        self._ahead, self._left = _shares(ahead), _shares(left)
        self._level = [axis for axis in range(3)
                       if max(abs(ahead[axis]), abs(left[axis])) > NOTEWORTHY]

    def yaw_and_rate(self, imu: StampedNumbers) -> tuple[float, float]:
        """Return yaw [rad] and yaw rate [rad/s] of the base, NaN for what it lacks."""
        numbers, yaw, rate = imu.numbers, math.nan, math.nan
        if self._has_yaw and numbers[4] != NOT_MEASURED:
            yaw = yaw_of(product(Rotation(*numbers[:4]), self._back))
        if self._has_rate and numbers[16] != NOT_MEASURED:
            rate = _along(self._up, numbers[13:16])
        return yaw, rate

    def inertial(self, imu: StampedNumbers) -> InertialSample:
        """Return force and rates along the level axes of the base."""
        numbers, force, rates = imu.numbers, None, None
        axes = numbers[25:28]
        if numbers[28] != NOT_MEASURED:
            force = complex(_along(self._ahead, axes), _along(self._left, axes))
        if self._has_rate and numbers[16] != NOT_MEASURED:
            omega = numbers[13:16]
            rates = complex(_along(self._ahead, omega), _along(self._left, omega))
        size = math.hypot(*axes)
        if _along(self._up, axes) < UPRIGHT * size:
            size = -size
        return InertialSample(force, rates, size, tuple([axes[axis] for axis in self._level]))


def _shares(axis: Sequence[float]) -> Shares:
    """Return with what share each number of a vector counts along an axis, if it does."""
    return tuple((place, share) for place, share in enumerate(axis) if abs(share) > 1e-9)


def _along(shares: Shares, vector: Sequence[float]) -> float:
    """Return a vector's part along an axis; what that does not need, may be NaN."""
    return sum([share * vector[place] for place, share in shares])
