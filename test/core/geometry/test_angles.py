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

"""Angles lie in (-pi, pi] to the last bit, whatever comes in."""

from hypothesis import given, strategies as st
import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
import pytest
from swerve_kinematics import angle_difference, wrap_angle
from swerve_kinematics.core.geometry.angles import direction, nearest_equivalent, sinc

BEYOND_PI = np.nextafter(np.pi, 4.0)
BELOW_PI = np.nextafter(np.pi, 3.0)

angles = st.floats(-1e3, 1e3)


@pytest.mark.parametrize('angle, wrapped', [
    (0.0, 0.0), (np.pi, np.pi), (-np.pi, np.pi), (3 * np.pi, np.pi), (-3 * np.pi, np.pi),
    (BELOW_PI, BELOW_PI), (-BELOW_PI, -BELOW_PI), (BEYOND_PI, -BELOW_PI), (-BEYOND_PI, BELOW_PI),
    (2 * np.pi, 0.0), (-2 * np.pi, 0.0), (5e-324, 5e-324), (-5e-324, -5e-324),
    (1.5 * np.pi, -0.5 * np.pi), (np.nan, np.nan)])
def test_wrap_angle_at_the_edges(angle, wrapped):
    assert_allclose(wrap_angle(angle), wrapped, rtol=0.0, atol=1e-15)


@given(angles)
def test_wrap_angle_changes_by_whole_turns_only(angle):
    wrapped = wrap_angle(angle)
    assert -np.pi < wrapped <= np.pi
    turns = (angle - wrapped) / (2.0 * np.pi)
    assert_allclose(turns, np.round(turns), atol=1e-12)


@given(st.floats(-np.pi, np.pi, exclude_min=True))
def test_wrap_angle_leaves_a_wrapped_angle_as_it_is(angle):
    assert wrap_angle(angle) == angle


def test_no_angle_near_an_edge_leaves_the_interval():
    edges = np.pi * np.arange(-101, 102)[:, np.newaxis]
    wrapped = wrap_angle(edges + np.spacing(edges) * np.arange(-20, 21))
    assert (wrapped > -np.pi).all()
    assert (wrapped <= np.pi).all()


def test_angle_difference_goes_the_shortest_way():
    assert_allclose(np.degrees(angle_difference(np.radians([-170, 10, 90, -90, 725]),
                                                np.radians([170, -10, -90, 90, 0]))),
                    [20, 20, 180, 180, 5], atol=1e-12)


@given(angles, angles)
def test_nearest_equivalent_points_the_same_way_within_half_a_turn(angle, reference):
    nearest = nearest_equivalent(angle, reference)
    assert abs(nearest - reference) <= np.pi + 1e-12
    assert_allclose(np.exp(1j * nearest), np.exp(1j * angle), atol=1e-12)


@pytest.mark.parametrize('y', [0.0, -0.0, -5e-324, -1e-20, 1e-20])
def test_direction_along_minus_x_is_plus_pi(y):
    assert direction(-1.0, y) == np.pi
    assert_array_equal(direction(np.array([-1.0, 1.0]), np.array([y, 1.0])), [np.pi, np.pi / 4])


def test_direction_of_a_vector_with_nan_is_nan():
    assert np.isnan(direction(np.nan, 1.0))


@pytest.mark.parametrize('x', [1e-300, 1e-12, 1e-4, 0.1, 1.0, np.pi / 2, 3.0, 10.0])
def test_sinc_is_the_quotient_and_even(x):
    assert_allclose(sinc([x, -x]), np.sin(x) / x, rtol=1e-15)


def test_sinc_at_its_edges():
    assert_array_equal(sinc([0.0, -0.0, 5e-324, np.nan]), [1.0, 1.0, 1.0, np.nan])
