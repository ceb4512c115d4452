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

"""Whether the orientation of a gyro is one at all, or never changes."""

import math

from swerve_kinematics.core.odometry.gyro import LARGEST_BIAS

# A yaw stands still if it keeps one and the same value for this long [s] while the rate turns
# by this much [rad]: slow orientations come at 10 Hz, coarse ones in whole degrees.
STILL_TIME = 0.2
STILL_TURN = 0.05


class StillYaw:
    """
    Tells whether an orientation follows its own rate, by the samples as the sensor sends them.

    Drivers of gyros without an orientation send one that never changes. Until it has changed
    once it counts only while nothing turns.

    Attributes
    ----------
    stands : bool
        Whether the yaw stands still although the rate turns.

    """

    def __init__(self) -> None:
        """Start without a sample."""
        self._yaw = self._rate = math.nan
        self._has_moved = self.stands = self._rate_changes = False
        self._time = self._turned = 0.0

    @property
    def is_frozen(self) -> bool:
        """
        Return whether rate and orientation are repeated over and over: neither tells anything.

        The orientation must have changed before, for many drivers have none, and a rate may well
        keep one value for a while.
        """
        return self.stands and self._has_moved and not self._rate_changes

    def follows(self, dt: float, yaw: float, rate: float) -> bool:
        """
        Return whether the yaw of this sample can be believed.

        Parameters
        ----------
        dt : float
            Time since the last sample [s].
        yaw, rate : float
            Of this sample [rad, rad/s].

        """
        self._rate_changes |= rate != self._rate
        self._rate = rate
        if yaw != self._yaw:
            self._has_moved = self._yaw == self._yaw
            self._yaw, self._time, self._turned = yaw, 0.0, 0.0
            self.stands = self._rate_changes = False
            return True
        if abs(rate) <= LARGEST_BIAS:
            return not self.stands
        self._time += dt
        self._turned += rate * dt
        self.stands |= self._time >= STILL_TIME and abs(self._turned) > STILL_TURN
        return self._has_moved and not self.stands
