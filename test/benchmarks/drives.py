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

"""Drives to judge odometry by: recorded logs, motions without slip, and sensor faults."""

from typing import NamedTuple

import numpy as np

ROLLING_RADIUS = 0.049876
ENCODER_STEP = 2.0 * np.pi / 4096.0


class Drive(NamedTuple):
    """
    What the sensors said in a drive, and where the base was.

    Attributes
    ----------
    modules : ndarray (n, 2)
        Module positions from base_link [m].
    stamp : ndarray (t,)
        [s].
    distance, angle : ndarray (t, n)
        Cumulative rim distance [m] and steering angle [rad].
    yaw, yaw_rate : ndarray (t,)
        Of the gyro [rad], [rad/s].
    truth : ndarray (t, 3)
        Pose `[x, y, yaw]` [m, m, rad].

    """

    modules: np.ndarray
    stamp: np.ndarray
    distance: np.ndarray
    angle: np.ndarray
    yaw: np.ndarray
    yaw_rate: np.ndarray
    truth: np.ndarray

    def at(self, samples):
        """Return the drive with only these samples, by index or mask."""
        return Drive(self.modules, *(series[samples] for series in self[1:]))


def from_rest(fine):
    """Return the drive, begun at rest and at its pace after a second."""
    time = fine.stamp
    told = np.where(time < 1.0, 0.5 * time ** 2, time - 0.5)
    yaw, distance, angle, truth = (
        np.column_stack([np.interp(told, time, column) for column in columns.T])
        for columns in (fine.yaw[:, np.newaxis], fine.distance, fine.angle, fine.truth))
    return fine._replace(yaw=yaw[:, 0], distance=distance, angle=angle, truth=truth)


def load(path):
    """Return the Drive in a log file (.npz with the arrays of a simulated or real base)."""
    with np.load(path) as log:
        return Drive(log['modules_xy'], log['t'], log['wheel_pos'] * ROLLING_RADIUS,
                     log['steer'].astype(float), log['gyro_yaw'].astype(float),
                     log['gyro_rate'].astype(float),
                     np.column_stack((log['gt_xy'], log['gt_yaw'])).astype(float))


def slower(drive, rate):
    """
    Return the drive with about `rate` samples a second.

    The nearest sample to each period, with its own stamp: nothing is interpolated, as on a
    robot that reports less often.
    """
    wanted = np.arange(drive.stamp[0], drive.stamp[-1], 1.0 / rate)
    after = np.searchsorted(drive.stamp, wanted - 1e-9)
    before = np.maximum(after - 1, 0)
    nearer = wanted - drive.stamp[before] < drive.stamp[after] - wanted - 1e-9
    return drive.at(np.unique(np.where(nearer, before, after)))


def faulty(drive, rng, bias=np.radians(0.5), dropped=0.1):
    """
    Return the drive as cheap sensors tell it.

    12-bit encoders (on the wheel and the steering axis, rounded down), a gyro with a bias
    [rad/s] and white noise of 0.2 deg/s per 5 ms, and a fraction of the samples missing.
    """
    dt = np.diff(drive.stamp, prepend=2.0 * drive.stamp[0] - drive.stamp[1])
    noise = np.radians(0.2) * np.sqrt(0.005 * dt) * rng.standard_normal(len(dt))
    step = ENCODER_STEP * ROLLING_RADIUS
    kept = rng.random(len(dt)) >= dropped
    kept[0] = True
    return drive._replace(
        distance=np.floor(drive.distance / step) * step,
        angle=np.floor(drive.angle / ENCODER_STEP) * ENCODER_STEP,
        yaw=drive.yaw + bias * (drive.stamp - drive.stamp[0]) + np.cumsum(noise),
        yaw_rate=drive.yaw_rate + bias + noise / dt).at(kept)


class Pace(NamedTuple):
    """How fast a smooth motion is: the most of its speed [m/s] and of two rates [rad/s]."""

    speed: float
    course_rate: float
    yaw_rate: float


GENTLE = Pace(2.5, 1.5, 3.0)
FAST = Pace(4.0, 2.2, 4.5)


def smooth_motion(modules, rate, seed=0, duration=40.0, finest=4000, pace=GENTLE):
    """
    Return a drive without slip or noise: 90 m in 40 s at the gentle pace.

    The twist is a sum of sines in closed form. Poses, distances and angles are integrated
    at the `finest` rate [Hz] by Simpson's rule, and sampled at `rate` [Hz].
    """
    steps = int(round(finest / rate))
    half_steps = 2 * steps * int(round(duration * rate))
    t = np.linspace(0.0, duration, half_steps + 1)
    rng = np.random.default_rng(seed)
    speed = pace.speed * (0.9 + 0.1 * np.sin(rng.uniform(0.3, 0.6) * t + rng.uniform(0.0, 6.0)))
    course, course_rate = _swing(rng, t, pace.course_rate, (0.4, 0.9))
    heading, omega = _swing(rng, t, pace.yaw_rate, (0.9, 1.3))
    velocity = speed * np.exp(1j * course)
    arms = modules[:, 0] + 1j * modules[:, 1]
    module_velocity = velocity[:, np.newaxis] + 1j * omega[:, np.newaxis] * arms
    position = _integral(velocity * np.exp(1j * heading), t)
    pick = slice(None, None, steps)
    heading = heading[::2][pick]
    return Drive(modules, t[::2][pick], _integral(np.abs(module_velocity), t)[pick],
                 np.unwrap(np.angle(module_velocity), axis=0)[::2][pick], heading,
                 omega[::2][pick],
                 np.column_stack((position.real[pick], position.imag[pick], heading)))


def _swing(rng, t, peak, frequencies):
    """Return an angle (t,) and its rate, a sine of this peak rate and a random frequency."""
    frequency, phase = rng.uniform(*frequencies), rng.uniform(0.0, 2.0 * np.pi)
    angle = -peak / frequency * (np.cos(frequency * t + phase) - np.cos(phase))
    return angle, peak * np.sin(frequency * t + phase)


def _integral(values, t):
    """Return the integral of samples (2 k + 1, ...) at every second one, by Simpson's rule."""
    step = (t[2] - t[0]) / 6.0
    parts = step * (values[:-2:2] + 4.0 * values[1:-1:2] + values[2::2])
    return np.concatenate((np.zeros_like(values[:1]), np.cumsum(parts, axis=0)))


def replay(odometry, drive, yaw=True, yaw_rate=False):
    """Return the poses (t, 3) that `odometry` tells in a drive, with these parts of the gyro."""
    poses = np.empty_like(drive.truth)
    for k, stamp in enumerate(drive.stamp):
        odometry.update(stamp, drive.distance[k], drive.angle[k],
                        drive.yaw[k] if yaw else None, drive.yaw_rate[k] if yaw_rate else None)
        poses[k] = odometry.pose
    return poses


def end_angle_poses(drive):
    """
    Return the poses (t, 3) by the common method, for comparison.

    Distance deltas at the angles of the end of the step, least squares, the gyro's yaw for
    the heading, one SE(2) exponential a step (WPILib's SwerveDriveOdometry).
    """
    arms = drive.modules[:, 0] + 1j * drive.modules[:, 1]
    centroid = arms.mean()
    levers = np.conj(1j * (arms - centroid)) / np.sum(np.abs(arms - centroid) ** 2)
    moved = np.diff(drive.distance, axis=0) * np.exp(1j * drive.angle[1:])
    delta = moved.mean(axis=1) - 1j * centroid * (moved @ levers).real
    turn = np.diff(drive.yaw)
    yaw = drive.yaw - drive.yaw[0] + drive.truth[0, 2]
    delta = delta * np.sinc(turn / (2.0 * np.pi)) * np.exp(1j * (yaw[:-1] + 0.5 * turn))
    start = complex(*drive.truth[0, :2])
    position = np.concatenate(([start], start + np.cumsum(delta)))
    return np.column_stack((position.real, position.imag, yaw))


def position_error(poses, drive):
    """Return the absolute trajectory error [m], root mean square, no alignment."""
    return np.sqrt(np.mean(np.sum((poses - drive.truth)[:, :2] ** 2, axis=1)))
