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

"""A gyro over a whole recording: read at any stamp from the samples before and after it."""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.ros.gyro_feedback import GyroFeedback, GyroReading
from swerve_kinematics.ros.stamps import NANOSECONDS


class GyroSeries:
    """
    Collects what a gyro says, and understands it as the node does.

    Parameters
    ----------
    timeout : int
        Distance [ns] from the nearest sample beyond which nothing is known.

    """

    def __init__(self, timeout: int) -> None:
        """Start without samples."""
        self._timeout = timeout
        self._gyro = GyroFeedback(timeout)
        self._readings: list[GyroReading] = []

    def add(self, stamp: int, yaw: float, rate: float) -> None:
        """Take a sample [ns], [rad], [rad/s]; NaN for what is missing."""
        if self._gyro.add(stamp, yaw, rate):
            self._readings.append(self._gyro.at(stamp))

    def yaw_at(self, stamps: NDArray[np.int64]) -> NDArray[np.float64] | None:
        """
        Return the yaw (t,) [rad] at stamps [ns], or the integral of the rate; None without both.

        NaN where the gyro was silent.
        """
        yaws = [(reading.stamp, reading.yaw) for reading in self._readings]
        told = [pair for pair in yaws if pair[1] is not None] or [
            (reading.stamp, reading.integral) for reading in self._readings]
        if not told:
            return None
        time, yaw = (np.array(series) for series in zip(*sorted(told)))
        after = np.clip(np.searchsorted(time, stamps), 1, max(len(time) - 1, 1))
        nearest = np.minimum(np.abs(time[after - 1] - stamps),
                             np.abs(time[np.minimum(after, len(time) - 1)] - stamps))
        known = np.interp((stamps - time[0]) / NANOSECONDS, (time - time[0]) / NANOSECONDS, yaw)
        return np.where(nearest <= self._timeout, known, np.nan)
