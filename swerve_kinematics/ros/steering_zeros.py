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

"""Tells when steering joints read something else without having turned there."""

from collections import deque
from collections.abc import Sequence
import math

from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds

TURN = 2.0 * math.pi
# Between readings nothing turns a module farther away from its command than by this [rad], and
# this fast [rad/s]. In a silence it keeps its angle: a longer time counts as this one [s].
TOLERANCE, FASTEST, LONGEST = 0.15, 10.0, 0.05
# A glitch is over sooner [ns], and in a longer silence [ns] somebody may have turned the modules.
PERSISTENCE, FORGETTING = nanoseconds(0.1), nanoseconds(10.0)
# So many commands between two readings are remembered, at 50 Hz for as long as a silence may be.
MOST_COMMANDS = 500


class SteeringZeros:
    """
    Watches for steering joints that have lost their zero, as when an encoder restarts.

    A module cannot leap. Where its reading does, away from all angles that it was told to take of
    late, and does not leap back, nobody knows where its wheel points. Whole turns of the module do
    not matter. Before the base has driven, readings may become right at any time.

    Parameters
    ----------
    count : int
        Number of modules.

    """

    def __init__(self, count: int) -> None:
        """Start with nothing to compare with."""
        self._none = [0.0] * count
        self.forget()

    def forget(self) -> None:
        """Take the next readings as they are."""
        self._leaps, self._since = self._none, 0
        self._stamp = 0
        self._angles: Sequence[float] | None = None
        # Commands since the latest reading, and between the two before it, which a reading that
        # comes late may still show.
        self._told: deque[Sequence[float]] = deque(maxlen=MOST_COMMANDS)
        self._told_before = self._told
        self._has_driven = False

    def command(self, angles: Sequence[float], is_driving: bool) -> None:
        """Take the angles [rad] that the modules are told to take, and whether the base drives."""
        self._told.append(angles)
        self._has_driven |= is_driving

    def read(self, stamp: int, angles: Sequence[float]) -> None:
        """
        Take the module angles that the joints tell.

        Parameters
        ----------
        stamp : int
            Their time [ns].
        angles : sequence of float (n,)
            [rad].

        """
        elapsed, before = stamp - self._stamp, self._angles
        if not 0 < elapsed <= FORGETTING:  # a silence, or a clock or simulator that was reset
            self.forget()
        elif self._has_driven and before is not None:
            farthest = TOLERANCE + FASTEST * min(elapsed / NANOSECONDS, LONGEST)
            for module, angle in enumerate(angles):
                if abs(angle - before[module]) > farthest:
                    told = [each[module] for each in (*self._told_before, *self._told)]
                    self._leap(module, stamp, angle, before[module], farthest, told)
        self._stamp, self._angles = stamp, angles
        if self._told:
            self._told_before, self._told = self._told, deque(maxlen=MOST_COMMANDS)

    def _leap(self, module: int, stamp: int, angle: float, before: float, farthest: float,
              told: Sequence[float]) -> None:
        """Add a leap to those of a module, unless it only catches up with where it was told to."""
        leap, known = _wrapped(angle - before), self._leaps[module]
        if abs(leap) <= farthest or not known and any(
                abs(to - angle) < abs(to - before)
                or abs(_wrapped(to - angle)) < abs(_wrapped(to - before)) for to in told):
            return
        if not any(self._leaps):
            self._since = stamp
        rest = _wrapped(known + leap)
        self._leaps = [*self._leaps]
        # What leaps back may have turned a little meanwhile.
        self._leaps[module] = rest if abs(rest) > farthest else 0.0

    @property
    def lost(self) -> list[bool]:
        """Return of each module whether its joint has lost its zero."""
        is_settled = self._stamp - self._since > PERSISTENCE
        return [leap != 0.0 and is_settled for leap in self._leaps]


def _wrapped(angle: float) -> float:
    """Return the equivalent angle in [-pi, pi] [rad]."""
    return math.remainder(angle, TURN)
