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

"""Whether the yaw and the rate of a gyro are believed, by each other and the wheels."""

import math

from swerve_kinematics.core.odometry.gyro import LARGEST_BIAS

# The values are judgements, within what test_yaw.py tells: it fails for SPAN 0.5, LASTING 0.5 or
# 2, SLOW_RATE 0.05, SLOW_TURN 0.2, SLOW_SPAN 2, TOO_FAST 2 or SILENT 6, and not for half or nearly
# twice of RATIO, LIKENESS and OPPOSITE.

# Two sources that differ by more than a bias, and by this part of the larger, contradict each
# other: the scale of a MEMS gyro is good to 3 % by its data sheet, and wheels creep.
RATIO = 0.2

# Turns are compared over so much time [s], more than two periods of an orientation at 10 Hz. They
# are believed or not after so much of one opinion, for an orientation that is filtered lags
# behind: by 0.16 s in the tests, where half of it would be too little.
SPAN = 0.25
LASTING = 1.0

# A turn that is too slow [rad/s] to be told from a bias shows in time: rate and wheels that agree,
# to this part, on a turn of this size [rad] within this time [s] are right about the yaw. A yaw
# that stands contradicts them at once from LARGEST_BIAS / (1 - RATIO) on, so that no rate is left
# out between; the slowest turn that shows is SLOW_TURN / SLOW_SPAN.
SLOW_RATE = 1.5 * LARGEST_BIAS
SLOW_TURN = 0.1
SLOW_SPAN = 4.0
LIKENESS = 0.3
NO_TURNS = 0.0, 0.0, 0.0, 0.0  # time [s], and turns by yaw, rate and wheels [rad]

# Wheels that agree with each other may all slip (on ice, a base pushed), so a gyro is wrong
# only if it says what no slip explains: the opposite, at this part of the wheels' turn or more;
# a turn so many times as fast, as degrees for radians are 57 times; or exactly the same all the
# time, without the noise of a living sensor, while the wheels turn by this many times the bias.
OPPOSITE = 0.5
TOO_FAST = 5.0
SILENT = 3.0

# A hand or a collision that turns the base may have all wheels say the opposite. They refute a
# gyro that they bore out before as much later as they did so, up to this time [s], which is longer
# than a push. One that is reversed, or in degrees, is so from the start, and frozen is frozen.
LARGEST_CREDIT = 5.0


class Trust:
    """
    Whether a source is believed: what was said for or against it lately changes that slowly.

    Attributes
    ----------
    given : bool
    is_contradicted : bool
        Whether the latest opinion says the opposite. To be set to False before the next one.
    is_proved : bool
        Whether the wheels have ever borne it out.
    astray : float
        How much further the wheels turned than the heading went by this source [rad], where they
        contradicted it since they last bore it out.

    """

    def __init__(self) -> None:
        """Start with trust, of which none is earned."""
        self.given, self.is_contradicted, self.is_proved = True, False, False
        self._contrary = self._credit = self.astray = 0.0

    def hear(self, good: bool, duration: float, is_sure: bool = True) -> None:
        """Take in an opinion that rests on so much time [s]; one that is not sure costs credit."""
        self.is_contradicted = good != self.given
        if not self.is_contradicted:
            self._contrary = 0.0
            if good:
                self.astray, self.is_proved = 0.0, True
                self._credit = min(self._credit + duration, LARGEST_CREDIT)
        elif self._credit > 0.0 and not is_sure:
            self._credit -= duration
        else:
            self._contrary += duration
        if self._contrary >= LASTING:
            self.given, self._contrary, self._credit = good, 0.0, 0.0


class GyroWatch:
    """
    Finds the yaw or the rate that the other one and the wheels contradict for a second.

    Of three that tell a turn, the one that stands alone is wrong. Against a gyro that agrees
    with itself, or that has a yaw or a rate only, the wheels' word counts less.

    Attributes
    ----------
    yaw, rate : Trust

    """

    def __init__(self) -> None:
        """Start with trust in both."""
        self.yaw, self.rate, self._amends = Trust(), Trust(), 0.0
        self._slow = NO_TURNS
        self._begin()

    def _begin(self) -> None:
        """Begin a span."""
        self._time = self._yaw = self._rate = self._wheels = self._astray = 0.0
        self._yaw_moves = self._rate_moves = False

    def update(self, dt: float, yaw: float, rate: float, wheels: float,
               rate_changes: bool, astray: float) -> None:
        """
        Take in the turns [rad] of a step of `dt` [s], NaN for those not known.

        `rate_changes` tells whether the rate at its end is any other than that at its start,
        `astray` how much further the wheels turned than the heading went [rad].
        """
        self._time += dt
        self._yaw += yaw
        self._rate += rate
        self._wheels += wheels
        self._astray += astray
        if yaw:
            self._yaw_moves = True
        if rate_changes:
            self._rate_moves = True
        if self._time >= SPAN:
            told = self._in_use()
            was_believed, told.is_contradicted = told.given, False
            self._judge()
            moves = yaw != 0.0 if told is self.yaw else rate_changes
            if (abs(self._astray) > LARGEST_BIAS * self._time
                    and not self._may_be_slip(told, moves)):
                told.astray += self._astray
            if was_believed and not told.given:
                # Others will tell this last step.
                self._amends, told.astray = self._amends + told.astray - astray, 0.0
            self._begin()

    def _in_use(self) -> Trust:
        """Return the source that told the heading in a span."""
        is_yaw_told = self.yaw.given and not math.isnan(self._yaw)
        return self.yaw if is_yaw_told or math.isnan(self._rate) else self.rate

    def _may_be_slip(self, told: Trust, moves: bool) -> bool:
        """Return whether slip explains a span: its source is alive, and not said to be wrong."""
        turn, wheels = self._yaw if told is self.yaw else self._rate, self._wheels
        if not told.is_proved and abs(turn) > abs(wheels):
            return False  # wheels that slip turn too far: rather it has another unit
        return moves and not told.is_contradicted and turn * wheels > -OPPOSITE * wheels * wheels

    def amends(self) -> float:
        """Return once what the heading lacks [rad] because a source led it astray, now refuted."""
        amends = self._amends
        if amends:
            self._amends = 0.0
        return amends

    def forget_turns(self) -> None:
        """Never make amends for the turns so far."""
        self._astray = self._amends = self.yaw.astray = self.rate.astray = 0.0

    def skip(self, dt: float) -> None:
        """Take in a step of `dt` [s] of which neither yaw nor rate is known."""
        self._time += dt
        self._yaw = self._rate = math.nan
        if self._time >= SPAN:
            self._slow = NO_TURNS
            self._begin()

    def _judge(self) -> None:
        """Form an opinion of each source at the end of a span."""
        time, yaw, rate, wheels = self._time, self._yaw, self._rate, self._wheels
        self._judge_slow_turns(time, yaw, rate, wheels)
        # It takes two opinions to change what is believed, however long a step is.
        weight = min(time, 0.5 * LASTING)
        if _contradict(time, yaw, rate):
            if math.isfinite(wheels):
                is_yaw_good = not _contradict(time, yaw, wheels)
                is_rate_good = not _contradict(time, rate, wheels)
                are_two = is_yaw_good or is_rate_good
                self.yaw.hear(is_yaw_good, weight, are_two or not self._yaw_moves)
                self.rate.hear(is_rate_good, weight, are_two or not self._rate_moves)
            return
        for trust, turn, moves in ((self.yaw, yaw, self._yaw_moves),
                                   (self.rate, rate, self._rate_moves)):
            opinion = _opinion(time, turn, moves, wheels)
            if opinion is not None:
                trust.hear(opinion, weight, not moves)

    def _judge_slow_turns(self, time: float, yaw: float, rate: float, wheels: float) -> None:
        """Compare the yaw with what rate and wheels have turned over a longer time."""
        if not abs(rate) <= SLOW_RATE * time:
            self._slow = NO_TURNS
            return
        slow = (self._slow[0] + time, self._slow[1] + yaw, self._slow[2] + rate,
                self._slow[3] + wheels)
        _, yaw, rate, wheels = slow
        is_told = min(abs(rate), abs(wheels)) > SLOW_TURN and _are_alike(rate, wheels)
        if is_told and math.isfinite(yaw):
            # Once may be the lag of an orientation at the start of a turn.
            self.yaw.hear(_are_alike(yaw, wheels), 0.5 * LASTING)
        self._slow = NO_TURNS if is_told or slow[0] >= SLOW_SPAN else slow


def _are_alike(one: float, other: float) -> bool:
    """Return whether two turns [rad] are about the same."""
    return abs(one - other) <= LIKENESS * max(abs(one), abs(other))


def _contradict(time: float, one: float, other: float) -> bool:
    """Return whether two turns [rad] in `time` [s] contradict each other; not where one is NaN."""
    return abs(one - other) > LARGEST_BIAS * time + RATIO * max(abs(one), abs(other))


def _opinion(time: float, turn: float, moves: bool, wheels: float) -> bool | None:
    """Return whether a gyro's turn [rad] is good by the wheels', None if they cannot tell."""
    least = LARGEST_BIAS * time
    if not abs(wheels) > least or math.isnan(turn):
        return None
    if not _contradict(time, turn, wheels):
        return _are_alike(turn, wheels) or None
    is_wrong = (turn * wheels < 0.0 and abs(turn) > max(OPPOSITE * abs(wheels), least)
                or abs(turn) > TOO_FAST * abs(wheels)
                or not moves and abs(wheels) > SILENT * least)
    return False if is_wrong else None
