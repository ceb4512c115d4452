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

import math

from benchmarks import drives
from hypothesis import given, settings, strategies as st
import numpy as np
import pytest
from strategies import seeds

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry import catch_up, coasting, inertial, velocity_filter
from swerve_kinematics.core.odometry.catch_up import CatchUp
from swerve_kinematics.core.odometry.coasting import Coasting
from swerve_kinematics.core.odometry.inertial import Inertial
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.tilt import STANDARD_GRAVITY, TiltRates
from swerve_kinematics.core.odometry.velocity_filter import VelocityFilter

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
PLACE = (0.12, -0.07)
RATE, FINE = 50, 500
ALIKE = [0j] * 4  # of four modules that agree
FINE_DRIVE = drives.smooth_motion(CORNERS, FINE, duration=16.0, finest=2000)
DRIVE = FINE_DRIVE.at(slice(None, None, FINE // RATE))


def forces_of(fine, every):
    """Return the mean specific force (t, 2) [m/s^2] at PLACE in each step of `every` samples."""
    turned = np.exp(1j * fine.truth[:, 2])
    path = fine.truth[:, 0] + 1j * fine.truth[:, 1] + turned * complex(*PLACE)
    dt = fine.stamp[1]
    force = np.gradient(np.gradient(path, dt), dt) / turned
    means = 0.5 * (force[1:] + force[:-1]).reshape(-1, every).mean(axis=1)
    means = np.concatenate(([0j], means))
    return np.column_stack((means.real, means.imag))


FORCES = forces_of(FINE_DRIVE, FINE // RATE)


def replay(drive=DRIVE, forces=FORCES, rates=None, **settings_):
    """Return the odometry after a drive, its poses (t, 3) and how long it had coasted (t,)."""
    odo = SwerveOdometry(SwerveKinematics(CORNERS), drive.truth[0], imu_position=PLACE,
                         **{'estimate_gyro_bias': False, **settings_})
    poses, coasted = [], []
    for k, stamp in enumerate(drive.stamp):
        odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k], drive.yaw_rate[k],
                   specific_force=None if forces is None else forces[k],
                   tilt_rates=None if rates is None else rates[k])
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


# Wheels that grip

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
        believed = judge.judge(dt, 0.0, velocity, ALIKE, force, rate if known else None)
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


# Wheels that creep, and stamps that scatter

def creeping(fine, time):
    """Return the drive with a base that lags behind its wheels by `time` [s] of acceleration."""
    way = fine.truth[:, 0] + 1j * fine.truth[:, 1]
    ahead = time * np.gradient(way, fine.stamp[1])
    way = way - (ahead - ahead[0])
    return fine._replace(truth=np.column_stack((way.real, way.imag, fine.truth[:, 2])))


@pytest.mark.parametrize('time', [-0.015, 0.008, 0.02])
def test_creep_is_learnt_and_taken_off(time):
    # What tyres give way by, and readings that come late, which look like less than none.
    fine = creeping(FINE_DRIVE, time)
    drive = fine.at(slice(None, None, FINE // RATE))
    forces = forces_of(fine, FINE // RATE) + np.array((0.1, 0.05))
    odo, poses, coasted = replay(drive, forces)
    assert not coasted.any()
    assert odo._solver.inertial._filter.creep == pytest.approx(time, abs=0.003)
    half = slice(len(poses) // 2, None)
    poses, wheels = (x - x[half][0] for x in (poses, replay(drive, None)[1]))
    drive = drive._replace(truth=drive.truth - drive.truth[half][0])
    assert (np.hypot(*(poses - drive.truth)[half, :2].T).max()
            < 0.4 * np.hypot(*(wheels - drive.truth)[half, :2].T).max())


def test_the_twist_is_that_of_the_base_and_not_of_its_creeping_wheels():
    fine = creeping(FINE_DRIVE, 0.02)
    drive, forces = fine.at(slice(None, None, FINE // RATE)), forces_of(fine, FINE // RATE)
    way = fine.truth[:, 0] + 1j * fine.truth[:, 1]
    velocity = (np.gradient(way, fine.stamp[1]) * np.exp(-1j * fine.truth[:, 2]))[::FINE // RATE]
    for rims in (np.gradient(drive.distance, 1.0 / RATE, axis=0), [None] * len(drive.stamp)):
        odo, errors = SwerveOdometry(SwerveKinematics(CORNERS), imu_position=PLACE), []
        for k, stamp in enumerate(drive.stamp):
            odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k],
                       velocities=rims[k], specific_force=forces[k])
            errors.append(abs(complex(*odo.twist[:2]) - velocity[k]))
        assert np.mean(errors[5 * RATE:]) < 0.02


def scattered(fine, largest, rng):
    """Return the drive at 50 Hz with readings up to so many fine samples before or after."""
    stamps = np.arange(FINE // RATE, len(fine.stamp) - FINE // RATE, FINE // RATE)
    read = stamps + rng.integers(-largest, largest, len(stamps), endpoint=True)
    drive = fine.at(stamps)
    return drive._replace(distance=fine.distance[read], angle=fine.angle[read])


@pytest.mark.parametrize('largest', [1, 2])
def test_stamps_that_scatter_are_no_slip(largest):
    fine = drives.from_rest(FINE_DRIVE)
    drive = scattered(fine, largest, np.random.default_rng(3))
    forces = forces_of(fine, FINE // RATE)[1:1 + len(drive.stamp)]
    odo, poses, coasted = replay(drive, forces)
    without = error_of(replay(drive, None)[1], drive)
    # A reading that is late by 4 ms is off by 12 mm at 3 m/s, for that moment.
    assert error_of(poses, drive) < 2.0 * without + 0.01
    assert coasted[2 * RATE:].mean() < 0.02
    spread = math.sqrt(largest * (largest + 1) / 3.0) / FINE
    assert math.sqrt(odo._solver.inertial._stamps.variance) == pytest.approx(spread, rel=0.4)


@pytest.mark.parametrize('factor', [0.0, 1.8])
def test_slip_is_no_scatter_of_stamps(factor):
    odo, _, _ = replay(spinning(DRIVE, 9.0, 9.8, factor))
    assert odo._solver.inertial._stamps.variance < 0.5e-3 ** 2


# Wheels that slip

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


def test_never_for_long_and_the_next_time_later():
    # Wheels that swing to and fro for ever, under a base that stands.
    judge, dt, coasts = Inertial(0j), 0.02, []
    for k in range(2000):
        velocity = 0j if k < 100 else 1.8 * np.sin(4.0 * dt * (k - 100)) + 0j
        believed = any(judge.judge(dt, 0.0, velocity, ALIKE, 0j, None))
        if believed:
            judge.settle(dt, velocity, 0.0)
        assert judge.doubt <= coasting.LONGEST_DISPUTE
        coasts.append(not believed)
    times = dt * np.flatnonzero(np.diff(np.array(coasts, dtype=int)))
    breaks = times[2::2] - times[1:-1:2]
    distrust = breaks[breaks > 4.0]
    assert distrust[0] == pytest.approx(coasting.DISTRUST_TIME, abs=0.5)
    assert distrust[1] == pytest.approx(2.0 * coasting.DISTRUST_TIME, abs=0.5)


def test_wheels_that_leap_have_no_grip_however_long_it_takes():
    # On ice the base follows wheels that spin, and then wheels that lock, at 0.8 m/s^2.
    judge, dt, speed = Inertial(0j), 0.02, 0.0
    for k in range(100 + 190):
        spinning = 100 <= k < 200
        force = 0.0 if k < 100 else 0.8 if spinning else -0.8
        wheels = complex(min(1.5, 0.3 * (k - 99)) if spinning else 0.0)
        believed = any(judge.judge(dt, 0.0, wheels, ALIKE, complex(force), 0j))
        if believed:
            judge.settle(dt, wheels, 0.0)
        speed = max(0.0, speed + force * dt)
        assert abs(judge.velocity - speed) < 0.1
    assert 190 * dt > coasting.LONGEST_DISPUTE


def test_a_rest_tells_what_the_force_is_off_by():
    # Bias and lean are unknown each, their sum is not.
    judge, dt = Inertial(0j), 0.02
    for _ in range(100):
        judge.judge(dt, 0.0, 0j, ALIKE, 0.3 + 0.1j, 0j)
        judge.settle(dt, 0j, 0.0)
    assert judge._filter.force_std < 0.1 < math.sqrt(judge._filter._bias_variance)
    # One that is mounted askew shows more the harder the base accelerates.
    judge.judge(dt, 0.0, 0j, ALIKE, 10.3 + 0.1j, 0j)
    judge.judge(dt, 0.0, 0j, ALIKE, 10.3 + 0.1j, 0j)
    assert judge._filter.force_std > 0.4


def test_an_offset_that_stays_is_the_accelerometers():
    # The wheels slip for 0.4 s and end up 0.3 m/s faster than the prediction says.
    judge, dt, coasts = Inertial(0j), 0.02, []
    for k in range(200):
        velocity = complex(min(max(k - 100, 0) * dt, 0.4) * 0.75 / 1.0)
        believed = any(judge.judge(dt, 0.0, velocity, ALIKE, 0j, None))
        if believed:
            judge.settle(dt, velocity, 0.0)
        coasts.append(not believed)
    assert any(coasts)
    assert not coasts[-1]
    assert abs(judge.velocity - 0.3) < 0.05
    assert sum(coasts) * dt < 1.0


def test_beyond_a_lean_the_wheels_are_believed():
    judge, dt = Inertial(0j), 0.02
    for k in range(400):
        lean = complex(min(k * dt, 4.0))
        judge.judge(dt, 0.0, 0j, ALIKE, lean, None)
        judge.settle(dt, 0j, 0.0)
    assert abs(judge.lean) > 1.0
    assert judge.believed == (abs(judge.lean) <= inertial.LARGEST_LEAN)


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


# The filter

@given(seeds)
def test_the_filter_is_the_textbooks(seed):
    rng = np.random.default_rng(seed)
    ours = VelocityFilter()
    ours.restart(complex(*rng.normal(size=2)), 0.1)
    # The way that was coasted, and the four states: velocity, bias, lean, creep.
    state = np.array((0j, ours.velocity, 0j, 0j, 0j))
    covariance = np.diag((0.0, 0.1, velocity_filter.BIAS_STD ** 2, velocity_filter.LEAN_STD ** 2,
                          velocity_filter.CREEP_STD ** 2)).astype(complex)
    for k in range(12):
        h, back = rng.uniform(0.005, 0.1), np.exp(1j * rng.normal(scale=0.3))
        gained = complex(*rng.normal(size=2))
        tilted = complex(*rng.normal(scale=0.01, size=2)) if rng.random() < 0.5 else None
        before = state[1]
        ours.predict(h, back, gained, tilted)
        step = np.array(((back, 0, 0, 0, 0), (0, back, -h, -h * back, 0), (0, 0, 1, 0, 0),
                         (0, 0, 0, back, 0), (0, 0, 0, 0, 1)))
        tilt = tilted or 0.0
        state = step @ state + (0.0, gained - 0.5 * h * tilt, 0.0, tilt, 0.0)
        lean_drift = (velocity_filter.FOLLOWED_DRIFT if tilted is not None
                      else velocity_filter.LEAN_DRIFT * (1.0 + abs(ours.velocity)))
        covariance = step @ covariance @ step.conj().T + h * np.diag(
            (0.0, velocity_filter.VIBRATION ** 2, velocity_filter.BIAS_DRIFT ** 2,
             lean_drift ** 2, velocity_filter.CREEP_DRIFT ** 2 * abs(ours.velocity)))
        acceleration = (state[1] - back * before) / h
        assert ours.acceleration == pytest.approx(acceleration)
        if k % 3:
            ours.coast(h)
            moved = np.eye(5, dtype=complex)
            moved[0, 1] = h
            covariance = moved @ covariance @ moved.T
        if k % 2:
            continue
        measured = np.array((0.0, 1.0, 0.0, 0.0, acceleration))
        innovation, variance = complex(*rng.normal(size=2)), rng.uniform(1e-4, 0.1)
        assert ours.wheel_velocity == pytest.approx(measured @ state)
        ours.correct(innovation, variance)
        with_measured = covariance @ measured.conj()
        total = (measured @ with_measured).real + variance
        state = state + with_measured / total * innovation
        # A time is a number, and no tyre or encoder is off by more than so much.
        state[4] = np.clip(state[4].real, -velocity_filter.LARGEST_CREEP,
                           velocity_filter.LARGEST_CREEP)
        covariance = covariance - np.outer(with_measured, with_measured.conj()) / total
        np.testing.assert_allclose((ours.velocity, ours.bias, ours.lean, ours.creep), state[1:],
                                   atol=1e-9)
        np.testing.assert_allclose(ours.way_error, with_measured[0] / total * innovation,
                                   atol=1e-9)
        ours.way_error = 0j
        assert ours.variance == pytest.approx(covariance[1, 1].real)


@given(st.lists(st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)), max_size=5),
       st.floats(0.001, 0.2))
def test_corrections_are_made_in_full_and_never_at_once(corrections, dt):
    left, total = CatchUp(), 0j
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


@pytest.mark.parametrize('accelerating', [0.0, 3.0])
@pytest.mark.parametrize('within', [True, False])
def test_wheels_come_back_once_they_change_as_the_prediction_does(accelerating, within):
    spell, dt, steps = Coasting(), 0.02, 0
    while not spell.has_regained(dt, 1.0, 1.0 - accelerating * dt * steps, True, within, 0.0, 0.0):
        steps += 1
        if steps > 50:
            break
    expected = coasting.REGAIN_TIME if within else coasting.AGREEMENT_TIME
    assert (steps > 50) == (accelerating > 0.0)
    assert accelerating or dt * steps == pytest.approx(expected, abs=dt)


@pytest.mark.parametrize('within', [True, False])
def test_one_step_of_any_length_is_no_agreement(within):
    spell, offsets = Coasting(), (1.0, -1.0, 1.0)
    assert not any(spell.has_regained(0.4, 1.0, offset + 0j, True, within, 0.0, 0.0)
                   for offset in offsets)


@pytest.mark.parametrize('credible, longest', [
    (lambda step: True, coasting.LONGEST_DISPUTE),
    (lambda step: step > 40, 40 * 0.02 + coasting.LONGEST_DISPUTE),
    (lambda step: step % 90 > 0, coasting.LONGEST_COASTING),
    (lambda step: False, coasting.LONGEST_COASTING)])
def test_wheels_that_are_credible_for_long_are_heard_sooner(credible, longest):
    spell, dt, step = Coasting(), 0.02, 0
    while not spell.is_too_long:
        step += 1
        assert not spell.has_regained(dt, 1.0, (-1.0) ** step + 0j, True, False, 0.0, 0.0)
        spell.dispute(dt, credible(step))
        assert spell.time < 10.0
    assert spell.time == pytest.approx(longest, abs=2.0 * dt)


@pytest.mark.parametrize('spread, longest', [
    (0.0, coasting.LONGEST_DISPUTE), (2.0, coasting.LONGEST_COASTING)])
def test_wheels_that_contradict_each_other_are_doubted_for_longer(spread, longest):
    # Wheels that swing to and fro under a base that stands: alike, or every one otherwise.
    judge, dt, spell = Inertial(0j), 0.02, 0.0
    for k in range(700):
        mean = 0j if k < 100 else 1.8 * np.sin(4.0 * dt * (k - 100)) + 0j
        errors = [spread * dt * 1j ** module for module in range(4)] if k >= 100 else ALIKE
        if any(judge.judge(dt, 0.0, mean, errors, 0j, None)):
            judge.settle(dt, mean, 0.0)
        spell = max(spell, judge.doubt)
    assert spell == pytest.approx(longest, abs=2.0 * dt)


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
