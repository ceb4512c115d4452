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

"""How a base gets past the twists at which a module nearly stands: no module holds it up long."""

import math

import numpy as np
import pytest

from swerve_kinematics import ModuleStates, SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.control.passing import is_sooner_by_rest, LARGEST_DETOUR, passing
from swerve_kinematics.core.control.setpoints import (
    common_fraction, next_setpoint, Setpoint, SLIDING_SPEED)
from swerve_kinematics.core.geometry.planar import difference, PlanarTwist, product, REST, scaled

DT = 0.02
LAYOUTS = {
    'four': [(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)],
    'three': [(0.3, 0.0), (-0.2, 0.25), (-0.2, -0.25)],
    'long': [(0.8, 0.25), (0.8, -0.25), (-0.8, 0.25), (-0.8, -0.25)]}
LIMITS = ControllerLimits(
    max_linear_speed=2.0, max_angular_speed=4.0, max_linear_acceleration=3.0,
    max_linear_deceleration=3.0, max_angular_acceleration=10.0, max_module_speed=3.6,
    max_steering_rate=8.0)
OFFSETS = Offsets(complex(x, y) for x, y in LAYOUTS['four'])


def random_twist(rng):
    """Return a twist within the limits."""
    return PlanarTwist(complex(*rng.uniform(-1.2, 1.2, 2)), rng.uniform(-2.2, 2.2))


def periods(start, target, limits=LIMITS, layout='four'):
    """Return the commands on the way from one steady twist to another, up to the arrival."""
    controller = SwerveController(SwerveKinematics(LAYOUTS[layout]), limits)
    for _ in range(150):
        controller.update(start, None, DT)
    commands = [controller.update(target, None, DT)]
    while np.abs(commands[-1].twist - target).max() > 1e-9:
        commands.append(controller.update(target, None, DT))
        assert len(commands) < 500
    return commands


def test_a_module_goes_through_rest_instead_of_swinging_about():
    # The third module slows down to 0.14 m/s there, and its velocity turns by 141 degrees.
    commands = periods((0.0, 0.0, 1.0), (0.6, 0.3, 0.8))
    assert len(commands) <= 13  # 11.2 periods at 3 m/s^2; 18 if the base waits for the module
    turned = np.abs(commands[-1].angle - commands[0].angle)
    assert turned.max() < math.radians(75.0)


@pytest.mark.parametrize('layout', LAYOUTS)
def test_every_twist_is_reached_and_soon(layout):
    rng, ratios = np.random.default_rng(11), []
    for _ in range(25):
        start, target = random_twist(rng), random_twist(rng)
        change = difference(start, target)
        shortest = max(abs(change.velocity) / 3.0, abs(change.omega) / 10.0)
        ratios.append(len(periods(start.parts, target.parts, layout=layout)) * DT / shortest)
    assert np.mean(ratios) < 1.5
    assert np.max(ratios) < 4.0


def test_the_aim_always_leads_nearer_and_within_the_limits():
    rng, led = np.random.default_rng(3), 0
    for _ in range(3000):
        target, previous = random_twist(rng), random_twist(rng)
        aim = passing(target, previous, OFFSETS, LIMITS, DT)
        if aim is target:
            continue
        led += 1
        arm = math.sqrt(np.mean(np.abs(OFFSETS) ** 2))
        way, aside = (PlanarTwist(twist.velocity, arm * twist.omega) for twist in (
            difference(previous, target), difference(target, aim)))
        assert product(aside, aside) <= LARGEST_DETOUR ** 2 * product(way, way) + 1e-9
        assert abs(aim.velocity) <= 2.0 + 1e-9 and abs(aim.omega) <= 4.0 + 1e-9
    assert 100 < led < 1500


def test_from_rest_to_rest_and_along_a_curve_the_aim_is_the_target():
    rng = np.random.default_rng(4)
    for _ in range(300):
        twist = random_twist(rng)
        for target, previous in ((twist, REST), (REST, twist), (scaled(twist, 0.3), twist),
                                 (twist, scaled(twist, 0.3))):
            assert passing(target, previous, OFFSETS, LIMITS, DT) is target


@pytest.mark.parametrize('target, turn, expected', [
    (PlanarTwist(-1.0 + 0.1j, 0.0), 0.1, True),
    (PlanarTwist(-1.0 + 1.0j, 0.0), math.pi / 4, False),
    (PlanarTwist(-0.2 + 0.05j, 0.0), 0.25, True)])
def test_rest_is_made_for_where_that_is_sooner(target, turn, expected):
    assert is_sooner_by_rest(
        target, PlanarTwist(1.0 + 0j, 0.0), turn, OFFSETS, LIMITS, DT) == expected


def test_a_velocity_that_turns_by_less_than_a_right_angle_more_needs_no_rest():
    commands = periods((1.0, 0.0, 0.0), (-0.7, 0.7, 0.0))
    assert min(np.abs(command.speed).min() for command in commands) > 0.3
    assert len(commands) <= 1.9 / 3.0 / DT + 2


def test_a_wheel_that_turns_over_next_to_rest_hardly_slides():
    rng, turned_over = np.random.default_rng(5), 0
    for _ in range(4000):
        start = Setpoint(rng.uniform(-0.1, 0.1), rng.uniform(-3.0, 3.0))
        goal = Setpoint(rng.uniform(-0.1, 0.1), start.angle + rng.uniform(-1.5, 1.5))
        step = rng.uniform(0.05, 0.3)
        fraction = common_fraction([start], [goal], step, 0.1)
        reached = next_setpoint(start, goal, fraction, step)
        assert abs(reached.angle - start.angle) <= step + 1e-12
        if start.speed * reached.speed < 0.0:
            turned_over += 1
            on_the_way = _velocity(start) + fraction * (_velocity(goal) - _velocity(start))
            assert abs(on_the_way - _velocity(reached)) <= SLIDING_SPEED + 1e-9
    assert turned_over > 100


def _velocity(setpoint):
    """Return a setpoint as a complex velocity."""
    return setpoint.speed * complex(math.cos(setpoint.angle), math.sin(setpoint.angle))


@pytest.mark.parametrize('seed', range(4))
def test_the_wheels_of_a_driven_base_never_fight_each_other(seed):
    kin, rng = SwerveKinematics(LAYOUTS['four']), np.random.default_rng(seed)
    controller = SwerveController(kin, LIMITS)
    for _ in range(12):
        twist = random_twist(rng).parts
        for _ in range(int(rng.choice([10, 40]))):
            command = controller.update(twist, None, DT)
            states = ModuleStates(command.speed, command.angle)
            assert kin.residuals(states).max() <= 2.0 * SLIDING_SPEED
