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

"""A gyro joint, as it comes, in the samples of the modules: no graph needed."""

import math

import numpy as np
import pytest
from two_modules import feedback, MS, NAMES


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
