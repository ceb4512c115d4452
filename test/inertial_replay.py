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

"""A drive without slip and what an accelerometer shows in it, to replay through odometry."""

from benchmarks import drives
import numpy as np

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.chord import Step
from swerve_kinematics.core.odometry.group import Group
from swerve_kinematics.core.odometry.odometry import SwerveOdometry

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
PLACE = (0.12, -0.07)
RATE, FINE = 50, 500
# Of four modules that agree.
ALIKE = Step(Group((0, 1, 2, 3), [complex(*corner) for corner in CORNERS]), [0j] * 4, 0.0, 0.0,
             True)
FINE_DRIVE = drives.smooth_motion(CORNERS, FINE, duration=16.0, finest=2000)
DRIVE = FINE_DRIVE.at(slice(None, None, FINE // RATE))


def forces_of(fine, every, place=PLACE):
    """Return the mean specific force (t, 2) [m/s^2] at a place in each step of `every` samples."""
    turned = np.exp(1j * fine.truth[:, 2])
    path = fine.truth[:, 0] + 1j * fine.truth[:, 1] + turned * complex(*place)
    dt = fine.stamp[1]
    force = np.gradient(np.gradient(path, dt), dt) / turned
    means = 0.5 * (force[1:] + force[:-1]).reshape(-1, every).mean(axis=1)
    means = np.concatenate(([0j], means))
    return np.column_stack((means.real, means.imag))


FORCES = forces_of(FINE_DRIVE, FINE // RATE)


def replay(drive=DRIVE, forces=FORCES, rates=None, integral=None, **settings_):
    """Return the odometry after a drive, its poses (t, 3) and how long it had coasted (t,)."""
    odo = SwerveOdometry(SwerveKinematics(CORNERS), drive.truth[0], imu_position=PLACE,
                         **{'estimate_gyro_bias': False, **settings_})
    poses, coasted = [], []
    for k, stamp in enumerate(drive.stamp):
        odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k], drive.yaw_rate[k],
                   specific_force=None if forces is None else forces[k],
                   tilt_rates=None if rates is None else rates[k],
                   rate_integral=None if integral is None else integral[k])
        poses.append(odo.estimate.pose)
        coasted.append(odo.coasting)
    return odo, np.array(poses), np.array(coasted)


def spinning(drive, start, end, factor):
    """Return the drive whose wheels all turn by this factor faster from `start` to `end` [s]."""
    rolled = np.diff(drive.distance, axis=0, prepend=0.0)
    rolled[(drive.stamp > start) & (drive.stamp <= end)] *= factor
    return drive._replace(distance=np.cumsum(rolled, axis=0))


def error_of(poses, drive=DRIVE):
    """Return the largest error of the position [m]."""
    return np.hypot(*(poses - drive.truth)[:, :2].T).max()


def worst_step(poses):
    """Return the longest way of one step [m]."""
    return np.hypot(*np.diff(poses[:, :2], axis=0).T).max()
