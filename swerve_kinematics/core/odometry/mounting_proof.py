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

"""Whether an accelerometer has yet felt what the wheels did, or seems turned against them."""

import math

from swerve_kinematics.core.geometry.angles import phase

# An accelerometer has to prove itself: until it has felt two changes greater than this [m/s] as
# the wheels did, it is suspect as soon as two in a row have it turned by one angle, the same to
# within the last value [rad]. Both changes differ by less than the factor then, as they mostly do
# not where the base is pushed or wheels spin. On drives with a sound sensor (docs/figures.md)
# values between 0.1 and 0.25, 1 and 4, 1.3 and 2, 20 and 60 degrees make no difference.
FIRST_CHANGE, FIRST_CHANGES, LARGEST_FACTOR = 0.15, 2, 1.5
SAME_ANGLE = math.radians(40.0)


class MountingProof:
    """
    A quick judgement of the first motions, before there are enough of them to tell an angle.

    Attributes
    ----------
    is_given : bool
        Whether the accelerometer has felt the same as the wheels. Nothing takes that back.

    """

    def __init__(self) -> None:
        """Start without a proof."""
        self.is_given = False
        self._agreed, self._turn = 0, 0j

    def is_suspect(self, changed: complex, gained: complex) -> bool:
        """Judge by what wheels that agree and the force have changed of the velocity [m/s]."""
        if self.is_given or abs(changed) < FIRST_CHANGE:
            return False
        turn, last = gained / changed, self._turn
        self._turn = 0j
        if abs(phase(turn)) < SAME_ANGLE:
            self._agreed += abs(turn) > 1.0 / LARGEST_FACTOR
            self.is_given = self._agreed >= FIRST_CHANGES
        elif 1.0 / LARGEST_FACTOR < abs(turn) < LARGEST_FACTOR:
            self._turn = turn
            return bool(last) and abs(phase(turn / last)) < SAME_ANGLE
        return False
