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

"""Tests of wheels that creep, and of stamps that scatter, in the eyes of an accelerometer."""

import math

from benchmarks import drives
from inertial_replay import (
    CORNERS, DRIVE, error_of, FINE, FINE_DRIVE, forces_of, PLACE, RATE, replay, spinning)
import numpy as np
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise

SLOW_DRIVE = drives.smooth_motion(
    CORNERS, FINE, duration=16.0, finest=FINE, pace=drives.Pace(0.3, 0.3, 1.0))


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


def scattered(largest, seed=3, spin=1.0):
    """
    Drive at 50 Hz with readings up to so many fine samples before or after their stamps.

    For 1.5 s, all wheels turn by the factor `spin` too fast. Return the odometry, for how long it
    had coasted (t,), its largest error and that without an accelerometer [m], and the standard
    deviation of the stamps [s].
    """
    fine, rng = drives.from_rest(FINE_DRIVE), np.random.default_rng(seed)
    stamps = np.arange(FINE // RATE, len(fine.stamp) - FINE // RATE, FINE // RATE)
    read = stamps + rng.integers(-largest, largest, len(stamps), endpoint=True)
    drive = fine.at(stamps)._replace(distance=spinning(fine, 9.0, 10.5, spin).distance[read],
                                     angle=fine.angle[read])
    forces = forces_of(fine, FINE // RATE)[1:1 + len(drive.stamp)]
    odo, poses, coasted = replay(drive, forces)
    without = error_of(replay(drive, None)[1], drive)
    spread = math.sqrt(largest * (largest + 1) / 3.0) / FINE
    return odo, coasted, error_of(poses, drive), without, spread


@pytest.mark.parametrize('largest', [1, 2])
def test_stamps_that_scatter_are_no_slip(largest):
    odo, coasted, error, without, spread = scattered(largest)
    # A reading that is late by 4 ms is off by 12 mm at 3 m/s, for that moment.
    assert error < 2.0 * without + 0.01
    assert coasted[2 * RATE:].mean() < 0.02
    assert math.sqrt(odo._solver.inertial._gate.stamps.variance) == pytest.approx(spread, rel=0.4)


@pytest.mark.parametrize('every', [5, 10])
def test_a_driver_that_is_held_up_makes_no_slip_at_any_rate(every):
    # It stamps readings when it gets round to it: often at once, now and then 10 ms late.
    fine, rng = drives.from_rest(FINE_DRIVE), np.random.default_rng(5)
    read = np.arange(every, len(fine.stamp) - 50, every)
    stamps = np.maximum.accumulate(read + rng.exponential(1.0, len(read)).astype(int))
    read, stamps = (x[np.diff(stamps, prepend=0) > 0] for x in (read, stamps))
    drive = fine.at(stamps)._replace(distance=fine.distance[read], angle=fine.angle[read])
    gained = np.cumsum(forces_of(fine, 1), axis=0)[stamps]
    forces = np.diff(gained, axis=0, prepend=0.0) / np.diff(stamps, prepend=0)[:, np.newaxis]
    _, poses, _ = replay(drive, forces)
    assert error_of(poses, drive) < error_of(replay(drive, None)[1], drive) + 0.15


@pytest.mark.parametrize('every', [2, 5, 10, 25])
@pytest.mark.parametrize('ticks', [64, 256])
def test_coarse_encoders_do_no_harm_at_any_rate(every, ticks):
    bit = 2.0 * np.pi / ticks * drives.ROLLING_RADIUS
    drive, forces = SLOW_DRIVE.at(slice(None, None, every)), forces_of(SLOW_DRIVE, every)
    drive = drive._replace(distance=np.floor(drive.distance / bit + (0.1, 0.35, 0.6, 0.9)) * bit)
    noise = OdometryNoise(distance_resolution=bit)
    odo, poses, coasted = replay(drive, forces, noise=noise)
    assert not coasted.any() and not odo.is_waiting and odo.stamp_scatter is None
    assert error_of(poses, drive) < error_of(replay(drive, None, noise=noise)[1], drive) + 0.005


@pytest.mark.parametrize('seed', range(3))
@pytest.mark.parametrize('largest', [1, 2])
def test_slip_shows_in_the_mean_of_many_steps_whose_stamps_scatter(largest, seed):
    # In a single step at 2.5 m/s, stamps make up to 1 m/s of it.
    _, coasted, error, without, _ = scattered(largest, seed, spin=1.5)
    assert error < 0.45 * without
    assert coasted.max() > 1.0


@pytest.mark.parametrize('largest', [7, 9])
def test_an_accelerometer_is_left_out_where_stamps_scatter_too_much(largest):
    odo, coasted, error, without, spread = scattered(largest)
    # It takes some motion to find it out.
    assert error < without + 0.1
    assert not coasted[3 * RATE:].any() and not odo.accelerometer_believed
    assert odo.stamp_scatter == pytest.approx(spread, rel=0.3)


@pytest.mark.parametrize('every', [13, 15, 17, 20, 25])
@pytest.mark.parametrize('spin', [0.0, 1.5])
def test_slip_shows_though_readings_are_sent_more_often_than_they_are_taken(every, spin):
    # Every 26 to 50 ms, but sent every 20 ms; for 1.5 s, all wheels lock or spin.
    fine = drives.from_rest(FINE_DRIVE)
    sent = np.arange(0, len(fine.stamp), FINE // RATE)
    read = sent // every * every
    drive = fine.at(sent)._replace(distance=spinning(fine, 9.0, 10.5, spin).distance[read],
                                   angle=fine.angle[read])
    _, poses, coasted = replay(drive, forces_of(fine, FINE // RATE)[:len(sent)])
    assert error_of(poses, drive) < 0.75 * error_of(replay(drive, None)[1], drive)
    assert coasted[:9 * RATE].mean() < 0.01


@pytest.mark.parametrize('own', [True, False])
@pytest.mark.parametrize('imu', [True, False])
def test_stamps_that_scatter_do_not_show_in_the_twist(own, imu):
    # Even readings are stamped up to 4 ms early or late. A gyro that is heard with them has the
    # same stamps, or else its own.
    fine, rng = drives.from_rest(FINE_DRIVE), np.random.default_rng(8)
    read = np.arange(FINE // RATE, len(fine.stamp) - FINE // RATE, FINE // RATE)
    stamps = read + rng.integers(-2, 2, len(read), endpoint=True)
    drive = fine.at(stamps)._replace(distance=fine.distance[read], angle=fine.angle[read])
    gained = np.cumsum(forces_of(fine, 1), axis=0)[stamps]
    forces = np.diff(gained, axis=0, prepend=0.0) / np.diff(stamps, prepend=0)[:, np.newaxis]
    way = fine.truth[:, 0] + 1j * fine.truth[:, 1]
    velocity = (np.gradient(way, 1.0 / FINE) * np.exp(-1j * fine.truth[:, 2]))[stamps]
    yaw_rate = np.gradient(fine.truth[:, 2], 1.0 / FINE)[stamps]
    odo, off, turning = SwerveOdometry(SwerveKinematics(CORNERS), imu_position=PLACE), [], []
    for k, stamp in enumerate(drive.stamp):
        odo.update(stamp, drive.distance[k], drive.angle[k],
                   fine.yaw[stamps[k] if own else read[k]],
                   specific_force=forces[k] if imu else None)
        off.append(abs(complex(*odo.twist[:2]) - velocity[k]))
        turning.append(odo.twist[2] - yaw_rate[k])
    assert np.sqrt(np.mean(np.square(off[2 * RATE:]))) < 0.1  # 0.5 by the stamps
    assert np.std(turning[2 * RATE:]) < 0.06  # 0.5, where the gyro is heard with the wheels


@pytest.mark.parametrize('factor', [0.0, 1.8])
def test_slip_is_no_scatter_of_stamps(factor):
    odo, _, _ = replay(spinning(DRIVE, 9.0, 9.8, factor))
    assert odo._solver.inertial._gate.stamps.variance < 0.5e-3 ** 2
    assert odo.stamp_scatter is None
