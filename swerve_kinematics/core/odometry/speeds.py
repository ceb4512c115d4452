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

"""Whether measured speeds are the change of the measured positions, or what unit would fit."""

from collections.abc import Sequence
import math

from swerve_kinematics.core.odometry.readings import FASTEST_RIM

# Speeds and changes of position are compared as means over about this time [s]: speeds lag
# behind while a wheel speeds up, and positions come in steps.
MEMORY = 0.3
# Samples that come faster than this [s], which is 50 Hz with some jitter, are not looked at one
# by one.
PACE = 0.018
# In an honest message they differ by less than this [m/s], plus this part of the largest speed
# of late, which is forgotten that many times as slowly: a wheel that stops lags behind too.
TOLERANCE = 0.05
RATIO = 0.25
SLOWER = 3.0
# A contradiction that lasts for so long [s] is reported.
LASTING = 1.0
# The units that speeds may be in by mistake, and how many times too large that makes them.
UNITS = {'rpm': 60.0 / math.tau, 'deg/s': 360.0 / math.tau, 'turns/s': 1.0 / math.tau}
# A unit explains a ratio that is within this part of it.
FIT = 0.1
# A position that changes by less than this part of what the velocity says does not change at all;
# nor does a velocity that stays below the second value [m/s].
STANDING_RATIO, STANDING_SPEED = 0.01, 1e-3


class SpeedCheck:
    """
    Compares the speeds of wheels with the changes of their positions.

    Parameters
    ----------
    scales : sequence of float (n,)
        By which the reported velocities [rad/s] have been multiplied to be speeds of the rim
        [m/s]: how far each rim rolls by the angle of its joint [m/rad].

    """

    def __init__(self, scales: Sequence[float]) -> None:
        """Start without a sample."""
        self._wheels = [_Wheel(scale) for scale in scales]
        self._distances: Sequence[float] | None = None
        self._elapsed, self._all_hold = 0.0, True

    def restart(self) -> None:
        """Forget the last positions: what was rolled until the next ones is not known."""
        self._distances = None

    def holds(self, dt: float, distances: Sequence[float], speeds: Sequence[float]) -> bool:
        """
        Return whether the speeds can be believed.

        Parameters
        ----------
        dt : float
            Time since the last call [s].
        distances : sequence of float (n,)
            Cumulative, of the rims [m].
        speeds : sequence of float (n,)
            Of the rims [m/s].

        """
        last, self._elapsed = self._distances, self._elapsed + dt
        if last is None or not dt > 0.0:
            for wheel, speed in zip(self._wheels, speeds):
                wheel.before = speed
        elif self._elapsed < PACE:
            return self._all_hold
        else:
            self._all_hold = self._compare(self._elapsed, last, distances, speeds)
        self._distances, self._elapsed = distances, 0.0
        return self._all_hold

    def _compare(self, dt: float, last: Sequence[float], distances: Sequence[float],
                 speeds: Sequence[float]) -> bool:
        """Return whether the speeds hold after a step of `dt` [s] from the last distances."""
        gain = dt / (MEMORY + dt)
        kept, holds = 1.0 - gain / SLOWER, True
        for wheel, distance, before, speed in zip(self._wheels, distances, last, speeds):
            holds &= wheel.update(dt, gain, kept, (distance - before) / dt, speed)
        return holds

    def contradictions(self) -> list[tuple[int, str]]:
        """Return each wheel whose speed has been wrong for a while, and what would explain it."""
        return [(index, wheel.explanation) for index, wheel in enumerate(self._wheels)
                if wheel.wrong_for >= LASTING]


class _Wheel:
    """The speeds of one wheel: as the encoder's counts tell them, and as they are reported."""

    def __init__(self, scale: float) -> None:
        """Start with nothing known."""
        self._scale = scale
        # The speed by the positions and, as the imaginary part, the reported one: both are
        # smoothed alike.
        self._speeds = complex(math.nan, math.nan)
        self._product = self._square = self._largest = 0.0
        self.before = math.nan
        self.holds, self.wrong_for = True, 0.0

    def update(self, dt: float, gain: float, kept: float, rolled: float, reported: float) -> bool:
        """
        Return whether the reported speed holds, by one more step of `dt` [s].

        `gain` is the part of the step in the means, `kept` what is left of the largest speed;
        `rolled` is the mean speed in the step by the positions, `reported` the one at its end
        [m/s].
        """
        if not abs(rolled) <= FASTEST_RIM:
            self.before = reported
            return self.holds
        # The mean of the step is compared with the mean of the speeds at its ends.
        now, speeds = complex(rolled, 0.5 * (self.before + reported)), self._speeds
        self.before = reported
        self._speeds = speeds = speeds + gain * (now - speeds) if speeds == speeds else now
        rolled, reported = speeds.real, speeds.imag
        self._largest = largest = max(reported, -reported, rolled, -rolled, kept * self._largest)
        self.holds = abs(reported - rolled) <= TOLERANCE + RATIO * largest
        if not self.holds:
            self.wrong_for += dt
            self._product += reported * rolled
            self._square += rolled * rolled
        elif self.wrong_for:
            self.wrong_for = self._product = self._square = 0.0
        return self.holds

    @property
    def explanation(self) -> str:
        """Return in a few words what the reported speed is instead."""
        if self._square <= STANDING_RATIO * abs(self._product) or not self._square:
            return 'the position does not change'
        ratio = self._product / self._square
        if abs(self._speeds.imag) < STANDING_SPEED:
            return 'the velocity does not change'
        turned = ', reversed' if ratio < 0.0 else ''
        for unit, factor in (('rad/s', 1.0), ('m/s', abs(self._scale)), *UNITS.items()):
            if abs(abs(ratio) / factor - 1.0) <= FIT:
                return f'it fits as {unit}{turned}'
        return f'it is {ratio:.3g} times as large'
