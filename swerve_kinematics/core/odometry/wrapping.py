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

"""Drive joints whose positions wrap, as within +-pi, made continuous again."""

import math
from typing import Sequence

from swerve_kinematics.core.geometry.clamping import clamped
from swerve_kinematics.core.odometry.readings import FASTEST_RIM, SHORTEST
from swerve_kinematics.core.odometry.traction import USUAL_GRIP

# Periods that drivers are known to wrap at, +-pi to +-4 pi among them [rad].
WRAPS = (math.pi, 2.0 * math.pi, 4.0 * math.pi, 8.0 * math.pi)
# A jump may differ from such a period by this share of it.
TOLERANCE = 0.2
SMALLEST_JUMP = (1.0 - TOLERANCE) * WRAPS[0]
# A joint that wraps reads within its period; if it wraps towards 0 from either side, in two.
GREATEST_SPAN = 2.1
# The speed of a joint is averaged over about this time [s], because stamps jitter.
SMOOTHING = 0.05
# Over a longer time [s] the reported velocity tells better how far the joint has gone.
LONG_STEP = 0.1


class DriveUnwrapper:
    """
    Makes the positions of n drive joints continuous.

    Of all the turns that a reading may mean, it takes the one that comes nearest to what the
    joint's speed leads to expect. Where no period is given, or a wrong one, a wrap betrays
    itself: the joint jumps by a period that drivers wrap at, against a speed that it cannot
    have changed so fast, or that its reported velocity confirms. So it seems where a geared wheel
    begins to spin. But such a joint soon reads further apart than one that wraps ever does.

    Parameters
    ----------
    distances_per_radian : sequence of float (n,)
        How far each rim rolls by the angle of its joint [m/rad].
    period : float
        Difference of two readings that mean the same [rad]; 0 if they never wrap.

    Attributes
    ----------
    period : float
        As given, while no wrap tells better.
    is_found : bool
        Whether `period` was found out.

    """

    def __init__(self, distances_per_radian: Sequence[float], period: float = 0.0) -> None:
        """Start without a reading."""
        self.period, self.is_found, self._given = period, False, period
        self._greatest_accelerations = [
            USUAL_GRIP / abs(distance) for distance in distances_per_radian]
        self._greatest_speeds = [
            FASTEST_RIM / abs(distance) for distance in distances_per_radian]
        self._lowest = [math.inf] * len(distances_per_radian)
        self._highest = [-math.inf] * len(distances_per_radian)
        self.clear()

    def clear(self) -> None:
        """Forget where the joints are: what they do until the next reading is not known."""
        self._readings: list[float] = []

    def counted(self, elapsed: float, readings: Sequence[float],
                velocities: Sequence[float]) -> list[float]:
        """
        Return positions that do not wrap.

        Parameters
        ----------
        elapsed : float
            Time since the readings before [s].
        readings : sequence of float (n,)
            What the joints report [rad].
        velocities : sequence of float (n,)
            What they report [rad/s]; of no use where NaN, or more than any wheel does.

        Returns
        -------
        list of float (n,)
            [rad]; after `clear` they begin again at the readings.

        """
        velocities = [velocity if -greatest <= velocity <= greatest else math.nan
                      for velocity, greatest in zip(velocities, self._greatest_speeds)]
        if not self._readings:
            self._positions = list(readings)
            self._speeds = [0.0 if math.isnan(velocity) else velocity for velocity in velocities]
            # For how long [s] each joint has told its speed; from SMOOTHING on that is known.
            self._heard = [0.0 if math.isnan(velocity) else SMOOTHING for velocity in velocities]
        for joint, reading in enumerate(readings):
            if self._readings:
                self._advance(joint, elapsed, reading, velocities[joint])
            if reading < self._lowest[joint]:
                self._lowest[joint] = reading
            if reading > self._highest[joint]:
                self._highest[joint] = reading
        self._readings, self._velocities = list(readings), velocities
        return list(self._positions)

    def _advance(self, joint: int, elapsed: float, reading: float, velocity: float) -> None:
        """Add what a joint has turned, and take its speed from that."""
        step, speed = reading - self._readings[joint], self._speeds[joint]
        if self.is_found and self._reads_apart(joint, reading):
            self._take_back()
        expected = predicted = speed * elapsed
        reported = 0.5 * (self._velocities[joint] + velocity) * elapsed
        if elapsed > LONG_STEP and math.isfinite(reported):
            expected = reported
        if self.period:
            if step == 0.0 and not abs(velocity * elapsed) > TOLERANCE * self.period:
                # The very same reading means rest, not a whole turn over and over.
                self._speeds[joint] = 0.0
                return
            step += self.period * round((expected - step) / self.period)
        if abs(step - expected) > SMALLEST_JUMP:
            step -= self._wrap(joint, elapsed, step - expected, expected - reported)
        self._positions[joint] += step
        # Until the speed is known it is the mean of all steps: stamps jitter, the first one's too.
        is_known, heard = self._heard[joint] >= SMOOTHING, self._heard[joint] + elapsed
        smoothing = SMOOTHING + elapsed if is_known else max(heard, SHORTEST)
        self._speeds[joint] = clamped(
            speed + (step - predicted) / smoothing, self._greatest_speeds[joint])
        self._heard[joint] = heard

    def _wrap(self, joint: int, elapsed: float, jump: float, doubt: float) -> float:
        """
        Return the period that a jump hides, with its sign, and keep it; 0 if it is no wrap.

        `jump` is by how much the joint has turned further than expected, and `doubt` by how much
        that expectation is more than its velocity reports; NaN where it reports none.
        """
        is_confirmed = abs(doubt) < TOLERANCE * WRAPS[0]
        # A joint whose speed is not known yet may have any that a wheel can have.
        is_known = self._heard[joint] >= SMOOTHING
        possible = (self._greatest_accelerations[joint] * elapsed ** 2 if is_known
                    else self._greatest_speeds[joint] * elapsed)
        is_impossible = abs(jump) > possible
        span = self._highest[joint] - self._lowest[joint]
        for period in WRAPS if is_confirmed or is_impossible else ():
            # Or it has turned so far, as its velocity says.
            is_told = abs(jump + doubt) < 0.5 * period
            if (abs(abs(jump) - period) < TOLERANCE * period and span < GREATEST_SPAN * period
                    and not is_told):
                self.period, self.is_found = period, True
                return math.copysign(period, jump)
        return 0.0

    def _reads_apart(self, joint: int, reading: float) -> bool:
        """Return whether a joint has shown readings that are too far apart for the period."""
        span = max(self._highest[joint], reading) - min(self._lowest[joint], reading)
        return span >= GREATEST_SPAN * self.period

    def _take_back(self) -> None:
        """Be as before a wrap was found, and learn the speeds anew, which it has spoilt."""
        self.period, self.is_found = self._given, False
        self._heard = [0.0] * len(self._heard)
