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

"""Tests of the accelerometer's part: which wheels are believed, and what happens with none."""

from itertools import product
import math

from hypothesis import given, settings, strategies as st
from inertial_replay import (
    ALIKE, CORNERS, DRIVE, error_of, FINE, FINE_DRIVE, FORCES, forces_of, PLACE, RATE, replay,
    spinning, worst_step)
import numpy as np
import pytest
from strategies import seeds

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry import catch_up, coasting
from swerve_kinematics.core.odometry.catch_up import CatchUp
from swerve_kinematics.core.odometry.inertial import Inertial
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.tilt import STANDARD_GRAVITY, TiltRates


def test_gripping_wheels_are_believed_and_the_bias_is_learnt():
    bias = np.array((0.15, -0.1))
    odo, poses, coasted = replay(forces=FORCES + bias)
    assert error_of(poses) < 1e-3
    assert not coasted.any()
    assert not odo.doubt.any()
    assert odo.accelerometer_believed
    learnt = odo._solver.inertial._filter.bias
    assert abs(learnt - complex(*bias)) < 0.05


def test_a_leaning_floor_is_told_from_a_bias_by_turning():
    lean = 0.25 * np.exp(0.5j)
    leaking = lean * np.exp(-1j * DRIVE.yaw)
    odo, poses, _ = replay(forces=FORCES + np.column_stack((leaking.real, leaking.imag)))
    assert error_of(poses) < 1e-3
    assert abs(complex(*odo.lean) - leaking[-1]) < 0.1


@pytest.mark.parametrize('known', [True, False])
def test_rates_about_x_and_y_follow_a_ramp(known):
    # At a steady 1 m/s the floor tilts by 10 degrees in a second: gravity leaks in.
    judge, dt, offset = Inertial(0j), 0.02, 0.01 - 0.02j
    tilts = np.radians(10.0) * np.clip(dt * np.arange(250) - 3.0, 0.0, 1.0)
    doubted = 0
    for k, tilt in enumerate(tilts):
        rate = offset - 1j * (tilt - tilts[max(k - 1, 0)]) / dt
        force = complex(STANDARD_GRAVITY * np.sin(tilt))
        velocity = 0j if k < 100 else 1.0 + 0j
        if k == 100:
            judge.interrupt()
        believed = judge.judge(dt, ALIKE, velocity, force, rate if known else None, 0.0)
        doubted += not any(believed)
        if any(believed):
            judge.settle(dt, velocity, 0.0)
    assert bool(doubted) != known
    if known:
        assert abs(judge.lean - force) < 0.1


@pytest.mark.parametrize('force', [(np.nan, 0.0), (0.0, np.inf), (500.0, 0.0), (1e308, 1e308)])
def test_an_absurd_force_is_as_none(force):
    odo, poses, _ = replay(forces=np.tile(force, (len(DRIVE.stamp), 1)))
    np.testing.assert_array_equal(poses, replay(forces=None)[1])
    assert not odo.accelerometer_believed


def test_a_velocity_by_the_last_bit_of_encoders_is_none():
    # Samples in a burst, between which all encoders go on by a bit.
    odo = SwerveOdometry(SwerveKinematics(CORNERS))
    for stamp in (0.0, 1e-5, 2e-5, *np.arange(0.02, 1.0, 0.02)):
        odo.update(stamp, [1e-4 * (stamp > 0.0)] * 4, [0.0] * 4, 0.0, specific_force=(0.1, 0.0))
    assert np.hypot(*odo.pose[:2]) < 1e-3 and not odo.coasting


def test_wrong_shapes_are_refused():
    odo = SwerveOdometry(SwerveKinematics(CORNERS))
    for name in ('specific_force', 'tilt_rates'):
        with pytest.raises(ValueError, match=name):
            odo.update(0.0, np.zeros(4), np.zeros(4), **{name: (0.0, 0.0, 9.81)})
    with pytest.raises(ValueError, match='imu_position'):
        SwerveOdometry(SwerveKinematics(CORNERS), imu_position=(np.nan, 0.0))
    for wrong in (0.0, -18.0, math.nan):
        with pytest.raises(ValueError, match='force_range'):
            SwerveOdometry(SwerveKinematics(CORNERS), force_range=wrong)


@pytest.mark.parametrize('factor', [0.0, 1.8])
def test_the_base_coasts_while_all_wheels_slip(factor):
    slipping = spinning(DRIVE, 9.0, 9.8, factor)
    without = error_of(replay(slipping, None)[1])
    odo, poses, coasted = replay(slipping)
    assert without > 0.5
    assert error_of(poses) < 0.05
    assert coasted.max() == pytest.approx(0.8 + coasting.REGAIN_TIME, abs=0.1)
    assert not odo.coasting
    assert worst_step(poses) < 1.1 * worst_step(DRIVE.truth)


@pytest.mark.parametrize('factor', [-1.0, 0.0, 57.3])
def test_a_wrong_rate_is_dropped_though_the_wheels_are_doubted_because_of_it(factor):
    kin, ways, coasted = SwerveKinematics(CORNERS), np.zeros(4), []
    odo = SwerveOdometry(kin, imu_position=PLACE)
    for k in range(500):
        turning = 0.5 * (k > 50)
        states = kin.inverse((1.0, 0.0, turning))
        ways = ways + 0.02 * states.speed
        centripetal = 1j * turning * (1.0 + 1j * turning * complex(*PLACE))
        odo.update(0.02 * k, ways, states.angle, None, factor * turning,
                   specific_force=(centripetal.real, centripetal.imag))
        coasted.append(odo.coasting)
    assert odo.gyro_trusted == (True, False)
    assert 1.0 < max(coasted) < 2.5
    assert max(coasted[-100:]) == 0.0


def test_wheels_that_are_right_are_believed_though_others_slip():
    rolled = np.diff(DRIVE.distance, axis=0, prepend=0.0)
    rolled[450:480, :2] *= 1.5
    slipping = DRIVE._replace(distance=np.cumsum(rolled, axis=0))
    odo = SwerveOdometry(SwerveKinematics(CORNERS), DRIVE.truth[0], False, imu_position=PLACE)
    doubts = []
    for k, stamp in enumerate(DRIVE.stamp):
        odo.update(stamp, slipping.distance[k], DRIVE.angle[k], DRIVE.yaw[k],
                   specific_force=FORCES[k])
        doubts.append(odo.doubt)
        np.testing.assert_array_equal(odo.slipping, odo.doubt > 0.0)
    assert np.abs(odo.pose - DRIVE.truth[-1]).max() < 0.02
    doubts = np.array(doubts)
    assert doubts[479, :2] == pytest.approx(0.6, abs=0.05)
    assert not doubts[:, 2:].any()
    assert not doubts[480:].any()


@pytest.mark.parametrize('factor', [0.0, 1.2, 2.0])
@pytest.mark.parametrize('place', [PLACE, (1.0, 0.5)])
def test_one_wheel_that_slips_is_left_out_without_a_gyro_too(factor, place):
    rolled = np.diff(DRIVE.distance, axis=0, prepend=0.0)
    rolled[(DRIVE.stamp > 4.0) & (DRIVE.stamp <= 6.0), 0] *= factor
    distance, forces = np.cumsum(rolled, axis=0), forces_of(FINE_DRIVE, FINE // RATE, place)
    odo = SwerveOdometry(SwerveKinematics(CORNERS), DRIVE.truth[0], imu_position=place)
    for k, stamp in enumerate(DRIVE.stamp):
        odo.update(stamp, distance[k], DRIVE.angle[k], specific_force=forces[k])
        assert not odo.coasting
        if stamp == 5.0:
            assert odo.slipping.tolist() == [True, False, False, False]
    np.testing.assert_allclose(odo.pose, DRIVE.truth[-1], atol=0.02)


@pytest.mark.parametrize('spike', [math.nan, 40.0])
def test_a_spike_of_the_accelerometer_has_no_spinning_wheels_believed(spike):
    slipping = spinning(DRIVE, 9.0, 9.8, 1.8)
    usual = error_of(replay(slipping)[1])
    # One step, or three, from when the spin has been noticed until just after its end.
    for first, count in product(range(454, 496, 6), (1, 3)):
        forces = FORCES.copy()
        forces[first:first + count, 0] = spike
        assert error_of(replay(slipping, forces)[1]) < usual + 0.03


@pytest.mark.parametrize('gained', [0.6, 1.0, 1.5])
@pytest.mark.parametrize('late', [0.0, 0.007, 0.015])
def test_a_base_that_is_hit_slides_as_far_as_its_accelerometer_says(gained, late):
    # Within 50 ms it has this velocity [m/s], and then its standing wheels brake it by 6 m/s^2.
    since = np.arange(0.0, 4.0, 1e-3) - 2.0 - late
    velocity = np.where(since < 0.05, 0.5 * gained * (1.0 - np.cos(
        np.pi * np.clip(since / 0.05, 0.0, 1.0))), np.maximum(gained - 6.0 * (since - 0.05), 0.0))
    forces = np.diff(velocity[::20]) / 0.02
    assert forces.max() > 18.0 or gained < 1.0
    odo = SwerveOdometry(SwerveKinematics(CORNERS), force_range=160.0)
    for k, force in enumerate([0.0, *forces]):
        odo.update(0.02 * k, np.zeros(4), np.zeros(4), 0.0, 0.0, None, (0.1, force - 0.1))
    np.testing.assert_allclose(odo.pose, [0.0, 1e-3 * velocity.sum(), 0.0], atol=0.05)


@pytest.mark.parametrize('rate, off', [
    (4.0, 0.02), (-7.0, 0.02j), (10.0, 0.015 - 0.015j), (-10.0, -0.02)])
@pytest.mark.parametrize('place', [(0.0, 0.0), PLACE])
@pytest.mark.parametrize('bias', [0.0, 0.1 - 0.1j])
def test_a_base_that_spins_stays_though_its_sensor_is_two_centimetres_from_where_it_should_be(
        rate, off, place, bias):
    dt, fine, every = 0.02, 0.001, 20
    rates = rate * np.interp(fine * np.arange(10001), (1.0, 2.0, 6.0, 6.5, 8.0, 9.0),
                             (0.0, 1.0, 1.0, 0.5, 1.0, 0.0))
    yaw = fine * np.cumsum(rates)
    pulled = (1j * np.gradient(rates, fine) - rates ** 2) * (complex(*place) + off)
    noise = np.random.default_rng(1).normal(0.0, 0.03, (2, 500))
    forces = pulled[1:].reshape(-1, every).mean(axis=1) + bias + noise[0] + 1j * noise[1]
    odo, corners = SwerveOdometry(SwerveKinematics(CORNERS), imu_position=place), CORNERS @ (1, 1j)
    for k, force in enumerate(forces, start=1):
        turned = yaw[every * k]
        odo.update(dt * k, turned * np.abs(corners), np.angle(1j * corners), turned,
                   rates[every * k], specific_force=(force.real, force.imag))
        assert np.hypot(*odo.pose[:2]) < 0.03
        assert odo.coasting == 0.0


def test_what_the_base_coasted_too_far_is_made_up_for():
    # A bias that nobody knows when the wheels begin to slip shows when they grip again.
    slipping = spinning(DRIVE, 1.0, 2.6, 1.8)
    forces = FORCES + np.array((0.2, -0.15))
    _, poses, coasted = replay(slipping, forces)
    off = np.hypot(*(poses - DRIVE.truth)[:, :2].T)
    end = np.flatnonzero(coasted)[-1] + 1
    assert off[end] > 0.1
    assert off[end + 2 * RATE:end + 3 * RATE].max() < 0.4 * off[end]
    assert worst_step(poses) < worst_step(DRIVE.truth) + catch_up.FASTEST / RATE + 0.01


def test_a_pose_given_while_coasting_keeps_no_error_of_the_way_before():
    slipping = spinning(DRIVE, 6.0, 7.9, 1.8)
    # The floor begins to lean as the wheels begin to slip.
    forces = FORCES + np.outer(DRIVE.stamp > 6.0, (0.25, -0.1))
    odo, errors, stds = SwerveOdometry(
        SwerveKinematics(CORNERS), DRIVE.truth[0], imu_position=PLACE), [], []
    for k, stamp in enumerate(DRIVE.stamp[:10 * RATE]):
        odo.update(stamp, slipping.distance[k], slipping.angle[k], slipping.yaw[k],
                   specific_force=forces[k])
        if k == int(7.7 * RATE):
            assert odo.coasting > 1.5
            odo.reset(DRIVE.truth[k])
        errors.append(math.hypot(*(odo.pose - DRIVE.truth[k])[:2]))
        stds.append(math.sqrt(odo.pose_covariance[0, 0]))
    assert max(errors[int(7.7 * RATE):]) < 0.05 < 0.15 < max(errors)
    # Nor does the covariance go on with the errors before.
    assert stds[int(7.7 * RATE) + 1] < 0.03


def test_coasting_grows_the_covariance_and_leaves_the_gyro_alone():
    slipping = spinning(DRIVE, 9.0, 10.5, 1.8)
    bias = 0.01
    slipping = slipping._replace(yaw=slipping.yaw + bias * slipping.stamp)
    gripping = DRIVE._replace(yaw=DRIVE.yaw + bias * DRIVE.stamp)
    odo, _, _ = replay(slipping, estimate_gyro_bias=True)
    expected, _, _ = replay(gripping, estimate_gyro_bias=True)
    growth = odo.pose_covariance - expected.pose_covariance
    assert (np.diag(growth)[:2] > 0.05 ** 2).all()
    assert odo.gyro_bias == pytest.approx(expected.gyro_bias, abs=1e-3)


@pytest.mark.parametrize('noise', [0.0, 0.05, 0.1])
@pytest.mark.parametrize('force', [2.4, 4.7, 9.8])
def test_a_parked_base_stays_where_it_is_whatever_leans_at_the_start(force, noise):
    # A ramp of 14 degrees, or a sensor that is mounted sideways.
    random = np.random.default_rng(0)
    odo = SwerveOdometry(SwerveKinematics(CORNERS), imu_position=PLACE)
    for k in range(2 * RATE):
        odo.update(k / RATE, [0.0] * 4, [0.0] * 4, 0.0, 0.001 * random.standard_normal(),
                   specific_force=(noise * random.standard_normal(), force), tilt_rates=(0.0, 0.0))
        assert not odo.coasting
    assert math.hypot(*odo.pose[:2]) < 0.03


def test_a_gap_forgets_the_velocity():
    _, poses, _ = replay()
    odo = replay()[0]
    odo.reprime()
    last = DRIVE.stamp[-1]
    odo.update(last + 3.0, DRIVE.distance[0], DRIVE.angle[0], 0.0, specific_force=(0.0, 0.0))
    for k in range(1, 20):
        odo.update(last + 3.0 + 0.02 * k, DRIVE.distance[0], DRIVE.angle[0], 0.0,
                   specific_force=(0.0, 0.0))
        assert not odo.coasting
    np.testing.assert_allclose(odo.pose, poses[-1], atol=1e-12)


@given(st.lists(st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)), max_size=5),
       st.floats(0.001, 0.2))
def test_corrections_are_made_in_full_and_never_at_once(corrections, dt):
    left, total = CatchUp(0j, catch_up.SLOWEST, catch_up.FASTEST), 0j
    for x, y in corrections:
        left.add(complex(x, y))
        part = left.part(dt)
        assert abs(part) <= catch_up.FASTEST * dt * (1.0 + 1e-9)
        total += part
    while part := left.part(dt):
        total += part
    assert abs(total - sum(complex(x, y) for x, y in corrections)) < 1e-9


@pytest.mark.parametrize('slow, steps, known', [
    (True, 20, False), (True, 60, True), (False, 200, False)])
def test_the_rates_offset_is_learnt_in_slow_motion(slow, steps, known):
    rates, dt, offset = TiltRates(), 0.02, 0.008 - 0.003j
    for _ in range(steps):
        rates.change(dt, offset, slow)
    change = rates.change(dt, offset + 0.1j, False)
    assert (change is not None) == known
    if known:
        assert change == pytest.approx(1j * STANDARD_GRAVITY * dt * 0.1j)


@settings(max_examples=30)
@given(seeds, st.booleans())
def test_covariances_stay_positive_and_poses_continuous(seed, gyro):
    rng = np.random.default_rng(seed)
    odo = SwerveOdometry(SwerveKinematics(CORNERS), imu_position=PLACE)
    distance, angle, yaw, last = np.zeros(4), np.zeros(4), 0.0, np.zeros(3)
    for k in range(120):
        speed = rng.uniform(-4.0, 4.0, 4) if rng.random() < 0.5 else np.full(4, 1.0)
        distance = distance + 0.02 * speed
        angle = angle + rng.normal(scale=0.05, size=4)
        yaw += rng.normal(scale=0.02)
        odo.update(0.02 * k, distance, angle, yaw if gyro else None,
                   specific_force=rng.normal(scale=rng.choice((0.1, 5.0)), size=2))
        if k > 1:
            assert (np.linalg.eigvalsh(odo.pose_covariance) > 0.0).all()
        assert np.hypot(*(odo.pose - last)[:2]) < 0.02 * 10.0
        last = odo.pose
