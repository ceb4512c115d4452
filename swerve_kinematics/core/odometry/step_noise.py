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

"""How wrong a step is: fresh errors of each module, and errors of the base that last."""

import math
import operator

from swerve_kinematics.core.odometry.chord import Step
from swerve_kinematics.core.odometry.disagreement import Disagreement
from swerve_kinematics.core.odometry.inertial import Inertial
from swerve_kinematics.core.odometry.module_paths import ModulePaths
from swerve_kinematics.core.odometry.pose_covariance import LastingError
from swerve_kinematics.core.odometry.steady_errors import SteadyErrors
from swerve_kinematics.core.odometry.traction import (
    BEST_GRIP, ICY_GRIP, POOR_GRIP, Traction)
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise

# Slip, creep and a wheel askew keep the base's velocity wrong for about so long [s].
LASTING_TIME = 1.0
# Where the modules disagree by more than so many standard deviations of their noise, the
# velocity of all of them is wrong by this many times the excess.
LASTING_STDS = 2.0
LASTING_SHARE = 2.0
# Tyres creep as they push, by this time [s] multiplied by the acceleration (4 to 20 ms on the
# floors of docs/figures.md): at 2 m/s^2 the wheels are 15 mm/s ahead. Most of it comes back as the
# base brakes or turns: this part stays in the position. All wheels have most of it in common: this
# part turns the base. The parts are those that make the covariance fit drives on good tyres.
CREEP_TIME = 0.0075
CREEP_LEFT = 0.2
CREEP_TURN_SHARE = 0.3
# As they spin the base up, all of them creep one way: by this time [s] multiplied by the angular
# acceleration, as stiff tyres do. 5 rad/s^2 make 0.9 deg/s, more than the bias of most gyros.
# The acceleration is averaged over the second time [s], a step at 50 Hz with some jitter: in
# shorter steps the last bit of an encoder makes more of it than any motor does.
TURN_CREEP_TIME, TURN_CREEP_MEAN = 0.003, 0.018
# Wheels that are steered while they hardly roll, at this speed [m/s] or less, scrub over the floor
# and shift the base: by this length [m] for each radian, as in the physics of docs/figures.md on
# level ground and on slopes. They turn it by as much as such an error of each module would.
SLOW_SPEED = 0.05
SCRUB_SHIFT = 0.0006
# Of what no tyre can have brought about, this part of the velocity is wrong, and this part of
# the turn: wheels that slip alike turn the base little.
SLIP_SHARE = 0.5
SLIP_TURN_SHARE = 0.05

# In a gap the base may have moved on as before, and crept or been pushed by this much even
# if it stood [m/s], [rad/s].
UNSEEN_SPEED = 0.05
UNSEEN_YAW_RATE = 0.05

# The wheels' yaw rate tells something of a gyro while the modules disagree by no more than a
# few times their ordinary creep: [m/s], plus this part of their speed.
CONSISTENT_SPEED = 0.03
CONSISTENT_RATIO = 0.03
# Wheels that roll slowly and steadily, as on a slope that drags a base against its motors, slip
# by less than the usual: by this part of their speed, and by this length [m] times the rate
# of their steering, which scrubs them over the floor.
CREEPING_SLIP = 0.1
SCRUB = 0.1

# What a base at rest may creep unseen, as a random walk [m/sqrt(s)]: 0.6 mm in an hour.
LEAST_WALK = 1e-5


class StepNoise:
    """
    What each step adds to the uncertainty of the pose, and how sure its twist is.

    Parameters
    ----------
    module_count : int
        Number of modules of the base, in use or not.
    correlation_time : float
        How long the errors of a module last [s].

    Attributes
    ----------
    residual : float
        Root mean square disagreement of the modules in the last step [m/s].
    variance : float
        Of one module's velocity, in x and in y [m^2/s^2]: what the noise model says, inflated
        while the modules disagree by more than that.
    steady : SteadyErrors
        Of the modules.

    """

    def __init__(self, module_count: int, correlation_time: float) -> None:
        """Start with nothing seen."""
        self.residual = self.variance = 0.0
        self._time = correlation_time
        self._disagreement = Disagreement(module_count, correlation_time)
        self._traction, self.steady = Traction(), SteadyErrors(module_count)
        # Errors of the base's velocity that last [m/s]: contradiction, creep, common slip, scrub,
        # and modules that are not calibrated, across each of them.
        self._doubt = self._creep = self._slip = self._scrub = self._askew = 0.0
        # Of the last step from which a gyro could learn [rad/s], and how that changes [rad/s^2].
        self._wheel_rate = self._wheel_acceleration = 0.0
        self._unsettled = 0.0  # variance of the way in a spell that ended without a winner [m^2]
        # What an encoder's last bit is of a speed [m/s]; the variance of differences of such
        # roundings, uniform over it each [m^2/s^2].
        self._rounding = self._rounding_variance = 0.0
        self.forget_sums()

    def forget_sums(self) -> None:
        """Forget what lasting errors have added up to: the pose is known anew."""
        self._position, self._turn = LastingError(LASTING_TIME), LastingError(LASTING_TIME)

    def interrupt(self) -> None:
        """Forget the velocity, after a gap."""
        self._traction.interrupt()

    def observe(self, dt: float, step: Step, paths: ModulePaths, noise: OdometryNoise,
                acceleration: float, inertial: Inertial) -> None:
        """
        Take in how well the modules agree, and how hard they accelerate.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        step : Step
            The motion.
        paths : ModulePaths
            Of all modules.
        noise : OdometryNoise
            What is expected.
        acceleration : float
            Of the base until the step [m/s^2].
        inertial : Inertial
            What an accelerometer says. While it is believed, it confirms the velocity or has
            told it; while it is not, because it contradicted the wheels, they may slip on ice.

        """
        along, across, speed = noise.distance_noise, noise.steering_noise, step.length / dt
        expected = 0.5 * (along * along + across * across) * (speed * speed)
        self.residual = step.spread / dt
        self._rounding = rounding = noise.distance_resolution / dt
        self._rounding_variance = rounding * rounding / 6.0
        # Which of the two was wrong is not known: each may have been.
        self._unsettled = 0.5 * inertial.coasting.unsettled() ** 2
        if inertial.believed:
            self._traction.interrupt()
            self._slip = 0.0
        else:
            grip = BEST_GRIP if self._is_consistent(speed) else POOR_GRIP
            if inertial.coasting.distrust:
                # The accelerometer is defective, or the wheels slip on ice.
                grip = ICY_GRIP
            self._slip = self._traction.excess(dt, step.displacement / dt, step.turn, grip)
        # Each fitted number takes one of the 2 k degrees of freedom of k modules.
        freedom = 2 * step.group.size - (2 if step.by_gyro else 3)
        used = step.group.used
        errors = list(map(operator.truediv, step.errors,
                          map(paths.directions.__getitem__, used)))
        if freedom > 0:
            # Wheels that hardly move are not worse than expected because they creep as usual.
            usual = expected + noise.slip_speed * noise.slip_speed
            self._disagreement.update(dt, used, errors, freedom * usual)
        self.variance = expected * self._disagreement.inflation
        self._scrub = SCRUB_SHIFT * _steering_rate(dt, step, paths) if speed < SLOW_SPEED else 0.0
        if step.coasting_std is None:
            self.steady.update(used, errors, paths.rolled)
            self._askew = math.sqrt(0.5 * self.steady.variance) * speed
            self._doubt = math.hypot(
                LASTING_SHARE * self._excess(dt, noise), inertial.gaps.contradiction)
            self._creep = CREEP_TIME * acceleration
        else:
            self._doubt, self._creep = step.coasting_std, 0.0

    def growth(self, dt: float, step: Step, noise: OdometryNoise) -> tuple[float, float]:
        """
        Return how much the step adds to the variance of position and heading.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        step : Step
            The motion.
        noise : OdometryNoise
            What is expected.

        Returns
        -------
        tuple of float
            Of the displacement of the modules' centroid, in x and in y [m^2], and of the turn,
            without the gyro's bias [rad^2].

        """
        group, creep = step.group, CREEP_LEFT * self._creep
        # The random walk of an error that lasts for the correlation time, in one step [m^2].
        walk = 2.0 * self._time * dt * self.variance + LEAST_WALK * LEAST_WALK * dt
        position = (walk / group.size + self._position.grow(dt, self._moving(creep))
                    + self._unsettled)
        if step.by_gyro:
            return position, noise.gyro_variance * dt
        return position, walk / group.inertia + self._turn.grow(
            dt, self._turning(creep) * math.sqrt(group.size / group.inertia))

    def twist_variances(self, dt: float, step: Step, noise: OdometryNoise) -> tuple[float, float]:
        """
        Return the variances of velocity and yaw rate at the end of a step.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        step : Step
            The motion.
        noise : OdometryNoise
            What is expected.

        Returns
        -------
        tuple of float
            Of the velocity of the modules' centroid, in x and in y [m^2/s^2], and of the yaw rate,
            without the gyro's bias [rad^2/s^2].

        """
        # Carried on to the stamp as the twist is, roundings have this many times the variance of
        # their differences: 1.74 at 50 Hz, 1.26 at 200 Hz and 2.28 at 20 Hz.
        group = step.group
        fresh = self.variance + 1.8 * self._rounding_variance
        lasting = self._moving(self._creep)
        velocity = fresh / group.size + lasting * lasting
        if step.by_gyro:
            return velocity, noise.gyro_variance / dt
        turning = self._turning(self._creep)
        return velocity, (fresh + group.size * turning * turning) / group.inertia

    def wheel_rate_variance(self, dt: float, step: Step, noise: OdometryNoise,
                            steered: list[float]) -> float | None:
        """
        Return the variance of the wheels' yaw rate, None if a gyro cannot learn from it.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        step : Step
            The motion.
        noise : OdometryNoise
            What is expected.
        steered : list of float (n,)
            Change of each module's steering angle [rad].

        """
        group, limit = step.group, self._consistent_limit(step.length / dt)
        if not group.inertia or not step.do_wheels_agree(limit * dt):
            return None
        # Ten times the variance of one sample at 50 Hz: what lasts weighs more.
        lasting = 2.0 * self._time / dt
        slip = _expected_slip(dt, step, noise.slip_speed, steered, self._creep)
        variance = lasting * (self.variance + slip * slip) + self._rounding_variance
        # By the wheels: a gyro that is heard rarely catches up in leaps.
        rate, acceleration = step.wheel_turn / dt, self._wheel_acceleration
        change = (rate - self._wheel_rate) / dt - acceleration
        acceleration += change if dt >= TURN_CREEP_MEAN else dt / TURN_CREEP_MEAN * change
        self._wheel_rate, self._wheel_acceleration = rate, acceleration
        creep = TURN_CREEP_TIME * acceleration
        # Modules that are askew do so for as long as the base keeps driving in one direction.
        variance += 2.0 * LASTING_TIME / dt * group.size * self._askew * self._askew
        return variance / group.inertia + lasting * creep * creep

    def _is_consistent(self, speed: float) -> bool:
        """Return whether the modules disagree by no more than creep and encoders explain."""
        return self.residual <= self._consistent_limit(speed)

    def _consistent_limit(self, speed: float) -> float:
        """Return the largest disagreement [m/s] that creep and encoders explain at a speed."""
        return consistent_speed(speed) + self._rounding

    def _moving(self, creep: float) -> float:
        """Return how much of the lasting errors moves the base [m/s], with this much creep."""
        return math.hypot(self._doubt, creep, SLIP_SHARE * self._slip, self._scrub)

    def _turning(self, creep: float) -> float:
        """Return how much of the lasting errors turns the base [m/s], with this much creep."""
        return math.hypot(self._doubt, CREEP_TURN_SHARE * creep, SLIP_TURN_SHARE * self._slip,
                          self._scrub, self._askew)

    def _excess(self, dt: float, noise: OdometryNoise) -> float:
        """Return the disagreement beyond what the noise explains [m/s]."""
        ratio = 2.0 * self._time / dt
        fresh = self.variance * ratio if ratio > 1.0 else self.variance
        usual = (noise.slip_speed * noise.slip_speed
                 + LASTING_STDS * LASTING_STDS * (fresh + self._rounding_variance))
        square = self.residual * self.residual
        return math.sqrt(square - usual) if square > usual else 0.0


def _expected_slip(dt: float, step: Step, usual: float, steered: list[float],
                   creep: float) -> float:
    """Return the slip to expect of the wheels [m/s]: the usual, less while they creep."""
    rolling = CREEPING_SLIP * step.length / dt + creep
    if rolling >= usual:
        return usual
    scrub = SCRUB * max(map(abs, map(steered.__getitem__, step.group.used))) / dt
    return min(usual, rolling + scrub)


def _steering_rate(dt: float, step: Step, paths: ModulePaths) -> float:
    """Return how fast the modules steer [rad/s], on average."""
    steered = map(abs, map(paths.steered.__getitem__, step.group.used))
    return sum(steered) / (step.group.size * dt)


def consistent_speed(speed: float) -> float:
    """Return the largest disagreement of modules [m/s] of which a gyro may learn, at a speed."""
    return CONSISTENT_SPEED + CONSISTENT_RATIO * speed


def unseen_speeds(twist: tuple[float, float, float]) -> tuple[float, float]:
    """Return how fast [m/s], [rad/s] a base may move in a gap after this twist."""
    vx, vy, omega = twist
    return UNSEEN_SPEED + math.hypot(vx, vy), UNSEEN_YAW_RATE + abs(omega)
