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

"""Which samples of an accelerometer to believe, those of collisions among them."""

import math

from swerve_kinematics.core.odometry.inertial import USUAL_RANGE

# The widest range [m/s^2] that sensors of this kind are set to, 16 g, and how long a collision
# presses like that [s]: a sensor that says so for longer is at the end of its range, or broken.
# One that says so for a greater part of the time is shaken, and its samples tell nothing.
LARGEST_HIT, LONGEST_HIT, LARGEST_PART = 160.0, 0.1, 0.1
# Two forces in a row of a collision have about one direction, and the smaller is at least this
# part of the larger: so it is in one of 30 ms that is sampled at 200 Hz. What stands alone is a
# spike, and a part that rings changes its sign.
LEAST_LIKENESS = 0.25


class RangeCheck:
    """
    Tells forces of driving and of collisions from those of a sensor that is out of range.

    Attributes
    ----------
    is_doubting : bool
        Whether the latest force is a spike, or the first one of a collision: the next one shows.
    confirms : bool
        Whether it shows that the one before it was of a collision.

    """

    def __init__(self) -> None:
        """Start at rest."""
        self._before = 0j
        self._hit = 0.0  # how long forces were beyond the usual range of late [s]
        self.is_doubting = self.confirms = False

    def believes(self, dt: float, force: complex) -> bool:
        """
        Take a sample; return whether a base drives, or collides, with such a force.

        Parameters
        ----------
        dt : float
            Time since the sample before [s].
        force : complex
            Specific force [m/s^2], or not finite.

        """
        size, before = math.hypot(force.real, force.imag), self._before
        is_usual = size <= USUAL_RANGE
        self._hit += -LARGEST_PART * dt if is_usual else dt
        self._hit = min(max(self._hit, 0.0), 2.0 * LONGEST_HIT)
        if not (is_usual or size <= LARGEST_HIT and self._hit <= LONGEST_HIT):
            self._before, self.is_doubting, self.confirms = 0j, False, False
            return False
        largest = max(size, abs(before))
        is_alike = (before * force.conjugate()).real >= LEAST_LIKENESS * largest * largest
        self.confirms = self.is_doubting and is_alike
        self._before, self.is_doubting = force, not (is_usual or is_alike)
        return not self.is_doubting
