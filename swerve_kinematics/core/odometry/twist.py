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
from swerve_kinematics.core.odometry.pace import LATEST_WEIGHT, LONGEST_USUAL
from swerve_kinematics.core.odometry.pose_covariance import Matrix

# The acceleration that carries a mean of a step on to its end is averaged over this time [s]:
# one step at 50 Hz, several where steps are short and encoders coarse.
SLOPE_TIME = 0.02

# Past half a turn a step tells little of its arc: no chord counts as shorter, by its arc.
LEAST_CHORD_PER_ARC = 2.0 / math.pi

# A step shorter than this part of the usual duration has a stamp that is off, as where a clock was
# set back: over so little time the last bit of an encoder is a speed of metres per second.
SHORT_PART = 0.25

# No base changes its velocity by more than this from one step to the next: [m/s] and [m/s^2],
# [rad/s] and [rad/s^2]. Where it seems to, a stamp is off, unless the next step says so too.
LEAP, LEAP_RATE = 0.2, 15.0
TURN_LEAP, TURN_LEAP_RATE = 1.0, 60.0
# A gyro that is heard more rarely than the wheels makes up in one step for what it was taken for.
# Beyond this [rad/s], [rad/s^2] the wheels tell the rate of that one step, unless they leap too.
CATCH_UP, CATCH_UP_RATE = 0.3, 30.0


class Extrapolation:
    """
    The value at the end of each step of something that is known as a mean over it.

    A mean belongs to the middle of its step, half a step before the stamp: at 20 Hz and
    2 m/s^2 that is 5 cm/s.

    Attributes
    ----------
    mean : complex or None
        Over the last step; None without a past.
    duration : float
        Of that step [s].
    slope : complex
        Its change per second, averaged over a step or so.

    """

    def __init__(self) -> None:
        """Start without a past."""
        self.mean: complex | None = None
        self.duration = 0.0
        self.slope: complex = 0.0

    def interrupt(self) -> None:
        """Forget the past, after a gap."""
        self.mean, self.slope = None, 0.0

    def at_end(self, dt: float, mean: complex) -> complex:
        """
        Return the value at the end of a step.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        mean : complex
            Over the step.

        """
        if self.mean is not None:
            interval = 0.5 * (dt + self.duration)
            change = (mean - self.mean) / interval - self.slope
            self.slope += interval / (interval + SLOPE_TIME) * change
        self.mean, self.duration = mean, dt
        return mean + 0.5 * dt * self.slope


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
        self._velocity, self._rate = Extrapolation(), Extrapolation()
        self._usual = 0.0  # duration of a step, of late [s]
        self._has_doubted = False

    @property
    def acceleration(self) -> float:
        """Return how fast the velocity in the base frame changes [m/s^2]."""
        return abs(self._velocity.slope)

    def interrupt(self) -> None:
        """Forget the past, after a gap; the twist stands."""
        self._velocity.interrupt()
        self._rate.interrupt()

    def forget(self, speed: float, yaw_rate: float) -> None:
        """Take the twist to be 0, give or take a speed [m/s] and a yaw rate [rad/s]."""
        self.twist = 0.0, 0.0, 0.0
        variance = speed * speed
        self.covariance = variance, 0.0, 0.0, 0.0, variance, 0.0, 0.0, 0.0, yaw_rate * yaw_rate

    def measure(self, dt: float, step: Step, rims: list[complex] | None, fastest: float,
                variance: float, rate_variance: float) -> None:
        """
        Take the twist from the velocities of the rims, or from the steps.

        After a step that is much shorter than usual, or in which the base seems to leap, the last
        twist stands, or that of the rims. The step after one that was doubted is believed.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        step : Step
            How the base moved in it.
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
        is_short = dt < SHORT_PART * self._usual
        counted = dt if dt < LONGEST_USUAL else LONGEST_USUAL
        self._usual += LATEST_WEIGHT * (counted - self._usual)
        if is_short:
            return
        group = step.group
        # A chord is shorter than its arc.
        chord_per_arc = scalar_sinc(0.5 * step.turn)
        if chord_per_arc < LEAST_CHORD_PER_ARC:
            chord_per_arc = LEAST_CHORD_PER_ARC
        velocity, omega = step.displacement / (dt * chord_per_arc), step.turn / dt
        last, last_omega = self._velocity.mean, self._rate.mean
        # What two steps in a row tell is true.
        is_second, self._has_doubted, leaps = self._has_doubted, False, False
        if last is not None and last_omega is not None and not is_second:
            interval = 0.5 * (dt + self._velocity.duration)
            leap, turn_leap = abs(velocity - last), abs(omega - last_omega)
            limit = CATCH_UP + CATCH_UP_RATE * interval
            if turn_leap > limit and abs(step.wheel_turn / dt - last_omega) <= limit:
                omega, turn_leap, self._has_doubted = step.wheel_turn / dt, 0.0, True
            leaps = (leap > LEAP + LEAP_RATE * interval
                     or turn_leap > TURN_LEAP + TURN_LEAP_RATE * interval)
            if leaps:
                self._has_doubted = True
                if rims is None:
                    # It may be either.
                    leap, turn_leap = min(leap, fastest), min(turn_leap, MAX_YAW_RATE)
                    self.covariance = rigid_covariance(
                        variance + leap * leap, rate_variance + turn_leap * turn_leap,
                        -group.lever)
                    return
        if not leaps:
            velocity = self._velocity.at_end(dt, velocity)
            omega = self._rate.at_end(dt, omega).real
        if rims is not None:
            if leaps or not step.by_gyro:
                omega = group.rate(rims)
            velocity = sum(rims) / group.size - omega * group.lever - step.creep
        if (abs(omega) > MAX_YAW_RATE
                or not abs(velocity + omega * group.lever) <= fastest):
            return
        self.twist = self.measured = velocity.real, velocity.imag, omega
        self.covariance = rigid_covariance(variance, rate_variance, -group.lever)


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
    x, y = lever.real, lever.imag
    by_x, by_y = rate_variance * x, rate_variance * y
    across = by_x * y
    return (velocity_variance + by_x * x, across, by_x,
            across, velocity_variance + by_y * y, by_y,
            by_x, by_y, rate_variance)
