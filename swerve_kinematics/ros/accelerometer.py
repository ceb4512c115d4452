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

"""What an accelerometer says about the time between two sets of encoder readings."""

from collections import deque
import math
from typing import NamedTuple

from swerve_kinematics.core.odometry.gyro import MAX_YAW_RATE
from swerve_kinematics.core.odometry.rest import have_rolled
from swerve_kinematics.ros.collisions import RangeCheck
from swerve_kinematics.ros.late_messages import LateMessages
from swerve_kinematics.ros.resting_force import RestingForce
from swerve_kinematics.ros.stamps import is_valid, NANOSECONDS, nanoseconds, NEVER
from swerve_kinematics.ros.stuck_axes import StuckAxes

# Samples kept: encoders are read before their message is sent, and the IMU goes on meanwhile;
# at 1 kHz for longer than SILENCE.
REMEMBERED = 256
# The longest time [ns] that one sample speaks for: of slower sensors nothing is believed. In 0.1 s
# a base that starts gains more than wheels that grip are granted.
SILENCE = nanoseconds(0.1)
# A force that is carried on for a time t makes the velocity wrong by t^2 / 2 times the jerk. Where
# the root mean square of t [s] over this memory [s] is larger, that does more harm than wheels
# that slip: samples come 33 ms late, at 16 Hz, or in bundles of 60 ms.
LATEST, LAG_MEMORY = 0.033, 1.0

Pair = tuple[float, float]


class InertialSample(NamedTuple):
    """
    What an IMU says at one time, None where it does not measure it.

    Attributes
    ----------
    force : complex or None
        Specific force along x and y of the base [m/s^2].
    rates : complex or None
        Rates about x and y of the base [rad/s].
    size : float
        Of the whole force [m/s^2], negative where that does not point up.
    axes : tuple of float
        What the sensor's own axes show that tell `force` [m/s^2].

    """

    force: complex | None
    rates: complex | None
    size: float
    axes: tuple[float, ...]


class InertialMeans(NamedTuple):
    """Mean specific force [m/s^2] and rates [rad/s] along x and y; None where of no use."""

    force: Pair | None
    rates: Pair | None


UNKNOWN = InertialMeans(None, None)


class _Sums(NamedTuple):
    """Integrals of force [m/s] and rates [rad] up to a stamp [ns], and what is added to them."""

    stamp: int
    velocity: complex
    angle: complex
    force: complex
    rates: complex

    def at(self, stamp: int) -> '_Sums':
        """Return the integrals at a stamp [ns] for which this sample speaks."""
        elapsed = (stamp - self.stamp) / NANOSECONDS
        return _Sums(stamp, self.velocity + elapsed * self.force,
                     self.angle + elapsed * self.rates, self.force, self.rates)


class AccelerometerFeedback:
    """
    Averages what an IMU says, at whatever rate, over the steps of the odometry.

    A sample speaks for the time since the one before: sensors average. Beyond the newest one
    its values are carried on; what that makes wrong in one step, the next one puts right.

    Attributes
    ----------
    heard : bool
        Whether a force has been measured.
    fault : str or None
        Why it was left out of the last step, in words; None if it was not.
    is_out_of_range : bool
        Whether a sample of the last step was saturated, absurd or no number.
    out_of_range : int
        How many samples were, and spikes, for which the force before them stands in.

    """

    def __init__(self) -> None:
        """Start without a sample."""
        self.out_of_range, self._late = 0, LateMessages()
        self.clear()

    def clear(self) -> None:
        """Forget all samples."""
        self.heard = self.is_out_of_range = False
        self.fault: str | None = None
        self._sums: deque[_Sums] = deque(maxlen=REMEMBERED)
        self._told: _Sums | None = None
        self._distances: list[float] = []
        self._square_lag = 0.0  # mean square of how far the newest sample is behind [s^2]
        # When force and rates were last of no use, and when a force was last out of range [ns].
        self._bad_force = self._bad_rates = self._beyond = NEVER
        self._axes, self._resting, self._range = StuckAxes(), RestingForce(), RangeCheck()
        self._missed = 0j  # velocity [m/s] that the last force would add if it is confirmed

    def add(self, stamp: int, sample: InertialSample) -> None:
        """Take a sample at a stamp [ns]; see `LateMessages` for one older than the last."""
        if sample.force is None or not is_valid(stamp):
            return
        if self._sums and stamp <= self._sums[-1].stamp:
            if not self._is_set_back(stamp):
                return
            self.clear()
        sums = self._sums
        last = sums[-1] if sums else _Sums(stamp, 0j, 0j, 0j, 0j)
        self.heard = True
        elapsed = (stamp - last.stamp) / NANOSECONDS
        force, missed = self._believed(stamp, elapsed, sample.force, last.force)
        rates = sample.rates
        if rates is None or not _is_within(rates, MAX_YAW_RATE):
            self._bad_rates, rates = stamp, last.rates
        if stamp - last.stamp > SILENCE or not sums:
            self._bad_force = self._bad_rates = stamp
        self._axes.watch(stamp, sample.axes)
        self._resting.follow(elapsed, sample.size)
        sums.append(_Sums(stamp, last.velocity + missed + elapsed * force,
                          last.angle + elapsed * rates, force, rates))

    def _believed(self, stamp: int, elapsed: float, force: complex,
                  before: complex) -> tuple[complex, complex]:
        """
        Return the force of a sample, or the one `before` that stands in for it [m/s^2].

        And the velocity [m/s] that is missing because one stood in for the sample before, which
        has turned out to be right.
        """
        is_believed, missed = self._range.believes(elapsed, force), 0j
        if self._range.confirms:
            self.out_of_range -= 1
            missed = self._missed
        if is_believed:
            return force, missed
        self.out_of_range += 1
        if self._range.is_doubting:
            self._missed = elapsed * (force - before)
        else:
            self._bad_force = self._beyond = stamp
        return before, missed

    def _is_set_back(self, stamp: int) -> bool:
        """Return whether the clock was set back before a sample, and it is not just late."""
        known = self._sums[-1].stamp
        before = self._sums[-2].stamp if len(self._sums) > 1 else NEVER
        return self._late.tell_of_set_clock(stamp, known, before, known - SILENCE)

    def means(self, stamp: int, distances: list[float]) -> InertialMeans:
        """
        Return the means of force and rates from the last call's stamp to this one.

        Parameters
        ----------
        stamp : int
            Of the encoders [ns].
        distances : list of float (n,)
            By them [m], to know whether the wheels stand still.

        """
        if not self.heard:
            return UNKNOWN
        # Values that are carried on for too long must not be made up for in the step after them.
        is_silent = abs(stamp - self._sums[-1].stamp) > SILENCE
        before, self._told = self._told, None if is_silent else self._at(stamp)
        is_still = not have_rolled(distances, self._distances)
        if not is_still:
            self._distances = distances
        self._resting.look(stamp, is_still)
        since = stamp if before is None else before.stamp
        if not is_silent:
            self._follow_lag(since, stamp)
        self.is_out_of_range = not is_silent and (
            self._beyond > since or self._beyond == self._sums[-1].stamp)
        self.fault = self._fault(is_still)
        if (before is None or self._told is None or self.fault or self._axes.are_stuck
                or stamp <= before.stamp):
            return UNKNOWN
        elapsed = (stamp - before.stamp) / NANOSECONDS
        force = (self._told.velocity - before.velocity) / elapsed
        rates = (self._told.angle - before.angle) / elapsed
        # Where the driver takes gravity off, no tilt of the base shows in the force.
        knows_rates = self._bad_rates <= before.stamp and self._resting.has_gravity
        return InertialMeans(
            None if self._bad_force > before.stamp else (force.real, force.imag),
            (rates.real, rates.imag) if knows_rates else None)

    def _follow_lag(self, since: int, stamp: int) -> None:
        """Take in how far the newest sample is behind a stamp [ns], a step after another one."""
        elapsed = (stamp - since) / NANOSECONDS
        lag = max(stamp - self._sums[-1].stamp, 0) / NANOSECONDS
        self._square_lag += elapsed / (LAG_MEMORY + elapsed) * (lag * lag - self._square_lag)

    def _at(self, stamp: int) -> _Sums:
        """Return the integrals at a stamp [ns]."""
        after = self._sums[-1]
        for sums in reversed(self._sums):
            if sums.stamp <= stamp:
                break
            after = sums
        return after.at(stamp)

    def _fault(self, is_still: bool) -> str | None:
        """Return in words what was wrong in the last step, if anything was."""
        if self._told is None:
            return 'silent, or stamped by another clock'
        # In a simulation without noise nothing changes at rest.
        if self._axes.are_stuck and not is_still:
            return 'frozen, or at the end of its range'
        if self.is_out_of_range:
            return 'saturated, absurd or not a number'
        if self._square_lag > LATEST * LATEST:
            return f'late by {1e3 * math.sqrt(self._square_lag):.0f} ms'
        return None if self._resting.is_plausible else self._resting.fault


def _is_within(vector: complex, limit: float) -> bool:
    """Return whether both parts are numbers no larger than a limit."""
    return abs(vector.real) <= limit and abs(vector.imag) <= limit  # false for NaN
