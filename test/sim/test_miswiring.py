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

"""Wrong wiring does to commands and readings what it says, and nothing by default."""

from dataclasses import replace

import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.configuration.miswiring import Miswiring
from swerve_kinematics.sim.actuators import Actuator
from swerve_kinematics.sim.base import at_rest, BaseCommand, BaseConfig, step
from swerve_kinematics.sim.miswiring import miswired_command, miswired_reading
from swerve_kinematics.sim.sensors import Reading

COMMAND = BaseCommand(np.array([1.0, 2.0, 3.0, 4.0]), np.array([0.1, 0.2, 0.3, 0.4]))
HELD = BaseCommand(np.zeros(4), np.array([9.0, 8.0, 7.0, 6.0]))
FIRST = Reading(np.zeros(4), np.zeros(4), np.ones(4), np.zeros(4), 0.5, 0.0, False)
READING = Reading(np.array([1.0, 2.0, 3.0, 4.0]), np.ones(4), np.array([0.1, 0.2, 0.3, 0.4]),
                  np.ones(4), 2.0, 0.2, False)


def as_lists(parts):
    return [np.asarray(part).tolist() for part in parts]


def told(**faults):
    command = miswired_command(Miswiring(**faults), COMMAND, HELD)
    return as_lists((command.drive_velocity, command.steering_position))


def read(**faults):
    return as_lists(miswired_reading(Miswiring(**faults), READING, FIRST))


def test_nothing_is_wrong_by_default():
    assert told() == as_lists((COMMAND.drive_velocity, COMMAND.steering_position))
    assert read() == as_lists(READING)


@pytest.mark.parametrize('faults, velocity, position', [
    ({'drive_motors': (1,)}, [1.0, -2.0, 3.0, 4.0], [0.1, 0.2, 0.3, 0.4]),
    ({'steering_motors': (0,)}, [1.0, 2.0, 3.0, 4.0], [-0.1, 0.2, 0.3, 0.4]),
    ({'swapped': (0, 3)}, [4.0, 2.0, 3.0, 1.0], [0.4, 0.2, 0.3, 0.1]),
    ({'dead_drives': (2,)}, [1.0, 2.0, 0.0, 4.0], [0.1, 0.2, 0.3, 0.4]),
    ({'dead_steerings': (2,)}, [1.0, 2.0, 3.0, 4.0], [0.1, 0.2, 7.0, 0.4]),
    ({'emergency_stop': True}, [0.0] * 4, [9.0, 8.0, 7.0, 6.0])])
def test_commands_arrive_wrongly(faults, velocity, position):
    assert told(**faults) == [velocity, position]


@pytest.mark.parametrize('faults, part, expected', [
    ({'drive_encoders': (0,)}, 0, [-1.0, 2.0, 3.0, 4.0]),
    ({'steering_encoders': (3,)}, 2, [0.1, 0.2, 0.3, -0.4]),
    ({'swapped': (0, 1)}, 2, [0.2, 0.1, 0.3, 0.4]),
    ({'frozen': (1,)}, 0, [1.0, 0.0, 3.0, 4.0]), ({'frozen': (1,)}, 1, [1.0, 0.0, 1.0, 1.0]),
    ({'gyro_scale': -1.0}, 4, -2.0), ({'gyro_frozen': True}, 4, 0.5),
    ({'gyro_frozen': True}, 5, 0.0)])
def test_readings_arrive_wrongly(faults, part, expected):
    assert read(**faults)[part] == expected


def test_a_silent_gyro_reads_nothing():
    assert np.isnan(read(gyro_silent=True)[4:6]).all()


def test_a_wheel_off_the_floor_does_not_move_the_base():
    config = BaseConfig(
        SwerveKinematics([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)]),
        ModuleJoints([0.05] * 4), Actuator(0.05, 40.0, 100.0), Actuator(0.03, 8.0, 150.0))
    spinning = BaseCommand(np.array([20.0, 0.0, 0.0, 0.0]), np.zeros(4))
    free = replace(config, free_wheels=(0,))
    assert step(config, at_rest(config), spinning, 0.5).pose[0] > 0.05
    np.testing.assert_allclose(step(free, at_rest(free), spinning, 0.5).pose, 0.0, atol=1e-12)
