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

"""What the pose still has to make up for, little by little."""

from typing import Generic, TypeVar

Correction = TypeVar('Correction', complex, float)

# A correction is made within about this time [s], so that the pose never jumps.
TIME = 0.5
# The fastest and the slowest one: of the position [m/s], and of the heading [rad/s]. The rest of a
# correction is made at the latter speed, for in proportion it would never end.
FASTEST, SLOWEST = 0.3, 0.05
FASTEST_TURN, SLOWEST_TURN = 1.0, 0.1


class CatchUp(Generic[Correction]):
    """
    Spreads corrections of the position, or of the heading, over the steps that follow.

    Parameters
    ----------
    none : complex or float
        0, of the kind that a correction is.
    slowest, fastest : float
        Speeds of a correction, [m/s] or [rad/s].

    Attributes
    ----------
    left : complex or float
        What is still to be corrected: [m] in the odom frame, or [rad].

    """

    def __init__(self, none: Correction, slowest: float, fastest: float) -> None:
        """Start without any."""
        self.left: Correction = none
        self._slowest, self._fastest = slowest, fastest

    def add(self, correction: Correction) -> None:
        """Take on a correction."""
        self.left += correction

    def part(self, dt: float) -> Correction:
        """Take off the part of the corrections for a step of `dt` [s], and return it."""
        size = abs(self.left)
        most = min(max(size / TIME, self._slowest), self._fastest) * dt
        part: Correction = self.left if most >= size else most / size * self.left
        self.left -= part
        return part
