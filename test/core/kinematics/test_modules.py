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

"""Module states: flipping, cosine scaling, desaturation, interpolation."""

from hypothesis import given, strategies as st
import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
import pytest
from strategies import layouts, seeds, twists
from swerve_kinematics import (
    angle_difference, cosine_scale, desaturate, desaturate_chassis, interpolate, ModuleStates,
    optimize, SwerveKinematics)
from swerve_kinematics.core.kinematics.modules import flip, flip_choice

SPEED = np.array([5.0, 6.0, 4.0, 7.0])
ZERO = np.zeros(4)


@st.composite
def states(draw, count=(20, 4)):
    """Draw states with speeds of both signs and angles of several turns."""
    rng = np.random.default_rng(draw(seeds))
    return ModuleStates(rng.normal(scale=3.0, size=count), rng.uniform(-10.0, 10.0, count))


def vectors(module_states):
    """Return the velocities as complex numbers (..., n)."""
    return module_states.speed * np.exp(1j * module_states.angle)


@pytest.mark.parametrize('speed, degrees, measured, new_speed, new_degrees', [
    (-2.0, 180, 45, 2.0, 0), (4.7, 41, -50, -4.7, -139), (2.0, 89, 0, 2.0, 89),
    (1.0, 90, 0, 1.0, 90), (1.0, -90, 0, 1.0, -90), (1.0, 180, 0, -1.0, 0), (1.0, 0, 180, -1, 180),
    (1.0, 0, -180, -1.0, 180), (1.0, -180, 180, 1.0, -180), (3.0, 725, 0, 3.0, 725),
    (3.0, 0, 725, 3.0, 0)])
def test_optimize_known_states(speed, degrees, measured, new_speed, new_degrees):
    result = optimize(([speed], np.radians([degrees])), np.radians([measured]))
    assert_allclose(result.speed, new_speed)
    assert_allclose(np.degrees(result.angle), new_degrees, atol=1e-10)


def test_optimize_leaves_exactly_90_degrees_wherever_it_is():
    measured = np.radians(np.arange(-720, 721))
    for quarter in (0.5 * np.pi, -0.5 * np.pi):
        result = optimize((np.ones_like(measured), measured + quarter), measured)
        assert_array_equal(result.speed, 1.0)


@pytest.mark.parametrize('beyond, flipped', [(-1e-8, False), (1e-12, False), (1e-8, True)])
def test_optimize_flips_a_hair_beyond_90_degrees(beyond, flipped):
    assert flip_choice(0.5 * np.pi + beyond, 0.0) == flipped
    assert flip_choice(-0.5 * np.pi - beyond, 0.0) == flipped


@given(states(), seeds)
def test_optimize_keeps_the_velocity_and_moves_at_most_90_degrees(target, seed):
    measured = np.random.default_rng(seed).uniform(-10.0, 10.0, 4)
    result = optimize(target, measured)
    assert_allclose(vectors(result), vectors(target), atol=1e-12)
    assert (np.abs(angle_difference(result.angle, measured)) <= 0.5 * np.pi + 1e-8).all()
    flipped = result.speed != target.speed
    assert (np.abs(result.angle[flipped]) <= np.pi).all()
    assert_array_equal(result.angle[~flipped], target.angle[~flipped])
    again = optimize(result, measured)
    assert_array_equal(again.angle, result.angle)


@pytest.mark.parametrize('error, was_flipped, flipped', [
    (79, True, False), (81, True, True), (81, False, False), (99, False, False), (99, True, True),
    (101, False, True), (-81, True, True), (-99, False, False), (-101, False, True)])
def test_hysteresis_keeps_the_previous_choice_near_90_degrees(error, was_flipped, flipped):
    choice = flip_choice(np.radians(error + 30.0), np.radians(30.0), np.radians(10.0), was_flipped)
    assert choice == flipped
    result = optimize(([1.0], np.radians([error])), [0.0], np.radians(10.0), [was_flipped])
    assert_array_equal(result.speed, -1.0 if flipped else 1.0)


@pytest.mark.parametrize('hysteresis', [-0.1, np.pi / 2, np.nan])
def test_a_hysteresis_that_leaves_no_choice_is_refused(hysteresis):
    with pytest.raises(ValueError, match='hysteresis'):
        optimize((SPEED, ZERO), ZERO, hysteresis)


def test_optimize_does_not_guess_where_a_module_is():
    result = optimize((SPEED, ZERO), [0.0, np.nan, np.pi, 0.0])
    assert_allclose(result.angle, [0.0, np.nan, np.pi, 0.0])


@given(states())
def test_a_double_flip_is_no_flip(target):
    twice = flip(flip(target, True), True)
    assert_array_equal(twice.speed, target.speed)
    assert_allclose(angle_difference(twice.angle, target.angle), 0.0, atol=1e-14)


def test_cosine_scale_known_errors():
    measured = np.radians([0, 45, -45, 135, -135, 180])
    result = cosine_scale((np.full(6, 2.0), np.full(6, np.pi / 4)), measured)
    assert_allclose(result.speed, [np.sqrt(2), 2, 0, 0, -2, -np.sqrt(2)], atol=1e-15)
    assert_array_equal(result.angle, np.pi / 4)


@given(states(), seeds)
def test_cosine_scale_leaves_the_part_of_the_velocity_along_the_wheel(target, seed):
    measured = np.random.default_rng(seed).uniform(-10.0, 10.0, 4)
    along = (vectors(target) * np.exp(-1j * measured)).real
    assert_allclose(cosine_scale(target, measured).speed, along, atol=1e-13)


@pytest.mark.parametrize('speed, limit, expected', [
    (SPEED, 5.5, [3.928571429, 4.714285714, 3.142857143, 5.5]),
    ([1, 1, -2, -2], 1, [0.5, 0.5, -1, -1]),
    (SPEED, 7.0, SPEED), (SPEED, np.inf, SPEED), (SPEED, 0.0, ZERO), (ZERO, 0.0, ZERO),
    (ZERO, 1.0, ZERO), ([np.nan, 2, 4, 1], 2.0, [np.nan, 1, 2, 0.5]), ([np.nan] * 4, 1.0, np.nan)])
def test_desaturate_known_speeds(speed, limit, expected):
    result = desaturate((speed, ZERO), limit)
    assert_allclose(result.speed, expected, atol=1e-9)
    assert_array_equal(result.angle, ZERO)


@given(states(), st.floats(0.01, 20.0))
def test_desaturate_keeps_ratios_and_never_exceeds_the_limit(target, limit):
    result = desaturate(target, limit)
    assert (np.abs(result.speed) <= limit).all()
    assert_allclose(result.speed * target.speed[:, :1], target.speed * result.speed[:, :1],
                    rtol=1e-12)
    within = (np.abs(target.speed) <= limit).all(axis=-1)
    assert_array_equal(result.speed[within], target.speed[within])
    assert_allclose(np.abs(result.speed[~within]).max(axis=-1, initial=0.0), limit)


def test_desaturate_with_a_limit_for_each_item():
    result = desaturate((np.stack((SPEED, SPEED)), ZERO), [7.0, 3.5])
    assert_allclose(result.speed, [SPEED, 0.5 * SPEED])


@pytest.mark.parametrize('limits, factor', [
    ((8.0, 9.0, 9.0), 1.0), ((3.5, 9.0, 9.0), 0.5), ((8.0, 2.5, 9.0), 0.5),
    ((8.0, 9.0, 0.5), 0.25), ((3.5, 1.0, 1.5), 0.2), ((8.0, 0.0, 9.0), 0.0),
    ((np.inf,) * 3, 1.0)])
def test_desaturate_chassis_obeys_the_tightest_limit(limits, factor):
    result = desaturate_chassis((SPEED, ZERO), [3.0, 4.0, -2.0], *limits)
    assert_allclose(result.speed, factor * SPEED)


@given(layouts(), twists(), st.tuples(*[st.floats(0.01, 10.0)] * 3))
def test_desaturate_chassis_brings_modules_and_chassis_within_their_limits(
        positions, twist, limits):
    kinematics = SwerveKinematics(positions)
    target = kinematics.inverse(twist)
    result = desaturate_chassis(target, twist, *limits)
    assert (np.abs(result.speed) <= limits[0]).all()
    vx, vy, omega = kinematics.forward(result).T
    assert (np.hypot(vx, vy) <= limits[1] * (1 + 1e-9)).all()
    assert (np.abs(omega) <= limits[2] * (1 + 1e-9)).all()
    linear, angular = np.hypot(*twist[:, :2].T), np.abs(twist[:, 2])
    free = ((target.speed.max(axis=-1) <= limits[0])
            & (linear <= limits[1]) & (angular <= limits[2]))
    assert_array_equal(result.speed[free], target.speed[free])


@pytest.mark.parametrize('limit', [-1.0, np.nan, [1.0, -1.0]])
def test_a_limit_that_makes_no_sense_is_refused(limit):
    with pytest.raises(ValueError, match='max_speed must be zero or more'):
        desaturate((SPEED, ZERO), limit)
    with pytest.raises(ValueError, match='max_angular_speed must be zero or more'):
        desaturate_chassis((SPEED, ZERO), [0, 0, 0], 1.0, 1.0, limit)


@pytest.mark.parametrize('t, speed, degrees', [
    (0.25, 2, 22.5), (0.5, 3, 45), (-0.5, 1, 0), (1.5, 5, 90), (0.0, 1, 0), (1.0, 5, 90)])
def test_interpolate_known_states(t, speed, degrees):
    result = interpolate(([1.0], [0.0]), ([5.0], [np.pi / 2]), t)
    assert_allclose(result.speed, speed)
    assert_allclose(np.degrees(result.angle), degrees)


def test_interpolate_goes_the_shortest_way():
    result = interpolate(([2.0], np.radians([170])), ([4.0], np.radians([-170])), 0.5)
    assert_allclose(result.speed, 3.0)
    assert_allclose(np.abs(result.angle), np.pi)
    assert_allclose(interpolate(([2.0], np.radians([170])), ([4.0], np.radians([-170])),
                                [0.25, 0.75]).angle, np.radians([[175], [-175]]))


@given(states(), states(), st.floats(0.0, 1.0))
def test_interpolate_starts_ends_and_keeps_its_proportion(start, end, t):
    result = interpolate(start, end, t)
    whole = angle_difference(end.angle, start.angle)
    part = angle_difference(result.angle, start.angle)
    assert_allclose(np.exp(1j * part), np.exp(1j * t * whole), atol=1e-12)
    assert_allclose(result.speed, start.speed + t * (end.speed - start.speed), atol=1e-12)
    assert (np.abs(result.angle) <= np.pi).all()


@pytest.mark.parametrize('call, named', [
    (lambda fitting: optimize(fitting, np.zeros(3)), 'measured_angles'),
    (lambda fitting: optimize(fitting, ZERO, 0.1, np.zeros(3, bool)), 'flipped'),
    (lambda fitting: optimize((SPEED, np.zeros(3)), ZERO), 'states.angle'),
    (lambda fitting: cosine_scale(fitting, np.zeros((2, 3))), 'measured_angles'),
    (lambda fitting: cosine_scale((SPEED, np.zeros(3)), ZERO), 'states.angle'),
    (lambda fitting: interpolate(fitting, (SPEED[:3], ZERO[:3]), 0.5), 'end.speed'),
    (lambda fitting: interpolate((SPEED[:3], ZERO), fitting, 0.5), 'start.angle'),
    (lambda fitting: interpolate(([SPEED] * 2, [ZERO] * 2), fitting, np.zeros(3)), r'^t\b')])
def test_a_wrong_shape_is_named(call, named):
    with pytest.raises(ValueError, match=named):
        call(ModuleStates(SPEED, ZERO))
