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

"""Commands that are not worth a turn of the wheels, and those that are."""

import math

import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits

DT = 0.02
KIN = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
RAMPS = {'max_linear_acceleration': 2.0, 'max_linear_deceleration': 3.0,
         'max_angular_acceleration': 6.0, 'max_steering_rate': 8.0}
LIMITS = ControllerLimits(min_steering_speed=0.012, **RAMPS)
LITERAL = ControllerLimits(**RAMPS)


def follow(controller, twists, measured=None):
    """Return the commands for a sequence of twists, the modules following each at once."""
    measured, commands = np.zeros(4) if measured is None else measured, []
    for twist in twists:
        commands.append(controller.update(twist, measured, DT))
        measured = commands[-1].angle
    return commands


@pytest.mark.parametrize('period', [1, 2])
@pytest.mark.parametrize('deviation', [0.0005, 0.002, 0.005])
@pytest.mark.parametrize('after_drive', [False, True])
def test_noise_at_rest_turns_no_module(deviation, period, after_drive):
    for seed in range(10):
        rng = np.random.default_rng(seed)
        controller = SwerveController(KIN, LIMITS)
        measured = np.zeros(4)
        if after_drive:
            drive = [(0.8, 0.3, 0.5)] * 60 + [(0.0, 0.0, 0.0)] * 40
            measured = follow(controller, drive)[-1].angle
        noise = np.repeat(rng.normal(size=(500, 3)) * deviation, period, axis=0)[:500]
        turns = np.abs([command.angle - measured
                        for command in follow(controller, noise, measured)])
        assert np.degrees(turns.max()) < 5.0


@pytest.mark.parametrize('twist', [
    (0.02, 0.0, 0.0), (0.0, 0.02, 0.0), (-0.015, 0.015, 0.0), (0.0, 0.0, 0.05), (0.0, 0.0, -0.1)])
@pytest.mark.parametrize('deviation', [0.0, 0.002])
def test_a_slow_steady_command_is_executed(twist, deviation):
    noise = np.random.default_rng(1).normal(size=(250, 3)) * deviation
    commands = follow(SwerveController(KIN, LIMITS), twist + noise)
    began = next(i for i, command in enumerate(commands) if command.angle.any()
                 or command.speed.any())
    assert began * DT < 0.2
    executed = np.array([command.twist for command in commands[50:]])
    np.testing.assert_allclose(executed.mean(axis=0), twist,
                               atol=0.05 * np.linalg.norm(twist) + deviation / 5)


@pytest.mark.parametrize('twist', [(0.5, 0.0, 0.0), (0.3, -0.2, 0.8)])
def test_creeping_into_a_goal_arrives_exactly(twist):
    twists = np.array([twist]) * np.exp(-0.02 * np.arange(600))[:, np.newaxis]
    ours = follow(SwerveController(KIN, LIMITS), twists)
    literal = follow(SwerveController(KIN, LITERAL), twists)
    np.testing.assert_array_equal([command.twist for command in ours],
                                  [command.twist for command in literal])
    assert np.linalg.norm(ours[-1].twist) < 1e-5


def test_a_curve_of_falling_speed_ends_within_millimetres():
    time = DT * np.arange(500)
    heading = 0.5 * time
    speed = 0.4 * np.exp(-time)
    twists = np.column_stack((speed * np.cos(heading), speed * np.sin(heading), 0.0 * time))
    ours, literal = (
        np.sum([command.twist for command in follow(SwerveController(KIN, limits), twists)],
               axis=0) * DT for limits in (LIMITS, LITERAL))
    assert np.abs(ours - literal).max() < 0.003


def test_nothing_changes_for_commands_well_above_the_threshold():
    rng = np.random.default_rng(3)
    twists = np.repeat(rng.uniform(-1, 1, (20, 3)), 25, axis=0)
    twists += 0.1 * np.sign(twists)
    ours = follow(SwerveController(KIN, LIMITS), twists)
    literal = follow(SwerveController(KIN, LITERAL), twists)
    np.testing.assert_array_equal([command.angle for command in ours],
                                  [command.angle for command in literal])


@pytest.mark.parametrize('value', [-0.1, math.inf, math.nan])
def test_a_threshold_that_makes_no_sense_is_named(value):
    with pytest.raises(ValueError, match='min_steering_speed must be zero or more'):
        ControllerLimits(min_steering_speed=value)
