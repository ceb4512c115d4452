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

"""Feasible fractions of a setpoint change: closed forms against numbers and brute force."""

import cmath
import math

from hypothesis import example, given, strategies as st
import numpy as np
import pytest

from swerve_kinematics.core.control.setpoints import (
    common_fraction, drive_fraction, next_setpoint, Setpoint, steering_fraction, within_reach)

INF = math.inf


@pytest.mark.parametrize('start, goal, step, expected', [
    (1 + 0j, 1j, 0.1, 0.0911855953), (2 + 0j, 2j, math.pi / 4, 0.5),
    (1 + 0j, 2 + 0j, 0.1, 1.0), (1 + 0j, 1j, INF, 1.0), (1 + 0j, 1j, 0.0, 0.0),
    (1 + 0j, 1 + 0.01j, 0.1, 1.0), (1 + 0j, 1 + 0j, 0.1, 1.0)])
def test_steering_fraction(start, goal, step, expected):
    assert steering_fraction(start, goal, step) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize('start, goal, step, expected', [
    (1 + 0j, 2 + 0j, 0.1, 0.1), (0j, 3 + 4j, 0.5, 0.1), (2 + 0j, 1 + 0j, 0.1, 0.1),
    (1 + 0j, 1 + 0j, 0.0, 1.0), (1 + 0j, 1j, INF, 1.0), (1 + 0j, 1j, 0.4, 1.0)])
def test_drive_fraction(start, goal, step, expected):
    assert drive_fraction(start, goal, step) == pytest.approx(expected, abs=1e-9)


def test_fractions_are_the_first_at_which_the_limit_is_met():
    rng = np.random.default_rng(3)
    s = np.linspace(0.0, 1.0, 20001)
    for _ in range(200):
        start, goal = rng.normal(size=(2, 2)) @ (1, 1j)
        steering_step, drive_step = rng.uniform(0.02, 1.5), rng.uniform(0.02, 2.0)
        way = start + s * (goal - start)
        steering = np.abs(np.angle(way / start)) > steering_step
        drive = np.abs(np.abs(way) - abs(start)) > drive_step
        for fraction, beyond in ((steering_fraction(start, goal, steering_step), steering),
                                 (drive_fraction(start, goal, drive_step), drive)):
            first = s[np.argmax(beyond)] if beyond.any() else 1.0
            assert fraction == pytest.approx(first, abs=1e-4)


def test_the_slowest_module_sets_the_common_fraction():
    start = [Setpoint(1.0, 0.0), Setpoint(2.0, 0.0)]
    goal = [Setpoint(2.0, 0.0), Setpoint(2.0, math.pi / 2)]
    assert common_fraction(start, goal, 0.1, INF) == pytest.approx(0.0911855953)
    assert common_fraction(start, goal, INF, 0.01) == pytest.approx(
        drive_fraction(2 + 0j, 2j, 0.01))


def test_a_module_at_rest_turns_before_the_base_moves():
    start = [Setpoint(0.0, 0.3), Setpoint(1.0, 0.0)]
    goal = [Setpoint(1.0, 0.8), Setpoint(2.0, 0.0)]
    assert common_fraction(start, goal, 0.2, INF) == 0.0
    assert next_setpoint(start[0], goal[0], 0.0, 0.2) == Setpoint(0.0, 0.5)
    assert next_setpoint(start[1], goal[1], 0.0, 0.2) == start[1]


def test_a_goal_within_reach_is_taken_exactly():
    start, goal = [Setpoint(0.01, 0.0)], [Setpoint(-0.01, 0.1)]
    assert within_reach(start, goal, 0.1, 0.02)
    assert common_fraction(start, goal, 0.1, 0.02) == 1.0
    assert next_setpoint(start[0], goal[0], 1.0, 0.1) == goal[0]


def test_a_reversal_on_one_line_passes_through_rest():
    start, goal = [Setpoint(0.3, 1.0)], [Setpoint(-1.0, 1.0)]
    fraction = common_fraction(start, goal, 0.1, 0.5)
    assert next_setpoint(start[0], goal[0], fraction, 0.1).speed == pytest.approx(-0.2)
    assert next_setpoint(start[0], goal[0], fraction, 0.1).angle == 1.0


@pytest.mark.parametrize('speed, angle', [(1.0, 0.2), (-1.0, 7.0)])
def test_a_fraction_of_the_way_lies_between_the_velocities(speed, angle):
    start, goal = Setpoint(speed, angle), Setpoint(1.4 * speed, angle + 0.7)
    way = cmath.rect(*start) + 0.3 * (cmath.rect(*goal) - cmath.rect(*start))
    setpoint = next_setpoint(start, goal, 0.3, 1.0)
    assert cmath.isclose(cmath.rect(*setpoint), way)
    assert abs(setpoint.angle - angle) < 0.7


def test_random_changes_keep_both_steps():
    rng = np.random.default_rng(4)
    for _ in range(2000):
        start = [Setpoint(*pair) for pair in rng.normal(size=(3, 2)) * (1.0, 3.0)]
        goal = [Setpoint(rng.normal(), s.angle + rng.uniform(-1.6, 1.6)) for s in start]
        steering_step, drive_step = rng.uniform(0.01, 2.0), rng.uniform(0.01, 2.0)
        fraction = common_fraction(start, goal, steering_step, drive_step)
        assert 0.0 <= fraction <= 1.0
        for s, g in zip(start, goal):
            reached = next_setpoint(s, g, fraction, steering_step)
            assert abs(reached.speed - s.speed) <= drive_step + 1e-9
            assert abs(reached.angle - s.angle) <= steering_step + 1e-9


SPEEDS = st.sampled_from((-2.0, -0.5, -1e-3, 0.0, 1e-9, 0.5, 2.0)) | st.floats(-4.0, 4.0)
TURNS = st.sampled_from([0.5 * math.pi * quarter for quarter in range(-6, 7)]) | st.floats(-9, 9)
STEPS = st.sampled_from((1e-6, 0.1, 0.5 * math.pi, math.pi, INF))


@example(-0.5, 0.5 * math.pi, 0.5, -0.5 * math.pi, INF, 1e-6)  # half a turn, the drive reversed
@given(SPEEDS, TURNS, SPEEDS, TURNS, STEPS, STEPS)
def test_every_change_has_a_fraction_whatever_its_limits(
        speed, angle, wanted_speed, wanted_angle, steering_step, drive_step):
    start, goal = Setpoint(speed, angle), Setpoint(wanted_speed, wanted_angle)
    fraction = common_fraction([start], [goal], steering_step, drive_step)
    assert 0.0 <= fraction <= 1.0
    told = next_setpoint(start, goal, fraction, steering_step)
    assert math.isfinite(told.speed) and abs(told.angle - angle) <= steering_step + 1e-9
