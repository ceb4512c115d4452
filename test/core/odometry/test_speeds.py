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

"""Speeds that are not the change of their positions."""

import math

from hypothesis import given, strategies as st
import numpy as np
import pytest

from swerve_kinematics.core.odometry.speeds import SpeedCheck

RADIUS = 0.05


def replay(way, speed, dt=0.02, duration=4.0):
    """Return a check after a wheel went `way(t)` [m] and said `speed(t)` [m/s], and its words."""
    check, t = SpeedCheck([RADIUS]), np.arange(0.0, duration, dt)
    return check, [check.holds(dt, [way(now)], [speed(now)]) for now in t]


def sway(t):
    """Return a distance [m] of a wheel that goes back and forth from rest."""
    return 0.5 * (1.0 - math.cos(2.0 * t))


def sway_speed(t):
    return math.sin(2.0 * t)


@pytest.mark.parametrize('factor, words', [
    (60.0 / math.tau, 'rpm'), (57.3, 'deg/s'), (1.0 / math.tau, 'turns/s'), (RADIUS, 'm/s'),
    (-1.0, 'rad/s, reversed'), (-57.3, 'deg/s, reversed'), (2.3, '2.3 times'),
    (0.0, 'velocity does not change')])
def test_a_wrong_unit_or_sign_is_named(factor, words):
    check, holds = replay(lambda t: 0.5 * t, lambda t: factor * 0.5)
    assert not any(holds[5:])
    assert [wheel for wheel, _ in check.contradictions()] == [0]
    assert words in check.contradictions()[0][1]


def test_a_speed_while_the_position_stands_counts_from_the_first_step():
    check, holds = replay(lambda t: 1.0, lambda t: 0.25)
    assert not any(holds[1:])
    assert check.contradictions() == [(0, 'the position does not change')]


@given(st.floats(0.005, 0.1), st.floats(0.0, 0.06), st.sampled_from([0.0, 0.08e-3, 1e-3]))
def test_an_honest_speed_that_lags_behind_rounded_positions_holds(dt, lag, resolution):
    def way(t):
        return math.floor(sway(t) / resolution) * resolution if resolution else sway(t)
    check, holds = replay(way, lambda t: sway_speed(t - lag) if t > lag else 0.0, dt)
    assert all(holds)
    assert check.contradictions() == []


def test_an_encoder_that_is_reset_says_nothing_of_the_speed():
    check, holds = replay(lambda t: 0.5 * t - (0.0 if t < 2.0 else 100.0), lambda t: 0.5)
    assert all(holds)


def test_a_speed_that_is_mended_is_believed_again():
    check, holds = replay(lambda t: 0.5 * t, lambda t: 5.0 if t < 1.0 else 0.5, duration=5.0)
    assert not any(holds[1:50])
    assert all(holds[-50:])
    assert check.contradictions() == []
