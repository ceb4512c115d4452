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

# A correction is made within about this time [s], at no more than this speed [m/s], so that
# the pose never jumps.
TIME = 0.5
FASTEST = 0.3
# The rest of a correction is made at this speed [m/s]: in proportion it would never end.
SLOWEST = 0.05


class CatchUp:
    """
    Spreads corrections of the position over the steps that follow.

    Attributes
    ----------
    left : complex
        What is still to be corrected [m], in the odom frame.

    """

    def __init__(self) -> None:
        """Start without any."""
        self.left = 0j

    def add(self, correction: complex) -> None:
        """Take on a correction [m], in the odom frame."""
        self.left += correction

    def part(self, dt: float) -> complex:
        """Take off the part of the corrections for a step of `dt` [s], and return it [m]."""
        distance = abs(self.left)
        way = min(max(distance / TIME, SLOWEST), FASTEST) * dt
        part = self.left if way >= distance else way / distance * self.left
        self.left -= part
        return part
