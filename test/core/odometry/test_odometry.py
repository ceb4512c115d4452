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

"""Tests of the odometry's geometry, and of setting and reading its state."""

from benchmarks import drives
from hypothesis import given, strategies as st
import numpy as np
from odometry_drives import (
    ANY_SPEED, constant_drive, CORNERS, feed, KIN, odometry, PERIOD, TWIST)
import pytest
from strategies import layouts, seeds

from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.geometry.se2 import se2_compose, se2_exp
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise


# Geometry

@given(layouts(), seeds)
def test_constant_twist_is_exact_with_each_kind_of_gyro(positions, seed):
    kin = SwerveKinematics(positions)
    drive = constant_drive(kin, np.random.default_rng(seed).normal(scale=2.0, size=3))
    for gyro in ({'yaw': True}, {'yaw': False, 'yaw_rate': True}, {'yaw_rate': True}):
        odo = odometry(kin, noise=ANY_SPEED)
        np.testing.assert_allclose(feed(odo, drive, **gyro), drive.truth[-1], atol=1e-9)
        assert not odo.slipping.any()


@given(layouts(), seeds)
def test_wheels_alone_follow_a_constant_twist(positions, seed):
    kin = SwerveKinematics(positions)
    drive = constant_drive(kin, np.random.default_rng(seed).normal(scale=1.0, size=3))
    pose = feed(odometry(kin, noise=ANY_SPEED), drive, yaw=False)
    np.testing.assert_allclose(pose, drive.truth[-1], atol=2e-5)


@given(layouts(), st.floats(-3.0, 3.0), st.floats(0.1, 3.0))
def test_constant_steering_rate_is_exact(positions, steering_rate, speed):
    kin = SwerveKinematics(positions)
    t = 0.1 * np.arange(40)
    angle = steering_rate * t
    for yaw in (0.0, None):
        odo = odometry(kin)
        for k, stamp in enumerate(t):
            modules = np.ones(kin.module_count)
            odo.update(stamp, speed * stamp * modules, angle[k] * modules, yaw)
        # The integral of speed exp(i angle): the arc of a circle, base_link never turns.
        arc = speed * t[-1] * np.sinc(angle[-1] / (2.0 * np.pi)) * np.exp(0.5j * angle[-1])
        np.testing.assert_allclose(odo.pose, (arc.real, arc.imag, 0.0), atol=1e-9)


def test_smooth_motion_is_a_hundred_times_closer_than_by_end_angles():
    drive = drives.smooth_motion(CORNERS, 50, finest=1000)
    error = drives.position_error(drives.replay(odometry(), drive), drive)
    assert error < 0.01 * 4.0 * drives.position_error(drives.end_angle_poses(drive), drive)


@given(layouts(counts=(2, 3, 6)), seeds)
def test_pose_is_where_it_was_set(positions, seed):
    rng = np.random.default_rng(seed)
    kin, start = SwerveKinematics(positions), rng.normal(scale=5.0, size=3)
    drive = constant_drive(kin, rng.normal(size=3), start=start)
    pose = feed(odometry(kin, pose=start, noise=ANY_SPEED), drive)
    np.testing.assert_allclose(pose, drive.truth[-1], atol=1e-9)


@pytest.mark.parametrize('gyro', [{'yaw': True}, {'yaw': False}])
def test_twist_is_that_of_the_base(gyro):
    odo = odometry()
    feed(odo, constant_drive(KIN, TWIST), **gyro)
    np.testing.assert_allclose(odo.twist, TWIST, atol=1e-5)


@pytest.mark.parametrize('yaws', [(0.0, 0.0), (None, None)])
def test_measured_velocities_make_the_twist(yaws):
    odo, states = odometry(), KIN.inverse((1.0, 0.5, 0.0))
    for k, yaw in enumerate(yaws):
        odo.update(0.1 * k, np.zeros(4), states.angle, yaw, velocities=states.speed)
    np.testing.assert_allclose(odo.twist, (1.0, 0.5, 0.0), atol=1e-12)
    np.testing.assert_allclose(odo.pose, 0.0, atol=1e-12)


def test_wheels_tell_the_yaw_rate_by_their_velocities():
    odo, states = odometry(), KIN.inverse(TWIST)
    for k in range(2):
        odo.update(0.1 * k, np.zeros(4), states.angle, velocities=states.speed)
    np.testing.assert_allclose(odo.twist, TWIST, atol=1e-12)


def test_velocity_that_is_missing_is_made_from_distances():
    odo, drive = odometry(), constant_drive(KIN, TWIST)
    for k in range(3):
        odo.update(drive.stamp[k], drive.distance[k], drive.angle[k], drive.yaw[k],
                   velocities=[np.nan, 9.0, 9.0, 9.0])
    np.testing.assert_allclose(odo.twist, TWIST, atol=1e-9)


def test_wrapped_sensors_tell_the_same():
    drive = drives.smooth_motion(CORNERS, 50, finest=1000)
    turned = drive._replace(angle=drive.angle + 6.0, yaw=drive.yaw + 3.0)
    wrapped = drive._replace(angle=wrap_angle(turned.angle), yaw=wrap_angle(turned.yaw))
    np.testing.assert_allclose(feed(odometry(), wrapped), feed(odometry(), turned), atol=1e-9)


def test_yaw_counts_whole_turns():
    assert feed(odometry(), constant_drive(KIN, (0.0, 0.0, 3.0), steps=500))[2] == (
        pytest.approx(30.0))


# Setting and reading the state

def test_reset_sets_pose_and_covariance_and_drives_on():
    odo, drive = odometry(), constant_drive(KIN, TWIST)
    feed(odo, drive.at(slice(0, 26)))
    covariance = np.diag((0.1, 0.2, 0.3))
    odo.reset((5.0, 6.0, 7.0), covariance)
    np.testing.assert_array_equal(odo.pose, (5.0, 6.0, 7.0))
    np.testing.assert_array_equal(odo.pose_covariance, covariance)
    expected = se2_compose((5.0, 6.0, 7.0), se2_exp(25 * PERIOD * TWIST))
    np.testing.assert_allclose(feed(odo, drive.at(slice(26, None))), expected, atol=1e-9)
    odo.reset()
    np.testing.assert_array_equal(odo.pose_covariance, 1e-12 * np.eye(3))


def test_what_is_read_is_a_copy():
    odo = odometry()
    feed(odo, constant_drive(KIN, TWIST))
    for name in ('pose', 'twist', 'pose_covariance', 'twist_covariance', 'slipping'):
        getattr(odo, name)[...] = 0
        if name != 'slipping':
            assert np.any(getattr(odo, name)), name


@pytest.mark.parametrize('arguments', [
    (np.zeros(3), np.zeros(4)), (np.zeros(4), np.zeros((1, 4))), (np.zeros((2, 4)), np.zeros(4)),
    (0.0, np.zeros(4)), (np.zeros((4, 1)), np.zeros(4)), ([[0.0]] * 4, np.zeros(4))])
def test_wrong_shapes_are_refused(arguments):
    with pytest.raises(ValueError):
        odometry().update(0.0, *arguments)


def test_wrong_velocities_are_refused():
    with pytest.raises(ValueError, match='velocities'):
        odometry().update(0.0, np.zeros(4), np.zeros(4), velocities=np.zeros(3))


@pytest.mark.parametrize('arguments', [
    ((0.0, 0.0),), ((0.0, 0.0, np.nan),), ((0.0, 0.0, 0.0), np.zeros((2, 2))),
    ((0.0, 0.0, 0.0), np.full((3, 3), np.inf)), ((0.0, 0.0, 0.0), np.diag((1.0, -4.0, 1.0))),
    ((0.0, 0.0, 0.0), [(1, 5, 0), (5, 1, 0), (0, 0, 1)]),
    ((0.0, 0.0, 0.0), [(1, 0.5, 0), (0, 1, 0), (0, 0, 1)])])
def test_impossible_pose_is_refused_and_changes_nothing(arguments):
    odo = odometry(pose=(1.0, 2.0, 3.0))
    with pytest.raises(ValueError):
        odo.reset(*arguments)
    np.testing.assert_array_equal(odo.pose, (1.0, 2.0, 3.0))


@pytest.mark.parametrize('setting', [
    {'distance_noise': -1.0}, {'gyro_noise': np.nan}, {'slip_speed': np.inf}])
def test_impossible_noise_is_refused(setting):
    with pytest.raises(ValueError, match=next(iter(setting))):
        OdometryNoise(**setting)
