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

"""Tests of whether the covariances of the odometry tell how wrong it is."""

from dataclasses import fields

from benchmarks import drives
import numpy as np
from odometry_drives import (
    after_rest, constant_drive, CORNERS, feed, KIN, nees_along, odometry, TWIST)
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise


def noisy(drive, rng, noise, bias):
    """Return the drive with the noise that `OdometryNoise` describes, and 12-bit encoders."""
    dt = drive.stamp[1] - drive.stamp[0]
    scale = np.sqrt(2.0 * noise.correlation_time / dt)
    moved = np.diff(drive.distance, axis=0, prepend=0.0)
    moved *= 1.0 + scale * noise.distance_noise * rng.standard_normal(moved.shape)
    angle = drive.angle + scale * noise.steering_noise * rng.standard_normal(moved.shape)
    walk = noise.gyro_noise * np.sqrt(dt) * np.cumsum(rng.standard_normal(len(drive.stamp)))
    rounded = np.round(np.cumsum(moved, axis=0) / noise.distance_resolution)
    return drive._replace(
        distance=rounded * noise.distance_resolution,
        angle=np.round(angle / drives.ENCODER_STEP) * drives.ENCODER_STEP,
        yaw=drive.yaw + walk + bias * drive.stamp)


def mean_nees(level, yaw, runs=300, rate=5, bias=None):
    """
    Return the mean normalised estimation error squared of 40 s drives, for the 3 states.

    With `level` times the noise that the odometry expects of the wheels, at `rate` [Hz]. With
    a bias [rad/s] the drives start with 2 s of rest, and the odometry estimates it.
    """
    expected = OdometryNoise()
    true = OdometryNoise(distance_noise=level * expected.distance_noise,
                         steering_noise=level * expected.steering_noise)
    total = 0.0
    for run in range(runs):
        rng = np.random.default_rng(run)
        twist = rng.uniform((-1.5, -1.5, -1.0), (1.5, 1.5, 1.0))
        drive = constant_drive(KIN, twist, 40 * rate, 1.0 / rate)
        if bias is not None:
            drive = after_rest(drive, 2 * rate)
        drive = noisy(drive, rng, true, bias or 0.0)
        odo = SwerveOdometry(KIN, estimate_gyro_bias=bias is not None, noise=expected)
        for k, stamp in enumerate(drive.stamp):
            odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k] if yaw else None)
        error = odo.pose - drive.truth[-1]
        total += error @ np.linalg.solve(odo.pose_covariance, error)
    return total / runs


@pytest.mark.parametrize('yaw', [True, False])
def test_covariance_tells_the_truth(yaw):
    assert 2.5 < mean_nees(1.0, yaw) < 3.5


@pytest.mark.parametrize('yaw', [True, False])
def test_covariance_follows_modules_that_are_worse_than_expected(yaw):
    assert 1.5 < mean_nees(4.0, yaw, runs=60, rate=10) < 6.0


def test_covariance_tells_the_truth_about_a_bias():
    assert 2.0 < mean_nees(1.0, True, runs=60, bias=np.radians(0.5)) < 4.0


@pytest.mark.parametrize('yaw', [True, False])
def test_covariance_tells_the_truth_about_motion_that_changes(yaw):
    # What tyres do under a force is not in the noise: the covariance allows for it all the same.
    nees = []
    for run in range(12):
        rng = np.random.default_rng(run)
        drive = drives.from_rest(drives.smooth_motion(
            CORNERS, 50, seed=run, finest=1000, pace=drives.Pace(1.5, 1.0, 1.5)))
        drive = noisy(drive, rng, OdometryNoise(), 0.0)
        nees += nees_along(odometry(pose=drive.truth[0]), drive, yaw)
    assert 1.2 < np.mean(nees) < 4.5


@pytest.mark.parametrize('gyro', [{'yaw': True}, {'yaw': False}])
def test_covariance_does_not_depend_on_the_rate(gyro):
    covariances = []
    for rate in (10, 200):
        odo = odometry(noise=OdometryNoise(slip_speed=1.0))
        feed(odo, constant_drive(KIN, TWIST, 10 * rate, 1.0 / rate), **gyro)
        covariances.append(odo.pose_covariance)
    np.testing.assert_allclose(covariances[0], covariances[1], rtol=0.03, atol=1e-6)


def test_slip_makes_the_pose_less_sure():
    drive = constant_drive(KIN, TWIST)
    gripping, slipping = odometry(), odometry()
    feed(gripping, drive)
    drive.distance[10:, 3] += np.linspace(0.0, 0.4, 41)
    feed(slipping, drive)
    growth = slipping.pose_covariance - gripping.pose_covariance
    assert (np.linalg.eigvalsh(growth[:2, :2]) > 0.0).all()


@pytest.mark.parametrize('yaw', [True, False])
def test_coarse_encoders_that_are_read_often_are_no_slip(yaw):
    # 600 counts a turn of a 50 mm wheel: at 200 Hz the last bit is a speed of 0.1 m/s.
    noise = OdometryNoise(distance_resolution=0.5e-3)
    drive = drives.from_rest(drives.smooth_motion(
        CORNERS, 200, duration=20.0, finest=1000, pace=drives.Pace(0.2, 0.3, 0.3)))
    drive = noisy(drive, np.random.default_rng(0), noise, 0.0)
    odo = odometry(pose=drive.truth[0], noise=noise)
    drives.replay(odo, drive, yaw=yaw)
    stds = np.sqrt(odo.pose_covariance.diagonal())
    assert stds[0] < 0.03 and stds[2] < np.radians(1.0)


@pytest.mark.parametrize('heard', [1, 3000])
def test_a_bias_of_which_nothing_tells_wanders(heard):
    # For ten minutes: the wheels are not heard, or never agree, as under a base that is pushed.
    odo, noise, time = SwerveOdometry(KIN), OdometryNoise(), 600.0
    for k in range(3000):
        odo.update(0.02 * k, np.zeros(4), np.zeros(4), 0.0)
    known = odo._bias.variance
    odo.reprime(gyro_went_on=True)
    ways = 0.1 * time / heard * np.array([1.0, 0.0, 0.0, 1.0])
    for k in range(1, heard + 1):
        odo.update(60.0 + time / heard * k, k * ways, np.zeros(4), 0.0)
    true = np.sqrt(known * time ** 2 + noise.gyro_bias_drift ** 2 * time ** 3 / 3.0
                   + noise.gyro_variance * time)
    assert 0.99 < np.sqrt(odo.pose_covariance[2, 2]) / true < 1.75
    assert odo._bias.variance == pytest.approx(
        known + noise.gyro_bias_drift ** 2 * time, rel=0.01)


@pytest.mark.parametrize('rest', [0.0, 10.0])
def test_wheels_that_contradict_one_another_after_a_rest_make_the_pose_less_sure(rest):
    # Somebody pushes the base: two of its wheels turn, the other two slide.
    odo, way = odometry(), np.zeros(4)
    for k in range(int((rest + 1.0) * 50)):
        if k >= rest * 50:
            way = way + 0.02 * np.array([0.2, 0.0, 0.0, 0.2])
        odo.update(0.02 * k, way, np.zeros(4), 0.0)
    assert np.sqrt(odo.pose_covariance[0, 0]) > 0.05


@pytest.mark.parametrize('rate', [20, 200])
def test_wheels_that_are_steered_at_rest_shift_the_base_a_little(rate):
    # In rigid-body physics by 0.9 mm and 0.06 degrees for each radian, on average.
    for radians in (0.5, 1.5):
        odo = odometry()
        for k in range(rate + 1):
            odo.update(k / rate, np.zeros(4), np.full(4, radians * min(2.0 * k / rate, 1.0)))
        stds = np.sqrt(odo.pose_covariance.diagonal()) / radians
        assert 0.4e-3 < stds[0] < 0.9e-3 and np.radians(0.04) < stds[2] < np.radians(0.12)


def test_covariance_is_that_of_base_link_wherever_it_is():
    # The same drive seen from a point 2 m beside the wheels: its position is as unsure as a
    # lever of 2 m on the yaw makes it.
    offset = 2.0
    rolling = (1.0, 0.0, 0.0)
    near, far = odometry(), odometry(SwerveKinematics(CORNERS + (0.0, offset)))
    feed(near, constant_drive(KIN, rolling))
    feed(far, constant_drive(SwerveKinematics(CORNERS + (0.0, offset)), rolling))
    lever = np.array([(1.0, 0.0, offset), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
    np.testing.assert_allclose(far.pose_covariance, lever @ near.pose_covariance @ lever.T,
                               atol=1e-11)
    np.testing.assert_allclose(far.twist_covariance, lever @ near.twist_covariance @ lever.T,
                               atol=1e-12)


@pytest.mark.parametrize('yaw', [True, False])
def test_a_noise_that_is_replaced_leaves_alone_what_stays_that_of_the_start(yaw):
    estimates, drive = [], after_rest(constant_drive(KIN, TWIST, 100, 0.02), 20)
    for later in ({}, {'correlation_time': 5.0, 'gyro_bias_std': 1.0, 'gyro_bias_drift': 1.0}):
        odo = SwerveOdometry(KIN)
        odo.noise = OdometryNoise(**later)
        for k, stamp in enumerate(drive.stamp):
            odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k] if yaw else None)
        estimates.append((odo.estimate, odo.gyro_bias))
    assert estimates[0] == estimates[1]


@pytest.mark.parametrize('speed', [0.0, 1.0])
def test_sensors_that_are_said_to_be_perfect_leave_covariances_with_an_inverse(speed):
    perfect = {field.name: 0.0 for field in fields(OdometryNoise)} | {'max_module_speed': 10.0}
    odo = SwerveOdometry(SwerveKinematics(CORNERS + (2.0, 1.0)), noise=OdometryNoise(**perfect))
    for k in range(50):
        odo.update(0.02 * k, np.full(4, 0.02 * k * speed), np.zeros(4), 0.0)
        for covariance in (odo.pose_covariance, odo.twist_covariance):
            assert (np.linalg.eigvalsh(covariance) > 0.0).all()


def test_covariances_are_symmetric_and_positive():
    odo = SwerveOdometry(KIN)
    assert (np.linalg.eigvalsh(odo.pose_covariance) > 0.0).all()
    feed(odo, drives.smooth_motion(CORNERS, 20, finest=400))
    for covariance in (odo.pose_covariance, odo.twist_covariance):
        np.testing.assert_array_equal(covariance, covariance.T)
        assert (np.linalg.eigvalsh(covariance) > 0.0).all()


def test_wheels_that_an_accelerometer_contradicted_for_too_long_are_not_trusted_blindly():
    # On ice the base follows its wheels at 0.9 m/s^2, for longer than it may coast.
    odo, dt = SwerveOdometry(SwerveKinematics(CORNERS)), 0.02
    rolled = place = speed = wheels = 0.0
    ratios, trusting = [], 0
    for k in range(600):
        told = 2.4 * (k > 50 and (k - 50) % 150 < 75)
        wheels += np.clip(told - wheels, -6.0 * dt, 6.0 * dt)
        force = np.clip((wheels - speed) / dt, -0.9, 0.9)
        place, rolled = place + dt * (speed + 0.5 * force * dt), rolled + dt * wheels
        speed += force * dt
        odo.update(dt * k, [rolled] * 4, [0.0] * 4, 0.0, specific_force=(force, 0.0))
        if odo.distrust:
            trusting += 1
            ratios.append(abs(odo.pose[0] - place) / np.sqrt(odo.pose_covariance[0, 0]))
    assert trusting > 200
    assert max(ratios) < 5.0
