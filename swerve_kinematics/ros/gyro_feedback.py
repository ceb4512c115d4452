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

"""What the gyro says at the stamp of the encoders."""

from collections import deque
from dataclasses import dataclass
import math

from swerve_kinematics.core.geometry.angles import scalar_nearest_equivalent
from swerve_kinematics.core.odometry.gyro import MAX_YAW_RATE
from swerve_kinematics.core.odometry.still_yaw import StillYaw
from swerve_kinematics.core.odometry.yaw import JUMP
from swerve_kinematics.ros.late_messages import LateMessages
from swerve_kinematics.ros.stamps import is_valid, NANOSECONDS, NEVER
from swerve_kinematics.ros.usable import is_usable

# Samples kept, to tell what the gyro said before the newest one: encoders are read before
# their message is sent, and meanwhile a fast gyro goes on.
REMEMBERED = 64
# A yaw that changes faster than this [rad/s], beyond its rate, has jumped; or beyond how fast it
# changed before, where there is no rate.
FASTEST = 5.0
# The longest time [s] that one sample speaks for.
LONGEST = 0.1
# A gyro that falls behind its usual lag by so much [ns], or by so many of its periods, is not
# carried on any further. In 50 ms a rate that changes by 6 rad/s^2 turns the base by 0.4 degrees
# unseen, which nothing covers; wheels that tell the turn come with an error that is known.
SHORTEST_REACH, REACH_PERIODS = 50_000_000, 2.5


@dataclass(slots=True)
class GyroReading:
    """
    What the gyro says at one time.

    Attributes
    ----------
    stamp : int
        The time [ns].
    yaw, rate : float or None
        [rad], continuous, and [rad/s]; None for what is not known.
    integral : float or None
        Of the rate [rad], over all samples since the gyro was first heard.
    has_jumped : bool
        Whether the yaw has not turned since the sample before, but was set anew.

    """

    stamp: int
    yaw: float | None
    rate: float | None
    integral: float | None
    has_jumped: bool = False


class GyroFeedback:
    """
    Keeps the latest gyro samples, and tells what they say at another stamp.

    Parameters
    ----------
    timeout : int
        Age [ns] beyond which a sample is of no use.

    Attributes
    ----------
    breaks : int
        How often a sample did not go on from the one before: at first, after a silence or a
        clock that was set, with a yaw or a rate that was away, or a yaw that jumped.
    silent_until : int
        When the latest silence of the rate ended, or its clock was set back [ns]: the integral
        lacks what was turned meanwhile.

    """

    def __init__(self, timeout: int) -> None:
        """Start without a sample."""
        self.timeout = timeout
        self.breaks, self._integral, self._late = 0, 0.0, LateMessages()
        self.clear()

    def clear(self) -> None:
        """Forget all samples."""
        self._samples: deque[GyroReading] = deque(maxlen=REMEMBERED)
        self._stamp = NEVER
        self._yaw: float | None = None
        self._speed = 0.0  # how fast that changed last [rad/s]; NaN after a jump
        self._last_rate: tuple[int, float] | None = None
        self._asked, self._lag = NEVER, 0
        self.silent_until = NEVER
        self._still = StillYaw()

    @property
    def yaw_stands_still(self) -> bool:
        """Return whether only the rate is used: it shows a turn, but the yaw stands still."""
        return self._still.stands and not self._still.is_frozen

    def add(self, stamp: int, yaw: float, rate: float) -> bool:
        """
        Take a sample; see `LateMessages` for one that is older than the one before.

        One older than the timeout means at once that the clock was set back.

        Parameters
        ----------
        stamp : int
            Time [ns].
        yaw, rate : float
            Yaw [rad], wrapped or continuous, and yaw rate [rad/s]; NaN for what is missing.

        Returns
        -------
        bool
            False if the sample says nothing, or nothing new.

        """
        if not is_valid(stamp):
            return False
        has_yaw, has_rate = is_usable(yaw), abs(rate) <= MAX_YAW_RATE
        if not (has_yaw or has_rate):
            return False
        if stamp <= self._stamp:
            if not self._is_set_back(stamp):
                return False
            self.clear()
            self.silent_until = stamp
        elapsed = min((stamp - self._stamp) / NANOSECONDS, LONGEST)
        follows = not has_rate or not has_yaw or self._still.follows(elapsed, yaw, rate)
        if has_rate and has_yaw and self._still.is_frozen:
            return False
        sample = GyroReading(
            stamp, self._unwrapped(yaw) if has_yaw and follows else None,
            rate if has_rate else None, self._integrated(stamp, rate) if has_rate else None)
        before = self._samples[-1] if self._samples else None
        if before is not None:
            sample.has_jumped = self._has_jumped(before, sample)
        if before is None or not _goes_on(before, sample, self.timeout):
            self.breaks += 1
        self._samples.append(sample)
        self._stamp = stamp
        return True

    def _is_set_back(self, stamp: int) -> bool:
        """Return whether the clock was set back before a sample, and it is not just late."""
        known, samples = self._stamp, self._samples
        before = samples[-2].stamp if len(samples) > 1 else NEVER
        return self._late.tell_of_set_clock(stamp, known, before, known - self.timeout)

    def _unwrapped(self, yaw: float) -> float:
        """Return the yaw [rad] that goes on from the last one without a turn in between."""
        if self._yaw is not None:
            yaw = scalar_nearest_equivalent(yaw, self._yaw)
        self._yaw = yaw
        return yaw

    def _has_jumped(self, before: GyroReading, after: GyroReading) -> bool:
        """Return whether a yaw was set anew: it cannot have turned from the one before."""
        if before.yaw is None or after.yaw is None:
            return False
        span, change = (after.stamp - before.stamp) / NANOSECONDS, after.yaw - before.yaw
        speed = self._speed
        if before.rate is not None:
            speed = 0.5 * (before.rate + (before.rate if after.rate is None else after.rate))
        has_jumped = abs(change - speed * span) > JUMP + FASTEST * span  # false for NaN
        # After a jump the next change is believed: it was none if the base has come to turn fast.
        self._speed = math.nan if has_jumped else change / span
        return has_jumped

    def _integrated(self, stamp: int, rate: float) -> float:
        """Return the integral [rad] of the rates, by the trapezoid rule but for silences."""
        if self._last_rate is not None:
            since, before = self._last_rate
            if stamp - since <= self.timeout:
                self._integral += 0.5 * (before + rate) * (stamp - since) / NANOSECONDS
            else:
                self.silent_until = stamp
        self._last_rate = stamp, rate
        return self._integral

    def at(self, stamp: int) -> GyroReading:
        """
        Return what the gyro says at a stamp [ns].

        Between two samples it is interpolated, after the latest it is carried on with the
        rate, or with the slope of the yaw, for a short time.
        """
        samples, age = self._samples, stamp - self._stamp
        if self._asked != self._stamp:
            self._asked, self._lag = self._stamp, max(age, 0)
        if abs(age) > self.timeout or age > self._lag + SHORTEST_REACH and age > self._reach():
            return GyroReading(stamp, None, None, None)
        newest = samples[-1]
        if stamp >= self._stamp:
            if stamp == self._stamp:
                return newest
            return _carried(newest, samples[-2] if len(samples) > 1 else newest, stamp)
        after = newest
        for sample in reversed(samples):
            if sample.stamp <= stamp:
                return _between(sample, after, stamp)
            after = sample
        return _carried(after, samples[1] if len(samples) > 1 else after, stamp)

    def _reach(self) -> float:
        """Return how long after its newest sample the gyro is carried on [ns]."""
        samples = self._samples
        period = samples[-1].stamp - samples[-2].stamp if len(samples) > 1 else 0
        return self._lag + REACH_PERIODS * period


def _carried(sample: GyroReading, beside: GyroReading, stamp: int) -> GyroReading:
    """Return a reading carried on to a stamp by its rate, or by its neighbour's yaw."""
    age = (stamp - sample.stamp) / NANOSECONDS
    yaw, rate, integral = sample.yaw, sample.rate, sample.integral
    if rate is not None and integral is not None:
        return GyroReading(stamp, None if yaw is None else yaw + rate * age, rate,
                           integral + rate * age)
    if yaw is not None and beside.yaw is not None and beside is not sample:
        span = (sample.stamp - beside.stamp) / NANOSECONDS
        if not (sample if span > 0.0 else beside).has_jumped:
            yaw += (yaw - beside.yaw) / span * age
    return GyroReading(stamp, yaw, None, None)


def _between(before: GyroReading, after: GyroReading, stamp: int) -> GyroReading:
    """Return the reading between two samples."""
    span = (after.stamp - before.stamp) / NANOSECONDS
    age = (stamp - before.stamp) / NANOSECONDS
    yaw, rate, integral = before.yaw, before.rate, before.integral
    turn = 0.0
    if rate is not None and integral is not None:
        last = rate if after.rate is None else after.rate
        end = rate + age / span * (last - rate)
        turn = 0.5 * (rate + end) * age
        rate, integral = end, integral + turn
    if yaw is not None:
        # A yaw set anew keeps its jump between two samples, not spread over steps.
        if after.yaw is not None and not after.has_jumped:
            turn = (after.yaw - yaw) * age / span
        yaw += turn
    return GyroReading(stamp, yaw, rate, integral)


def _goes_on(before: GyroReading, after: GyroReading, timeout: int) -> bool:
    """Return whether two samples in a row tell together what was turned between them."""
    span = after.stamp - before.stamp
    if span > timeout or (before.rate is None and after.rate is not None):
        return False
    return after.yaw is None or before.yaw is not None and not after.has_jumped
