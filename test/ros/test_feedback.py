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

from dataclasses import replace
import math
from time import perf_counter

import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.ros.feedback import JointFeedback

MS = 1_000_000  # ns
TIMEOUT = 500 * MS
DRIVES, STEERINGS = ('a_drive', 'b_drive'), ('a_steer', 'b_steer')
NAMES = [*DRIVES, *STEERINGS]
LAYOUT = Layout(('a', 'b'), SwerveKinematics([(1.0, 0.0), (-1.0, 0.0)]),
                ModuleJoints([0.1, 0.2]), DRIVES, STEERINGS, 'gyro', 'odom', 'base_link')


def feedback(gyro='gyro', **description):
    joints = ModuleJoints([0.1, 0.2], **description)
    return JointFeedback(replace(LAYOUT, joints=joints), gyro, TIMEOUT, 100 * MS)


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
    assert joints.ignored['joint states without any module'] == 1


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


def test_the_gyro_is_interpolated_to_the_stamp_of_the_encoders():
    joints = feedback()
    for k in range(4):
        joints.read(k * 10 * MS, ['gyro'], [3.1 + 0.05 * k], [])
    # Between the samples at 20 and 30 ms, and beyond them.
    assert joints.read(25 * MS, NAMES, [0, 0, 0, 0], []).yaw == pytest.approx(3.225)
    assert joints.read(35 * MS, NAMES, [0, 0, 0, 0], []).yaw == pytest.approx(3.275)


def test_a_wrapped_gyro_is_interpolated_like_a_continuous_one():
    joints = feedback()
    joints.read(0, ['gyro'], [np.pi - 0.02], [])
    joints.read(10 * MS, ['gyro'], [-np.pi + 0.02], [])
    yaw = joints.read(5 * MS, NAMES, [0, 0, 0, 0], []).yaw
    assert yaw == pytest.approx(np.pi)


def test_a_gyro_that_falls_silent_is_not_used_beyond_its_timeout():
    joints = feedback()
    joints.read(0, ['gyro'], [1.0], [0.5])
    sample = joints.read(100 * MS, NAMES, [0, 0, 0, 0], [])
    assert (sample.yaw, sample.yaw_rate) == (pytest.approx(1.05), 0.5)
    sample = joints.read(101 * MS, NAMES, [0, 0, 0, 0], [])
    assert (sample.yaw, sample.yaw_rate) == (None, None)


def yaws_told(period, lag, silent_from, until):
    """Return the yaws at 50 Hz beside a gyro that comes late [s], and then not at all."""
    joints, told, heard = feedback(), [], 0
    joints.gyro.timeout = 200 * MS
    for k in range(round(until * 50)):
        while heard * period + lag <= 0.02 * k and heard * period <= silent_from:
            joints.read_gyro(round(heard * period * 1e9), 0.5 * heard * period, 0.5)
            heard += 1
        told.append(joints.read(20 * MS * k, NAMES, [0, 0, 0, 0], []).yaw)
    return told


@pytest.mark.parametrize('period, lag', [(0.005, 0.0), (0.01, 0.06), (0.05, 0.02), (0.1, 0.0)])
def test_a_gyro_that_is_slow_or_late_as_usual_is_used_all_the_time(period, lag):
    told = yaws_told(period, lag, silent_from=9.0, until=4.0)
    assert None not in told[10:]


@pytest.mark.parametrize('period, lag, reach', [
    (0.005, 0.0, 0.06), (0.005, 0.06, 0.12), (0.1, 0.0, 0.2), (0.05, 0.02, 0.17)])
def test_a_lost_gyro_is_not_carried_on_for_longer_than_it_can_be_trusted(period, lag, reach):
    told = yaws_told(period, lag, silent_from=1.0, until=2.0)
    assert None not in told[10:51]
    assert all(yaw is None for yaw in told[math.floor(50 * (1.0 + reach)) + 1:])


def test_gyro_samples_of_no_use_are_counted():
    joints = feedback()
    joints.read(5 * MS, [*NAMES, 'gyro'], [0, 0, 0, 0, 1.0], [])
    joints.read_gyro(6 * MS, np.nan, np.inf)
    joints.read_gyro(4 * MS, 1.0, 0.0)
    assert joints.ignored == {'unusable gyro samples': 2}
    assert joints.read(6 * MS, NAMES, [0, 0, 0, 0], []).yaw == 1.0


def test_the_gyro_joint_is_ignored_where_the_gyro_comes_from_elsewhere():
    sample = feedback(gyro=None).read(1, [*NAMES, 'gyro'], [0, 0, 0, 0, 1.0], [])
    assert sample.yaw is None


def rates_heard(rate_at, seconds=60, every=4):
    """Return the turn [rad] of joints at 50 Hz and a gyro of rates four times as fast."""
    joints, turned = feedback(), []
    for k in range(200 * seconds):
        stamp = 5 * MS * k
        joints.read_gyro(stamp, np.nan, rate_at(0.005 * k))
        if k % every == 1:
            sample = joints.read(stamp + 2 * MS, NAMES, [0, 0, 0, 0], [])
            turned.append(sample.rate_integral)
    return turned[-1] - turned[0]


def test_white_noise_of_a_fast_gyro_is_averaged_over_all_samples():
    errors = [rates_heard(lambda _, random=np.random.default_rng(seed): 0.08 * random.normal(),
                          seconds=10) for seed in range(5)]
    # As many independent samples as there are: not those alone that meet the joints.
    assert np.sqrt(np.mean(np.square(errors))) < 1.5 * 0.08 * np.sqrt(0.005 * 10)


def test_vibration_near_the_rate_of_the_joints_does_not_turn_the_base():
    assert abs(rates_heard(lambda t: 0.05 * np.sin(2.0 * np.pi * 50.1 * t), seconds=10)) < 1e-3


def test_joints_older_than_the_newest_rates_are_told_what_was_said_then():
    joints = feedback()
    for k in range(21):
        joints.read_gyro(5 * MS * k, 0.1 * (0.005 * k) ** 2, 0.2 * 0.005 * k)
    sample = joints.read(51 * MS, NAMES, [0, 0, 0, 0], [])
    assert sample.yaw == pytest.approx(0.1 * 0.051 ** 2, abs=1e-6)
    assert sample.yaw_rate == pytest.approx(0.2 * 0.051)
    assert sample.rate_integral == pytest.approx(0.1 * 0.051 ** 2)


def test_rate_samples_that_are_lost_leave_the_turn_as_it_is():
    joints = feedback()
    for k in [*range(10), 15, *range(17, 30), 33]:
        joints.read_gyro(5 * MS * k, np.nan, 1.0)
    sample = joints.read(165 * MS, NAMES, [0, 0, 0, 0], [])
    assert sample.rate_integral == pytest.approx(0.165)


@pytest.mark.parametrize('lag', [0, 30, 90])
@pytest.mark.parametrize('silence', [40, 95, 105, 300])
def test_an_integral_that_lacks_a_silence_is_left_out_once_it_is_back(lag, silence):
    joints, last = feedback(), None
    for now in range(0, 2000, 5):
        if not 1000 <= now - lag < 1000 + silence:
            joints.read_gyro((now - lag) * MS, np.nan, 1.0)
        if now % 20:
            continue
        sample = joints.read(now * MS, NAMES, [0, 0, 0, 0], [])
        if sample.yaw_rate is None:
            continue
        if last is not None and sample.rate_integral is not None:
            assert sample.rate_integral - last[1] == pytest.approx(0.001 * (now - last[0]))
        last = None if sample.rate_integral is None else (now, sample.rate_integral)
    assert last is not None


def test_an_integral_is_left_out_once_a_gyro_whose_clock_was_set_back_is_told_again():
    joints = feedback()
    gyro = [(0, 1.0), (10, 1.0), (20, 1.0), (-900, 1.0), (-890, 1.0)]
    for stamp, rate in gyro:
        joints.read_gyro((1000 + stamp) * MS, np.nan, rate)
    assert joints.read(115 * MS, NAMES, [0, 0, 0, 0], []).rate_integral is None
    assert joints.read(120 * MS, NAMES, [0, 0, 0, 0], []).rate_integral is not None


@pytest.mark.parametrize('rate', [np.nan, 0.0])
def test_a_yaw_set_anew_is_not_spread_over_the_steps(rate):
    joints = feedback()
    joints.read_gyro(0, 0.0, rate)
    joints.read_gyro(10 * MS, 0.3, rate)
    assert joints.read(5 * MS, NAMES, [0, 0, 0, 0], []).yaw == 0.0
    assert joints.read(12 * MS, NAMES, [0, 0, 0, 0], []).yaw == 0.3


def test_an_orientation_that_stands_still_leaves_the_turn_to_the_rate():
    joints = feedback()
    for k in range(51):
        joints.read_gyro(10 * MS * k, 0.0, 1.0)
    sample = joints.read(500 * MS, NAMES, [0, 0, 0, 0], [])
    assert sample.yaw is None
    assert sample.rate_integral == pytest.approx(0.5)
    assert joints.gyro.yaw_stands_still


def test_a_gyro_that_repeats_itself_is_silent_until_it_goes_on():
    joints = feedback()

    def sample(stamp, yaw, rate):
        joints.read_gyro(stamp * MS, yaw, rate)
        return joints.read(stamp * MS, NAMES, [0, 0, 0, 0], [])
    for k in range(50):
        moving = sample(10 * k, 0.01 * k, 1.0)
    assert moving.yaw == pytest.approx(0.49)
    for k in range(50, 100):
        frozen = sample(10 * k, 0.49, 1.0)
    assert frozen.yaw is None and frozen.yaw_rate is None
    assert joints.ignored['unusable gyro samples'] > 20
    assert not joints.gyro.yaw_stands_still
    again = sample(1000, 1.0, 0.9)
    assert again.yaw == pytest.approx(1.0) and again.rate_integral is None


def test_velocities_that_the_positions_contradict_are_left_out_and_named():
    joints = feedback()
    samples = [joints.read(20 * MS * k, NAMES, [0.2 * k, 0.2 * k, 0, 0], [10, 95.5, 0, 0])
               for k in range(100)]
    assert not any(sample.velocities for sample in samples[1:])
    (joint, explanation), = joints.speeds.contradictions()
    assert joint == 1 and 'rpm' in explanation
