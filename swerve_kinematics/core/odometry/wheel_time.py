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

# The time between readings is a mean over so many steps of a moving base, as drivers that repeat
# readings are found out in motion, and is used from the first number of them on. Readings follow
# the stamps by this part of what one is late.
FIRST_STEPS, STEPS = 10, 40
PHASE_GAIN = 0.1
# Readings come more often than before where a step is shorter than this part of the last one, by
# its stamps and by its wheels, or where stamps are early, by so many periods in all, but none was
# late before. They come less often where a stamp is late again before others have made up for it,
# or where readings seem to be lost in more than so many steps in a row. What is neither made up
# for nor repeated fades by this factor in each step.
SHORTER, MOST_EARLY, MOST_LOSSES = 0.75, 2.0, 5
FADE = 0.9
# Where a step that is long by its stamps is one of wheels at this speed [m/s] or less, readings
# were hardly lost: wheels that start to move roll further in each step.
SLOW_SPEED = 0.04


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

    """

    def __init__(self, count: int) -> None:
        """Start with stamps that are right."""
        self._root = math.sqrt(count)
        self._rolled, self._turned = Evidence(LEAST_WAY), Evidence(LEAST_TURN)
        self._period = self._late = 0.0  # between readings; of the last stamp [s]
        self._steps, self._is_settled = 0, False  # how many the period is a mean of; is it known
        self._is_plain = False  # whether it is, and stamps are right
        self._dt = self._even = 0.0  # of the last step, by its stamps and as the usual one [s]
        self._count = 1  # how many readings it took
        self._unsure = 0  # in how many steps there is nothing to learn
        self._is_behind = False  # whether a stamp was late, and none has made up for it yet
        self._delay = 0.0  # by how many periods stamps are late that none has made up for
        self._losses = 0  # how many steps in a row took more than one reading
        # Time [s] and way [m] for each, in the last step and in the one before.
        self._each = self._each_before = self._way = self._way_before = math.nan
        # Turn for each in this step and in the two before [rad]; NaN where nobody has asked.
        self._turn = self._turn_last = self._turn_before = math.nan
        self._bend = math.nan  # how far the last three times are from a line [s]

    def interrupt(self) -> None:
        """Forget the last step, around a gap; what is known of the stamps stays."""
        self._each = math.nan

    def forget_period(self) -> None:
        """Find out anew how often there are readings."""
        self._steps, self._is_settled, self._is_plain = 0, False, False
        self._late = self._delay = 0.0
        self._losses = 0

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
        self._dt = self._even = dt
        self._count = 1
        if self._is_plain and abs(dt - self._period) < LEAST_PART * self._period:
            # The usual case: there is nothing to learn.
            self._late, self._delay, self._is_behind, self._turn = 0.0, 0.0, False, math.nan
            self._each_before, self._each = self._each, dt
            self._way_before, self._way = self._way, way
            return dt
        self._turn_before, self._turn_last, self._turn = self._turn_last, self._turn, math.nan
        if self._each == self._each and (way + self._way > 2.0 * LEAST_SPEED * usual
                                         or self._steps and not self._is_settled):
            return self._in_motion(dt, way)
        # Too slow to tell anything, or the first step after a gap.
        self._late, self._bend = 0.0, math.nan
        self._each_before, self._each = self._each, dt
        self._way_before, self._way = self._way, way
        return dt

    def turn_duration(self, turn: float) -> float:
        """Return how long the gyro took for the turn of the same step [rad], by stamps or not."""
        if self._rolled.part == 1.0:
            return self._dt
        self._turn = turn = abs(turn) / self._count
        last = self._turn_last
        speed = (turn + last) / (self._each + self._each_before)
        went = turn - last - last + self._turn_before
        if speed > LEAST_SPEED and went == went and abs(self._bend) > LEAST_PART * self._period:
            self._turned.add(self._dt, self._bend * speed, went)
        return self._between(self._turned.part)

    def _in_motion(self, dt: float, way: float) -> float:
        """Return how long a step lasted of wheels that move, and learn from it."""
        self._steps = min(self._steps + 1, STEPS)
        if not self._is_settled:
            self._settle(dt)
        elif not self._follow(dt, way):
            self.interrupt()
            return dt
        last, each, count = self._each, dt, self._count
        if count > 1:
            each, way = dt / count, way / count
        self._bend = each - last - last + self._each_before
        self._each_before, self._each = last, each
        if self._unsure:
            self._unsure -= 1
        elif abs(self._bend) > LEAST_PART * self._period and self._is_settled:
            self._learn(way)
        self._way_before, self._way = self._way, way
        self._is_plain = self._is_settled and self._rolled.part == 1.0
        return self._between(self._rolled.part)

    def _settle(self, dt: float) -> None:
        """Find out how often there are readings."""
        self._period += (dt - self._period) / self._steps
        # Not between a stamp that is late and those that make up for it.
        self._is_settled = (self._steps >= FIRST_STEPS
                            and abs(dt - self._period) < 0.5 * self._period)

    def _follow(self, dt: float, way: float) -> bool:
        """
        Count the readings that a step took, and find out how long it was if they are even.

        Return False if the clock was set back: nobody knows how long it was then.
        """
        period, missing = self._period, 0
        late = self._late + dt - period
        if abs(late) > 0.5 * period:
            missing = round(late / period)
            late -= missing * period
        # Where a step is long, a stamp is late, or readings were lost: then wheels rolled further.
        further = missing and way >= (1.0 + 0.5 * abs(missing)) * max(
            self._way, SLOW_SPEED * period)
        if missing < 0:
            if further:
                return False
            if self._delay < 0.5:
                # It may have been set back by less, or readings are late that nobody noticed.
                self._unsure = 3
        # What comes late makes the next step a short one: no two of them follow each other.
        if missing > 0 and (further or self._is_behind):
            self._count += missing
            missing = 0
        self._is_behind = missing > 0
        if self._is_another_rate(missing) or (
                dt < SHORTER * period and way < SHORTER * self._way and self._rolled.part < 1.0):
            self.forget_period()
            return True
        self._period = period + (dt / self._count - period) / self._steps
        self._even = self._count * period + PHASE_GAIN * late
        self._late = late - PHASE_GAIN * late
        return True

    def _is_another_rate(self, missing: int) -> bool:
        """Return whether readings come more or less often, by a stamp so many periods late."""
        self._losses = self._losses + 1 if self._count > 1 else 0
        is_late_again = missing > 0 and self._delay > 0.5
        self._delay = self._delay + missing if missing else FADE * self._delay
        return is_late_again or self._delay < -MOST_EARLY or self._losses > MOST_LOSSES

    def _between(self, part: float) -> float:
        """Return a duration between the usual one and that by the stamps, which counts in part."""
        return self._dt if part == 1.0 else self._even + part * (self._dt - self._even)

    def _learn(self, way: float) -> None:
        """Compare the last three steps, of which the wheels rolled so far in the last one [m]."""
        went = way - self._way - self._way + self._way_before
        if went == went:
            speed = (way + self._way) / (self._each + self._each_before)
            # A lost reading that was not recognized must not count for hundreds of steps.
            most = 0.5 * self._period
            self._rolled.add(self._dt, min(max(self._bend, -most), most) * speed, went)
