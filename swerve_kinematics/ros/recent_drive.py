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

"""The latest samples of a drive, kept as plain numbers."""

from array import array
from bisect import bisect_left
from collections.abc import Sequence
import math

import numpy as np

from swerve_kinematics.core.checking.drive_data import DriveData
from swerve_kinematics.ros.stamps import NANOSECONDS


class RecentDrive:
    """
    Remembers what joints and gyro reported, and what was commanded.

    To keep a sample costs the node a fraction of what an object for each would, at every set of
    joint states, and to judge the drive costs no conversion.

    Parameters
    ----------
    module_count : int
        How many modules there are.

    Attributes
    ----------
    stamps : array of int
        [ns], increasing.

    """

    def __init__(self, module_count: int) -> None:
        """Start without a sample."""
        self._module_count, self._width = module_count, 4 * module_count + 2
        self.stamps = array('q')
        self._numbers = array('d')

    def clear(self) -> None:
        """Forget all samples."""
        self._forget_first(len(self.stamps))

    def forget_before(self, stamp: int) -> None:
        """Forget the samples before a time [ns]."""
        self._forget_first(bisect_left(self.stamps, stamp))

    def _forget_first(self, count: int) -> None:
        """Forget so many samples, from the oldest on."""
        del self.stamps[:count], self._numbers[:count * self._width]

    def add(self, stamp: int, distances: Sequence[float], angles: Sequence[float],
            yaw: float | None, yaw_rate: float | None, commanded_speeds: Sequence[float],
            commanded_angles: Sequence[float]) -> None:
        """Keep a sample: `stamp` [ns], and the rest as in a row of `DriveData`."""
        self.stamps.append(stamp)
        numbers = self._numbers
        for values in (distances, angles, commanded_speeds, commanded_angles):
            numbers.extend(values)
        numbers.append(math.nan if yaw is None else yaw)
        numbers.append(math.nan if yaw_rate is None else yaw_rate)

    def data(self) -> DriveData:
        """Return the samples, of which there is at least one; time begins at the first."""
        stamps = np.array(self.stamps)
        table = np.array(self._numbers).reshape(len(stamps), self._width)
        count = self._module_count
        distances, angles, commanded_speeds, commanded_angles, gyro = np.split(
            table, range(count, self._width - 1, count), axis=1)
        return DriveData((stamps - stamps[0]) / NANOSECONDS, distances, angles, gyro[:, 0],
                         gyro[:, 1], commanded_speeds, commanded_angles)
