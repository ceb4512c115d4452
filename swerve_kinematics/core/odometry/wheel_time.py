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

"""How long the wheels took for a step, where stamps scatter about the times of the readings."""

import math

from swerve_kinematics.core.odometry.even_readings import EvenReadings

# What wheels bear out is a mean over this time of driving [s]: a driver keeps its habits.
MEMORY = 20.0
# Until stamps have deviated by this way [m] or this turn [rad] (root of the sum of squares), they
# count as right. Deviations of less than this part of a step do not matter, and a motion that is
# slower than this [m/s], [rad/s] tells nothing of them.
LEAST_WAY, LEAST_TURN = 0.01, 0.03
LEAST_PART = 0.01
LEAST_SPEED = 0.1
# Wheels that slip change their speed by themselves: one step counts no more than this many times
# what its stamps told. If wheels bear out this part of the deviations, they bear out all.
LARGEST_RATIO = 1.5
FULL = 0.7
# A step that may have been longer than its stamps say is one of so many that are compared.
UNSURE = 3


class Evidence:
    """
    What part of the deviations of the stamps a motion bears out, by regression.

    Parameters
    ----------
    least : float
        Size of the deviations (root of the sum of squares) below which they count as right.

    Attributes
    ----------
    part : float
        From 0, where all are errors of the stamps, to 1.

    """

    def __init__(self, least: float) -> None:
        """Start with stamps that are right."""
        self._square = self._product = least * least
        self.part = 1.0

    def add(self, dt: float, told: float, went: float) -> None:
        """Take in a step of `dt` [s] that bends off a line by so much, by its stamps and truly."""
        keep, most = MEMORY / (MEMORY + dt), LARGEST_RATIO * abs(told)
        self._square = keep * self._square + told * told
        self._product = keep * self._product + told * min(max(went, -most), most)
        self.part = min(max(self._product / (FULL * self._square), 0.0), 1.0)


class WheelTime:
    """
    The duration of steps as the wheels bear it out.

    Many a driver reads its encoders evenly, but stamps the readings as they arrive: the base
    seems to be too fast and too slow by turns. Whether it does so the wheels tell: they roll as
    far in a step that is too short or too long by its stamps as in any other. Then a step lasts
    as long as the usual one, in phase with the stamps (a phase-locked loop). The stamps of
    readings that are taken unevenly the wheels bear out, and each step lasts as they say.

    Parameters
    ----------
    count : int
        Number of wheels.

    Attributes
    ----------
    readings : EvenReadings

    """

    def __init__(self, count: int) -> None:
        """Start with stamps that are right."""
        self.readings = EvenReadings()
        self._root = math.sqrt(count)
        self._rolled, self._turned = Evidence(LEAST_WAY), Evidence(LEAST_TURN)
        self._dt = 0.0  # of the last step, by its stamps [s]
        self._unsure = 0  # in how many steps there is nothing to learn
        # Time [s] and way [m] for each reading, in the last step and in the one before.
        self._each = self._each_before = self._way = self._way_before = math.nan
        # Turn for each in this step and in the two before [rad]; NaN where nobody has asked.
        self._turn = self._turn_last = self._turn_before = math.nan
        self._bend = math.nan  # how far the last three times are from a line [s]

    def interrupt(self) -> None:
        """Forget the last step, around a gap; what is known of the stamps stays."""
        self._each = math.nan

    def duration(self, dt: float, way: float, usual: float) -> float:
        """
        Return how long the wheels took for a step [s].

        Parameters
        ----------
        dt : float
            Time since the last sample by the stamps [s].
        way : float
            Root of the sum of squares of how far wheels rolled [m]; NaN where one is unknown.
        usual : float
            Duration of a step by the stamps, of late [s].

        """
        way /= self._root
        self._dt, readings = dt, self.readings
        is_usual = (readings.is_known and self._rolled.part == 1.0
                    and abs(dt - readings.period) < LEAST_PART * readings.period)
        if not is_usual and self._each == self._each and (
                way + self._way > 2.0 * LEAST_SPEED * usual or readings.is_settling):
            return self._in_motion(dt, way)
        # There is nothing to learn, or it is too slow for that, or the first step after a gap.
        readings.skip(dt)
        self._bend = self._turn = math.nan
        self._each_before, self._each = self._each, dt
        self._way_before, self._way = self._way, way
        return dt

    def turn_duration(self, turn: float) -> float:
        """Return how long the gyro took for the turn of the same step [rad], by stamps or not."""
        if self._rolled.part == 1.0:
            return self._dt
        self._turn = turn = abs(turn) / self.readings.count
        last = self._turn_last
        speed = (turn + last) / (self._each + self._each_before)
        went = turn - last - last + self._turn_before
        if (speed > LEAST_SPEED and went == went
                and abs(self._bend) > LEAST_PART * self.readings.period):
            self._turned.add(self._dt, self._bend * speed, went)
        return self._between(self._turned.part)

    def _in_motion(self, dt: float, way: float) -> float:
        """Return how long a step lasted of wheels that move, and learn from it."""
        self._turn_before, self._turn_last, self._turn = self._turn_last, self._turn, math.nan
        readings = self.readings
        if not readings.take(dt, way, self._way, self._rolled.part < 1.0):
            self.interrupt()
            return dt
        last, each, count = self._each, dt, readings.count
        if count > 1:
            each, way = dt / count, way / count
        self._bend = each - last - last + self._each_before
        self._each_before, self._each = last, each
        if readings.is_early:
            self._unsure = UNSURE
        if self._unsure:
            self._unsure -= 1
        elif readings.is_known and abs(self._bend) > LEAST_PART * readings.period:
            self._learn(way)
        self._way_before, self._way = self._way, way
        return self._between(self._rolled.part)

    def _between(self, part: float) -> float:
        """Return a duration between the usual one and that by the stamps, which counts in part."""
        even = self.readings.duration
        return self._dt if part == 1.0 else even + part * (self._dt - even)

    def _learn(self, way: float) -> None:
        """Compare the last three steps, of which the wheels rolled so far in the last one [m]."""
        went = way - self._way - self._way + self._way_before
        if went == went:
            speed = (way + self._way) / (self._each + self._each_before)
            # A lost reading that was not recognized must not count for hundreds of steps.
            most = 0.5 * self.readings.period
            self._rolled.add(self._dt, min(max(self._bend, -most), most) * speed, went)
