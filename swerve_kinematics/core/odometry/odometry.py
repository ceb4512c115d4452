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

"""Where the base is, from module encoders and a gyro, and how sure that is."""

import cmath
import math

import numpy as np
from numpy.typing import ArrayLike

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.geometry.arrays import as_floats
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.catch_up import (
    CatchUp, FASTEST, FASTEST_TURN, SLOWEST, SLOWEST_TURN)
from swerve_kinematics.core.odometry.chord import Step
from swerve_kinematics.core.odometry.gyro import GyroBiasFilter
from swerve_kinematics.core.odometry.inertial import USUAL_RANGE
from swerve_kinematics.core.odometry.lost_yaw import LostYaw
from swerve_kinematics.core.odometry.pose_covariance import is_covariance, PoseCovariance
from swerve_kinematics.core.odometry.readings import (
    finite_array, LARGEST_READING, Pair, read_modules, read_vector, SHORTEST)
from swerve_kinematics.core.odometry.repeats import Repeats
from swerve_kinematics.core.odometry.solver import StepSolver
from swerve_kinematics.core.odometry.step_noise import StepNoise, unseen_speeds
from swerve_kinematics.core.odometry.twist import rim_velocities, SHORT_PART, TwistMeter
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise
from swerve_kinematics.core.odometry.views import OdometryViews

# A clock that jumped back cannot tell how long the gap was: it counts as this long [s].
UNSEEN_TIME = 1.0


class SwerveOdometry(OdometryViews):
    """
    Dead reckoning of a swerve base by module encoders and, where there is one, a gyro.

    Each step takes every module's path as the chord of an arc, lets the modules vote on the
    displacement of the base, leaves out a module that contradicts the others, and adds the
    mean of the votes to the pose. The turn of the step comes from the gyro, or without
    one from the wheels. `OdometryNoise` describes the noise behind the covariances.

    Parameters
    ----------
    kin : SwerveKinematics
        The layout.
    pose : array_like (3,)
        Where the base starts, `[x, y, yaw]` [m, m, rad] in the odom frame.
    estimate_gyro_bias : bool
        Estimate the gyro's constant rate error, at rest and against the wheels, and take it
        off each turn. A yaw that the sensor integrates drifts with it as a rate does.
    noise : OdometryNoise
        What to expect of sensors and wheels. May be replaced at any time as the attribute
        `noise`; the correlation time and the two values of the gyro's bias stay those of the
        start.
    imu_position : array_like (2,)
        Where the accelerometer is, from base_link [m].
    force_range : float
        Mean forces beyond this count as out of range [m/s^2]. Give that of the sensor, such as
        160 for 16 g, where its samples are free of spikes and other faults: then the odometry
        takes part in collisions as they are measured.

    Raises
    ------
    ValueError
        If the pose is not three finite numbers, the position not two, or the range not positive.

    Notes
    -----
    Errors that all modules share (a wrong wheel radius, steering offsets of one sign) are
    invisible to the modules' votes and not in the covariance; calibrate them.

    """

    def __init__(self, kin: SwerveKinematics, pose: ArrayLike = (0.0, 0.0, 0.0),
                 estimate_gyro_bias: bool = True, noise: OdometryNoise = OdometryNoise(),
                 imu_position: ArrayLike = (0.0, 0.0), force_range: float = USUAL_RANGE) -> None:
        """Wait for the first sample."""
        if not force_range > 0.0:
            raise ValueError(f'force_range must be positive, got {force_range}')
        self._count: int = kin.module_count
        self.noise = noise
        self._estimate_bias = bool(estimate_gyro_bias)
        self._bias = GyroBiasFilter(noise.gyro_bias_std if estimate_gyro_bias else 0.0,
                                    noise.gyro_bias_drift if estimate_gyro_bias else 0.0)
        self._step_noise = StepNoise(self._count, noise.correlation_time)
        place = finite_array(imu_position, (2,), 'imu_position')
        self._solver = StepSolver(kin.module_positions, complex(*place), force_range)
        self._twist_meter, self._repeats = TwistMeter(), Repeats()
        self._stamp = math.nan
        self._primed = self._gyro_went_on = False
        self.reset(pose)

    def reset(self, pose: ArrayLike = (0.0, 0.0, 0.0),
              covariance: ArrayLike | None = None) -> None:
        """
        Set the pose; the motion continues from there without a gap.

        Parameters
        ----------
        pose : array_like (3,)
            `[x, y, yaw]` [m, m, rad].
        covariance : array_like (3, 3), optional
            Of the pose. Where a variance is zero or not given, it is that of a micrometre or of
            a microradian.

        Raises
        ------
        ValueError
            If a shape is wrong, an entry is not finite, or the covariance cannot be one.

        """
        x, y, yaw = finite_array(pose, (3,), 'pose').tolist()
        if covariance is None:
            covariance = np.zeros((3, 3))
        elif not is_covariance(covariance := finite_array(covariance, (3, 3), 'covariance')):
            raise ValueError('covariance must be symmetric and without negative variance, got '
                             f'{covariance.tolist()}')
        self._position, self._yaw = complex(x, y), float(yaw)
        self._covariance = PoseCovariance(covariance, self._bias.variance)
        self._catch_up = CatchUp(0j, SLOWEST, FASTEST)
        self._turn_catch_up = CatchUp(0.0, SLOWEST_TURN, FASTEST_TURN)
        self._lost_yaw = LostYaw()
        self._unseen = 0.0  # for how long nothing has told how the base moves [s]
        # Errors of the way so far are no longer in the pose, and not to be made up for.
        self._step_noise.forget_sums()
        self._solver.inertial.forget_way()
        self._solver.gyro.watch.forget_turns()

    def reprime(self, gyro_went_on: bool = False) -> None:
        """
        Forget the last sample: the next one is a new start, whatever its stamp and readings.

        For a gap, a clock that jumped, a restarted driver. The pose is kept, and its
        covariance grows by how far the base may have moved until the next sample. That one
        tells no motion yet: its twist is 0, with the variance of what was known before the gap.

        Parameters
        ----------
        gyro_went_on : bool
            Whether the gyro was heard all the time between the two samples, without a break or
            a jump. What its yaw turned meanwhile, or the integral of its rate, is then added
            to the heading, which grows less certain by the gyro's own errors only.

        """
        self._primed, self._gyro_went_on = False, gyro_went_on
        self._solver.interrupt_clock()

    def update(self, stamp: float, distances: ArrayLike, angles: ArrayLike,
               yaw: float | None = None, yaw_rate: float | None = None,
               velocities: ArrayLike | None = None, specific_force: Pair | None = None,
               tilt_rates: Pair | None = None, rate_integral: float | None = None) -> bool:
        """
        Take in one sample of the encoders, the gyro and the accelerometer.

        Parameters
        ----------
        stamp : float
            When it was measured [s], by any clock.
        distances : array_like (n,)
            Cumulative distance of each rim [m].
        angles : array_like (n,)
            Steering angles [rad], counting turns or wrapped. A module with a distance or an
            angle that is not finite, or beyond 1e12, is left out.
        yaw : float, optional
            By the gyro [rad], continuous or wrapped, from any zero. Not finite, or beyond 1e12:
            absent. One that comes back within two seconds puts right what the others told of the
            turn meanwhile, unless it seems to come from a sensor that was restarted.
        yaw_rate : float, optional
            By the gyro [rad/s]; integrated where there is no yaw. Likewise. Yaw and rate each
            count in a step only where they are given at both of its ends: for a gyro that is
            slower than the updates, give what it said last, carried on to their stamps.
        velocities : array_like (n,), optional
            Measured rim speeds [m/s] for the twist. Without them, or if one is not finite
            or impossible, the twist comes from the steps.
        specific_force : array_like (2,), optional
            What the accelerometer shows along x and y of the base [m/s^2], gravity not removed:
            the mean since the last sample. Not finite: absent; for up to 0.1 s the last one stands
            in for it. Beyond `force_range`: as in a collision that nobody measured. It judges
            the wheels only in a step that follows on one that has a force.
        tilt_rates : array_like (2,), optional
            Rates about x and y of the base [rad/s], likewise. Give them where you can: without
            them a ramp of six degrees may look like a push, until the wheels are believed again.
        rate_integral : float, optional
            Of `yaw_rate` over all its samples [rad], from any zero, where there are more of
            them than updates; its change takes the place of the mean of two rates. Leave it out
            of one update where it lacks a turn since the last one with a rate.

        Returns
        -------
        bool
            Whether the pose moved on by a step. False when the sample only primed (the first
            one, after `reprime`, or when too few modules were left to tell the motion), when
            it was dropped for its stamp (repeated, older or not finite), and while an encoder
            of a moving wheel repeats its last reading, if it did so before.

        Raises
        ------
        ValueError
            If a shape is wrong.

        """
        stamp = float(stamp)
        ways, steering = read_modules(distances, angles, self._count)
        rims: list[float] | None = (
            None if velocities is None else as_floats(velocities, self._count, 'velocities'))
        force = read_vector(specific_force, 'specific_force')
        rates = read_vector(tilt_rates, 'tilt_rates')
        is_new_start, by_stamps = not self._primed, stamp - self._stamp
        if not abs(stamp) <= LARGEST_READING or by_stamps < SHORTEST and not is_new_start:
            return False
        noise, solver, repeats = self.noise, self._solver, self._repeats
        if is_new_start:
            if not by_stamps > 0.0:
                # A clock that jumped back, or else the first sample of all.
                by_stamps = UNSEEN_TIME if by_stamps <= 0.0 else 0.0
        elif repeats.expected:
            if repeats.has(by_stamps, ways, noise.distance_resolution):
                repeats.wait(by_stamps, force, rates)
                return False
            force, rates = repeats.means(by_stamps, force, rates)
        self._stamp, self._primed = stamp, True
        dt = solver.hear(by_stamps, ways, steering, yaw, yaw_rate, rate_integral, noise)
        self._bias.predict(dt)
        self._covariance.bias_variance = self._bias.variance
        step = None if is_new_start else solver.solve(force, rates, self._bias.bias, noise)
        if repeats.keep(dt, ways, solver.paths.rolled, noise.distance_resolution):
            solver.inertial.forget_scatter()
            solver.time.readings.forget()
        if step is None:
            self._lose_track(dt, is_new_start)
            return False
        self._unseen = 0.0
        self._step_noise.observe(solver.lasted, step, solver.paths, noise,
                                 self._twist_meter.acceleration, solver.inertial)
        self._integrate(dt, step)
        if dt == by_stamps:
            # Else wheels and gyro may tell of different times.
            self._measure_twist(dt, step, steering, rims)
            self._correct_bias(dt, step)
        return True

    def _lose_track(self, dt: float, is_new_start: bool) -> None:
        """Go on without knowing how far the base moved since the last sample."""
        meter, solver = self._twist_meter, self._solver
        turn = solver.gyro_turn
        if is_new_start:
            turn = solver.gyro.over_gap() if self._gyro_went_on else None
        solver.interrupt()
        meter.interrupt()
        self._lost_yaw.forget()
        self._step_noise.interrupt()
        speed, yaw_rate = unseen_speeds(meter.measured)
        square = self._unseen_square(dt, is_new_start)
        position_variance = speed * speed * square
        if turn is None:
            self._covariance.grow(position_variance, yaw_rate * yaw_rate * square)
        else:
            self._yaw += turn - self._bias.bias * dt
            self._covariance.propagate(
                0j, 0j, position_variance, self.noise.gyro_variance * dt, dt)
        if is_new_start:
            meter.forget(speed, yaw_rate)

    def _unseen_square(self, dt: float, is_new_start: bool) -> float:
        """Return by how much the square of the time [s^2] grows in which nobody saw the base."""
        # Not that of each step: it may have moved on in all of them as in one long gap.
        before = self._unseen
        self._unseen += dt
        if not (is_new_start or before):
            # Where wheels have rolled further than they can, the clock may have been set back, by
            # a message or two: the step was longer than its stamps say.
            self._unseen += 2.0 * self._solver.pace.usual
        return self._unseen * self._unseen - before * before

    def _integrate(self, dt: float, step: Step) -> None:
        """Add the step to the pose and its noise to the covariance."""
        gyro = self._solver.gyro
        if amends := gyro.watch.amends():
            self._turn_catch_up.add(math.remainder(amends, TURN))
        # What is known of the heading, but not shown yet, turns the way at once.
        heading = self._yaw + self._turn_catch_up.left
        halfway = cmath.rect(1.0, heading + 0.5 * step.turn)
        displacement = halfway * step.displacement
        position_variance, turn_variance = self._step_noise.growth(dt, step, self.noise)
        self._covariance.propagate(
            displacement, 1j * (0.5 * displacement - halfway * step.group.centroid),
            position_variance, turn_variance, dt if step.by_gyro else 0.0)
        self._covariance.scale_variance = self._step_noise.steady.variance
        self._position += displacement
        self._yaw += step.turn
        if self._lost_yaw.is_lost or gyro.is_silent:
            self._turn_catch_up.add(self._lost_yaw.error(
                dt, step.turn + self._bias.bias * dt, turn_variance, gyro))
        if step.belated:
            self._catch_up.add(cmath.rect(1.0, heading + step.turn) * step.belated)
        if self._catch_up.left:
            self._position += self._catch_up.part(dt)
        if self._turn_catch_up.left:
            self._yaw += self._turn_catch_up.part(dt)

    def _measure_twist(self, by_stamps: float, step: Step, angles: list[float],
                       rims: list[float] | None) -> None:
        """Take the twist at the stamp, and its covariance; the last one stands in short steps."""
        noise, solver, velocities = self.noise, self._solver, None
        if by_stamps < SHORT_PART * solver.pace.usual:
            return
        dt, fastest = solver.lasted, noise.largest_speed
        if rims is not None and step.coasting_std is None:
            velocities = rim_velocities(step.group.used, rims, angles, fastest)
        variance, rate_variance = self._step_noise.twist_variances(dt, step, noise)
        variance += solver.inertial.scatter ** 2
        yaw_rate = step.turn / dt
        if step.by_gyro:
            yaw_rate = step.turn / solver.time.turn_duration(step.turn)
            rate_variance += self._bias.variance
        self._twist_meter.measure(dt, step, yaw_rate, velocities, fastest, variance, rate_variance)

    def _correct_bias(self, dt: float, step: Step) -> None:
        """Let the bias filter see the gyro's rate against rest, or against the wheels."""
        if not step.by_gyro or not self._estimate_bias:
            return
        gain = self._bias_gain(dt, step)
        if gain:
            self._covariance.correct_bias(gain)

    def _bias_gain(self, dt: float, step: Step) -> float:
        """Return the gain with which the bias filter has learnt from a step, or several."""
        solver, bias, noise = self._solver, self._bias, self.noise
        error, variance = step.turn / dt + bias.bias, noise.gyro_variance / dt
        if solver.at_rest:
            return bias.correct(error, variance)
        wheel_variance = None if solver.is_doubting else self._step_noise.wheel_rate_variance(
            dt, step, noise, solver.paths.steered)
        if wheel_variance is None:
            return bias.learn()
        return bias.compare(dt, error - step.wheel_turn / dt, variance + wheel_variance)
