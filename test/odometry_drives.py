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

"""Drives with one constant twist, and an odometry to replay them through."""

from benchmarks import drives
import numpy as np

from swerve_kinematics.core.geometry.se2 import se2_compose, se2_exp
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
KIN = SwerveKinematics(CORNERS)
TWIST = np.array([1.2, -0.4, 0.8])
PERIOD = 0.02
# Modules far from base_link may move faster than any real one does.
ANY_SPEED = OdometryNoise(max_module_speed=np.inf)


def constant_drive(kin, twist, steps=50, period=PERIOD, start=(0.0, 0.0, 0.0)):
    """Return the Drive of a base that moves with one twist from `start`."""
    t = period * np.arange(steps + 1)
    states = kin.inverse(twist)
    truth = se2_compose(start, se2_exp(np.multiply.outer(t, twist)))
    return drives.Drive(kin.module_positions, t, np.multiply.outer(t, states.speed),
                        np.tile(states.angle, (steps + 1, 1)), 0.3 + truth[:, 2],
                        np.full(steps + 1, twist[2]), truth)


def after_rest(drive, steps):
    """Return the drive with so many steps of rest before it."""
    series = [np.concatenate((np.repeat(values[:1], steps, axis=0), values))
              for values in drive[2:]]
    stamps = (drive.stamp[1] - drive.stamp[0]) * np.arange(steps + len(drive.stamp))
    return drives.Drive(drive.modules, stamps, *series)


def odometry(kin=KIN, **settings_):
    """Return an odometry that trusts its gyro, which most of these drives have without bias."""
    return SwerveOdometry(kin, **{'estimate_gyro_bias': False, **settings_})


def nees_along(odo, drive, yaw=True, skipped=0):
    """Return the normalised estimation errors squared every 100 samples, after some `skipped`."""
    nees = []
    for k, stamp in enumerate(drive.stamp):
        odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k] if yaw else None)
        if k % 100 == 99 and k > skipped:
            error = odo.pose - drive.truth[k]
            nees.append(error @ np.linalg.solve(odo.pose_covariance, error))
    return nees


def feed(odo, drive, **gyro):
    """Run a drive and return the last pose."""
    return drives.replay(odo, drive, **gyro)[-1]
