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

"""How far a gyro led the heading astray is taken back when it is refuted."""

from inertial_replay import CORNERS, DRIVE, replay
import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics, SwerveOdometry
from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.odometry.catch_up import FASTEST_TURN

PERIOD = DRIVE.stamp[1] - DRIVE.stamp[0]
RADII, TANGENTS = np.hypot(*CORNERS.T), np.arctan2(CORNERS[:, 0], -CORNERS[:, 1])
UNKNOWN = np.full_like(DRIVE.yaw, np.nan)


def frozen(values, at=300):
    """Return a series that keeps the value it has after so many samples."""
    return np.concatenate((values[:at], np.full(len(values) - at, values[at])))


GYROS = {
    'reversed': (-DRIVE.yaw, -DRIVE.yaw_rate),
    'reversed, only its yaw': (-DRIVE.yaw, UNKNOWN),
    'reversed, only its rate': (UNKNOWN, -DRIVE.yaw_rate),
    'in degrees': (UNKNOWN, np.degrees(DRIVE.yaw_rate)),
    'frozen': (frozen(DRIVE.yaw), frozen(DRIVE.yaw_rate)),
}


@pytest.mark.parametrize('kind', GYROS)
@pytest.mark.parametrize('estimates_bias', [False, True])
def test_a_gyro_that_is_refuted_leaves_no_error_of_the_heading(kind, estimates_bias):
    yaw, rate = GYROS[kind]
    odo, poses, _ = replay(DRIVE._replace(yaw=yaw, yaw_rate=rate), None,
                           estimate_gyro_bias=estimates_bias)
    assert not all(odo.gyro_trusted)
    errors = wrap_angle(poses[:, 2] - DRIVE.truth[:, 2])
    assert np.abs(errors).max() > 0.5
    assert np.abs(errors[-50:]).max() < 0.05


class Base:
    """A base that turns on the spot, and an odometry that hears of its yaw."""

    def __init__(self):
        self.odometry = SwerveOdometry(SwerveKinematics(CORNERS), estimate_gyro_bias=False)
        self._stamp = self._wheels = self._yaw = 0.0
        self._rng = np.random.default_rng(0)

    def run(self, duration, wheels, gyro, noise=1e-4):
        """Go on for a time [s] while wheels and gyro tell these rates [rad/s]."""
        for _ in range(round(duration / PERIOD)):
            self._stamp += PERIOD
            self._wheels += wheels * PERIOD
            self._yaw += gyro * PERIOD
            told = self._yaw + noise * self._rng.standard_normal()
            self.odometry.update(self._stamp, RADII * self._wheels, TANGENTS, told)
        return self.odometry.yaw


def test_the_heading_never_jumps():
    base = Base()
    told = np.array([base.run(PERIOD, 1.0, -1.0) for _ in range(300)])
    assert told[-1] == pytest.approx(5.98, abs=0.01)
    assert np.abs(np.diff(told)).max() <= 1.01 * (1.0 + FASTEST_TURN) * PERIOD


def test_wheels_are_not_believed_about_the_time_when_they_did_not_contradict_the_gyro():
    base = Base()
    base.run(1.0, 1.0, 1.0)
    base.run(30.0, 0.05, 0.0)
    assert base.run(4.0, 1.0, 0.0, noise=0.0) == pytest.approx(5.0, abs=0.1)
    assert base.odometry.gyro_trusted == (False, True)


def test_a_gyro_in_degrees_is_wrong_about_its_offset_too():
    odo, turned = SwerveOdometry(SwerveKinematics(CORNERS), estimate_gyro_bias=False), 0.0
    rng = np.random.default_rng(0)
    for k in range(500):
        # Half a degree a second, while wheels hardly turn the base: that looks like no slip.
        turn = 0.01 if k < 200 else 0.5
        turned += turn * PERIOD
        rate = np.degrees(turn) + 0.5 + 0.1 * rng.standard_normal()
        odo.update(k * PERIOD, RADII * turned, TANGENTS, None, rate)
    assert odo.gyro_trusted == (True, False)
    assert abs(wrap_angle(odo.yaw - turned)) < 0.1


@pytest.mark.parametrize('turn', [0.0, 0.5])
def test_wheels_that_slipped_are_not_believed_about_that_time_later(turn):
    base = Base()
    base.run(8.0, 1.5, turn)
    expected = 8.0 * turn + 3.0
    assert base.run(6.0, 0.5, 0.0, noise=0.0) == pytest.approx(expected, abs=0.3)
    assert base.odometry.gyro_trusted == (False, True)


def test_a_pose_that_is_set_makes_amends_for_what_came_after_only():
    base = Base()
    base.run(0.6, 1.0, -1.0)
    base.odometry.reset((0.0, 0.0, 2.0))
    assert base.run(4.0, 1.0, -1.0) == pytest.approx(6.0, abs=0.05)
    assert base.odometry.gyro_trusted == (False, True)
