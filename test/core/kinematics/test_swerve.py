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

"""Swerve kinematics of first order: known numbers, edges, and properties over random layouts."""

from hypothesis import given, strategies as st
import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
import pytest
from strategies import layouts, MODULE_COUNTS, twists
from swerve_kinematics import SwerveKinematics

S12 = SwerveKinematics([(12, 12), (12, -12), (-12, 12), (-12, -12)])
BASE = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
TURN = 2.0 * np.pi

centers = st.tuples(st.floats(-2, 2), st.floats(-2, 2))


def velocities(states):
    """Return the velocity vectors (..., n, 2) of module states."""
    return np.stack((states.speed * np.cos(states.angle), states.speed * np.sin(states.angle)),
                    axis=-1)


@pytest.mark.parametrize('twist, center, speed, degrees', [
    ((5, 0, 0), (0, 0), (5, 5, 5, 5), (0, 0, 0, 0)),
    ((0, 5, 0), (0, 0), (5, 5, 5, 5), (90, 90, 90, 90)),
    ((0, 0, TURN), (0, 0), (106.629190516,) * 4, (135, 45, -135, -45)),
    ((0, 0, TURN), (12, 12), (0, 150.796447372, 150.796447372, 213.258381032), (7, 0, -90, -45))])
def test_inverse_of_known_twists(twist, center, speed, degrees):
    states = S12.inverse(twist, center, held_angles=np.radians([7, 8, 9, 10]))
    assert_allclose(states.speed, speed, atol=1e-8)
    assert_allclose(np.degrees(states.angle), degrees, atol=1e-8)


def test_forward_of_known_states():
    assert_allclose(S12.forward(([5, 6, 4, 7], [0, 0, 0, 0])), [5.5, 0, 0.0416666667], atol=1e-10)


def test_forward_with_three_wheels_of_different_radius():
    line = SwerveKinematics([(-1, 0), (0, 0), (1, 0)])
    rim_speeds = 10.0 * np.array([0.1, 0.2, 0.3])
    assert_allclose(line.forward((rim_speeds, [0, 0, 0])), [2, 0, 0], atol=1e-12)


def test_a_module_without_motion_keeps_its_angle():
    held = np.array([0.1, -0.2, 4.0, np.pi])
    states = BASE.inverse([0.0, 0.0, 0.0], held_angles=held)
    assert_array_equal(states.speed, 0.0)
    assert_array_equal(states.angle, held)
    assert_array_equal(BASE.inverse([0.0, 0.0, 0.0]).angle, 0.0)


@pytest.mark.parametrize('speed, held', [(0.999e-6, True), (1.001e-6, False)])
def test_a_module_keeps_its_angle_below_a_micrometre_a_second(speed, held):
    states = BASE.inverse([0.0, speed, 0.0], held_angles=[0.3] * 4)
    assert_allclose(states.angle, 0.3 if held else np.pi / 2)
    assert_allclose(states.speed, speed)


@given(layouts(), twists(count=1))
def test_a_module_on_the_centre_of_rotation_keeps_its_angle(positions, twist):
    twist = twist[0] * [0.0, 0.0, 1.0]
    held = np.arange(1.0, len(positions) + 1.0)
    states = SwerveKinematics(positions).inverse(twist, positions[1], held)
    assert states.speed[1] < 1e-12
    assert states.angle[1] == 2.0
    assert (np.delete(states.angle, 1) != np.delete(held, 1)).all()


@pytest.mark.parametrize('vy', [0.0, -0.0, -1e-20, -5e-324])
def test_backwards_is_plus_pi(vy):
    assert_array_equal(BASE.inverse([-1.0, vy, 0.0]).angle, np.pi)


@given(layouts(), twists(), centers)
def test_inverse_gives_the_velocity_of_each_point_of_a_rigid_body(positions, twist, center):
    states = SwerveKinematics(positions).inverse(twist, center)
    offset = positions - center
    expected = np.stack((twist[:, :1] - twist[:, 2:] * offset[:, 1],
                         twist[:, 1:2] + twist[:, 2:] * offset[:, 0]), axis=-1)
    assert_allclose(velocities(states), expected, atol=1e-12)
    assert (states.speed >= 0.0).all()
    assert (np.abs(states.angle) <= np.pi).all()


@given(layouts(), twists())
def test_forward_undoes_inverse(positions, twist):
    kinematics = SwerveKinematics(positions)
    result = kinematics.forward(kinematics.inverse(twist))
    scale = np.linalg.norm(twist, axis=-1, keepdims=True)
    assert_allclose(result / scale, twist / scale, atol=1e-12)


@given(layouts(), twists(), st.sampled_from((1e3, 1e5)), st.floats(-np.pi, np.pi))
def test_a_base_link_far_away_costs_no_more_digits_than_its_distance(
        positions, twist, distance, bearing):
    far = SwerveKinematics(positions + distance * np.array((np.cos(bearing), np.sin(bearing))))
    states = far.inverse(twist)
    # The modules' speeds are rounded in proportion to the distance, and so is the yaw rate that
    # follows from them, whose lever to base_link is the distance once more.
    rounding = 1e-14 * distance
    assert_allclose(far.forward(states)[:, 2], twist[:, 2], rtol=0.0, atol=rounding)
    assert_allclose(far.forward(states), twist, rtol=0.0, atol=rounding * distance)
    assert_allclose(far.residuals(states), 0.0, atol=rounding * distance)


@given(layouts(), twists(), centers)
def test_a_centre_of_rotation_is_a_twist_moved_to_base_link(positions, twist, center):
    kinematics = SwerveKinematics(positions)
    moved = twist + twist[:, 2:] * [center[1], -center[0], 0.0]
    assert_allclose(velocities(kinematics.inverse(twist, center)),
                    velocities(kinematics.inverse(moved)), atol=1e-12)


@given(layouts(), st.integers(0, 1000))
def test_forward_is_the_least_squares_fit(positions, seed):
    rng = np.random.default_rng(seed)
    states = rng.normal(size=(2, 5, len(positions)))
    matrix = np.concatenate([[(1, 0, -y), (0, 1, x)] for x, y in positions])
    vectors = np.stack((states[0] * np.cos(states[1]), states[0] * np.sin(states[1])), axis=-1)
    expected = np.linalg.lstsq(matrix, vectors.reshape(5, -1).T, rcond=None)[0].T
    kinematics = SwerveKinematics(positions)
    assert_allclose(kinematics.forward(states), expected, atol=1e-10)
    misfit = vectors.reshape(5, -1) - expected @ matrix.T
    assert_allclose(kinematics.residuals(states),
                    np.linalg.norm(misfit.reshape(vectors.shape), axis=-1), atol=1e-10)


def test_forward_maps_distance_deltas_to_a_twist_delta():
    speed, angle = BASE.inverse([1.0, -0.5, 2.0])
    assert_allclose(BASE.forward((0.02 * speed, angle)), [0.02, -0.01, 0.04], atol=1e-15)


@given(layouts(), twists())
def test_modules_that_agree_leave_no_residual(positions, twist):
    kinematics = SwerveKinematics(positions)
    assert_allclose(kinematics.residuals(kinematics.inverse(twist)), 0.0, atol=1e-12)


def test_the_residual_of_the_slipping_module_is_the_largest():
    speed, angle = BASE.inverse([1.0, 0.0, 0.5])
    residuals = BASE.residuals((speed * [1, 1, 1.5, 1], angle))
    assert residuals.argmax() == 2
    assert residuals[2] > 0.1


def test_two_modules_share_one_disagreement():
    pair = SwerveKinematics([(0.5, 0.0), (-0.5, 0.0)])
    assert_allclose(pair.residuals(([1.0, 0.4], [0.0, 0.0])), [0.3, 0.3])


@given(layouts(), twists())
def test_every_pair_of_agreeing_modules_implies_the_twist(positions, twist):
    kinematics = SwerveKinematics(positions)
    pairs = kinematics.pairwise(kinematics.inverse(twist))
    count = len(positions)
    assert pairs.shape == (len(twist), count * (count - 1) // 2, 3)
    assert_allclose(pairs, np.broadcast_to(twist[:, np.newaxis], pairs.shape), atol=1e-10)
    assert_allclose(pairs.mean(axis=-2), kinematics.forward(kinematics.inverse(twist)), atol=1e-10)


@given(layouts(counts=(3, 4, 6)), st.integers(0, 1000))
def test_a_pair_is_the_least_squares_fit_to_its_two_modules(positions, seed):
    speed, angle = np.random.default_rng(seed).normal(size=(2, len(positions)))
    pairs = SwerveKinematics(positions).pairwise((speed, angle))
    for implied, i, j in zip(pairs, *np.triu_indices(len(positions), 1)):
        alone = SwerveKinematics(positions[[i, j]]).forward((speed[[i, j]], angle[[i, j]]))
        assert_allclose(implied, alone, atol=1e-10)


def test_a_pair_at_one_point_tells_nothing():
    twin = SwerveKinematics([(0.3, 0.0), (0.3, 0.0), (-0.3, 0.0)])
    pairs = twin.pairwise(twin.inverse([1.0, 2.0, 3.0]))
    assert np.isnan(pairs[0]).all()
    assert_allclose(pairs[1:], [[1.0, 2.0, 3.0]] * 2)


@pytest.mark.parametrize('count', MODULE_COUNTS)
def test_on_a_symmetric_layout_the_translation_is_the_mean_velocity(count):
    bearing = TURN * np.arange(count) / count
    kinematics = SwerveKinematics(np.stack((np.cos(bearing), np.sin(bearing)), axis=-1))
    speed, angle = np.random.default_rng(count).normal(size=(2, 50, count))
    mean = np.stack((speed * np.cos(angle), speed * np.sin(angle)), axis=-1).mean(axis=-2)
    assert_allclose(kinematics.forward((speed, angle))[:, :2], mean, atol=1e-14)


@pytest.mark.parametrize('wrong, match', [
    ([(0.3, 0.2)], '2 modules or more, got 1'), ([], r'\(n, 2\)'), (np.zeros((0, 2)), 'got 0'),
    ([(1, 2, 3), (4, 5, 6)], r'\(n, 2\), got \(2, 3\)'), ([1, 2], r'\(n, 2\), got \(2,\)'),
    ([(0.3, 0.2), (0.3, 0.2)], r'at one point: \[0.3, 0.2\]'),
    ([(1e6, 0.1), (1e6, 0.1), (1e6 + 1e-6, 0.1)], 'at one point'),
    ([(np.nan, 0), (1, 1)], 'finite.*nan'), ([(np.inf, 0), (1, 1)], 'finite.*inf')])
def test_a_layout_that_cannot_be_solved_is_refused(wrong, match):
    with pytest.raises(ValueError, match=match):
        SwerveKinematics(wrong)


def test_wrong_shapes_are_refused_by_name():
    for name, call in {
            'twist': lambda: BASE.inverse([1.0, 2.0]),
            'center': lambda: BASE.inverse([1.0, 2.0, 3.0], (1.0, 2.0, 3.0)),
            'held_angles': lambda: BASE.inverse([1.0, 2.0, 3.0], held_angles=[1.0]),
            'speed': lambda: BASE.forward(([1, 2, 3], [1, 2, 3, 4])),
            'angle': lambda: BASE.residuals(([1, 2, 3, 4], 0.0))}.items():
        with pytest.raises(ValueError, match=f'^{name} must'):
            call()


def test_the_layout_is_a_read_only_copy():
    positions = np.array([(0.3, 0.2), (-0.3, 0.2)])
    kinematics = SwerveKinematics(positions)
    with pytest.raises(ValueError, match='read-only'):
        kinematics.module_positions[0, 0] = 1.0
    positions[0, 0] = 7.0
    assert kinematics.module_positions[0, 0] == 0.3
    assert kinematics.module_count == 2
    assert repr(kinematics) == 'SwerveKinematics([[0.3, 0.2], [-0.3, 0.2]])'
