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

"""Which angle a module steers to: the nearer line, the measured turn, the range."""

import cmath
import math

import numpy as np
import pytest

from swerve_kinematics.core.control.setpoints import Setpoint
from swerve_kinematics.core.control.steering import (
    choose, steering_ranges, SteeringRange, within_bounds, x_pattern)

FREE = SteeringRange()
OFFSETS = [0.3 + 0.2j, 0.3 - 0.2j, -0.3 + 0.2j, -0.3 - 0.2j]


def chosen(degrees, measured=0.0, flipped=None, steering_range=FREE):
    """Return the goal for a unit velocity as (speed, degrees), and whether it is blocked."""
    velocity = cmath.rect(1.0, math.radians(degrees))
    goal, _, blocked = choose(
        velocity, Setpoint(0.0, 9.0), math.radians(measured), flipped, steering_range)
    return (goal.speed, pytest.approx(math.degrees(goal.angle))), blocked


def limited(lower, upper):
    return SteeringRange(math.radians(lower), math.radians(upper))


@pytest.mark.parametrize('degrees, measured, expected', [
    (30, 0, (1, 30)), (90, 0, (1, 90)), (-90, 0, (1, -90)), (91, 0, (-1, -89)),
    (180, 0, (-1, 0)), (-170, 170, (1, 190)), (170, -550, (1, -550)), (41, -50, (-1, -139)),
    (10, 3600, (1, 3610)), (-179, 899, (1, 901))])
def test_the_nearer_line_counting_on_from_the_measured_turn(degrees, measured, expected):
    assert chosen(degrees, measured) == (expected, False)


@pytest.mark.parametrize('flipped, degrees, expected', [
    (None, 92, (-1, -88)), (False, 92, (1, 90)), (False, 97, (-1, -83)),
    (True, 88, (-1, -90)), (True, 84, (1, 84))])
def test_the_choice_stays_near_a_quarter_turn_but_is_never_beyond_it(flipped, degrees, expected):
    assert chosen(degrees, 0, flipped) == (expected, False)


@pytest.mark.parametrize('degrees, measured, bounds, expected', [
    (100, 60, (-90, 90), (-1, -80)), (-100, -60, (-90, 90), (-1, 80)),
    (90, 0, (-90, 90), (1, 90)), (95, 80, (-100, 100), (1, 95)), (0, 350, (0, 360), (1, 360)),
    (10, 350, (0, 360), (-1, 190)), (20, 900, (-180, 180), (1, 20))])
def test_the_other_angle_where_the_nearer_one_is_out_of_range(degrees, measured, bounds, expected):
    assert chosen(degrees, measured, None, limited(*bounds)) == (expected, False)


@pytest.mark.parametrize('degrees, measured, expected', [
    (90, 20, (math.cos(math.radians(30)), 60)), (90, -20, (-math.cos(math.radians(30)), -60)),
    (110, 50, (-math.cos(math.radians(10)), -60)), (-65, 700, (math.cos(math.radians(5)), -60)),
    (-110, -700, (-math.cos(math.radians(10)), 60))])
def test_without_any_angle_in_range_the_end_stop_nearest_to_the_line_is_the_goal(
        degrees, measured, expected):
    speed, angle = expected
    assert chosen(degrees, measured, None, limited(-60, 60)) == (
        (pytest.approx(speed), angle), True)


@pytest.mark.parametrize('joint', [
    SteeringRange(-1.0, math.inf), SteeringRange(-math.inf, -1.0), SteeringRange(-1.0, 4.0),
    SteeringRange(-6.0, -1.0)])
def test_a_huge_reading_leaves_a_wide_range_an_angle_for_any_direction(joint):
    rng = np.random.default_rng(0)
    for offset, measured in zip(rng.uniform(-1e-8, 1e-8, 5000).tolist(),
                                rng.uniform(-2e7, 2e7, 5000).tolist()):
        direction = cmath.rect(1.0, -1.0 + offset)
        goal, _, blocked = choose(direction, Setpoint(0.0, 0.0), measured, None, joint)
        assert not blocked and joint.lower <= goal.angle <= joint.upper
        assert cmath.rect(*goal) == pytest.approx(direction, abs=1e-7)


def test_a_module_too_slow_for_a_direction_holds():
    choice = choose(1e-7 + 0j, Setpoint(0.5, 9.0), 8.9, True, FREE)
    assert choice == (Setpoint(0.0, 9.0), True, False)


def test_a_continuous_joint_is_kept_within_a_quarter_turn_of_where_it_is():
    assert within_bounds(Setpoint(1.0, 4.0), 1.0, FREE).angle == pytest.approx(
        1.0 + math.pi / 2)


def test_a_limited_joint_is_kept_within_its_range():
    joint = SteeringRange(-1.0, 1.0)
    assert within_bounds(Setpoint(1.0, 1.1), 0.5, joint) == (1.0, 1.0)
    assert within_bounds(Setpoint(1.0, 0.7), 1.4, joint) == (1.0, 0.7)


def test_the_x_pattern_points_at_the_middle_of_the_modules():
    shifted = [offset + 5.0 for offset in OFFSETS]
    assert x_pattern(shifted) == pytest.approx(OFFSETS)


@pytest.mark.parametrize('lower, upper, message', [
    ([0.0], None, 'must have shape'), ([0.0, 1.0], [1.0, 1.0], 'must be below'),
    ([0.0, np.nan], None, 'must be below')])
def test_bad_ranges_are_named(lower, upper, message):
    with pytest.raises(ValueError, match=message):
        steering_ranges(2, lower, upper)
