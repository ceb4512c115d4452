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

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds

# Between readings nothing turns a module farther away from its commands than by this [rad], and
# this fast [rad/s]. In a silence it keeps its angle: a longer time counts as this one [s].
TOLERANCE, FASTEST, LONGEST = 0.15, 10.0, 0.05
# A glitch is over sooner [ns], and in a longer silence [ns] somebody may have turned the modules.
PERSISTENCE, FORGETTING = nanoseconds(0.1), nanoseconds(10.0)
# Readings come late, and show commands that were given up to so long [ns] before them.
LATENESS = nanoseconds(0.5)
# While no readings come, no command grows old: no more than so many are kept.
MOST_ANGLES = 1000


class SteeringZeros:
    """
    Watches for steering joints that have lost their zero, as when an encoder restarts.

    A module can only be where it was of late, where it was told to go, or on the way. Where its
    reading leaps elsewhere, and does not leap back, nobody knows where its wheel points. How fast
    modules turn, and how late or how rarely that is heard, does not matter, nor do whole turns of
    the module. Before the base has driven, readings may become right at any time.

    Parameters
    ----------
    count : int
        Number of modules.

    """

    def __init__(self, count: int) -> None:
        """Start with nothing to compare with."""
        self._count = count
        self.forget()

    def forget(self) -> None:
        """Take the next readings as they are."""
        self._leaps, self._since = [0.0] * self._count, 0
        self._stamp = 0
        self._angles: Sequence[float] | None = None
        # What was read and told of late, with the stamps of the readings known then.
        self._late: deque[tuple[int, Sequence[float]]] = deque(maxlen=MOST_ANGLES)
        self._has_driven = False

    def command(self, angles: Sequence[float], is_driving: bool) -> None:
        """Take the angles [rad] that the modules are told to take, and whether the base drives."""
        self._late.append((self._stamp, angles))
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
                    self._leap(module, stamp, angle, before[module], farthest)
        late = self._late
        while late and self._stamp - late[0][0] > LATENESS:
            late.popleft()
        self._stamp, self._angles = stamp, angles
        if not any(self._leaps):
            late.append((stamp, angles))

    def _leap(self, module: int, stamp: int, angle: float, before: float,
              farthest: float) -> None:
        """Add a leap to those of a module, unless it leads to where the module may be."""
        known, leap = self._leaps[module], _wrapped(angle - before)
        if abs(leap) <= farthest:
            return
        was = before - known
        ways = [0.0]
        if not (known and self._is_settled):
            ways += [angles[module] - was for _, angles in self._late]
        if not any(self._leaps):
            self._since = stamp
        may_be = _contains(ways, angle - was, farthest) or _contains(
            [_wrapped(way) for way in ways], _wrapped(angle - was), farthest)
        self._leaps[module] = 0.0 if may_be else _wrapped(known + leap)

    @property
    def _is_settled(self) -> bool:
        """Tell whether leaps have lasted for longer than a glitch."""
        return self._stamp - self._since > PERSISTENCE

    @property
    def lost(self) -> list[bool]:
        """Return of each module whether its joint has lost its zero."""
        is_settled = self._is_settled
        return [leap != 0.0 and is_settled for leap in self._leaps]


def _wrapped(angle: float) -> float:
    """Return the equivalent angle in [-pi, pi] [rad]."""
    return math.remainder(angle, TURN)


def _contains(values: Sequence[float], value: float, tolerance: float) -> bool:
    """Tell whether a value lies between others, or hardly beyond them."""
    return min(values) - tolerance <= value <= max(values) + tolerance
