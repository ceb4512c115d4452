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

"""
The accuracy of the odometry on recorded drives and on motions without slip.

The bounds leave room above what was measured; they guard what the method reaches, not its
last digit. `make accuracy` prints the numbers.
"""

from pathlib import Path

from benchmarks import drives, inertial_drives
import numpy as np
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry

DATA = Path(__file__).parents[3] / 'test' / 'data'
LOGS = {path.stem: drives.load(path) for path in sorted(DATA.glob('*.npz'))}
CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
GYROS = [{}, {'yaw': False, 'yaw_rate': True}, {'yaw_rate': True}]


def odometry_of(drive, **settings):
    """Return an odometry at the start of a drive."""
    return SwerveOdometry(SwerveKinematics(drive.modules), drive.truth[0], **settings)


def error_of(drive, gyro, **settings):
    """Return the absolute trajectory error [m] of our odometry."""
    return drives.position_error(drives.replay(odometry_of(drive, **settings), drive, **gyro),
                                 drive)


def ratio_of(drive, gyro):
    """Return our error by that of the end-angle method."""
    return error_of(drive, gyro) / drives.position_error(drives.end_angle_poses(drive), drive)


@pytest.mark.parametrize('gyro', GYROS)
@pytest.mark.parametrize('name', ['strafe__clean', 'straight__clean'])
def test_gentle_drives_are_good_to_a_millimetre(name, gyro):
    assert error_of(LOGS[name], gyro) < 1e-3
    assert error_of(drives.slower(LOGS[name], 20), gyro) < 1e-3


@pytest.mark.parametrize('gyro', GYROS)
def test_dragging_wheel_does_not_count(gyro):
    drive = LOGS['figure8__drag']
    assert ratio_of(drive, gyro) < 0.1
    assert ratio_of(drives.slower(drive, 20), gyro) < 0.1


@pytest.mark.parametrize('gyro', GYROS)
def test_slipping_wheel_does_little_harm(gyro):
    assert ratio_of(LOGS['square_turn__slip'], gyro) < 0.9


@pytest.mark.parametrize('gyro', GYROS)
@pytest.mark.parametrize('name', sorted(LOGS))
def test_faulty_sensors_do_little_harm(name, gyro):
    faulty = drives.faulty(LOGS[name], np.random.default_rng(2))
    assert ratio_of(faulty, gyro) < 0.15


def test_wheels_alone_beat_the_reference_with_a_drifting_gyro():
    faulty = drives.faulty(LOGS['square_turn__slip'], np.random.default_rng(2))
    assert ratio_of(faulty, {'yaw': False}) < 0.5


def test_dragging_wheel_is_reported():
    drive = LOGS['figure8__drag']
    odometry, slips = odometry_of(drive), np.zeros(4)
    for k, stamp in enumerate(drive.stamp):
        odometry.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k])
        slips += odometry.slipping
    dragging = slips.argmax()
    assert slips[dragging] > 0.2 * len(drive.stamp)
    assert slips.sum() - slips[dragging] < 0.01 * len(drive.stamp)


@pytest.mark.parametrize('rate, ideal, with_bias, wheels', [
    (200, 0.016e-3, 1.5e-3, 0.6e-3), (50, 0.06e-3, 1.2e-3, 1e-3), (20, 0.3e-3, 6.6e-3, 6.3e-3)])
@pytest.mark.parametrize('pace', [drives.GENTLE, drives.FAST])
def test_motion_without_slip(pace, rate, ideal, with_bias, wheels):
    drive = drives.smooth_motion(CORNERS, rate, pace=pace)
    assert error_of(drive, {}, estimate_gyro_bias=False) < ideal
    assert error_of(drive, {}) < with_bias
    assert error_of(drive, {'yaw': False}) < wheels


SENSORS = {name: inertial_drives.faulty(inertial_drives.load(DATA / 'imu' / f'{name}.npz'),
                                        np.random.default_rng(1))
           for name in sorted(path.stem for path in (DATA / 'imu').glob('*.npz'))}


@pytest.mark.parametrize('name', sorted(SENSORS))
def test_accelerometer_on_floors_where_wheels_slip(name):
    log = SENSORS[name]
    poses, nees_without = inertial_drives.replay(log, imu=False)
    without = drives.position_error(poses, log.drive)
    poses, nees = inertial_drives.replay(log)
    error = drives.position_error(poses, log.drive)
    assert error < (0.04 if inertial_drives.slips(name) else 0.1)
    assert error < 1.15 * without + 0.01
    if inertial_drives.slips(name):
        assert error < 0.1 * without
    # One log has one history of slip, whose error may by chance be small; see the next test.
    assert np.median(nees) < 6.0
    assert np.median(nees_without) < 4.0 and np.mean(nees_without) < 6.0


@pytest.mark.parametrize('imu', [True, False])
def test_the_covariance_tells_the_truth_where_wheels_slip(imu):
    rng, nees = np.random.default_rng(2), []
    for name in SENSORS:
        if inertial_drives.slips(name):
            ideal = inertial_drives.load(DATA / 'imu' / f'{name}.npz')
            for _ in range(4):
                nees.append(inertial_drives.replay(inertial_drives.faulty(ideal, rng), imu)[1])
    assert 0.2 < np.median(np.concatenate(nees)) < 4.0
    assert 0.5 < np.mean(np.concatenate(nees)) < 6.0


@pytest.mark.parametrize('yaw', [True, False])
def test_the_covariance_tells_the_truth_where_a_wheel_slips_or_none(yaw):
    nees = []
    for drive in LOGS.values():
        for seed in range(4):
            faulty = drives.faulty(drive, np.random.default_rng(seed))
            none = np.zeros((len(faulty.stamp), 2))
            log = inertial_drives.InertialDrive(faulty, none, none, np.zeros(2))
            nees.append(inertial_drives.replay(log, imu=False, yaw=yaw)[1])
    assert 0.3 < np.mean(np.concatenate(nees)) < 6.0


@pytest.mark.parametrize('yaw, imu', [(True, True), (True, False), (False, False)])
def test_the_covariance_of_the_twist_tells_the_truth(yaw, imu):
    nees = {True: [], False: []}
    for name, log in SENSORS.items():
        drive, velocity = log.drive, inertial_drives.true_velocity(log.drive)
        odo = odometry_of(drive, imu_position=log.place)
        for k, stamp in enumerate(drive.stamp):
            odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k] if yaw else None,
                       specific_force=log.force[k] if imu else None,
                       tilt_rates=log.rates[k] if imu else None)
            if k % 5 == 4 and abs(velocity[k]) > 0.05:
                off = complex(*odo.twist[:2]) - velocity[k]
                nees[inertial_drives.slips(name)].append(
                    abs(off) ** 2 / odo.twist_covariance[0, 0])
    assert 0.7 < np.mean(nees[False]) < 4.0
    # Without a gyro nothing tells of the worst pushes, so one bound is for half of the time.
    assert np.median(nees[True]) < 1.0
    assert not yaw or 0.3 < np.mean(nees[True]) < 8.0


@pytest.mark.parametrize('name', ['B2_mu05', 'L3_mu06', 'P1_push400'])
def test_a_bad_accelerometer_is_better_than_none(name):
    ideal = inertial_drives.load(DATA / 'imu' / f'{name}.npz')
    log = inertial_drives.faulty(ideal, np.random.default_rng(1), worse=4.0)
    without = drives.position_error(inertial_drives.replay(log, imu=False)[0], log.drive)
    poses, _ = inertial_drives.replay(log)
    assert drives.position_error(poses, log.drive) < 0.5 * without


def test_end_angle_method_is_the_common_one():
    # One step by hand: a quarter turn on the spot of base_link, and forward at the new angle.
    drive = drives.Drive(CORNERS, np.arange(2.0), np.array([[0.0] * 4, [1.0] * 4]),
                         np.array([[0.5] * 4, [0.0] * 4]), np.array([0.0, np.pi / 2]),
                         np.zeros(2), np.zeros((2, 3)))
    np.testing.assert_allclose(drives.end_angle_poses(drive)[1],
                               (2.0 / np.pi, 2.0 / np.pi, np.pi / 2))
