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

"""What there is to say of who commands the base, and how often."""

from collections.abc import Iterator
import math
from typing import Any

from swerve_kinematics.ros.command_input import CommandInput
from swerve_kinematics.ros.diagnostics import Finding, OK, WARN
from swerve_kinematics.ros.grading import Grading, Patience
from swerve_kinematics.ros.peers import Peers
from swerve_kinematics.ros.stamps import NANOSECONDS

# A node that hands over to another one, or that is restarted, is one change of sender.
LEAST_CHANGES = 2
# Seen in two reports, a second apart.
CONFLICT = Patience(warn=0.5, error=math.inf, clear=3.0)
# Seen in three: who lets go of a key for once has paused on purpose.
PAUSES = Patience(warn=1.5, error=math.inf, clear=3.0)


class CommandSenders:
    """
    Tells when several nodes command the base at once, which obeys now one and now the other.

    A message says nothing of who sent it, but the middleware numbers those of each publisher: a
    number that does not go up is another one's. Where messages have no number, nothing is told.
    """

    def __init__(self) -> None:
        """Start with no command."""
        self._number, self._twist = -1, (0.0, 0.0, 0.0)
        self._changes = 0
        self._grading = Grading(CONFLICT)

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
        return self._grading.lasts(changes >= LEAST_CHANGES, now)


class CommandReport:
    """
    Looks at the velocity commands; meant for about once a second.

    Parameters
    ----------
    peers : Peers
        Tells who publishes.
    commands : CommandInput
        Tells what came of that.

    Attributes
    ----------
    senders : CommandSenders
        Is told of every command.

    """

    def __init__(self, peers: Peers, commands: CommandInput) -> None:
        """Start with nothing found."""
        self._peers, self._input = peers, commands
        self.senders = CommandSenders()
        self._pauses, self._pauses_counted = Grading(PAUSES), 0

    def findings(self, now: float) -> Iterator[Finding]:
        """Yield level and message of what there is to say at a time [s]."""
        if not self._input.has_come:
            # To wait for the first command is no fault.
            yield from ((OK, told) for told in self._peers.elsewhere('cmd_vel'))
        if self.senders.are_in_conflict(now):
            names = self._peers.publishers('cmd_vel')
            # Alone is who was left by the others, or makes a publisher for each message.
            if len(names) > 1:
                yield WARN, (f"cmd_vel comes in turn from {' and '.join(names)}, "
                             'with different values: only one may send at a time')
        if self._keeps_pausing(now):
            yield WARN, ('cmd_vel pauses for longer than cmd_vel_timeout '
                         f'{self._input.timeout / NANOSECONDS:g} s, '
                         'so that the base stops again and again')

    def _keeps_pausing(self, now: float) -> bool:
        """Tell whether the base had to stop in between commands, second after second."""
        counted, self._pauses_counted = self._pauses_counted, self._input.pauses
        return self._pauses.lasts(self._pauses_counted > counted, now)
