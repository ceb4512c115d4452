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

"""The geometry of what people draw of a base."""

from hypothesis import given
import numpy as np
import pytest
from strategies import layouts, seeds, twists
from swerve_kinematics import ModuleStates, SwerveKinematics
from swerve_kinematics.core.drawing import (
    covariance_ellipse, dashed_arrow, outline, twist_parts, velocity_vectors)


@given(layouts(), twists())
def test_the_parts_add_up_to_what_inverse_asks(positions, twists):
    center = positions.mean(axis=0) + 0.1
    translation, rotation = twist_parts(positions, twists, center)
    commanded = velocity_vectors(SwerveKinematics(positions).inverse(twists, center))
    np.testing.assert_allclose(translation + rotation, commanded, atol=1e-12)


def test_the_parts_of_a_turn_about_a_point_beside_the_base():
    translation, rotation = twist_parts([(1.0, 0.0), (0.0, 2.0)], (3.0, 4.0, 2.0), (0.0, -1.0))
    np.testing.assert_array_equal(translation, [(3.0, 4.0), (3.0, 4.0)])
    np.testing.assert_array_equal(rotation, [(-2.0, 2.0), (-6.0, 0.0)])


def test_a_reversed_module_moves_against_its_angle():
    vectors = velocity_vectors(ModuleStates(np.array([2.0, -2.0]), np.array([0.5, 0.5])))
    np.testing.assert_allclose(vectors[1], -vectors[0])
    np.testing.assert_allclose(vectors[0], [2.0 * np.cos(0.5), 2.0 * np.sin(0.5)])


def test_any_pair_of_arrays_can_be_drawn():
    np.testing.assert_allclose(velocity_vectors(([2, -2], [[0], [1]])), 2.0 * np.array(
        [[(1.0, 0.0), (-1.0, 0.0)],
         [(np.cos(1.0), np.sin(1.0)), (-np.cos(1.0), -np.sin(1.0))]]))


def test_the_outline_walks_around_without_crossing_itself():
    corners = [(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)]
    np.testing.assert_array_equal(
        outline(corners), [(-0.3, -0.25), (0.3, -0.25), (0.3, 0.25), (-0.3, 0.25)])


@given(seeds)
def test_the_ellipse_holds_its_share_of_the_points(seed):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(2, 2))
    (major, minor), angle = covariance_ellipse(root @ root.T, 0.8)
    x, y = root @ rng.normal(size=(2, 20000))
    along, across = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    assert major >= minor
    assert np.mean((along / major) ** 2 + (across / minor) ** 2 < 1.0) == pytest.approx(
        0.8, abs=0.02)


def test_the_ellipse_of_a_diagonal_covariance():
    semi_axes, angle = covariance_ellipse(np.diag((0.01, 0.04)))
    np.testing.assert_allclose(semi_axes, np.sqrt(5.991464547) * np.array([0.2, 0.1]))
    assert abs(angle) == pytest.approx(np.pi / 2)
    np.testing.assert_array_equal(covariance_ellipse(np.zeros((2, 2)))[0], 0.0)


@pytest.mark.parametrize('length', [0.01, 0.1, 1.0])
def test_a_dashed_arrow_has_dashes_at_both_ends_and_a_head_at_the_tip(length):
    start, along = np.array([1.0, 2.0]), np.array([0.6, 0.8])
    strokes = dashed_arrow(start, length * along, dash=0.02, head=0.06).reshape(-1, 2, 2)
    shaft, head = strokes[:-2], strokes[-2:]
    distances = (shaft - start) @ along
    np.testing.assert_allclose(shaft, start + distances[..., np.newaxis] * along, atol=1e-12)
    assert distances[0, 0] == 0.0 and distances[-1, 1] == pytest.approx(length)
    # Dashes and gaps are of one length, about that asked for.
    np.testing.assert_allclose(np.diff(distances.ravel()), distances[0, 1])
    if length > 0.05:
        assert distances[0, 1] == pytest.approx(0.02, rel=0.1)
    tip = start + length * along
    np.testing.assert_allclose(head[:, 0], [tip, tip])
    barbs = head[:, 1] - tip
    np.testing.assert_allclose(np.hypot(*barbs.T), min(length, 0.06))
    along_and_across = barbs @ np.stack((along, [-along[1], along[0]]), axis=-1)
    angles = np.arctan2(along_and_across[:, 1], along_and_across[:, 0])
    np.testing.assert_allclose(sorted(np.degrees(angles)), [-150.0, 150.0])
