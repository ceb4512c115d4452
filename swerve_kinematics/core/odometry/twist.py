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

"""The twist of the base at the stamp, and how sure it is."""

import cmath
import math

from swerve_kinematics.core.geometry.angles import scalar_sinc
from swerve_kinematics.core.odometry.chord import Step
from swerve_kinematics.core.odometry.gyro import MAX_YAW_RATE
from swerve_kinematics.core.odometry.pose_covariance import FINEST, Matrix
from swerve_kinematics.core.odometry.readings import UNKNOWN

# The acceleration that carries a mean of a step on to its end is averaged over this time [s]:
# one step at 50 Hz, several where steps are short and encoders coarse.
SLOPE_TIME = 0.02

# Past half a turn a step tells little of its arc: no chord counts as shorter, by its arc.
LEAST_CHORD_PER_ARC = 2.0 / math.pi

# A step shorter than this part of the usual duration, to which it counts, has a stamp that is off,
# as where a clock was set back: over so little time the last bit of an encoder is a speed of
# metres per second.
SHORT_PART = 0.3

# No base changes its velocity by more than this from one step to the next: [m/s] and [m/s^2],
# [rad/s] and [rad/s^2]. Where it seems to, a stamp is off, unless the next step says so too.
LEAP, LEAP_RATE = 0.2, 15.0
TURN_LEAP, TURN_LEAP_RATE = 1.0, 60.0
# A gyro that is heard more rarely than the wheels is carried on with its rate, and makes up in one
# step for what that missed in several: beyond this [rad/s], [rad/s^2] the wheels tell the rate of
# that one step, unless they leap too.
CATCH_UP, CATCH_UP_RATE = 0.3, 30.0

# No velocity [m^2/s^2] and no yaw rate [rad^2/s^2] is known better: a covariance without an
# inverse is of no use.
FINEST_VARIANCE = FINEST * FINEST


class Extrapolation:
    """
    Velocity and yaw rate at the end of each step, of which their means over it are known.

    A mean belongs to the middle of its step, half a step before the stamp: at 20 Hz and
    2 m/s^2 that is 5 cm/s.

    Attributes
    ----------
    velocity, yaw_rate : complex, float
        Means over the last step [m/s], [rad/s]; NaN without a past.
    duration : float
        Of that step [s]; 0 without a past.
    acceleration, turning : complex, float
        Their changes per second, averaged over a step or so [m/s^2], [rad/s^2].
    bend, turn_bend : complex, float
        By how much the last change of those moved the end of the step [m/s], [rad/s]: about as
        far as it may be off.

    """

    def __init__(self) -> None:
        """Start without a past."""
        self.interrupt()

    def interrupt(self) -> None:
        """Forget the past, after a gap."""
        self.velocity, self.yaw_rate, self.duration = UNKNOWN, math.nan, 0.0
        self.acceleration, self.turning = 0j, 0.0
        self.bend, self.turn_bend = 0j, 0.0

    def at_end(self, dt: float, velocity: complex, yaw_rate: float) -> tuple[complex, float]:
        """
        Return velocity and yaw rate at the end of a step.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        velocity, yaw_rate : complex, float
            Means over the step.

        """
        ahead, self.bend, self.turn_bend = 0.5 * dt, 0j, 0.0
        if self.duration:
            interval = 0.5 * (dt + self.duration)
            share = interval / (interval + SLOPE_TIME)
            change = share * ((velocity - self.velocity) / interval - self.acceleration)
            turn_change = share * ((yaw_rate - self.yaw_rate) / interval - self.turning)
            self.acceleration += change
            self.turning += turn_change
            self.bend, self.turn_bend = ahead * change, ahead * turn_change
        self.velocity, self.yaw_rate, self.duration = velocity, yaw_rate, dt
        return velocity + ahead * self.acceleration, yaw_rate + ahead * self.turning


class TwistMeter:
    """
    The twist of the base at the stamp of the last step, and its covariance.

    Attributes
    ----------
    twist : tuple of float (3,)
        `(vx, vy, omega)` [m/s, m/s, rad/s] in the base frame.
    covariance : tuple of float (9,)
        Of the twist, row by row [m^2/s^2, m rad/s^2, rad^2/s^2].
    measured : tuple of float (3,)
        The same as the twist; after a gap, the last one before it, which the base may have kept.

    """

    def __init__(self) -> None:
        """Start at rest."""
        self.twist = self.measured = 0.0, 0.0, 0.0
        self.covariance: Matrix = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        self._means = Extrapolation()
        self._has_doubted = False

    @property
    def acceleration(self) -> float:
        """Return how fast the velocity in the base frame changes [m/s^2]."""
        return abs(self._means.acceleration)

    def interrupt(self) -> None:
        """Forget the past, after a gap; the twist stands."""
        self._means.interrupt()

    def forget(self, speed: float, yaw_rate: float) -> None:
        """Take the twist to be 0, give or take a speed [m/s] and a yaw rate [rad/s]."""
        self.twist = 0.0, 0.0, 0.0
        variance = speed * speed
        self.covariance = variance, 0.0, 0.0, 0.0, variance, 0.0, 0.0, 0.0, yaw_rate * yaw_rate

    def measure(self, dt: float, step: Step, yaw_rate: float, rims: list[complex] | None,
                fastest: float, variance: float, rate_variance: float) -> None:
        """
        Take the twist from the velocities of the rims, or from the steps.

        After a step in which the base seems to leap, the last twist stands, or that of the rims.
        The step after one that was doubted is believed.

        Parameters
        ----------
        dt : float
            How long the wheels took for the step [s].
        step : Step
            How the base moved in it.
        yaw_rate : float
            Its mean in the step [rad/s].
        rims : list of complex (k,) or None
            Measured velocities of the used modules at the stamp [m/s], None without.
        fastest : float
            No base is faster [m/s]: beyond it the last twist stands, as it does beyond the
            yaw rate that a gyro can measure. The step was too short to tell.
        variance : float
            Of the velocity of the modules' centroid, in x and in y [m^2/s^2].
        rate_variance : float
            Of the yaw rate [rad^2/s^2].

        """
        # The means of the step along its arc, which is longer than its chord.
        chord_per_arc = scalar_sinc(0.5 * step.turn)
        if chord_per_arc < LEAST_CHORD_PER_ARC:
            chord_per_arc = LEAST_CHORD_PER_ARC
        velocity, omega = step.displacement / (dt * chord_per_arc), yaw_rate
        means, lever, leaps = self._means, step.group.lever, None
        interval = 0.5 * (dt + means.duration)
        # What two steps in a row tell is true.
        is_second, self._has_doubted = self._has_doubted, False
        if not is_second and (
                abs(velocity - means.velocity) > LEAP + LEAP_RATE * interval
                or abs(omega - means.yaw_rate) > CATCH_UP + CATCH_UP_RATE * interval):
            omega, leaps = self._doubt(velocity, omega, step.wheel_turn / dt, interval)
        # Carried on to the stamp, where they can be believed; or else only the rims can.
        if leaps is None:
            velocity, omega = means.at_end(dt, velocity, omega)
        elif rims is None:
            # The twist may be the last one, or this.
            leap, turn_leap = min(leaps[0], fastest), min(leaps[1], MAX_YAW_RATE)
            self.covariance = rigid_covariance(
                variance + leap * leap, rate_variance + turn_leap * turn_leap, -lever)
            return
        if rims is not None:
            if leaps is not None or not step.by_gyro:
                omega = step.group.rate(rims)
            velocity = sum(rims) / step.group.size - omega * lever - step.creep
        if abs(omega) > MAX_YAW_RATE or not abs(velocity + omega * lever) <= fastest:
            return
        self.twist = self.measured = velocity.real, velocity.imag, omega
        if rims is None:
            variance += abs(means.bend) ** 2
        if rims is None or step.by_gyro:
            rate_variance += means.turn_bend ** 2
        self.covariance = rigid_covariance(variance, rate_variance, -lever)

    def _doubt(self, velocity: complex, omega: float, by_wheels: float,
               interval: float) -> tuple[float, tuple[float, float] | None]:
        """Return the yaw rate to go on with, and how far both leap if that is beyond a base."""
        means, limit = self._means, CATCH_UP + CATCH_UP_RATE * interval
        leap, turn_leap = abs(velocity - means.velocity), abs(omega - means.yaw_rate)
        if turn_leap > limit and abs(by_wheels - means.yaw_rate) <= limit:
            omega, turn_leap, self._has_doubted = by_wheels, 0.0, True
        if (leap <= LEAP + LEAP_RATE * interval
                and turn_leap <= TURN_LEAP + TURN_LEAP_RATE * interval):
            return omega, None
        self._has_doubted = True
        return omega, (leap, turn_leap)


def rim_velocities(used: tuple[int, ...], rims: list[float], angles: list[float],
                   fastest: float) -> list[complex] | None:
    """
    Return the velocities of the rims of the used modules (k,) [m/s], None if one is impossible.

    Parameters
    ----------
    used : tuple of int (k,)
        Indices of the modules.
    rims : list of float (n,)
        Measured speeds [m/s].
    angles : list of float (n,)
        Steering angles [rad].
    fastest : float
        Largest possible speed [m/s].

    """
    velocities = []
    for module in used:
        speed = rims[module]
        if not abs(speed) <= fastest:
            return None
        velocities.append(cmath.rect(speed, angles[module]))
    return velocities


def rigid_covariance(velocity_variance: float, rate_variance: float, lever: complex) -> Matrix:
    """
    Return the covariance of the twist of base_link, row by row.

    Parameters
    ----------
    velocity_variance : float
        Of the velocity of the wheels' centroid, in x and in y [m^2/s^2].
    rate_variance : float
        Of the yaw rate [rad^2/s^2].
    lever : complex
        How an error of the yaw rate moves base_link [m/rad].

    """
    # Sensors that are said to be perfect leave no variance of a base at rest.
    velocity_variance += FINEST_VARIANCE
    rate_variance += FINEST_VARIANCE
    x, y = lever.real, lever.imag
    by_x, by_y = rate_variance * x, rate_variance * y
    across = by_x * y
    return (velocity_variance + by_x * x, across, by_x,
            across, velocity_variance + by_y * y, by_y,
            by_x, by_y, rate_variance)
