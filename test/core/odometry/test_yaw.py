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

"""Which word of a gyro is believed: its yaw, its rate, or neither."""

from hypothesis import given, strategies as st
import numpy as np
import pytest
from strategies import seeds

from swerve_kinematics import SwerveKinematics, SwerveOdometry
from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.odometry.gyro_watch import GyroWatch, LARGEST_CREDIT
from swerve_kinematics.core.odometry.yaw import YawTracker

RATES = st.floats(-20.0, 20.0)
CORNERS = np.array([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
TANGENTS = np.arctan2(CORNERS[:, 0], -CORNERS[:, 1])
RADIUS = np.hypot(0.3, 0.2)
DT = 0.02


def heard(tracker, *samples, dt=0.02):
    """Return the turns a tracker tells for (yaw, rate) samples."""
    return [tracker.turn(dt, yaw, rate) for yaw, rate in samples]


class Turntable:
    """A base that turns on the spot, and an odometry that hears of it."""

    def __init__(self):
        self.odometry = SwerveOdometry(SwerveKinematics(CORNERS), estimate_gyro_bias=False)
        self._stamp = self._wheels = 0.0
        self._noise = np.random.default_rng(0)

    def step(self, wheel_rate=0.0, yaw=None, rate=None, dt=DT, slip=(1.0,) * 4):
        """Turn the wheels as for a rate of the base [rad/s]; the gyro says yaw and rate."""
        self._stamp += dt
        self._wheels += wheel_rate * dt
        self.odometry.update(self._stamp, RADIUS * self._wheels * np.array(slip), TANGENTS,
                             yaw, rate)

    def run(self, duration, wheel_rate=0.0, yaw_rate=None, rate=None, yaw=0.0, noise=0.0):
        """Go on for a time [s] with constant rates; None: the gyro does not say that."""
        for k in range(round(duration / DT)):
            error = noise * self._noise.standard_normal(2)
            self.step(wheel_rate,
                      None if yaw_rate is None else yaw + yaw_rate * k * DT + error[0],
                      None if rate is None else rate + error[1])
        return self.odometry.yaw


@given(st.lists(st.floats(-0.5, 0.5), min_size=2, max_size=20))
def test_wrapped_yaw_tells_the_same_as_continuous(turns):
    yaws = 3.0 + np.cumsum(turns)
    continuous = heard(YawTracker(), *((yaw, None) for yaw in yaws))
    wrapped = heard(YawTracker(), *((wrap_angle(yaw), None) for yaw in yaws))
    assert continuous[0] is None and wrapped[0] is None
    np.testing.assert_allclose(wrapped[1:], continuous[1:], atol=1e-12)


@given(RATES, RATES)
def test_rate_is_integrated_by_the_trapezoid_rule(first, second):
    turns = heard(YawTracker(), (None, first), (None, second), dt=0.1)
    assert turns[1] == pytest.approx(0.05 * (first + second))


def test_yaw_is_preferred_to_the_rate():
    assert heard(YawTracker(), (0.0, 5.0), (0.1, 5.0))[1] == pytest.approx(0.1)


def test_source_that_comes_back_does_not_make_up_for_the_gap():
    turns = heard(YawTracker(), (0.0, None), (np.nan, None), (None, None), (0.5, None),
                  (0.6, None))
    assert turns[:4] == [None] * 4
    assert turns[4] == pytest.approx(0.1)


def test_rate_stands_in_while_the_yaw_is_away():
    turns = heard(YawTracker(), (0.0, 1.0), (None, 1.0), (9.0, 1.0), (9.1, 1.0))
    np.testing.assert_allclose(turns[1:], [0.02, 0.02, 0.1])


def test_yaw_that_jumps_faster_than_a_gyro_can_turn_is_no_turn():
    assert heard(YawTracker(), (0.0, None), (3.0, None), (3.1, None))[1:] == [
        None, pytest.approx(0.1)]


@pytest.mark.parametrize('jump', [0.1, 0.3, -0.65, 3.0])
@pytest.mark.parametrize('rate', [None, 0.0])
@pytest.mark.parametrize('turning', [0.0, 1.0])
def test_a_yaw_set_anew_is_no_turn_and_is_counted(jump, rate, turning):
    base = Turntable()
    rate = None if rate is None else turning
    base.run(1.0, turning, turning, rate)
    base.run(1.0, turning, turning, rate, yaw=turning + jump)
    assert base.odometry.yaw == pytest.approx(1.98 * turning, abs=1e-3)
    assert base.odometry.yaw_jumps == 1
    assert base.odometry.pose_covariance[2, 2] < 0.01 ** 2


@given(st.lists(st.tuples(st.floats(0.005, 0.5), st.floats(-15.0, 15.0)), min_size=2))
def test_an_honest_gyro_is_believed_whatever_samples_are_lost(steps):
    base, yaw, rate = Turntable(), 0.0, 0.0
    base.step(0.0, 0.0, 0.0)
    for dt, acceleration in steps:
        # Less than half a turn in the longest step: more cannot be told from less.
        before, rate = rate, min(max(rate + acceleration * dt, -5.0), 5.0)
        mean = 0.5 * (before + rate)
        yaw += mean * dt
        base.step(mean, yaw, rate, dt)
    assert base.odometry.yaw == pytest.approx(yaw, abs=1e-6)
    assert base.odometry.gyro_trusted == (True, True)
    assert base.odometry.yaw_jumps == 0


@pytest.mark.parametrize('has_yaw, has_rate', [(True, True), (True, False), (False, True)])
@pytest.mark.parametrize('wheels, turn', [(2.0, 0.0), (0.0, 2.0), (2.0, 1.0), (1.0, 2.0)])
def test_wheels_that_slide_on_ice_do_not_refute_a_gyro(has_yaw, has_rate, wheels, turn):
    base = Turntable()
    base.run(4.0, wheels, turn if has_yaw else None, turn if has_rate else None, noise=1e-3)
    assert base.odometry.yaw == pytest.approx(4.0 * turn, abs=0.1)
    assert base.odometry.gyro_trusted == (True, True)


@pytest.mark.parametrize('wheels', [0.0, -4.0, 8.0])
def test_a_base_that_turns_fast_on_wheels_that_lock_or_spin_has_not_jumped(wheels):
    base = Turntable()
    base.run(1.0, 4.0, 4.0)
    base.run(0.5, wheels, 4.0, yaw=4.0)
    assert base.odometry.yaw == pytest.approx(5.92, abs=1e-6)
    assert base.odometry.yaw_jumps == 0


@pytest.mark.parametrize('has_yaw, has_rate', [(True, True), (True, False), (False, True)])
@pytest.mark.parametrize('wheels, turn', [(-2.0, 2.0), (-0.5, 1.0), (0.2, 2.0)])
def test_a_push_does_not_refute_a_gyro_that_the_wheels_bore_out(has_yaw, has_rate, wheels, turn):
    base = Turntable()
    for start in (0.0, 3.0 * (1.0 + turn)):
        for duration, rolled, turned in ((3.0, 1.0, 1.0), (3.0, wheels, turn)):
            base.run(duration, rolled, turned if has_yaw else None, turned if has_rate else None,
                     yaw=start, noise=1e-3)
            start += duration * turned
            assert base.odometry.gyro_trusted == (True, True)
    assert base.odometry.yaw == pytest.approx(6.0 * (1.0 + turn), abs=0.1)


@pytest.mark.parametrize('wheels, turn', [(-1.0, 1.0), (0.2, 2.0)])
def test_wheels_refute_a_gyro_that_they_bore_out_if_they_do_so_for_long(wheels, turn):
    base = Turntable()
    base.run(20.0, 1.0, rate=1.0, noise=1e-3)
    base.run(LARGEST_CREDIT + 1.5, wheels, rate=turn, noise=1e-3)
    assert base.odometry.gyro_trusted == (True, False)


def test_a_wheel_that_slips_does_not_refute_a_gyro():
    base = Turntable()
    for k in range(200):
        base.step(1.0, 0.02 * k, 1.0, slip=(2.0, 1.0, 1.0, 1.0))
    assert base.odometry.yaw == pytest.approx(3.98)
    assert base.odometry.gyro_trusted == (True, True)


@pytest.mark.parametrize('factor', [-1.0, 0.0, 57.3, -57.3])
@pytest.mark.parametrize('turning', [0.5, -1.0])
def test_a_rate_of_another_sign_or_unit_is_dropped_within_a_second(factor, turning):
    base = Turntable()
    base.run(1.2, turning, rate=factor * turning)
    assert base.odometry.gyro_trusted == (True, False)
    told = base.run(4.0, turning, rate=factor * turning)
    assert wrap_angle(told - 5.18 * turning) == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize('frozen', [0.3, -0.2, 2.5])
@pytest.mark.parametrize('has_yaw', [True, False])
def test_a_gyro_that_repeats_itself_while_the_wheels_turn_otherwise_is_dropped(frozen, has_yaw):
    base, yaw = Turntable(), 0.0 if has_yaw else None
    base.run(1.0, frozen, frozen if has_yaw else None, frozen, noise=1e-3)
    for wheels in (1.0, -1.0):
        base.run(1.3, wheels, yaw, frozen, yaw=frozen)
        assert base.odometry.gyro_trusted[1] is False
    told = base.run(3.0, 1.0, yaw, frozen, yaw=frozen)
    assert told == pytest.approx(0.98 * frozen + 3.0, abs=0.1)
    base.run(3.0, 1.0, 1.0 if has_yaw else None, 1.0, noise=1e-3)
    assert base.odometry.gyro_trusted == (True, True)


def test_a_reversed_rate_beside_a_good_yaw_is_not_needed_but_reported():
    base = Turntable()
    assert base.run(3.0, 1.0, 1.0, -1.0) == pytest.approx(2.98)
    assert base.odometry.gyro_trusted == (True, False)


def test_a_reversed_sensor_gives_way_to_the_wheels():
    base = Turntable()
    base.run(1.5, 1.0, -1.0, -1.0)
    assert base.odometry.gyro_trusted == (False, False)
    assert base.run(3.0, 1.0, -1.0, -1.0) == pytest.approx(4.48)


def test_wheels_that_disagree_while_no_sensor_is_believed_are_borne():
    base = Turntable()
    base.run(5.0, 1.0, -1.0, -1.0)
    for k in range(50):
        base.step(1.0, -5.0 - 0.02 * k, -1.0, slip=(2.0, 1.0, 1.0, 1.0) if k % 10 else (1.0,) * 4)
    assert np.isfinite(base.odometry.pose).all()


def test_a_yaw_that_wanders_at_rest_is_dropped_and_believed_again_when_it_follows():
    base = Turntable()
    base.run(2.0, 0.0, 0.5, 0.0)
    assert base.odometry.gyro_trusted == (False, True)
    assert abs(base.odometry.yaw) < 0.7
    assert base.run(2.0, 0.0, 0.5, 0.0) == pytest.approx(0.0, abs=0.05)
    base.run(2.0, 1.0, 1.0, 1.0)
    assert base.odometry.gyro_trusted == (True, True)


@pytest.mark.parametrize('turning', [0.1, 0.05, -0.03])
def test_a_yaw_that_misses_a_slow_turn_is_dropped(turning):
    base = Turntable()
    told = base.run(20.0, turning, 0.0, turning)
    assert base.odometry.gyro_trusted == (False, True)
    assert told == pytest.approx(20.0 * turning, abs=0.3)
    base.run(20.0, turning, turning, turning)
    assert base.odometry.gyro_trusted == (True, True)


def test_an_orientation_that_lags_behind_is_believed():
    base, turned = Turntable(), np.zeros(600)
    for k in range(600):
        rate = 1.5 * ((k // 75) % 2)
        turned[k] = turned[k - 1] + rate * DT
        base.step(rate, turned[max(0, k - 8)], rate)
        assert base.odometry.gyro_trusted == (True, True)


def test_a_bias_and_noise_are_no_contradiction():
    base = Turntable()
    base.run(5.0, 0.0, 0.0, 0.05, noise=0.01)
    base.run(5.0, 1.0, 1.0, 1.05, noise=0.01)
    assert base.odometry.gyro_trusted == (True, True)


@given(seeds)
def test_to_skip_a_silent_step_is_to_hear_that_nothing_is_known(seed):
    rng = np.random.default_rng(seed)
    skipping, hearing = GyroWatch(), GyroWatch()
    told = []
    for _ in range(400):
        dt, is_silent = rng.uniform(0.01, 0.05), rng.random() < 0.02
        yaw = 0.1 * rng.standard_normal() if rng.random() < 0.2 else 0.0
        if is_silent:
            skipping.skip(dt)
        else:
            skipping.update(dt, yaw, 0.05, 0.06, True, 0.0)
        hearing.update(dt, *(np.nan, np.nan) if is_silent else (yaw, 0.05), 0.06, True, 0.0)
        told.append([(watch.yaw.given, watch.rate.given) for watch in (skipping, hearing)])
    assert all(one == other for one, other in told)
    assert any(one != (True, True) for one, _ in told)
