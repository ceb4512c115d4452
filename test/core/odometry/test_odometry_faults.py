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

"""Tests of gaps, lost and repeated samples, and of modules that reset, go missing or slip."""

from benchmarks import drives
import numpy as np
from odometry_drives import constant_drive, CORNERS, feed, KIN, odometry, PERIOD, TWIST
import pytest

from swerve_kinematics.core.odometry.uncertainty import OdometryNoise


def test_first_call_primes():
    odo = odometry(pose=(1.0, 2.0, 3.0))
    assert not odo.update(5.0, [7.0] * 4, [0.0] * 4, 0.4)
    np.testing.assert_array_equal(odo.pose, (1.0, 2.0, 3.0))
    assert odo.update(5.1, [7.1] * 4, [0.0] * 4, 0.4)


@pytest.mark.parametrize('stamp', [1.0, 0.5, -3.0, np.nan, np.inf, -np.inf])
def test_repeated_or_older_stamp_is_dropped(stamp):
    odo = odometry()
    odo.update(0.9, np.zeros(4), np.zeros(4))
    odo.update(1.0, np.full(4, 0.1), np.zeros(4))
    pose, covariance = odo.pose, odo.pose_covariance
    assert not odo.update(stamp, np.full(4, 0.2), np.zeros(4))
    np.testing.assert_array_equal(odo.pose, pose)
    np.testing.assert_array_equal(odo.pose_covariance, covariance)
    assert odo.update(1.1, np.full(4, 0.3), np.zeros(4))
    assert odo.pose[0] == pytest.approx(0.3)


def test_dropped_samples_are_bridged():
    drive = constant_drive(KIN, TWIST, steps=100)
    kept = np.random.default_rng(3).random(101) > 0.3
    kept[[0, -1]] = True
    np.testing.assert_allclose(feed(odometry(), drive.at(kept)), drive.truth[-1], atol=1e-9)


@pytest.mark.parametrize('stamp', [30.0, 0.99])
def test_reprime_keeps_the_pose_and_grows_the_covariance(stamp):
    odo, drive = odometry(), constant_drive(KIN, TWIST)
    feed(odo, drive)
    pose, variances = odo.pose, np.diag(odo.pose_covariance)
    odo.reprime()
    assert not odo.update(stamp, np.full(4, -50.0), np.zeros(4), -2.0)
    np.testing.assert_array_equal(odo.pose, pose)
    assert (np.diag(odo.pose_covariance) > variances + 0.5).all()
    assert odo.update(stamp + 0.1, np.full(4, -50.0), np.zeros(4), -2.0)
    np.testing.assert_allclose(odo.pose, pose, atol=1e-12)


def test_a_twist_from_before_a_gap_is_not_that_of_a_base_that_may_have_stopped():
    odo, drive = odometry(), constant_drive(KIN, TWIST)
    feed(odo, drive)
    odo.reprime()
    odo.update(30.0, np.zeros(4), np.zeros(4), 0.0)
    np.testing.assert_array_equal(odo.twist, 0.0)
    assert (np.sqrt(np.diag(odo.twist_covariance)) > np.abs(TWIST)).all()
    odo.update(30.02, np.zeros(4), np.zeros(4), 0.0)
    np.testing.assert_array_equal(odo.twist, 0.0)
    assert (np.sqrt(np.diag(odo.twist_covariance)) < 0.1).all()


def test_longer_gap_loses_more():
    variances = []
    for gap in (0.5, 5.0):
        odo = odometry()
        feed(odo, constant_drive(KIN, TWIST))
        odo.reprime()
        odo.update(1.0 + gap, np.zeros(4), np.zeros(4))
        variances.append(np.diag(odo.pose_covariance))
    assert (variances[1] > 10.0 * variances[0]).all()


def test_a_gap_right_after_another_loses_no_less():
    odo, variances = odometry(), []
    feed(odo, constant_drive(KIN, TWIST))
    for stamp in (2.0, 3.0, 4.0):
        odo.reprime()
        odo.update(stamp, np.zeros(4), np.zeros(4), 0.0)
        variances.append(np.diag(odo.pose_covariance))
    assert (np.diff(variances, axis=0) > 0.9 * variances[0]).all()


@pytest.mark.parametrize('gyro', [None, 0.0])
@pytest.mark.parametrize('rate', [1, 5, 50, 500])
@pytest.mark.parametrize('reprimed', [False, True])
def test_steps_in_a_row_that_tell_nothing_lose_as_much_as_one_gap(gyro, rate, reprimed):
    stds = []
    for steps in (1, 10 * rate):
        odo = odometry()
        for k in range(51):
            odo.update(PERIOD * k, np.full(4, PERIOD * k), np.zeros(4), gyro)
        if steps == 1:
            odo.reprime(gyro_went_on=True)
        for k in range(1, steps + 1):
            if reprimed:
                odo.reprime(gyro_went_on=True)
            odo.update(1.0 + 10.0 * k / steps, np.full(4, np.nan), np.zeros(4), gyro)
        stds.append(np.sqrt(np.diag(odo.pose_covariance)))
    assert stds[0][0] > 10.0
    np.testing.assert_allclose(stds[1], stds[0], rtol=0.02)


SOURCES = ({'yaw': 2.7}, {'yaw_rate': 0.1, 'rate_integral': 2.7})


@pytest.mark.parametrize('before', SOURCES)
@pytest.mark.parametrize('went_on', [False, True])
def test_the_heading_follows_a_gyro_that_went_on_through_a_gap(before, went_on):
    after = {name: value + 2.0 for name, value in before.items()}
    odo = odometry(pose=(1.0, 2.0, 0.5))
    for k in range(3):
        odo.update(PERIOD * k, np.full(4, 0.01 * k), np.zeros(4), **before)
    pose, variances = odo.pose, np.diag(odo.pose_covariance)
    odo.reprime(gyro_went_on=went_on)
    assert not odo.update(2.0, np.full(4, 90.0), np.ones(4), **after)
    np.testing.assert_allclose(odo.pose, pose + (0.0, 0.0, 2.0 * went_on), atol=1e-12)
    # Where the base is, nobody knows; its heading is as sure as the gyro, or not at all.
    grown = np.sqrt(np.diag(odo.pose_covariance) - variances)
    assert (grown[:2] > 0.5).all()
    assert (grown[2] < 0.001) if went_on else (grown[2] > 0.05)
    np.testing.assert_array_equal(odo.twist, 0.0)
    # The wheels go on from there, and a gap that was not watched turns nothing.
    odo.update(2.0 + PERIOD, np.full(4, 90.0), np.ones(4), **after)
    odo.reprime()
    odo.update(9.0, np.full(4, 90.0), np.ones(4), **before)
    np.testing.assert_allclose(odo.pose, pose + (0.0, 0.0, 2.0 * went_on), atol=1e-12)


def test_two_rates_do_not_tell_the_turn_of_a_gap_between_them():
    odo = odometry()
    for stamp in (0.0, PERIOD):
        odo.update(stamp, np.zeros(4), np.zeros(4), yaw_rate=0.0)
    odo.reprime(gyro_went_on=True)
    odo.update(3.0, np.zeros(4), np.zeros(4), yaw_rate=1.0)
    assert odo.pose[2] == 0.0
    assert odo.pose_covariance[2, 2] > 0.02


def test_the_bias_of_the_gyro_is_taken_off_the_turn_of_a_gap():
    odo = odometry(estimate_gyro_bias=True)
    for k in range(500):
        odo.update(PERIOD * k, np.zeros(4), np.zeros(4), yaw=0.01 * PERIOD * k)
    odo.reprime(gyro_went_on=True)
    odo.update(PERIOD * 499 + 20.0, np.zeros(4), np.zeros(4), yaw=0.01 * PERIOD * 499 + 0.2)
    assert abs(odo.pose[2]) < 0.01
    assert abs(odo.pose[2]) < 3.0 * np.sqrt(odo.pose_covariance[2, 2])


@pytest.mark.parametrize('before', SOURCES)
def test_encoders_that_all_jump_at_once_leave_the_heading_to_the_gyro(before):
    odo = odometry()
    for k in range(20):
        turned = {name: value + 0.5 * PERIOD * k for name, value in before.items()}
        odo.update(PERIOD * k, np.full(4, 50.0 if k < 10 else 0.0), np.zeros(4), **turned)
    np.testing.assert_allclose(odo.pose, (0.0, 0.0, 0.5 * PERIOD * 19), atol=1e-9)


@pytest.mark.parametrize('period', [0.02, 0.05, 0.1])
def test_a_way_that_a_clock_set_back_hides_is_in_the_covariance(period):
    odo, speed, stamp = odometry(), 4.0, 0.0
    for k in range(40):
        # One message was dropped for its stamp, and the next one is hardly newer than the last.
        stamp += 0.001 if k == 30 else period
        odo.update(stamp, np.full(4, speed * period * (k + (k >= 30))), np.zeros(4), 0.0)
    lost = speed * period * 40 - odo.pose[0]
    assert lost == pytest.approx(2.0 * speed * period, rel=0.01)
    assert np.sqrt(odo.pose_covariance[0, 0]) > 0.7 * lost


@pytest.mark.parametrize('gyro', [{'yaw': True}, {'yaw': False}])
@pytest.mark.parametrize('faulty_readings', ['reset', 'missing', 'missing angle'])
def test_module_that_resets_or_goes_missing_is_left_out(gyro, faulty_readings):
    drive = constant_drive(KIN, TWIST)
    distance, angle = drive.distance + 8.0, drive.angle.copy()
    if faulty_readings == 'reset':
        distance[25:, 2] -= 9.0
    elif faulty_readings == 'missing':
        distance[20:30, 2] = np.nan
    else:
        angle[20:30, 2] = np.inf
    odo = odometry()
    np.testing.assert_allclose(feed(odo, drive._replace(distance=distance, angle=angle), **gyro),
                               drive.truth[-1], atol=1e-6)


def test_encoder_reset_is_reported_for_its_step():
    odo = odometry()
    readings = ([8.0] * 4, [8.01] * 4, [8.02, 8.02, 0.0, 8.02], [8.03, 8.03, 0.01, 8.03])
    reported = []
    for k, distances in enumerate(readings):
        odo.update(PERIOD * k, distances, np.zeros(4), 0.0)
        reported.append(odo.slipping.tolist())
    assert reported == [[False] * 4, [False] * 4, [False, False, True, False], [False] * 4]
    np.testing.assert_allclose(odo.pose, (0.03, 0.0, 0.0), atol=1e-12)


def test_too_few_modules_prime_instead_of_guessing():
    odo = odometry()
    for k in range(3):
        odo.update(PERIOD * k, np.full(4, 0.01 * k), np.zeros(4))
    pose, variance = odo.pose, odo.pose_covariance[0, 0]
    assert not odo.update(0.06, [0.03, np.nan, np.nan, np.nan], np.zeros(4))
    assert not odo.update(0.08, np.full(4, np.nan), np.zeros(4))
    np.testing.assert_array_equal(odo.pose, pose)
    assert odo.pose_covariance[0, 0] > variance


def test_one_module_and_a_gyro_are_enough():
    drive = constant_drive(KIN, TWIST)
    drive.distance[:, :3] = np.nan
    np.testing.assert_allclose(feed(odometry(), drive), drive.truth[-1], atol=1e-9)


def test_gyro_lost_and_back_leaves_no_jump():
    drive = constant_drive(KIN, TWIST, steps=90)
    drive.yaw[30:60] = np.nan
    drive.yaw[60:] += 2.0
    poses = drives.replay(odometry(), drive)
    np.testing.assert_allclose(poses, drive.truth, atol=1e-5)


@pytest.mark.parametrize('rate', [50, 500])
@pytest.mark.parametrize('wrong', [-1.0, 0.0])
def test_wheels_refute_a_wrong_gyro_however_often_coarse_encoders_are_read(wrong, rate):
    # 600 counts a turn of a 50 mm wheel: at 500 Hz the last bit is a speed of 0.25 m/s.
    resolution = 0.5e-3
    drive = drives.smooth_motion(CORNERS, rate, duration=4.0, finest=1000)
    drive = drive._replace(distance=resolution * np.round(drive.distance / resolution),
                           yaw_rate=wrong * drive.yaw_rate)
    odo = odometry(noise=OdometryNoise(distance_resolution=resolution))
    feed(odo, drive, yaw=False, yaw_rate=True)
    assert not odo.gyro_trusted[1]


@pytest.mark.parametrize('gyro', [{'yaw': True}, {'yaw': False}])
def test_slipping_wheel_is_left_out_and_reported(gyro):
    drive = constant_drive(KIN, TWIST)
    drive.distance[10:, 3] += np.linspace(0.0, 0.4, 41)
    odo = odometry()
    np.testing.assert_allclose(feed(odo, drive, **gyro), drive.truth[-1], atol=1e-4)
    assert odo.slipping.tolist() == [False, False, False, True]


def test_no_wheel_is_left_out_when_two_disagree_with_two():
    odo = odometry()
    odo.update(0.0, np.zeros(4), np.zeros(4), 0.0)
    odo.update(0.1, [0.1, 0.1, 0.2, 0.2], np.zeros(4), 0.0)
    assert not odo.slipping.any()
    assert odo.residual == pytest.approx(0.5)
    assert odo.pose[0] == pytest.approx(0.15)
