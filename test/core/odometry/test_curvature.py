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

"""Tests of the sideways term of a wheel's path: exact to the next order, and never a harm."""

from benchmarks import drives
from hypothesis import given, strategies as st
import numpy as np
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.module_paths import ModulePaths
from swerve_kinematics.core.odometry.odometry import SwerveOdometry

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
FAST = drives.smooth_motion(CORNERS, 100, duration=20.0, finest=2000, pace=drives.FAST)


def odometry(**settings):
    """Return an odometry that trusts its gyro."""
    return SwerveOdometry(SwerveKinematics(CORNERS), **{'estimate_gyro_bias': False, **settings})


def error_of(drive, **gyro):
    """Return the absolute trajectory error of a drive [m]."""
    return drives.position_error(drives.replay(odometry(), drive, **gyro), drive)


def chord_error_of(drive, monkeypatch):
    """Return the same with chords alone."""
    with monkeypatch.context() as patch:
        patch.setattr('swerve_kinematics.core.odometry.module_paths.LARGEST_TURN', -1.0)
        return error_of(drive)


def sideways(before, now, used=(0,)):
    """
    Return how far [m] the path of each module ends to the left of its chord.

    Both steps are `(duration, distance, turned)`; modules not in `used` had no part in the first.
    """
    paths, count = ModulePaths(len(used) + 1), len(used) + 1
    paths.update([0.0] * count, [0.0] * count)
    paths.update([before[1]] * count, [before[2]] * count)
    paths.keep(before[0], 0.0, used)
    paths.update([before[1] + now[1]] * count, [before[2] + now[2]] * count)
    paths.take_duration(now[0])
    return [(path / direction).imag for path, direction in
            zip(paths.of(tuple(range(count)), 0.0), paths.directions)]


small = st.floats(-0.2, 0.2)
slow = st.floats(-0.1, 0.1)  # turns no wheel further than LARGEST_TURN


@given(small, small, slow, slow, st.floats(0.41, 2.4))
def test_linear_speed_and_turning_rate_end_where_the_formula_says(v, v_rate, c, c_rate, ratio):
    # Speed v + v_rate t and turning rate c + c_rate t about the middle of a step of one
    # second; the means of the step before are their values in the middle of that one.
    before, t = 1.0 / ratio, np.linspace(-0.5, 0.5, 1001)
    earlier = -0.5 * (1.0 + before)
    distance, turned = (v + v_rate * earlier) * before, (c + c_rate * earlier) * before
    aside, _ = sideways((before, distance, turned), (1.0, v, c))
    # The direction, as seen from halfway between those at the two ends, to the first order.
    values = (v + v_rate * t) * (c * t + c_rate * (t * t - 0.25) / 2.0)
    assert aside == pytest.approx(np.mean(0.5 * (values[1:] + values[:-1])), abs=1e-6)


@given(st.floats(-5.0, 5.0), small, st.floats(0.1, 10.0))
def test_a_constant_motion_has_no_bend(distance, turned, ratio):
    aside = sideways((1.0, distance, turned), (ratio, ratio * distance, ratio * turned))
    assert max(map(abs, aside)) < 1e-12


def test_modules_without_a_past_and_steps_of_another_length_stay_chords():
    without, beside = sideways((1.0, 0.1, 0.1), (1.0, 0.2, 0.3), used=(1,))
    assert abs(without) < 1e-12 < 1e-4 < abs(beside)
    for duration in (0.3, 3.0):
        assert max(map(abs, sideways((1.0, 0.1, 0.1), (duration, 0.2, 0.3)))) < 1e-12


@pytest.mark.parametrize('kept', ['uneven', 'dropped'])
def test_uneven_steps_and_drops_are_better_for_it(kept, monkeypatch):
    rng = np.random.default_rng(5)
    if kept == 'uneven':
        chosen = np.unique(np.cumsum(rng.integers(2, 5, 400)))
        drive = FAST.at(np.concatenate(([0], chosen[chosen < len(FAST.stamp)])))
    else:
        mask = rng.random(len(FAST.stamp)) > 0.1
        mask[0] = True
        drive = FAST.at(mask)
    assert error_of(drive) < 0.3 * chord_error_of(drive, monkeypatch)


@pytest.mark.parametrize('rate', [20, 50, 100])
def test_quantised_encoders_are_no_worse_for_it(rate, monkeypatch):
    slow = drives.slower(FAST, rate)
    ours, chords = [], []
    for seed in range(6):
        faulty = drives.faulty(slow, np.random.default_rng(seed), bias=0.0)
        ours.append(error_of(faulty))
        chords.append(chord_error_of(faulty, monkeypatch))
    assert np.mean(ours) < 1.02 * np.mean(chords)


def test_a_gap_leaves_no_bend_behind():
    # The same motion, once as it is and once after a step in another direction and a gap.
    angle = np.array((0.3, 0.4, 0.5, 0.6))
    poses = []
    for interrupted in (False, True):
        odo = odometry()
        if interrupted:
            odo.update(0.0, np.zeros(4), angle - 0.5, 0.0)
            odo.update(0.1, np.full(4, 0.2), angle - 0.1, 0.0)
            odo.reset()
            odo.reprime()
        odo.update(0.2, np.full(4, 0.3), angle, 0.0)
        odo.update(0.3, np.full(4, 0.4), angle + 0.1, 0.1)
        poses.append(odo.pose)
    np.testing.assert_array_equal(*poses)


def test_a_module_that_slipped_in_the_step_before_has_no_past():
    poses = []
    for spun in (0.0, 0.3):
        odo, distance = odometry(), np.zeros(4)
        for k in range(4):
            distance = distance + 0.1
            if k == 2:
                distance[3] += spun
            odo.update(0.1 * k, distance, np.full(4, 0.05 * k ** 2), 0.0)
        poses.append(odo.pose)
    assert np.abs(poses[1] - poses[0])[:2].max() < 3e-4
