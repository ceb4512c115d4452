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

"""Messages of joints and of an accelerometer that are lost in bursts."""

from benchmarks import drives
from inertial_replay import (
    CORNERS, DRIVE, error_of, FINE, FORCES, forces_of, RATE, replay, spinning)
import numpy as np
import pytest

PERIOD = 1.0 / RATE


def in_gaps(stamp, gap):
    """Return which samples (t,) are lost if every second has a gap of this duration [s]."""
    phase = stamp % 1.0
    return (phase > 0.3 + 0.5 * PERIOD) & (phase < 0.3 + gap - 0.5 * PERIOD)


def without_gaps(drive, forces, gap):
    """Return the drive without the samples that are lost, and the mean forces of its steps."""
    kept = np.flatnonzero(~in_gaps(drive.stamp, gap))
    means = [forces[last + 1:now + 1].mean(axis=0) for last, now in zip(kept, kept[1:])]
    return drive.at(kept), np.vstack((forces[:1], means))


@pytest.mark.parametrize('pace, gap', [
    (drives.GENTLE, 0.35), (drives.FAST, 0.2), (drives.FAST, 0.3)])
@pytest.mark.parametrize('seed', range(3))
def test_a_long_step_does_not_make_wheels_with_grip_seem_to_slip(pace, gap, seed):
    fine = drives.smooth_motion(CORNERS, FINE, seed, 16.0, 2000, pace)
    drive, forces = without_gaps(
        fine.at(slice(None, None, FINE // RATE)), forces_of(fine, FINE // RATE), gap)
    _, by_wheels, _ = replay(drive, None)
    odo, poses, coasted = replay(drive, forces)
    assert not coasted.any()
    assert error_of(poses, drive) < 1.1 * error_of(by_wheels, drive)
    assert odo.stamp_scatter is None


@pytest.mark.parametrize('start', [4.0, 9.0])
def test_wheels_that_spin_for_all_of_a_long_step_are_in_the_covariance(start):
    # They roll further by half, from the beginning of a gap to its end.
    drive, forces = without_gaps(DRIVE, FORCES, 0.44)
    rolled = np.diff(drive.distance, axis=0, prepend=0.0)
    rolled[np.searchsorted(drive.stamp, start + 0.5)] *= 1.5
    drive = drive._replace(distance=np.cumsum(rolled, axis=0))
    odo, poses, _ = replay(drive, forces)
    error = (poses - drive.truth)[-1]
    assert np.hypot(*error[:2]) > 0.1
    assert error @ np.linalg.solve(odo.pose_covariance, error) < 12.0


@pytest.mark.parametrize('gap', [0.14, 0.3])
def test_a_silent_accelerometer_still_knows_where_the_floor_leans_to(gap):
    leaking = 0.5 * np.exp(1j * (0.5 - DRIVE.yaw))
    forces = FORCES + np.column_stack((leaking.real, leaking.imag))
    forces[in_gaps(DRIVE.stamp, gap)] = np.nan
    odo, poses, coasted = replay(forces=forces)
    assert abs(complex(*odo.lean) - leaking[-1]) < 0.1
    assert not coasted.any()
    assert error_of(poses) < 1e-3


@pytest.mark.parametrize('begin', [0.0, 0.1])
def test_wheels_that_slip_at_the_end_of_a_gap_do_not_send_the_base_astray(begin):
    """They spin for 0.06 s while the accelerometer, silent before, cannot tell."""
    silent = (DRIVE.stamp > 6.0) & (DRIVE.stamp < 6.2)
    forces = np.where(silent[:, np.newaxis], np.nan, FORCES)
    rolled = np.diff(DRIVE.distance, axis=0, prepend=0.0)
    slips = (DRIVE.stamp > 6.1 + begin) & (DRIVE.stamp < 6.21 + begin)
    rolled[slips] *= 1.4
    drive = DRIVE._replace(distance=np.cumsum(rolled, axis=0))
    _, by_wheels, _ = replay(drive, None)
    _, poses, coasted = replay(drive, forces)
    assert coasted.max() < 0.2
    assert error_of(poses, drive) < 1.1 * error_of(by_wheels, drive)


@pytest.mark.parametrize('lost', [1, 3])
@pytest.mark.parametrize('before', range(3))
def test_a_force_that_is_lost_as_wheels_begin_to_spin_has_them_believed_no_more(lost, before):
    slipping = spinning(DRIVE, 9.0, 9.8, 1.8)
    usual = error_of(replay(slipping)[1])
    forces = FORCES.copy()
    first = 450 - before
    forces[first:first + lost] = np.nan
    assert error_of(replay(slipping, forces)[1]) < usual + 0.03


def test_forces_that_are_lost_now_and_then_do_no_harm():
    forces = FORCES.copy()
    forces[np.random.default_rng(0).random(len(forces)) < 0.1] = np.nan
    _, poses, coasted = replay(forces=forces)
    assert not coasted.any()
    assert error_of(poses) < 2e-3


@pytest.mark.parametrize('seed', range(3))
def test_a_force_over_more_than_a_second_tells_nothing_of_the_velocity(seed):
    fine = drives.smooth_motion(CORNERS, FINE, seed, 16.0, 2000, drives.FAST)
    drive = fine.at(slice(None, None, FINE // RATE))
    kept = np.flatnonzero(drive.stamp % 4.0 < 1.0)
    all_forces = forces_of(fine, FINE // RATE)
    means = [all_forces[last + 1:now + 1].mean(axis=0) for last, now in zip(kept, kept[1:])]
    drive, forces = drive.at(kept), np.vstack((all_forces[:1], means))
    _, by_wheels, _ = replay(drive, None)
    _, poses, coasted = replay(drive, forces)
    assert not coasted.any()
    assert error_of(poses, drive) == pytest.approx(error_of(by_wheels, drive), rel=0.1)
