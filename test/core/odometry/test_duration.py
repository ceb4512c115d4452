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

"""Tests of the time that a step has lasted, by stamps of a clock that may be set forward."""

from hypothesis import given, strategies as st
import numpy as np
from odometry_drives import KIN, odometry, PERIOD, TWIST
import pytest

from swerve_kinematics.core.geometry.se2 import se2_exp
from swerve_kinematics.core.odometry.pace import Pace

SPEED = 1.5


def after(steps, speed=SPEED):
    """Return a Pace after steps of these durations [s] at a speed [m/s]."""
    pace = Pace(1)
    for dt in steps:
        assert pace.duration(dt, speed * dt) == dt
    return pace


@given(jump=st.floats(0.03, 5.0), period=st.sampled_from([0.005, 0.01, 0.02, 0.05]),
       speed=st.floats(1.0, 6.0))
def test_a_clock_that_is_set_forward_makes_no_long_step(jump, period, speed):
    pace = after([0.0, *[period] * 50], speed)
    assert pace.duration(period + jump, speed * period) == pytest.approx(period)
    assert pace.duration(period, speed * period) == period


@given(steps=st.lists(st.floats(1e-4, 1.0), min_size=1, max_size=50))
def test_whatever_the_stamps_of_a_steady_base_they_are_right(steps):
    after([0.0, *steps])


@given(lost=st.integers(1, 25), braking=st.floats(0.0, 7.9), speed=st.floats(0.1, 6.0))
def test_samples_that_are_lost_are_no_clock_that_was_set(lost, braking, speed):
    pace, dt = after([0.0, *[PERIOD] * 20], speed), (lost + 1) * PERIOD
    time = min(dt, speed / braking) if braking else dt
    assert pace.duration(dt, time * (speed - 0.5 * braking * time)) == dt


def test_neither_a_gap_nor_an_unknown_way_is_judged():
    pace = after([0.0, *[PERIOD] * 20])
    pace.interrupt()
    assert pace.duration(0.3, SPEED * PERIOD) == 0.3
    assert pace.duration(0.3, np.nan) == 0.3
    assert pace.duration(0.3, SPEED * PERIOD) == 0.3


@pytest.mark.parametrize('period', [0.001, 0.005, 0.02, 0.2])
def test_a_gap_is_no_usual_step_and_the_twist_is_known_again_at_once(period):
    states, odo = KIN.inverse(TWIST), odometry()
    for k in range(100):
        time = period * k + (2.0 if k >= 50 else 0.0)
        if k == 50:
            odo.reprime()
        odo.update(time, states.speed * time, states.angle, TWIST[2] * time)
        if k > 1:
            np.testing.assert_allclose(odo.twist, 0.0 if k == 50 else TWIST, atol=1e-6)


def test_a_rate_does_not_turn_the_base_for_time_that_has_not_passed():
    states, odo = KIN.inverse(TWIST), odometry()
    for k in range(100):
        time = PERIOD * k
        stamp = time + (0.4 if k >= 50 else 0.0)
        odo.update(stamp, states.speed * time, states.angle, yaw_rate=TWIST[2],
                   rate_integral=TWIST[2] * stamp)
        if k > 1:
            np.testing.assert_allclose(odo.twist, TWIST, atol=1e-6)
    assert odo.pose[2] == pytest.approx(TWIST[2] * time, abs=1e-6)


@given(held=st.floats(0.03, 0.15), period=st.sampled_from([0.005, 0.01, 0.02]),
       speed=st.floats(1.5, 6.0))
def test_messages_that_are_stamped_late_count_as_sent(held, period, speed):
    sent = period * np.arange(100)
    heard = 50.5 * period + held
    stamps = np.where((sent > 50.5 * period) & (sent < heard), heard, sent) + 1e-6 * sent
    pace = Pace(1)
    durations = [pace.duration(dt, speed * period) for dt in np.diff(stamps, prepend=0.0)[1:]]
    np.testing.assert_allclose(durations, period, rtol=0.35)
    assert sum(durations) == pytest.approx(stamps[-1], abs=0.31 * period)


@pytest.mark.parametrize('sources', ['rate', 'yaw', 'yaw and rate'])
@pytest.mark.parametrize('held', [0.028, 0.045, 0.1, 0.14])
def test_joint_states_that_are_stamped_late_spoil_neither_heading_nor_twist(held, sources):
    states, odo = KIN.inverse(TWIST), odometry()
    for k in range(100):
        sent = PERIOD * k
        # The gyro is heard all the time, and goes by its own stamps.
        stamp = 1.01 + held + 1e-5 * k if 1.01 < sent < 1.01 + held else sent
        gyro = {'yaw': TWIST[2] * stamp} if 'yaw' in sources else {}
        if 'rate' in sources:
            gyro.update(yaw_rate=TWIST[2], rate_integral=TWIST[2] * stamp)
        odo.update(stamp, states.speed * sent, states.angle, **gyro)
        if k > 1:
            np.testing.assert_allclose(odo.twist, TWIST, atol=0.15)
    assert odo.pose[2] == pytest.approx(TWIST[2] * sent, abs=2e-3)
    np.testing.assert_allclose(odo.twist, TWIST, atol=1e-2)


@pytest.mark.parametrize('sources', ['yaw', 'yaw and rate'])
@pytest.mark.parametrize('held', [0.045, 0.1, 0.3])
@pytest.mark.parametrize('kept', [5, 50])
def test_a_gyro_joint_that_is_stamped_late_with_the_others_loses_no_turn(kept, held, sources):
    states, odo = KIN.inverse(TWIST), odometry()
    for k in range(100):
        sent = PERIOD * k
        is_held = 1.01 < sent < 1.01 + held
        if is_held and sent < 1.01 + held - kept * PERIOD:
            continue  # so many messages wait for a reader, and no more
        stamp = 1.01 + held + 1e-5 * k if is_held else sent
        rate = {'yaw_rate': TWIST[2], 'rate_integral': TWIST[2] * stamp}
        odo.update(stamp, states.speed * sent, states.angle, TWIST[2] * sent,
                   **rate if 'rate' in sources else {})
    np.testing.assert_allclose(odo.pose, se2_exp(TWIST * sent), atol=1e-6)
    assert odo.yaw_jumps == 0


@given(count=st.integers(2, 5), apart=st.floats(1e-6, 1e-3))
def test_messages_that_come_in_bursts_make_no_burst_the_usual_thing(count, apart):
    pace, burst = Pace(1), [PERIOD * count - apart * (count - 1), *[apart] * (count - 1)]
    for k in range(40):
        for dt in burst:
            # The base starts to drive.
            assert pace.duration(dt, 0.003 * min(k, 10)) == dt
        assert k == 0 or PERIOD / 4.0 < pace.usual < PERIOD * count
