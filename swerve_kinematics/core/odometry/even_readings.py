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

"""How often there are readings of the encoders, and when they were taken if that is even."""

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


class EvenReadings:
    """
    Follows the stamps of readings that are taken evenly (a phase-locked loop).

    Attributes
    ----------
    period : float
        Between readings [s].
    is_known : bool
        Whether the period is.
    count : int
        How many readings the last step took.
    duration : float
        Of that step if readings are even, else that by its stamps [s].
    is_early : bool
        Whether its stamp was early and nothing explains it.

    """

    def __init__(self) -> None:
        """Wait for wheels that move."""
        self.period = self.duration = 0.0
        self.count, self.is_early = 1, False
        self.forget()

    def forget(self) -> None:
        """Find out anew how often there are readings."""
        self._steps, self.is_known = 0, False  # how many the period is a mean of
        self._late = 0.0  # the latest stamp [s]
        self._is_behind = False  # whether a stamp was late, and the next has not made up for it
        self._delay = 0.0  # by how many periods stamps are late that none has made up for
        self._losses = 0  # how many steps in a row took more than one reading

    @property
    def is_settling(self) -> bool:
        """Return whether the period is being found out."""
        return self._steps > 0 and not self.is_known

    def skip(self, dt: float) -> None:
        """Take in a step of `dt` [s] that tells nothing."""
        self.duration, self.count = dt, 1
        self._late, self._delay, self._is_behind = 0.0, 0.0, False

    def take(self, dt: float, way: float, way_before: float, is_scattered: bool) -> bool:
        """
        Take in a step, and return False if the clock was set back: it may have been a long one.

        Parameters
        ----------
        dt : float
            Its duration by the stamps [s].
        way, way_before : float
            How far wheels rolled in it [m], and for each reading of the step before.
        is_scattered : bool
            Whether stamps are known to scatter.

        """
        self.duration, self.count, self.is_early = dt, 1, False
        self._steps = min(self._steps + 1, STEPS)
        if self.is_known:
            return self._follow(dt, way, way_before, is_scattered)
        self.period += (dt - self.period) / self._steps
        # Not between a stamp that is late and those that make up for it.
        self.is_known = self._steps >= FIRST_STEPS and abs(dt - self.period) < 0.5 * self.period
        return True

    def _follow(self, dt: float, way: float, way_before: float, is_scattered: bool) -> bool:
        """Count the readings that a step took, and find out how long it was if they are even."""
        period, missing = self.period, 0
        late = self._late + dt - period
        if abs(late) > 0.5 * period:
            missing = round(late / period)
            late -= missing * period
        # Where a step is long, a stamp is late, or readings were lost: then wheels rolled further.
        further = missing and way >= (1.0 + 0.5 * abs(missing)) * max(
            way_before, SLOW_SPEED * period)
        if missing < 0:
            if further:
                return False
            # The clock may have been set back by less, or a late stamp was not noticed.
            self.is_early = self._delay < 0.5
        # What comes late makes the next step a short one: no two of them follow each other.
        if missing > 0 and (further or self._is_behind):
            self.count += missing
            missing = 0
        self._is_behind = missing > 0
        if self._is_another_rate(missing) or (
                is_scattered and dt < SHORTER * period and way < SHORTER * way_before):
            self.forget()
            return True
        self.period = period + (dt / self.count - period) / self._steps
        self.duration = self.count * period + PHASE_GAIN * late
        self._late = late - PHASE_GAIN * late
        return True

    def _is_another_rate(self, missing: int) -> bool:
        """Return whether readings come more or less often, by a stamp so many periods late."""
        self._losses = self._losses + 1 if self.count > 1 else 0
        is_late_again = missing > 0 and self._delay > 0.5
        self._delay = self._delay + missing if missing else FADE * self._delay
        return is_late_again or self._delay < -MOST_EARLY or self._losses > MOST_LOSSES
