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

"""Tells when several nodes command the base at once, which obeys now one and now the other."""

import math
from typing import Any

from swerve_kinematics.ros.grading import Grading, Patience

# A node that hands over to another one, or that is restarted, is one change of sender.
LEAST_CHANGES = 2
# Seen in two reports, a second apart.
PATIENCE = Patience(warn=0.5, error=math.inf, clear=3.0)


class CommandSenders:
    """
    Counts how often commands change their sender and their value.

    A message says nothing of who sent it, but the middleware numbers those of each publisher: a
    number that does not go up is another one's. Where messages have no number, nothing is told.
    """

    def __init__(self) -> None:
        """Start with no command."""
        self._number, self._twist = -1, (0.0, 0.0, 0.0)
        self._changes = 0
        self._grading = Grading(PATIENCE)

    def heard(self, twist: tuple[float, float, float], info: dict[str, Any]) -> None:
        """
        Take a command.

        Parameters
        ----------
        twist : tuple of float (3,)
            What it says [m/s, m/s, rad/s].
        info : dict
            What rclpy says of the message.

        """
        number = info.get('publication_sequence_number')
        if number is None:
            return
        if number <= self._number and twist != self._twist:
            self._changes += 1
        self._number, self._twist = number, twist

    def are_in_conflict(self, now: float) -> bool:
        """
        Tell whether several senders contradict each other; meant for about once a second.

        Parameters
        ----------
        now : float
            Time [s].

        """
        changes, self._changes = self._changes, 0
        self._grading.update({'senders': ''} if changes >= LEAST_CHANGES else {}, now)
        return bool(self._grading.findings())
