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

"""Where the modules are, seen from the centre of rotation."""

from collections.abc import Iterable


class Offsets(list[complex]):
    """
    Module positions x + iy from the centre of rotation [m]; they do not change.

    Parameters
    ----------
    positions : iterable of complex
        Module positions from base_link [m].
    center : complex
        Centre of rotation from base_link [m].

    Attributes
    ----------
    mean_arm, reach : float
        Distance of the modules from the centre [m], the mean and the greatest.

    """

    def __init__(self, positions: Iterable[complex], center: complex = 0j) -> None:
        """Measure the arms once."""
        super().__init__(position - center for position in positions)
        arms = [abs(offset) for offset in self]
        self.mean_arm, self.reach = sum(arms) / len(arms), max(arms)
