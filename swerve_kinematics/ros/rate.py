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

"""How often something comes, by how often it has come."""


class Rate:
    """
    Tells the rate of something between two looks, however late they are.

    Parameters
    ----------
    now : float
        Time from which on it is looked at [s].

    """

    def __init__(self, now: float) -> None:
        """Start with nothing come."""
        self._total, self._looked = 0, now

    def look(self, total: int, now: float) -> float:
        """Take how often it has come in all, and return its rate since the last look [Hz]."""
        new, elapsed = total - self._total, now - self._looked
        self._total, self._looked = total, now
        return new / elapsed if elapsed > 0.0 else 0.0
