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

"""SE(2): the numbers of the field, the inverse of each map, and what happens near 0 and pi."""

from hypothesis import given, strategies as st
import numpy as np
from numpy.testing import assert_allclose
import pytest
from strategies import twists
from swerve_kinematics import (
    discretize, se2_compose, se2_exp, se2_log, to_field_frame, to_robot_frame)


@pytest.mark.parametrize('twist, pose', [
    ((2.5 * np.pi, 0.0, 0.5 * np.pi), (5.0, 5.0, 0.5 * np.pi)),
    ((0.625 * np.pi, 0.0, np.pi), (0.0, 1.25, np.pi)),
    ((2.0, 2.0, 0.0), (2.0, 2.0, 0.0)),
    ((1.5, 0.5, 1.0), (1.0323576301, 1.1102820336, 1.0)),
    ((1.0, 2.0, 4 * np.pi), (0.0, 0.0, 4 * np.pi))])
def test_exp_of_known_arcs(twist, pose):
    assert_allclose(se2_exp(twist), pose, atol=1e-10)


@given(twists())
def test_log_undoes_exp_below_half_a_turn(twist):
    twist[:, 2] = np.clip(twist[:, 2], -3.14, 3.14)
    assert_allclose(se2_log(se2_exp(twist)), twist, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize('theta', [0.0, 5e-324, 1e-300, 1e-16, 1e-9, 1e-8, 1e-4, -1e-6, 3.1415])
def test_log_undoes_exp_to_the_last_digits_near_zero_and_near_pi(theta):
    twist = np.array([1.5, -0.5, theta])
    assert_allclose(se2_log(se2_exp(twist)), twist, rtol=1e-11 if theta > 3 else 1e-15, atol=0)


@pytest.mark.parametrize('theta', [1e-3, -1e-5, 1e-7])
def test_exp_near_zero_agrees_with_its_series(theta):
    x, y = 1.5, -0.5
    expected = [x * (1 - theta ** 2 / 6) - y * theta / 2, x * theta / 2 + y * (1 - theta ** 2 / 6)]
    assert_allclose(se2_exp([x, y, theta])[:2], expected, rtol=abs(theta) ** 3)


def test_log_at_half_a_turn_turns_left():
    assert_allclose(se2_log([0.0, 1.25, np.pi]), [0.625 * np.pi, 0.0, np.pi], atol=1e-15)
    assert_allclose(se2_log([0.0, 1.25, -np.pi]), [0.625 * np.pi, 0.0, np.pi], atol=1e-15)


def test_log_takes_a_heading_beyond_half_a_turn_the_short_way_round():
    pose = np.array([1.0, 2.0, 4.0])
    twist = se2_log(pose)
    assert_allclose(twist[2], 4.0 - 2 * np.pi)
    assert_allclose(se2_exp(twist)[:2], pose[:2], atol=1e-12)


@given(twists(), twists(), twists())
def test_compose_is_associative_and_origin_is_neutral(a, b, c):
    assert_allclose(se2_compose(se2_compose(a, b), c), se2_compose(a, se2_compose(b, c)),
                    atol=1e-12)
    assert_allclose(se2_compose(a, np.zeros(3)), a)
    assert_allclose(se2_compose(np.zeros(3), a), a)


def test_compose_matches_homogeneous_matrices():
    def matrix(pose):
        x, y, heading = pose
        cos, sin = np.cos(heading), np.sin(heading)
        return np.array([[cos, -sin, x], [sin, cos, y], [0, 0, 1]])

    a, b = np.array([1.0, -2.0, 0.7]), np.array([0.3, 0.4, -2.0])
    assert_allclose(matrix(se2_compose(a, b)), matrix(a) @ matrix(b), atol=1e-15)


@given(twists())
def test_two_halves_of_a_constant_twist_make_the_whole(twist):
    half = se2_exp(0.5 * twist)
    assert_allclose(se2_compose(half, half), se2_exp(twist), atol=1e-12)


def test_exp_is_what_small_steps_add_up_to():
    twist, steps = np.array([1.5, 0.5, 1.0]), 100000
    headings = twist[2] * (np.arange(steps) + 0.5) / steps
    path = to_field_frame(twist, headings).sum(axis=0) / steps
    assert_allclose(path, se2_exp(twist), atol=1e-10)


@pytest.mark.parametrize('twist, dt, expected', [
    ((1.0, 0.0, 0.5), 1.0, (0.9790793412, -0.25, 0.5)),
    ((1.0, -2.0, 3.0), 0.1, (0.6924887258, -2.1349774517, 3.0)),
    ((1.0, -2.0, 3.0), 0.0, (1.0, -2.0, 3.0)),
    ((1.0, -2.0, 0.0), 0.1, (1.0, -2.0, 0.0))])
def test_discretize_known_twists(twist, dt, expected):
    assert_allclose(discretize(twist, dt), expected, atol=1e-10)


@given(twists(), st.floats(0.0, 0.5))
def test_discretize_then_exp_reaches_the_straight_pose(twist, dt):
    assert_allclose(se2_exp(discretize(twist, dt) * dt), twist * dt, atol=1e-11)


@pytest.mark.parametrize('omega', [3.5, 4.0, 6.0, 7.0, -5.0, 20.0])
def test_discretize_does_not_wrap_a_turn_beyond_pi(omega):
    twist = np.array([1.0, -0.5, omega])
    result = discretize(twist, 1.0)
    assert result[2] == omega
    assert_allclose(se2_exp(result), twist, atol=1e-12)


def test_discretize_backwards_in_time():
    assert_allclose(se2_exp(discretize([1.0, -0.5, 2.0], -0.1) * -0.1), [-0.1, 0.05, -0.2])


def test_frames_of_known_headings():
    assert_allclose(to_robot_frame([1.0, 0.0, 0.5], np.radians(-90)), [0, 1, 0.5], atol=1e-15)
    assert_allclose(to_field_frame([1.0, 0.0, 0.5], np.radians(45)),
                    [np.sqrt(0.5), np.sqrt(0.5), 0.5], atol=1e-15)


@given(twists(), st.floats(-100, 100))
def test_frames_are_each_others_inverse(twist, heading):
    assert_allclose(to_robot_frame(to_field_frame(twist, heading), heading), twist, atol=1e-13)


@pytest.mark.parametrize('function', [se2_exp, se2_log])
@pytest.mark.parametrize('wrong', [1.0, [1.0, 2.0], np.zeros((3, 2))])
def test_a_wrong_shape_is_refused_with_its_value(function, wrong):
    with pytest.raises(ValueError, match='last axis of 3'):
        function(wrong)
