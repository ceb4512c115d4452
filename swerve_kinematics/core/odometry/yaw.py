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

"""Which of a gyro's words about a turn to believe: its yaw, its rate, or neither."""

import math

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.odometry.gyro import largest_turn
from swerve_kinematics.core.odometry.gyro_watch import GyroWatch
from swerve_kinematics.core.odometry.readings import LARGEST_READING

# A yaw that in one step moves by so much more [rad] than its rate and the wheels tell was set
# anew. In a long step both may have missed something: the base sped up and slowed down again
# by 20 rad/s^2 within it, which is a quarter of that times the time squared.
JUMP = 0.05
UNSEEN_ACCELERATION = 5.0


class YawTracker:
    """
    The turn of each step by a gyro that may give its yaw, its rate, both, or fall silent.

    Each source must be there at both ends of a step to count. What one that comes back tells of
    the turn in between is for `LostYaw`.

    Attributes
    ----------
    yaw, last_yaw : float
        At the end of the last step and at its start [rad]; NaN where unknown.
    integral, last_integral : float
        Of the rate [rad], likewise.
    jumps : int
        How many steps of the yaw were no turns: the sensor was set anew.
    is_silent : bool
        Whether nothing has told the turn of the last step.
    watch : GyroWatch
        Which of them is believed.

    """

    def __init__(self) -> None:
        """Start with nothing heard."""
        self.yaw = self.last_yaw = self.integral = self.last_integral = math.nan
        self._rate = math.nan
        self._by_yaw = self._by_rate = math.nan  # turns of the last step [rad]
        self._dt = 0.0  # its duration, as the gyro counts it [s]
        self._largest = 0.0  # the largest turn that is possible in it [rad]
        self._rate_changes = False  # whether the rate is another one since
        self._is_sampled = False  # whether that by rate is more than a mean of two
        self.is_silent = True
        self._yaw_speed = math.nan  # of the last step of the yaw that was a turn [rad/s]
        self.watch = GyroWatch()
        self.jumps = 0

    @property
    def trusted(self) -> tuple[bool, bool]:
        """Return whether the yaw and the rate are believed."""
        return self.watch.yaw.given, self.watch.rate.given

    def turn(self, dt: float, yaw: float | None, rate: float | None,
             integral: float | None = None) -> float | None:
        """
        Return the change of heading since the last call [rad].

        Parameters
        ----------
        dt : float
            Time since the last call [s].
        yaw : float or None
            Continuous or wrapped [rad]; preferred. None or no measurement: absent.
        rate : float or None
            Yaw rate [rad/s], integrated by the trapezoid rule.
        integral : float or None
            Of the yaw rate [rad], from any zero, where more samples of it are known than
            those of the calls; in place of that rule.

        Returns
        -------
        float or None
            None without a source for this step.

        """
        last_yaw, last_rate, last_integral = self.yaw, self._rate, self.integral
        self.yaw, self.last_yaw = math.nan if yaw is None else _reading(yaw), last_yaw
        self._rate = math.nan if rate is None else _reading(rate)
        self.integral = math.nan if integral is None else _reading(integral)
        self.last_integral = last_integral
        self._rate_changes = self._rate != last_rate
        by_rate = self.integral - last_integral
        self._is_sampled = by_rate == by_rate
        if not self._is_sampled:
            by_rate = 0.5 * (self._rate + last_rate) * dt
        by_yaw = math.remainder(self.yaw - last_yaw, TURN)
        self._by_yaw, self._by_rate, self._dt = by_yaw, by_rate, dt
        self._largest = largest_turn(dt)
        self.is_silent = by_yaw != by_yaw and by_rate != by_rate
        return None if self.is_silent else self._best(by_yaw, by_rate)

    def over_gap(self) -> float | None:
        """
        Return the turn of the same step [rad] where only the gyro was heard meanwhile.

        What the rate did in between, its values at both ends do not tell. None if unknown.
        """
        by_rate = self._by_rate if self._is_sampled else math.nan
        return self._best(self._by_yaw, by_rate)

    def checked(self, wheels: float, astray: float) -> float | None:
        """
        Return the turn of the same step [rad], now that the wheels' is known.

        Parameters
        ----------
        wheels : float
            Change of heading by the wheels [rad], NaN where they disagree among themselves.
        astray : float
            How much further they turned than the heading went [rad], likewise.

        """
        dt, by_yaw, by_rate = self._dt, self._by_yaw, self._by_rate
        if self.is_silent:
            self._yaw_speed = math.nan
            self.watch.skip(dt)
            return None
        if self._has_jumped(dt, by_yaw, by_rate, wheels):
            self.jumps += 1
            by_yaw, astray = math.nan, 0.0  # the heading will not follow it
        else:
            self._yaw_speed = by_yaw / dt if dt > 0.0 else math.nan
        self.watch.update(dt, by_yaw, by_rate, wheels, self._rate_changes, astray)
        return self._best(by_yaw, by_rate)

    def _has_jumped(self, dt: float, by_yaw: float, by_rate: float, wheels: float) -> bool:
        """Return whether the yaw moved unlike its rate, the wheels, and itself before."""
        if abs(by_yaw) > self._largest:
            return True
        limit = JUMP + UNSEEN_ACCELERATION * dt * dt
        if abs(by_yaw - self._yaw_speed * dt) <= limit:
            return False  # wheels that lock or spin do not stop the base at once
        off_rate = abs(by_yaw - by_rate) if self.watch.rate.given else math.nan
        off_wheels = abs(by_yaw - wheels)
        return not (off_rate <= limit or off_wheels <= limit) and (
            off_rate > limit or off_wheels > limit)

    def _best(self, by_yaw: float, by_rate: float) -> float | None:
        """Return the first turn that is possible, of a source that is believed."""
        watch = self.watch
        if watch.yaw.given and abs(by_yaw) <= self._largest:
            return by_yaw
        if watch.rate.given and abs(by_rate) <= self._largest:
            return by_rate
        return None


def _reading(value: float) -> float:
    """Return `value` as a float, NaN where it is no measurement."""
    value = float(value)
    return value if abs(value) <= LARGEST_READING else math.nan
