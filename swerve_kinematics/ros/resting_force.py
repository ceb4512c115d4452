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

"""What an accelerometer shows of a base at rest: gravity, nothing, or what is neither."""

import math

from swerve_kinematics.core.geometry.clamping import clamped
from swerve_kinematics.ros.stamps import nanoseconds, NEVER

# After so long a rest [ns] a sensor shows gravity, or nothing where its driver takes that off. The
# time leaves room for wheels that stand while the base still slides. Between the two sizes [m/s^2]
# lies 1, beyond them 32: gravity in units of itself, and in feet.
REST = nanoseconds(1.0)
GRAVITY, NO_GRAVITY = (7.0, 13.0), 0.6
# To be compared with these, the size of the force is smoothed over this time [s], and limited
# [m/s^2], so that one absurd sample is forgotten within a second.
SMOOTHING = 0.1
LARGEST_SIZE = 1e4


class RestingForce:
    """
    Tells by the force on a base at rest whether unit and mounting of a sensor can be right.

    Attributes
    ----------
    is_plausible : bool
        Whether the latest rest, if there was one, showed gravity or nothing.
    has_gravity : bool
        Whether it was not nothing.

    """

    def __init__(self) -> None:
        """Start without a sample."""
        self.is_plausible = self.has_gravity = True
        self._size, self._rest_began = math.nan, NEVER

    def follow(self, elapsed: float, size: float) -> None:
        """Smooth the size of the whole force [m/s^2], with its sign, over a time [s]."""
        if math.isfinite(self._size):
            size = self._size + min(elapsed / SMOOTHING, 1.0) * (size - self._size)
        self._size = clamped(size, LARGEST_SIZE)

    def look(self, stamp: int, is_still: bool) -> None:
        """Look what there is at a stamp [ns], where the wheels have stood for long enough."""
        if not is_still:
            self._rest_began = NEVER
        elif self._rest_began == NEVER:
            self._rest_began = stamp
        elif stamp - self._rest_began >= REST:
            self.has_gravity = abs(self._size) > NO_GRAVITY
            self.is_plausible = (not self.has_gravity
                                 or GRAVITY[0] <= self._size <= GRAVITY[1])

    @property
    def fault(self) -> str:
        """Return in words what must be wrong with a sensor that is not plausible."""
        if GRAVITY[0] <= -self._size <= GRAVITY[1]:
            return 'at rest gravity does not point up: wrong imu_orientation?'
        return f'{abs(self._size):.3g} m/s^2 at rest is not gravity: wrong unit?'
