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

"""Curves that the base does not follow with its heading: slower where need be, but the same."""

import cmath
import math

from hypothesis import given, strategies as st
import numpy as np
import pytest

from swerve_kinematics import ModuleStates, se2_compose, se2_exp, SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.control.pace import turn_back

DT = 0.02
KIN = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
LIMITS = ControllerLimits(
    max_linear_speed=3.0, max_angular_speed=6.0, max_linear_acceleration=2.0,
    max_linear_deceleration=3.0, max_angular_acceleration=6.0, max_module_speed=4.0,
    max_steering_rate=8.0)


def drive_line(speed, omega, in_field, limits=LIMITS, duration=8.0):
    """Drive a straight line along the world's x while turning; return poses and commands."""
    controller, pose, measured = SwerveController(KIN, limits), np.zeros(3), np.zeros(4)
    poses, commands = [pose], []
    for _ in range(int(duration / DT)):
        along = cmath.rect(speed, -pose[2])
        command = (controller.update((speed, 0.0, omega), measured, DT, pose[2]) if in_field else
                   controller.update((along.real, along.imag, omega), measured, DT))
        measured = command.angle
        executed = KIN.forward(ModuleStates(command.speed, command.angle))
        pose = se2_compose(pose, se2_exp(executed * DT))
        poses.append(pose)
        commands.append(command)
    return np.array(poses), commands


@pytest.mark.parametrize('in_field', [False, True])
@pytest.mark.parametrize('speed, omega', [(1.0, 3.0), (1.5, 3.0), (1.5, -3.0), (2.0, 4.0)])
def test_a_line_in_the_world_stays_where_it_is_however_fast_the_base_turns(
        speed, omega, in_field):
    poses, commands = drive_line(speed, omega, in_field)
    x, y = poses[-1, :2]
    assert abs(math.degrees(math.atan2(y, x))) < 1.5
    # Slower, where the steering must follow, both parts alike.
    turned = poses[-1, 2] / (omega * 8.0)
    assert x / (speed * 8.0) == pytest.approx(turned, abs=0.01) and turned > 0.6
    assert min(command.scale for command in commands) < 1.0


@pytest.mark.parametrize('in_field', [False, True])
@pytest.mark.parametrize('speed, omega', [(1.0, 1.0), (2.0, 2.0), (2.0, 1.0), (0.3, 3.0)])
def test_a_line_within_the_limits_is_not_slowed(speed, omega, in_field):
    poses, commands = drive_line(speed, omega, in_field)
    assert abs(math.degrees(math.atan2(poses[-1, 1], poses[-1, 0]))) < 0.1
    speeds = np.hypot(*np.diff(poses[:, :2], axis=0).T) / DT
    assert speeds[75:].min() > 0.97 * speed
    assert all(command.scale == 1.0 for command in commands)


@pytest.mark.parametrize('twist', [(1.5, 0.0, 3.0), (0.7, -2.0, -1.5)])
def test_an_arc_of_the_base_is_not_slowed(twist):
    controller, measured = SwerveController(KIN, LIMITS), np.zeros(4)
    for _ in range(100):
        command = controller.update(twist, measured, DT)
        assert command.scale == 1.0
        measured = command.angle
    assert command.twist == pytest.approx(twist)


def test_the_drives_keep_up_on_a_line_while_the_base_turns():
    limits = ControllerLimits(max_module_acceleration=1.5)
    poses, commands = drive_line(1.0, 3.0, True, limits)
    assert abs(math.degrees(math.atan2(poses[-1, 1], poses[-1, 0]))) < 1.0
    assert all(command.fraction == 1.0 for command in commands[100:])


@pytest.mark.parametrize('rate, message_period', [(3.0, 1), (-3.0, 1), (3.0, 3)])
def test_a_curve_too_tight_for_the_acceleration_is_run_slower(rate, message_period):
    controller, measured = SwerveController(KIN, LIMITS), np.zeros(4)
    velocities, errors = [], []
    for step in range(300):
        if step % message_period == 0:
            commanded = cmath.rect(1.5, rate * step * DT)
        command = controller.update((commanded.real, commanded.imag, 0.0), measured, DT)
        measured = command.angle
        velocities.append(complex(*command.twist[:2]))
        errors.append(cmath.phase(velocities[-1] / commanded))
    assert np.abs(np.degrees(errors[100:])).max() < 12.0
    assert np.abs(velocities[100:]).mean() == pytest.approx(2.0 / 3.0, abs=0.1)
    assert np.abs(np.diff(velocities)).max() <= 3.0 * DT + 1e-9


COMPLEX = st.complex_numbers(max_magnitude=5.0, allow_nan=False)


@given(velocity=COMPLEX, goal=COMPLEX, base_turn=st.floats(-1.0, 1.0))
def test_the_part_of_the_turn_is_the_one_that_leaves_the_smallest_change(
        velocity, goal, base_turn):
    best = abs(goal - velocity * cmath.rect(1.0, turn_back(velocity, goal, base_turn)))
    for part in np.linspace(0.0, 1.0, 21):
        assert best <= abs(goal - velocity * cmath.rect(1.0, -part * base_turn)) + 1e-9
