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

"""From joint states, as they come, to complete samples: no graph needed."""

import math
from time import perf_counter

import numpy as np
import pytest
from two_modules import DRIVES, feedback, MS, NAMES, STEERINGS, TIMEOUT


def test_a_complete_message_is_one_sample():
    sample = feedback().read(7, [*NAMES, 'gyro'], [10, 20, 0.3, 0.4, 0.5], [1, 2, 0, 0, 0.6])
    np.testing.assert_allclose(sample.distances, [1.0, 4.0])
    np.testing.assert_allclose(sample.velocities, [0.1, 0.4])
    np.testing.assert_allclose(sample.angles, [0.3, 0.4])
    assert (sample.stamp, sample.yaw, sample.yaw_rate) == (7, 0.5, 0.6)
    assert not sample.continuous


def test_a_sample_of_one_message_is_not_merged():
    joints = feedback()
    for stamp in range(3):
        joints.read(stamp, NAMES, [0, 0, 0, 0], [])
    assert joints.merged == 0


@pytest.mark.parametrize('yaw, rate, without', [
    (0.1, 0.2, 0), (math.nan, 0.2, 0), (0.1, math.nan, 0), (math.nan, math.nan, 1)])
def test_samples_without_a_gyro_are_counted(yaw, rate, without):
    joints = feedback()
    for stamp, heard in ((0, True), (200 * MS, False), (400 * MS, True)):
        velocities = [0, 0, 0, 0, 0.2 if heard else rate]
        joints.read(stamp, [*NAMES, 'gyro'], [0, 0, 0, 0, 0.1 if heard else yaw], velocities)
    assert joints.without_gyro == without


def test_joints_are_found_by_name_among_others_in_any_order():
    names = ['arm', 'b_steer', 'a_drive', 'gyro', 'a_steer', 'camera', 'b_drive']
    sample = feedback().read(1, names, [9, 0.4, 10, 0.5, 0.3, 9, 20], [])
    np.testing.assert_allclose(sample.distances, [1.0, 4.0])
    np.testing.assert_allclose(sample.angles, [0.3, 0.4])
    assert sample.velocities is None
    assert sample.yaw == 0.5


def test_a_message_of_very_many_joints_does_not_hold_the_node_up():
    names = [*NAMES, *(f'finger_{index}' for index in range(50_000))]
    began = perf_counter()
    assert feedback().read(1, names, [0.0] * len(names), []) is not None
    assert perf_counter() - began < 1.0


def test_a_message_of_other_joints_is_counted_and_harmless():
    joints = feedback()
    assert joints.read(1, ['arm'], [1.0], []) is None
    assert joints.foreign == 1 and not joints.ignored


def test_split_messages_make_one_sample_for_each_complete_set():
    joints = feedback()
    for round_, stamp in enumerate((10 * MS, 20 * MS)):
        assert joints.read(stamp, DRIVES, [round_ * 10, 0], []) is None
        sample = joints.read(stamp, STEERINGS, [0, 0], [])
        assert sample.stamp == stamp
        assert sample.distances[0] == pytest.approx(round_ * 1.0)
    assert not joints.ignored
    assert joints.merged == 2


def test_two_publishers_at_different_rates_step_with_the_slower():
    joints = feedback()
    stamps = [sample.stamp for k in range(10) for sample in (
        joints.read((2 * k + 1) * MS, ['a_drive', 'a_steer'], [k, 0], []),
        joints.read((2 * k + 2) * MS, ['b_drive', 'b_steer'], [k, 0], []) if k % 2 else None)
        if sample is not None]
    assert stamps == [(2 * k + 2) * MS for k in range(1, 10, 2)]


@pytest.mark.parametrize('lost', range(1, 25))
def test_split_messages_lost_in_a_stall_are_not_taken_for_a_wrap(lost):
    """After the stall old drives meet new steerings, and the next drives are far ahead of them."""
    joints, sample = feedback(), None
    for k in range(60):
        if k == 20:
            joints.read(20 * k * MS, DRIVES, [0.2 * k] * 2, [])
        if 20 <= k < 20 + lost:
            continue
        if k != 20 + lost:
            joints.read(20 * k * MS, DRIVES, [0.2 * k] * 2, [])
        sample = joints.read(20 * k * MS, STEERINGS, [0.0] * 2, []) or sample
    assert not joints.unwrapper.is_found
    np.testing.assert_allclose(sample.distances, [0.2 * 59 * 0.1, 0.2 * 59 * 0.2])


@pytest.mark.parametrize('bad', [np.nan, np.inf, -np.inf])
def test_a_joint_that_is_not_finite_is_not_updated(bad):
    joints = feedback()
    assert joints.read(1 * MS, NAMES, [1, 2, bad, 0.4], []) is None
    assert joints.ignored['unusable joint values'] == 1
    sample = joints.read(2 * MS, NAMES, [1, 2, 0.3, 0.4], [])
    np.testing.assert_allclose(sample.angles, [0.3, 0.4])


def test_joints_that_keep_a_set_from_being_complete_are_named():
    joints = feedback()
    assert joints.missing is None
    joints.read(1 * MS, NAMES, [1, 2, np.nan, 0.4], [])
    assert joints.missing == f'joint_states have no usable position of {NAMES[2]}'
    joints.read(2 * MS, NAMES, [1, 2, 0.3, 0.4], [])
    assert joints.missing is None
    joints.read(3 * MS, NAMES, [1, np.nan, 0.3], [])
    assert joints.missing == f'joint_states have no usable position of {NAMES[1]}, {NAMES[3]}'


def test_short_positions_leave_the_joints_behind_them_alone():
    joints = feedback()
    assert joints.read(1 * MS, NAMES, [1, 2, 0.3], []) is None
    assert joints.read(2 * MS, NAMES, [1, 2, 0.3, 0.4], []).angles[1] == 0.4


def test_a_joint_listed_twice_is_not_updated():
    joints = feedback()
    assert joints.read(1, [*NAMES, 'b_steer'], [1, 2, 0.3, 0.4, 0.9], []) is None


def test_a_repeated_message_is_dropped_and_counted():
    joints = feedback()
    joints.read(5 * MS, NAMES, [0, 0, 0, 0], [])
    assert joints.read(5 * MS, NAMES, [9, 9, 9, 9], []) is None
    assert joints.read(4 * MS, NAMES, [9, 9, 9, 9], []) is None
    assert joints.ignored['repeated or old joint states'] == 2
    assert joints.read(6 * MS, NAMES, [1, 1, 0, 0], []).continuous


def test_a_gap_or_a_clock_set_back_breaks_the_continuity_once():
    joints = feedback()
    stamps = [0, 10 * MS, 10 * MS + TIMEOUT + 1, 20 * MS + TIMEOUT, 5 * MS, 15 * MS]
    samples = [joints.read(stamp, NAMES, [0, 0, 0, 0], []) for stamp in stamps]
    assert [s.continuous for s in samples] == [False, True, False, True, False, True]


def test_velocity_stands_in_for_a_missing_drive_position():
    joints = feedback()
    names = [*STEERINGS, *DRIVES]
    # The short positions cover the steering only; the drives are known by velocity alone.
    for k in range(101):
        sample = joints.read(k * 10 * MS, names, [0.3, 0.4], [0, 0, 0.02 * k, 1.0])
    # One second at a speed that rises from 0 to 2 rad/s, and one at 1 rad/s.
    np.testing.assert_allclose(sample.distances, [0.1 * 1.0, 0.2 * 1.0])


@pytest.mark.parametrize('absurd', [np.nan, np.inf, 1e300])
@pytest.mark.parametrize('position', [np.nan, 0.0])
def test_an_absurd_velocity_does_not_stand_in_for_ever(absurd, position):
    joints = feedback()
    joints.read(0, NAMES, [position, position, 0.0, 0.0], [absurd, absurd, 0.0, 0.0])
    for time in (20, 40):
        sample = joints.read(time * MS, NAMES, [np.nan, np.nan, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0])
    assert sample is not None


def test_a_sample_tells_what_the_modules_do_and_not_their_joints():
    joints = feedback(drive_ratios=[5.0, -5.0], steering_ratios=[1.0, -2.0],
                      steering_offsets=[0.5, -0.5], drive_coupling_ratios=[2.0, 0.0])
    sample = joints.read(1, NAMES, [10.0, 20.0, 1.0, 2.0], [1.0, 2.0, 0.1, 0.2])
    np.testing.assert_allclose(sample.angles, [0.5, -1.25])
    np.testing.assert_allclose(sample.distances, [0.1 * 9.0 / 5.0, 0.2 * -4.0])
    np.testing.assert_allclose(sample.velocities, [0.1 * 0.8 / 5.0, 0.2 * -0.4])


def test_velocities_that_the_positions_contradict_are_left_out_and_named():
    joints = feedback()
    samples = [joints.read(20 * MS * k, NAMES, [0.2 * k, 0.2 * k, 0, 0], [10, 95.5, 0, 0])
               for k in range(100)]
    assert not any(sample.velocities for sample in samples[1:])
    (joint, explanation), = joints.speeds.contradictions()
    assert joint == 1 and 'rpm' in explanation
