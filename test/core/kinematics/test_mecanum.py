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

"""Mecanum: the numbers of the field, each wheel's own position, and the least squares."""

from hypothesis import given, strategies as st
import numpy as np
from numpy.testing import assert_allclose
import pytest
from strategies import layouts, twists
from swerve_kinematics import MecanumKinematics

SQUARE = MecanumKinematics([(12, 12), (12, -12), (-12, 12), (-12, -12)])
CORNERS = np.array([(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)])


@st.composite
def bases(draw):
    """Draw a base whose wheels are off the corners of a rectangle by up to 10 cm."""
    rng = np.random.default_rng(draw(st.integers(0, 2 ** 32 - 1)))
    size = rng.uniform(0.2, 0.6, 2)
    return MecanumKinematics(CORNERS * size + rng.uniform(-0.1, 0.1, (4, 2)))


@pytest.mark.parametrize('twist, speeds', [
    ((2.0, 3.0, 1.0), (-25.0, 29.0, -19.0, 23.0)),
    ((5.0, 0.0, 0.0), (5.0, 5.0, 5.0, 5.0)),
    ((0.0, 4.0, 0.0), (-4.0, 4.0, 4.0, -4.0)),
    ((0.0, 0.0, 2 * np.pi), 48 * np.pi * np.array([-1, 1, -1, 1])),
    ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))])
def test_known_wheel_speeds_and_back(twist, speeds):
    assert_allclose(SQUARE.inverse(twist), speeds, atol=1e-12)
    assert_allclose(SQUARE.forward(speeds), twist, atol=1e-12)


def test_every_row_uses_its_own_wheel():
    x, y = np.array([0.5, 0.4, -0.3, -0.2]), np.array([0.25, -0.35, 0.45, -0.55])
    speeds = MecanumKinematics(np.stack((x, y), axis=-1)).inverse([0.0, 0.0, 1.0])
    assert_allclose(speeds, [-(x[0] + y[0]), x[1] - y[1], x[2] - y[2], -(x[3] + y[3])])


@given(bases(), twists())
def test_forward_undoes_inverse(kinematics, twist):
    assert_allclose(kinematics.forward(kinematics.inverse(twist)), twist, rtol=1e-12, atol=1e-12)


@given(bases(), twists(), st.floats(-2, 2), st.floats(-2, 2))
def test_a_centre_of_rotation_is_a_twist_moved_to_base_link(kinematics, twist, x, y):
    moved = twist + twist[:, 2:] * [y, -x, 0.0]
    assert_allclose(kinematics.inverse(twist, (x, y)), kinematics.inverse(moved), atol=1e-12)
    elsewhere = MecanumKinematics(kinematics.wheel_positions - [x, y])
    assert_allclose(kinematics.inverse(twist, (x, y)), elsewhere.inverse(twist), atol=1e-12)


@given(bases(), twists())
def test_forward_is_the_least_squares_fit(kinematics, noise):
    speeds = np.concatenate((noise, noise[:, :1]), axis=-1)
    misfit = speeds - kinematics.inverse(kinematics.forward(speeds))
    rows = kinematics.inverse(np.eye(3))
    assert_allclose(misfit @ rows.T, 0.0, atol=1e-12)


def test_the_same_matrices_map_deltas_and_accelerations():
    start, rate, dt = np.array([1.0, -0.5, 0.3]), np.array([0.2, 0.4, -0.6]), 0.1
    change = SQUARE.inverse(start + rate * dt) - SQUARE.inverse(start)
    assert_allclose(SQUARE.inverse(rate), change / dt)
    assert_allclose(SQUARE.forward(SQUARE.inverse(start) * dt), start * dt)


def test_desaturate():
    assert_allclose(SQUARE.desaturate([5.0, 6.0, 4.0, 7.0], 5.5),
                    [3.928571429, 4.714285714, 3.142857143, 5.5])
    assert_allclose(SQUARE.desaturate([1.0, 1.0, -2.0, -2.0], 1.0), [0.5, 0.5, -1.0, -1.0])
    assert_allclose(SQUARE.desaturate([0.0, 0.0, 0.0, 0.0], 1.0), 0.0)


@pytest.mark.parametrize('wrong, match', [
    (np.zeros((3, 2)), r'\(4, 2\)'), (np.zeros((4, 3)), r'\(n, 2\)'), (np.zeros(4), r'\(n, 2\)'),
    (CORNERS * np.nan, 'finite'), (np.zeros((4, 2)), 'determine no motion')])
def test_a_layout_that_cannot_work_is_refused(wrong, match):
    with pytest.raises(ValueError, match=match):
        MecanumKinematics(wrong)


@given(layouts(counts=(4,)))
def test_the_layout_is_a_read_only_copy(positions):
    kinematics = MecanumKinematics(positions)
    with pytest.raises(ValueError, match='read-only'):
        kinematics.wheel_positions[0, 0] = 1.0
    positions[0, 0] = 7.0
    assert kinematics.wheel_positions[0, 0] != 7.0
    assert str(kinematics.wheel_positions.tolist()) in repr(kinematics)
