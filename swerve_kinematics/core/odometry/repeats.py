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

"""Samples of encoders that repeat an old reading, because there is no new one yet."""

from collections.abc import Sequence

from swerve_kinematics.core.odometry.readings import UNKNOWN

# Wheels seldom stop faster than this [m/s^2]: a distance that has not changed at all is taken for
# an old one, unless it stays as it is for so long [s], for encoders are read at 20 Hz or more. A
# wheel that really stops so fast costs no more than that wait.
HARDEST_STOP = 5.0
LONGEST_WAIT = 0.05
# Drivers that have repeated a reading are expected to do it again for so long [s].
MEMORY = 10.0


class Repeats:
    """
    Recognizes old readings, and keeps what the accelerometer says until there are new ones.

    A driver that publishes faster than it hears from its encoders repeats their readings. A
    wheel then seems to stand still for a moment in the middle of its motion, which no wheel
    does: the twist would flicker, and an accelerometer would contradict the wheels as it does
    slip. From then on a step lasts until all wheels have moved: ask `has` for each sample while
    they are `expected`, then `wait` or take the `means`, and `keep` each sample that ends a step.

    Attributes
    ----------
    expected : float
        For how long old readings are expected yet [s]; 0 while there is no reason to.

    """

    def __init__(self) -> None:
        """Wait for the first sample, from a driver without that habit."""
        self._distances: Sequence[float] = ()
        self._rolled: Sequence[float] = ()
        self._standing: dict[int, float] = {}  # wheels that stopped at once, for how long [s]
        self._duration = self._waited = self.expected = 0.0
        self._force = self._rates = 0j

    @property
    def is_waiting(self) -> bool:
        """Return whether the step goes on until there are new readings."""
        return self._waited > 0.0

    def keep(self, dt: float, distances: list[float], rolled: list[float],
             resolution: float) -> bool:
        """
        Begin a step where the last one ended, and return whether old readings were found in it.

        Parameters
        ----------
        dt : float
            Duration of the last one [s].
        distances, rolled : list of float (n,)
            Of the modules at its end, and how far they rolled in it [m].
        resolution : float
            Of the encoders [m]: a wheel that stands by them may have rolled as far.

        """
        expected = self.expected
        if expected or self._standing or 0.0 in rolled:
            self._learn(dt, rolled, 2.0 * resolution)
        self._distances, self._rolled, self._duration = distances, rolled, dt
        return self.expected > expected == 0.0

    def _learn(self, dt: float, rolled: list[float], rounding: float) -> None:
        """Find out by wheels that stand still in the middle of their motion what to expect."""
        self.expected = max(self.expected - dt, 0.0)
        if self._waited:
            # It was worth the while, or a wheel really stands.
            self.expected = 0.0 if 0.0 in rolled else MEMORY
            self._waited, self._force, self._rates = 0.0, 0j, 0j
            return
        standing, least = self._standing, HARDEST_STOP * dt
        for module, (now, before) in enumerate(zip(rolled, self._rolled)):
            if now:
                stood = standing.pop(module, LONGEST_WAIT)
                if stood < LONGEST_WAIT and abs(now) > least * dt + rounding:
                    self.expected = MEMORY
            elif module in standing or abs(before) > least * self._duration + rounding:
                standing[module] = standing.get(module, 0.0) + dt

    def has(self, dt: float, distances: list[float], resolution: float) -> bool:
        """Return whether one of these distances [m] is an old one, that of `dt` [s] ago."""
        if dt >= LONGEST_WAIT:
            return False
        least = HARDEST_STOP * dt * self._duration + 2.0 * resolution
        for distance, last, rolled in zip(distances, self._distances, self._rolled):
            if distance == last and abs(rolled) > least:
                return True
        return False

    def wait(self, dt: float, force: complex | None, rates: complex | None) -> None:
        """Take in what the accelerometer says in a step that is to go on after `dt` [s]."""
        span, self._waited = dt - self._waited, dt
        self._force += span * (UNKNOWN if force is None else force)
        self._rates += span * (UNKNOWN if rates is None else rates)

    def means(self, dt: float, force: complex | None,
              rates: complex | None) -> tuple[complex | None, complex | None]:
        """Return the means of force and rates over the whole of a step, None where unknown."""
        if not self._waited:
            return force, rates
        self.wait(dt, force, rates)
        force, rates = self._force / dt, self._rates / dt
        return force if force == force else None, rates if rates == rates else None
