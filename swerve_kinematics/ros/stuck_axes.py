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

"""Axes of a sensor that show the same number again and again."""

import math

from swerve_kinematics.ros.stamps import nanoseconds

# A sensor has noise: an axis that shows the very same number for so long [ns], in so many
# samples, is stuck or at the end of its range.
STUCK_TIME, STUCK_SAMPLES = nanoseconds(0.1), 3


class StuckAxes:
    """
    Notices axes that do not change.

    Attributes
    ----------
    are_stuck : bool
        Whether any axis is stuck now.

    """

    def __init__(self) -> None:
        """Start without a sample."""
        self.are_stuck = False
        # What each axis shows, since when [ns], and in how many samples.
        self._unchanged: list[tuple[float, int, int]] = []

    def watch(self, stamp: int, axes: tuple[float, ...]) -> None:
        """Take what the axes show at a stamp [ns]."""
        if len(self._unchanged) != len(axes):
            self._unchanged = [(math.nan, stamp, 0)] * len(axes)
        self._unchanged = [(value, since, count + 1) if value == now else (now, stamp, 1)
                           for now, (value, since, count) in zip(axes, self._unchanged)]
        self.are_stuck = any(stamp - since >= STUCK_TIME and count >= STUCK_SAMPLES
                             for _, since, count in self._unchanged)
