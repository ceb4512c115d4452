"""Where the base is, from module encoders and a gyro, and how sure that is."""

import cmath
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.geometry.arrays import as_floats
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.chord import fit, Readings, Step, without_slipping
from swerve_kinematics.core.odometry.curvature import bend_after, STRAIGHT
from swerve_kinematics.core.odometry.group import Layout
from swerve_kinematics.core.odometry.gyro import GyroBiasFilter, MAX_YAW_RATE, RestDetector
from swerve_kinematics.core.odometry.inertial import Inertial
from swerve_kinematics.core.odometry.pose_covariance import PoseCovariance
from swerve_kinematics.core.odometry.readings import (
    finite_array, LARGEST_READING, LARGEST_SPEED, Modules, read_modules, read_vector, SHORTEST)
from swerve_kinematics.core.odometry.step_noise import StepNoise
from swerve_kinematics.core.odometry.twist import Estimate, TwistMeter
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise
from swerve_kinematics.core.odometry.yaw import YawTracker

# Stamps wander by a few milliseconds against the encoders: this much time [s] a module is
# granted on top of a step before its distance counts as impossible.
STAMP_JITTER = 0.01

# In a gap the base may have moved on as before, and crept or been pushed by this much even
# if it stood [m/s], [rad/s]. A clock that jumped back cannot tell how long [s].
UNSEEN_SPEED = 0.05
UNSEEN_YAW_RATE = 0.05
UNSEEN_TIME = 1.0

# The wheels' yaw rate feeds the bias filter while the modules disagree by no more than a few
# times their ordinary creep: [m/s], plus this part of their speed.
CONSISTENT_SPEED = 0.03
CONSISTENT_RATIO = 0.03


class SwerveOdometry:
    """
    Dead reckoning of a swerve base by module encoders and, where there is one, a gyro.

    Each step takes every module's path as the chord of an arc, lets the modules vote on the
    displacement of the base, leaves out a module that contradicts the others, and adds the
    mean of the votes to the pose. The gyro tells the turn of the step; without it the wheels
    do. `OdometryNoise` describes the noise behind the covariances.

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

    Raises
    ------
    ValueError
        If the pose is not three finite numbers.

    Notes
    -----
    Errors that all modules share (a wrong wheel radius, steering offsets of one sign) are
    invisible to the modules' votes and not in the covariance; calibrate them.

    """

    def __init__(self, kin: SwerveKinematics, pose: ArrayLike = (0.0, 0.0, 0.0),
                 estimate_gyro_bias: bool = True, noise: OdometryNoise = OdometryNoise(),
                 imu_position: ArrayLike = (0.0, 0.0)) -> None:
        """Wait for the first sample."""
        self._count: int = kin.module_count
        self._layout = Layout(kin.module_positions)
        self.noise = noise
        self._estimate_bias = bool(estimate_gyro_bias)
        self._bias = GyroBiasFilter(noise.gyro_bias_std if estimate_gyro_bias else 0.0,
                                    noise.gyro_bias_drift if estimate_gyro_bias else 0.0)
        self._step_noise = StepNoise(self._count, noise.correlation_time)
        self._gyro, self._rest = YawTracker(), RestDetector()
        self._inertial = Inertial(complex(*finite_array(imu_position, (2,), 'imu_position')))
        self._stamp: float | None = None
        unknown = [math.nan] * self._count
        self._modules: Modules = unknown, unknown
        self._twist_meter = TwistMeter()
        self._slipping = [False] * self._count
        self._doubt = [0.0] * self._count
        self._step_before: tuple[float, list[float], list[float], float,
                                 tuple[int, ...]] | None = None
        self._primed = False
        self.reset(pose)

    @property
    def estimate(self) -> Estimate:
        """Return pose, twist and their covariances as an Estimate."""
        return Estimate(
            (self._position.real, self._position.imag, self._yaw), self._twist_meter.twist,
            self._covariance.pose, self._twist_meter.covariance)

    @property
    def yaw(self) -> float:
        """Return the yaw of the pose [rad]; it counts whole turns."""
        return self._yaw

    @property
    def pose(self) -> NDArray[np.float64]:
        """Return `[x, y, yaw]` (3,) [m, m, rad] in the odom frame; the yaw counts whole turns."""
        return np.array(self.estimate.pose)

    @property
    def twist(self) -> NDArray[np.float64]:
        """Return `[vx, vy, omega]` (3,) [m/s, m/s, rad/s] at the stamp, in the base frame."""
        return np.array(self.estimate.twist)

    @property
    def pose_covariance(self) -> NDArray[np.float64]:
        """Return the covariance (3, 3) of the pose [m^2, m rad, rad^2]."""
        return np.array(self.estimate.pose_covariance).reshape(3, 3)

    @property
    def twist_covariance(self) -> NDArray[np.float64]:
        """Return the covariance (3, 3) of the twist [m^2/s^2, m rad/s^2, rad^2/s^2]."""
        return np.array(self.estimate.twist_covariance).reshape(3, 3)

    @property
    def slipping(self) -> NDArray[np.bool_]:
        """Return which modules (n,) the last step left out as wrong: slip, or a jump."""
        return np.array(self._slipping)

    @property
    def gyro_bias(self) -> float:
        """Return the estimated constant error of the gyro's rate [rad/s]."""
        return float(self._bias.bias)

    @property
    def yaw_jumps(self) -> int:
        """Return how many steps of the yaw were no turns: its sensor was set anew."""
        return self._gyro.jumps

    @property
    def gyro_trusted(self) -> tuple[bool, bool]:
        """
        Return whether the yaw and the rate of the gyro are believed.

        One that the other and the wheels contradict for a second is not, until they agree.
        """
        return self._gyro.trusted

    @property
    def residual(self) -> float:
        """Return the root mean square disagreement of the modules in the last step [m/s]."""
        return self._step_noise.residual

    @property
    def doubt(self) -> NDArray[np.float64]:
        """Return for how long (n,) [s] the accelerometer has contradicted each module."""
        return np.array(self._doubt)

    @property
    def coasting(self) -> float:
        """Return for how long [s] the base has been coasting on its accelerometer alone."""
        return self._inertial.doubt

    @property
    def lean(self) -> NDArray[np.float64]:
        """Return the gravity (2,) that leaks into x and y as the floor leans [m/s^2]."""
        return np.array((self._inertial.lean.real, self._inertial.lean.imag))

    @property
    def accelerometer_believed(self) -> bool:
        """Return whether an accelerometer had a say in the last step."""
        return self._inertial.believed

    def reset(self, pose: ArrayLike = (0.0, 0.0, 0.0),
              covariance: ArrayLike | None = None) -> None:
        """
        Set the pose; the motion goes on from there without a gap.

        Parameters
        ----------
        pose : array_like (3,)
            `[x, y, yaw]` [m, m, rad].
        covariance : array_like (3, 3), optional
            Of the pose; zero where not given.

        Raises
        ------
        ValueError
            If a shape is wrong or an entry is not finite.

        """
        x, y, yaw = finite_array(pose, (3,), 'pose').tolist()
        if covariance is None:
            covariance = np.zeros((3, 3))
        covariance = finite_array(covariance, (3, 3), 'covariance')
        self._position, self._yaw = complex(x, y), yaw
        self._covariance = PoseCovariance(covariance, self._bias.variance)

    def reprime(self) -> None:
        """
        Forget the last sample: the next one starts anew, whatever its stamp and readings.

        For a gap, a clock that jumped, a restarted driver. The pose is kept, and its
        covariance grows by what the base may have moved until the next sample.
        """
        self._primed = False

    def update(self, stamp: float, distances: ArrayLike, angles: ArrayLike,
               yaw: float | None = None, yaw_rate: float | None = None,
               velocities: ArrayLike | None = None, specific_force: ArrayLike | None = None,
               tilt_rates: ArrayLike | None = None, rate_integral: float | None = None) -> bool:
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
            angle that is not finite is left out.
        yaw : float, optional
            By the gyro [rad], continuous or wrapped, from any zero. Not finite: absent.
        yaw_rate : float, optional
            By the gyro [rad/s]; integrated where there is no yaw. Not finite: absent.
        velocities : array_like (n,), optional
            Measured rim speeds [m/s] for the twist. Without them, or where one is not finite
            or impossible, the steps tell it.
        specific_force : array_like (2,), optional
            What the accelerometer shows along x and y of the base [m/s^2], gravity not removed:
            the mean since the last sample. Not finite: absent.
        tilt_rates : array_like (2,), optional
            Rates about x and y of the base [rad/s], likewise.
        rate_integral : float, optional
            Of `yaw_rate` over all its samples [rad], from any zero, where there are more of
            them than updates; its change takes the place of the mean of two rates.

        Returns
        -------
        bool
            Whether the pose moved on by a step. False when the sample only primed (the first
            one, after `reprime`, or when too few modules were left to tell the motion), and
            when it was dropped for its stamp: repeated, older or not finite.

        Raises
        ------
        ValueError
            If a shape is wrong.

        """
        stamp = float(stamp)
        modules = read_modules(distances, angles, self._count)
        rims: list[float] | None = (
            None if velocities is None else as_floats(velocities, self._count, 'velocities'))
        force = read_vector(specific_force, 'specific_force')
        rates = read_vector(tilt_rates, 'tilt_rates')
        if not abs(stamp) <= LARGEST_READING or (
                self._primed and self._stamp is not None and stamp < self._stamp + SHORTEST):
            return False
        before, self._modules = self._modules, modules
        dt = self._advance(stamp)
        gyro_turn = self._gyro.turn(dt, yaw, yaw_rate, rate_integral)
        at_rest = self._rest.update(dt, *modules)
        readings = self._read_step(dt, before, gyro_turn)
        step = None
        if self._primed:
            readings, step = self._fit_checked(dt, readings)
        self._primed = True
        if step is None:
            self._lose_track(dt)
            return False
        step, coasting = self._believe(dt, readings, step, force, rates, at_rest)
        by_gyro = readings.turn is not None
        self._step_noise.observe(dt, step, self.noise, by_gyro)
        self._integrate(dt, step, by_gyro, coasting)
        self._measure_twist(dt, step, by_gyro, None if coasting else rims)
        if readings.turn is not None and self._estimate_bias:
            self._correct_bias(dt, step, readings.turn, at_rest)
        return True

    def _advance(self, stamp: float) -> float:
        """Keep the stamp and return the time since the last one [s]."""
        last, self._stamp = self._stamp, stamp
        if last is None:
            return 0.0
        return stamp - last if stamp > last else UNSEEN_TIME

    def _lose_track(self, dt: float) -> None:
        """Go on without knowing how the base moved since the last sample."""
        self._step_before = None
        self._inertial.interrupt()
        self._doubt = [0.0] * self._count
        self._twist_meter.interrupt()
        vx, vy, omega = self._twist_meter.twist
        self._covariance.grow((UNSEEN_SPEED + math.hypot(vx, vy)) * dt,
                              (UNSEEN_YAW_RATE + abs(omega)) * dt)

    def _read_step(self, dt: float, before: Modules, gyro_turn: float | None) -> Readings:
        """Return what encoders and gyro say about the step since the modules were as `before`."""
        fastest = min(self.noise.max_module_speed, LARGEST_SPEED) * (dt + STAMP_JITTER)
        (distances, angles), (last_distances, last_angles) = self._modules, before
        rolled = [now - last for now, last in zip(distances, last_distances)]
        steered = [math.remainder(now - last, TURN) for now, last in zip(angles, last_angles)]
        used = tuple(module for module, way in enumerate(rolled) if abs(way) <= fastest)
        self._slipping = [abs(way) > fastest for way in rolled]
        turn = None if gyro_turn is None else gyro_turn - self._bias.bias * dt
        bend = bend_after(*self._step_before, dt) if self._step_before else STRAIGHT
        return Readings(used, rolled, last_angles, steered, turn, bend)

    def _fit_checked(self, dt: float, readings: Readings) -> tuple[Readings, Step | None]:
        """Return the readings, without the gyro where the wheels refute it, and their Step."""
        step = self._fit(dt, readings)
        if step is None and readings.turn is None:
            return readings, None
        # Wheels that the accelerometer has caught slipping refute nothing.
        wheel_turn = math.nan if step is None or any(self._doubt) else _agreed_turn(dt, step)
        checked = self._gyro.checked(dt, wheel_turn)
        turn = None if checked is None else checked - self._bias.bias * dt
        if turn != readings.turn:
            readings = readings._replace(turn=turn)
            step = self._fit(dt, readings)
        return readings, step

    def _fit(self, dt: float, readings: Readings) -> Step | None:
        """Return the Step that fits all modules best, None if it tells no turn a base can make."""
        step = fit(self._layout, readings)
        if step is None or abs(step.turn) > MAX_YAW_RATE * (dt + STAMP_JITTER):
            return None
        return step

    def _believe(self, dt: float, readings: Readings, step: Step, force: complex | None,
                 rates: complex | None, at_rest: bool) -> tuple[Step, bool]:
        """Return the Step without what contradicts it, and whether no wheel was left."""
        inertial, noise = self._inertial, self.noise
        lever = 2j * math.sin(0.5 * step.turn) * inertial.position
        votes = [(step.displacement + error + lever) / dt for error in step.errors]
        believed = inertial.judge(dt, step.turn, votes, force, rates, at_rest)
        coasting = not any(believed)
        for module, trusted in zip(step.used, believed):
            self._doubt[module] = 0.0 if trusted else self._doubt[module] + dt
            self._slipping[module] |= not trusted
        if coasting:
            self._step_before = None
            return step._replace(displacement=dt * inertial.velocity - lever), True
        if all(believed):
            step = without_slipping(
                self._layout, readings, step,
                math.hypot(noise.slip_speed * dt, noise.distance_resolution), noise.slip_ratio)
        else:
            used = tuple(module for module, trusted in zip(step.used, believed) if trusted)
            # Where the believed modules cannot tell the turn, all of them do.
            step = fit(self._layout, readings._replace(used=used)) or step
        if step.slipping is not None:
            self._slipping[step.slipping] = True
        self._step_before = dt, readings.rolled, readings.steered, step.turn, step.used
        inertial.settle(dt, (step.displacement + lever) / dt, step.spread / dt)
        return step, False

    def _integrate(self, dt: float, step: Step, by_gyro: bool, coasting: bool) -> None:
        """Add the step to the pose and its noise to the covariance."""
        halfway = cmath.exp(1j * (self._yaw + 0.5 * step.turn))
        displacement = halfway * step.displacement
        sure = math.sqrt(self._inertial.variance) if coasting else None
        position_variance, turn_variance = self._step_noise.growth(
            dt, step, self.noise, by_gyro, self._twist_meter.acceleration, sure)
        self._covariance.propagate(
            displacement, 1j * (0.5 * displacement - halfway * step.group.centroid),
            position_variance, turn_variance, dt if by_gyro else 0.0)
        self._position += displacement
        self._yaw += step.turn

    def _measure_twist(self, dt: float, step: Step, by_gyro: bool,
                       rims: list[float] | None) -> None:
        """Take the twist at the stamp, and its covariance."""
        noise = self.noise
        fastest = min(noise.max_module_speed, LARGEST_SPEED)
        velocities = None
        if rims is not None and all(abs(rims[module]) <= fastest for module in step.used):
            angles = self._modules[1]
            velocities = [cmath.rect(rims[module], angles[module]) for module in step.used]
        rate_variance = noise.gyro_noise ** 2 / dt + self._bias.variance if by_gyro else None
        # Differences of roundings, each uniform over the resolution, carried on to the stamp.
        rounding = 0.3 * (noise.distance_resolution / dt) ** 2
        self._twist_meter.measure(dt, step, velocities, fastest,
                                  self._step_noise.variance + rounding, rate_variance)

    def _correct_bias(self, dt: float, step: Step, turn: float, at_rest: bool) -> None:
        """Let the bias filter see the gyro's rate against rest, or against the wheels."""
        noise, group = self.noise, step.group
        self._bias.predict(dt)
        if any(self._doubt):
            return
        rate_variance = noise.gyro_noise ** 2 / dt
        rate_error = turn / dt + self._bias.bias
        if not at_rest:
            limit = CONSISTENT_SPEED + CONSISTENT_RATIO * step.length / dt
            if not group.inertia or self._step_noise.residual > limit:
                return
            rate_error -= step.wheel_turn / dt
            # Ten times the variance of one sample at 50 Hz: what lasts weighs more.
            lasting = 2.0 * noise.correlation_time / dt
            variance = self._step_noise.variance + noise.slip_speed ** 2
            rate_variance += lasting * variance / group.inertia
        gain = self._bias.correct(rate_error, rate_variance)
        self._covariance.correct_bias(gain, self._bias.variance)


def _agreed_turn(dt: float, step: Step) -> float:
    """Return the turn by the wheels [rad], NaN where they do not agree on one among themselves."""
    off = 2.0 * (math.sin(0.5 * step.wheel_turn) - math.sin(0.5 * step.turn))
    # What the votes differ by because the gyro turned otherwise is not the wheels' own.
    own = step.spread ** 2 - off * off * step.group.inertia / step.group.size
    limit = CONSISTENT_SPEED * dt + CONSISTENT_RATIO * step.length
    return step.wheel_turn if own <= limit * limit else math.nan
