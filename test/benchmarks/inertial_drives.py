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

"""Recorded drives with an accelerometer, on floors where wheels slip, and its faults."""

from typing import NamedTuple

from benchmarks import drives
import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry

# Locked braking, launches, patches of low friction, pushes, and slip on slopes, bumps and soft
# springs: the first letters of the names of the logs in which wheels slip on purpose.
SLIP = ('B', 'L', 'M', 'P', 'PR', 'SX', 'UX', 'VX', 'X')


class InertialDrive(NamedTuple):
    """
    A drive, and what an IMU said in it.

    Attributes
    ----------
    drive : Drive
        All the rest.
    force, rates : ndarray (t, 2)
        Specific force along x and y [m/s^2] and rates about them [rad/s]: means of each step.
    place : ndarray (2,)
        Where the IMU sits, as the odometry is told [m].

    """

    drive: drives.Drive
    force: NDArray[np.float64]
    rates: NDArray[np.float64]
    place: NDArray[np.float64]


def slips(name: str) -> bool:
    """Tell by a log's name whether wheels slip in it on purpose."""
    return name.split('_')[0].rstrip('0123456789') in SLIP


def load(path) -> InertialDrive:
    """Return the drive in a log file (.npz), all of its sensors ideal."""
    with np.load(path) as log:
        truth = np.column_stack((log['gt_xy'], log['gt_yaw'])).astype(float)
        yaw = log['gyro_yaw'].astype(float)
        rate = log['imu_gyro'][:, 2].astype(float)
        drive = drives.Drive(log['modules_xy'], log['t'].astype(float),
                             log['wheel_pos'].astype(float) * float(log['radius']),
                             log['steer'].astype(float), yaw, rate, truth)
        return InertialDrive(drive, log['imu_acc'][:, :2].astype(float),
                             log['imu_gyro'][:, :2].astype(float), log['imu_xyz'][:2])


def faulty(log: InertialDrive, rng: np.random.Generator, worse: float = 1.0) -> InertialDrive:
    """
    Return the drive as ordinary sensors tell it.

    12-bit encoders and a gyro with a bias of 0.5 deg/s; an accelerometer with an offset of
    0.05 to 0.2 m/s^2, noise of 0.01 to 0.05 m/s^2 per 5 ms, mounted askew by 1 degree and 1 cm
    off. The IMU's faults are `worse` times as bad.
    """
    drive = drives.faulty(log.drive, rng, dropped=0.0, bias=np.radians(0.5) * worse)
    roll, pitch, yaw = worse * np.radians(1.0) * _direction(rng, 3)
    gravity = 9.81 * np.array((pitch, -roll))
    turned = log.force @ np.array(((1.0, yaw), (-yaw, 1.0)))
    offset = worse * rng.uniform(0.05, 0.2) * _direction(rng, 2)
    noise = worse * rng.uniform(0.01, 0.05) / 2.0 * rng.standard_normal(log.force.shape)
    rate_offset = worse * np.radians(0.3) * rng.standard_normal(2)
    rate_noise = worse * np.radians(0.1) * rng.standard_normal(log.rates.shape)
    leaking = log.drive.yaw_rate[:, np.newaxis] * np.array((-pitch, roll))
    return InertialDrive(drive, turned + gravity + offset + noise,
                         log.rates + leaking + rate_offset + rate_noise,
                         log.place + worse * 0.01 * _direction(rng, 2))


def true_velocity(drive: drives.Drive) -> NDArray[np.complex128]:
    """Return how fast base_link moved (t,), as x + iy in base axes [m/s]."""
    x, y, yaw = drive.truth.T
    return np.gradient(x + 1j * y, drive.stamp) * np.exp(-1j * yaw)


def _direction(rng: np.random.Generator, size: int) -> NDArray[np.float64]:
    """Return a random unit vector."""
    vector = rng.standard_normal(size)
    return vector / np.linalg.norm(vector)


def replay(log: InertialDrive, imu: bool = True, yaw: bool = True,
           skip: int = 50) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return the poses (t, 3) of the odometry, and the NEES of every tenth after `skip` samples.

    The normalised estimation error squared of the pose: 3 in the mean where its covariance
    tells the truth.
    """
    drive = log.drive
    odometry = SwerveOdometry(SwerveKinematics(drive.modules), drive.truth[0],
                              imu_position=log.place)
    poses, nees = np.empty_like(drive.truth), []
    for k, stamp in enumerate(drive.stamp):
        inertial = {'specific_force': log.force[k], 'tilt_rates': log.rates[k]} if imu else {}
        odometry.update(stamp, drive.distance[k], drive.angle[k],
                        drive.yaw[k] if yaw else None, **inertial)
        poses[k] = odometry.estimate.pose
        if k >= skip and k % 10 == 0:
            error = poses[k] - drive.truth[k]
            nees.append(error @ np.linalg.solve(odometry.pose_covariance, error))
    return poses, np.array(nees)
