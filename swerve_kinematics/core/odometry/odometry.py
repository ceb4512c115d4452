"""Where the base is, from module encoders and a gyro, and how sure that is."""

import cmath
import math
from typing import NamedTuple

import numpy as np

from swerve_kinematics.core.geometry.angles import scalar_sinc, TURN
from swerve_kinematics.core.geometry.arrays import as_floats
from swerve_kinematics.core.odometry.chord import Readings, solve_step
from swerve_kinematics.core.odometry.curvature import bend_after, STRAIGHT
from swerve_kinematics.core.odometry.group import Layout
from swerve_kinematics.core.odometry.gyro import GyroBiasFilter, MAX_YAW_RATE, RestDetector
from swerve_kinematics.core.odometry.uncertainty import Disagreement, OdometryNoise, PoseCovariance
from swerve_kinematics.core.odometry.yaw import YawTracker

# Stamps wander by a few milliseconds against the encoders: this much time [s] a module is
# granted on top of a step before its distance counts as impossible.
STAMP_JITTER = 0.01

# No base rolls a billion kilometres, and no clock of one shows 30,000 years: a distance [m],
# an angle [rad] or a stamp [s] beyond this is no measurement. Nor is a speed [m/s] beyond a
# thousandth of that of light. Within these bounds no sum of steps overflows.
LARGEST = 1e12
LARGEST_SPEED = 3e5
# Stamps closer than this [s] are the same: nanoseconds in a float of today's seconds since
# 1970 are no finer.
SHORTEST = 1e-7

# In a gap the base may have moved on as before, and crept or been pushed by this much even
# if it stood [m/s], [rad/s]. A clock that jumped back cannot tell how long [s].
UNSEEN_SPEED = 0.05
UNSEEN_YAW_RATE = 0.05
UNSEEN_TIME = 1.0

# The wheels' yaw rate feeds the bias filter while the modules disagree by no more than a few
# times their ordinary creep: [m/s], plus this part of their speed.
CONSISTENT_SPEED = 0.03
CONSISTENT_RATIO = 0.03


class Estimate(NamedTuple):
    """
    What the odometry knows, as Python's own numbers.

    For a caller that passes single numbers on, at every step: to make and to read arrays of
    them takes as long as to compute them.

    Attributes
    ----------
    pose : tuple of float (3,)
        `(x, y, yaw)` [m, m, rad] in the odom frame; the yaw counts whole turns.
    twist : tuple of float (3,)
        `(vx, vy, omega)` [m/s, m/s, rad/s] of the last step, in the base frame.
    pose_covariance : tuple of float (9,)
        Row by row [m^2, m rad, rad^2].
    twist_covariance : tuple of float (9,)
        Row by row [m^2/s^2, m rad/s^2, rad^2/s^2].

    """

    pose: tuple
    twist: tuple
    pose_covariance: tuple
    twist_covariance: tuple


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

    def __init__(self, kin, pose=(0.0, 0.0, 0.0), estimate_gyro_bias=True,
                 noise=OdometryNoise()):
        """Wait for the first sample."""
        self._count = kin.module_count
        self._layout = Layout(kin.module_positions)
        self.noise = noise
        self._estimate_bias = bool(estimate_gyro_bias)
        self._bias = GyroBiasFilter(noise.gyro_bias_std if estimate_gyro_bias else 0.0,
                                    noise.gyro_bias_drift if estimate_gyro_bias else 0.0)
        self._disagreement = Disagreement(self._count, noise.correlation_time)
        self._gyro = YawTracker()
        self._rest = RestDetector()
        self._stamp = None
        unknown = [math.nan] * self._count
        self._modules = unknown, unknown
        self._twist = 0.0, 0.0, 0.0
        self._twist_variances = 0.0, 0.0, 0j
        self._slipping = [False] * self._count
        self._residual = 0.0
        self._step_before = None
        self._primed = False
        self.reset(pose)

    @property
    def estimate(self):
        """Return pose, twist and their covariances as an Estimate."""
        velocity, turn_rate, lever = self._twist_variances
        by_x, by_y = turn_rate * lever.real, turn_rate * lever.imag
        across = by_x * lever.imag
        return Estimate(
            (self._position.real, self._position.imag, self._yaw), self._twist,
            self._covariance.pose,
            (velocity + by_x * lever.real, across, by_x,
             across, velocity + by_y * lever.imag, by_y,
             by_x, by_y, turn_rate))

    @property
    def yaw(self):
        """Return the yaw of the pose [rad]; it counts whole turns."""
        return self._yaw

    @property
    def pose(self):
        """Return `[x, y, yaw]` (3,) [m, m, rad] in the odom frame; the yaw counts whole turns."""
        return np.array(self.estimate.pose)

    @property
    def twist(self):
        """Return `[vx, vy, omega]` (3,) [m/s, m/s, rad/s] of the last step, in the base frame."""
        return np.array(self.estimate.twist)

    @property
    def pose_covariance(self):
        """Return the covariance (3, 3) of the pose [m^2, m rad, rad^2]."""
        return np.array(self.estimate.pose_covariance).reshape(3, 3)

    @property
    def twist_covariance(self):
        """Return the covariance (3, 3) of the twist [m^2/s^2, m rad/s^2, rad^2/s^2]."""
        return np.array(self.estimate.twist_covariance).reshape(3, 3)

    @property
    def slipping(self):
        """Return which modules (n,) the last step left out as wrong: slip, or a jump."""
        return np.array(self._slipping)

    @property
    def gyro_bias(self):
        """Return the estimated constant error of the gyro's rate [rad/s]."""
        return self._bias.bias

    @property
    def yaw_jumps(self):
        """Return how many steps of the yaw were no turns: its sensor was set anew."""
        return self._gyro.jumps

    @property
    def gyro_trusted(self):
        """
        Return whether the yaw and the rate of the gyro are believed, as two bools.

        One that the other and the wheels contradict for a second is not, until they agree.
        """
        return self._gyro.trusted

    @property
    def residual(self):
        """Return the root mean square disagreement of the modules in the last step [m/s]."""
        return self._residual

    def reset(self, pose=(0.0, 0.0, 0.0), covariance=None):
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
        pose = _finite_array(pose, (3,), 'pose')
        if covariance is None:
            covariance = np.zeros((3, 3))
        covariance = _finite_array(covariance, (3, 3), 'covariance')
        self._position, self._yaw = complex(pose[0], pose[1]), float(pose[2])
        self._covariance = PoseCovariance(covariance, self._bias.variance)

    def reprime(self):
        """
        Forget the last sample: the next one starts anew, whatever its stamp and readings.

        For a gap, a clock that jumped, a restarted driver. The pose is kept, and its
        covariance grows by what the base may have moved until the next sample.
        """
        self._primed = False

    def update(self, stamp, distances, angles, yaw=None, yaw_rate=None, velocities=None,
               rate_integral=None):
        """
        Take in one sample of the encoders and the gyro.

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
            or impossible, the twist is the mean of the step.
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
        modules = _read_modules(distances, angles, self._count)
        if velocities is not None:
            velocities = as_floats(velocities, self._count, 'velocities')
        if not abs(stamp) <= LARGEST or (
                self._primed and stamp < self._stamp + SHORTEST):
            return False
        before, self._modules = self._modules, modules
        dt = self._advance(stamp)
        gyro_turn = self._gyro.turn(dt, yaw, yaw_rate, rate_integral)
        step = None
        if self._primed:
            gyro_turn, step = self._solve_checked(dt, before, gyro_turn)
        self._primed = True
        if step is None:
            self._step_before = None
            self._covariance.grow(*self._unseen_motion(dt))
            return False
        by_gyro = gyro_turn is not None
        variance = self._velocity_variance(dt, step, by_gyro)
        self._integrate(dt, step, by_gyro, variance)
        self._measure_twist(dt, step, by_gyro, variance, velocities)
        self._correct_bias(dt, step, gyro_turn, variance)
        return True

    def _advance(self, stamp):
        """Keep the stamp and return the time since the last one [s]."""
        last, self._stamp = self._stamp, stamp
        if last is None:
            return 0.0
        return stamp - last if stamp > last else UNSEEN_TIME

    def _solve_checked(self, dt, before, gyro_turn):
        """Return the turn by the gyro, unless the wheels refute it, and the Step with it."""
        history = self._step_before
        step = self._solve(dt, before, gyro_turn)
        if gyro_turn is None and step is None:
            return None, None
        wheel_turn = math.nan if step is None else _agreed_turn(dt, step)
        checked = self._gyro.checked(dt, wheel_turn)
        if checked != gyro_turn:
            self._step_before = history
            step = self._solve(dt, before, checked)
        return checked, step

    def _solve(self, dt, before, gyro_turn):
        """Return the Step since the modules were as `before`, None if they cannot tell."""
        noise = self.noise
        fastest = min(noise.max_module_speed, LARGEST_SPEED) * (dt + STAMP_JITTER)
        (distances, angles), (last_distances, last_angles) = self._modules, before
        rolled = [now - last for now, last in zip(distances, last_distances)]
        steered = [math.remainder(now - last, TURN) for now, last in zip(angles, last_angles)]
        used = tuple(module for module, way in enumerate(rolled) if abs(way) <= fastest)
        turn = None if gyro_turn is None else gyro_turn - self._bias.bias * dt
        bend = bend_after(*self._step_before, dt) if self._step_before else STRAIGHT
        step = solve_step(
            self._layout, Readings(used, rolled, last_angles, steered, turn, bend),
            math.hypot(noise.slip_speed * dt, noise.distance_resolution), noise.slip_ratio)
        self._slipping = [abs(way) > fastest for way in rolled]
        if step is None or abs(step.turn) > MAX_YAW_RATE * (dt + STAMP_JITTER):
            return None
        if step.slipping is not None:
            self._slipping[step.slipping] = True
        self._step_before = dt, rolled, steered, step.turn, step.used
        return step

    def _unseen_motion(self, dt):
        """Return how far [m] and by how much [rad] the base may have moved in `dt`."""
        vx, vy, omega = self._twist
        return (UNSEEN_SPEED + math.hypot(vx, vy)) * dt, (UNSEEN_YAW_RATE + abs(omega)) * dt

    def _velocity_variance(self, dt, step, by_gyro):
        """
        Return the variance of one module's velocity, in x and in y [m^2/s^2].

        What the noise model says, inflated while the modules disagree by more than that.
        """
        noise, size = self.noise, len(step.errors)
        relative = 0.5 * (noise.distance_noise ** 2 + noise.steering_noise ** 2)
        expected = relative * (step.length / dt) ** 2
        self._residual = step.spread / dt
        # Each fitted number takes one of the 2 k degrees of freedom of k modules.
        freedom = 2 * size - (2 if by_gyro else 3)
        if freedom > 0:
            errors = [error / (direction * dt)
                      for error, direction in zip(step.errors, step.directions)]
            self._disagreement.update(dt, step.used, errors, freedom * expected)
        return expected * self._disagreement.inflation

    def _integrate(self, dt, step, by_gyro, variance):
        """Add the step to the pose and its noise to the covariance."""
        noise, group = self.noise, step.group
        halfway = cmath.exp(1j * (self._yaw + 0.5 * step.turn))
        displacement = halfway * step.displacement
        # The random walk of an error that lasts for the correlation time, in one step [m^2].
        walk = 2.0 * noise.correlation_time * dt * variance
        turn_variance = noise.gyro_noise ** 2 * dt if by_gyro else walk / group.inertia
        self._covariance.propagate(
            displacement, 1j * (0.5 * displacement - halfway * group.centroid),
            walk / group.size, turn_variance, dt if by_gyro else 0.0)
        self._position += displacement
        self._yaw += step.turn

    def _measure_twist(self, dt, step, by_gyro, variance, velocities):
        """Take the twist from the rim speeds, or from the step, and its covariance."""
        group = step.group
        fastest = min(self.noise.max_module_speed, LARGEST_SPEED)
        omega = step.turn / dt
        velocity = step.displacement / (dt * _chord_per_arc(step.turn))
        if velocities is not None and all(
                abs(velocities[module]) <= fastest for module in step.used):
            angles = self._modules[1]
            rims = [cmath.rect(velocities[module], angles[module]) for module in step.used]
            if not by_gyro:
                omega = group.rate(rims)
            velocity = sum(rims) / group.size - 1j * omega * group.centroid
        if (abs(omega) > MAX_YAW_RATE
                or not abs(velocity + 1j * omega * group.centroid) <= fastest):
            return  # an instant too short to tell: the last twist stands
        self._twist = velocity.real, velocity.imag, omega
        # A difference of two roundings, each uniform over the resolution.
        variance += (self.noise.distance_resolution / dt) ** 2 / 6.0
        rate_variance = (self.noise.gyro_noise ** 2 / dt + self._bias.variance if by_gyro
                         else variance / group.inertia)
        self._twist_variances = variance / group.size, rate_variance, -1j * group.centroid

    def _correct_bias(self, dt, step, gyro_turn, variance):
        """Let the bias filter see the gyro's rate against rest, or against the wheels."""
        noise, group = self.noise, step.group
        at_rest = self._rest.update(dt, *self._modules)
        if gyro_turn is None or not self._estimate_bias:
            return
        self._bias.predict(dt)
        rate_variance = noise.gyro_noise ** 2 / dt
        rate_error = gyro_turn / dt
        if not at_rest:
            limit = CONSISTENT_SPEED + CONSISTENT_RATIO * step.length / dt
            if not group.inertia or self._residual > limit:
                return
            rate_error -= step.wheel_turn / dt
            # Ten times the variance of one sample at 50 Hz: what lasts weighs more.
            lasting = 2.0 * noise.correlation_time / dt
            rate_variance += lasting * (variance + noise.slip_speed ** 2) / group.inertia
        gain = self._bias.correct(rate_error, rate_variance)
        self._covariance.correct_bias(gain, self._bias.variance)


def _agreed_turn(dt, step):
    """Return the turn by the wheels [rad], NaN where they do not agree on one among themselves."""
    off = 2.0 * (math.sin(0.5 * step.wheel_turn) - math.sin(0.5 * step.turn))
    # What the votes differ by because the gyro turned otherwise is not the wheels' own.
    own = step.spread ** 2 - off * off * step.group.inertia / step.group.size
    limit = CONSISTENT_SPEED * dt + CONSISTENT_RATIO * step.length
    return step.wheel_turn if own <= limit * limit else math.nan


def _chord_per_arc(turn):
    """Return how much shorter a chord is, not below 2 / pi: past that a step tells little."""
    return max(scalar_sinc(0.5 * turn), 2.0 / math.pi)


def _read_modules(distances, angles, count):
    """Return distances and angles as lists (n,), NaN where a module has not both."""
    distances = as_floats(distances, count, 'distances')
    angles = as_floats(angles, count, 'angles')
    for module in range(count):
        if not (abs(distances[module]) <= LARGEST and abs(angles[module]) <= LARGEST):
            distances[module] = angles[module] = math.nan
    return distances, angles


def _finite_array(values, shape, name):
    """Return a finite float64 copy of `values` of this shape."""
    values = np.array(values, dtype=float)
    if values.shape != shape or not np.isfinite(values).all():
        raise ValueError(f'{name} must be finite and of shape {shape}, got {values.tolist()}')
    return values
