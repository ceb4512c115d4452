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

"""Joints with end stops: the long way round, and commands that no angle in range allows."""

import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from swerve_kinematics import SwerveController, SwerveKinematics
from swerve_kinematics.core.control.limits import ControllerLimits

KIN = SwerveKinematics([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
LIMITS = ControllerLimits(max_linear_acceleration=2.0, max_linear_deceleration=2.0,
                          max_steering_rate=6.0)
DT = 0.02


def controller(policy='project', end=math.radians(60.0)):
    """Return the controller of modules that steer by an angle [rad] to either side."""
    return SwerveController(KIN, LIMITS, steering_lower_limits=[-end] * 4,
                            steering_upper_limits=[end] * 4, unreachable_policy=policy)


def driven(control, twist, periods, angles=None):
    """Return the commands of some periods, the modules following at once."""
    commands = []
    for _ in range(periods):
        angles = commands[-1].angle if commands else np.zeros(4) if angles is None else angles
        commands.append(control.update(twist, angles, DT))
    return commands


def test_a_module_at_the_end_of_its_range_turns_round_at_rest():
    end = math.radians(100.0)
    control = controller(end=end)
    before = driven(control, (0.0, 1.0, 0.0), 60)[-1]
    commands = driven(control, (-1.0, 1.0, 0.0), 100, before.angle)
    assert np.abs([command.angle for command in commands]).max() <= end + 1e-9
    assert commands[-1].angle == pytest.approx([-math.pi / 4] * 4)
    assert commands[-1].twist == pytest.approx([-1.0, 1.0, 0.0])
    turning = [after for before, after in zip(commands, commands[1:])
               if after.angle[0] < before.angle[0] - 0.9 * LIMITS.max_steering_rate * DT]
    assert len(turning) > 10
    assert all(np.abs(command.speed).max() < 1e-6 for command in turning[:-1])


def test_the_nearest_twist_is_that_along_the_end_stops():
    control, end = controller(), math.radians(60.0)
    command = driven(control, (0.0, 1.0, 0.0), 300, np.full(4, 0.1))[-1]
    assert command.unreachable.all()
    assert command.angle == pytest.approx([end] * 4)
    assert KIN.residuals((command.speed, command.angle)).max() < 1e-9
    across = math.sin(end)
    assert command.twist == pytest.approx(
        [across * math.cos(end), across * math.sin(end), 0.0], abs=1e-3)
    command = driven(control, (0.0, 0.0, 1.0), 300, command.angle)[-1]
    assert not command.unreachable.any()
    assert command.twist == pytest.approx([0.0, 0.0, 1.0])


@pytest.mark.parametrize('end', [60.0, 75.0, 85.0])
def test_a_base_goes_on_along_its_end_stops_where_the_direction_wavers(end):
    control, rng = controller(end=math.radians(end)), np.random.default_rng(1)
    angles, speeds = np.zeros(4), []
    for k in range(600):
        direction = 0.5 * math.pi + 0.05 * math.sin(0.03 * k) + rng.normal(0.0, 0.01)
        command = control.update(
            (math.cos(direction), math.sin(direction), rng.normal(0.0, 0.01)), angles, DT)
        angles = command.angle
        speeds.append(math.hypot(*command.twist[:2]))
    assert min(speeds[150:]) > 0.8 * math.sin(math.radians(end))


@pytest.mark.parametrize('policy, is_moving', [('project', True), ('stop', False)])
def test_a_twist_out_of_reach_is_projected_or_stops_the_base(policy, is_moving):
    control = controller(policy)
    before = driven(control, (1.0, 0.0, 0.0), 60)[-1]
    after = driven(control, (0.3, 1.0, 0.0), 150, before.angle)
    assert np.hypot(*before.twist[:2]) == pytest.approx(1.0)
    assert after[-1].unreachable.all()
    assert bool(np.hypot(*after[-1].twist[:2]) > 0.1) is is_moving
    if not is_moving:
        speeds = np.array([np.hypot(*command.twist[:2]) for command in after])
        assert np.diff(speeds).min() > -2.0 * DT - 1e-9 and not after[-1].speed.any()
        np.testing.assert_allclose(after[-1].angle, before.angle)
    again = driven(control, (0.5, 0.5, 0.0), 100, after[-1].angle)[-1]
    np.testing.assert_allclose(again.twist, (0.5, 0.5, 0.0), atol=1e-6)
    assert not again.unreachable.any()


def test_another_policy_is_refused():
    with pytest.raises(ValueError, match='ask'):
        controller('ask')


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_end_stops_keep_the_accelerations_of_the_base_within_their_limits(seed):
    rng = np.random.default_rng(seed)
    limits = ControllerLimits(
        max_linear_acceleration=1.0, max_linear_deceleration=1.0, max_steering_rate=8.0,
        max_angular_acceleration=rng.choice([2.0, np.inf]))
    lower, upper = rng.uniform(-3.0, -0.3, 4), rng.uniform(0.3, 3.0, 4)
    control, before = SwerveController(KIN, limits, (0.0, 0.0), lower, upper), np.zeros(3)
    for step in range(150):
        if step % 15 == 0:
            target = rng.uniform(-1, 1, 3) * (2.0, 2.0, 4.0) * rng.choice([0.0, 1.0, 1.0], 3)
        dt = rng.uniform(0.005, 0.05)
        twist = control.update(target, None, dt).twist
        velocity, previous = complex(*twist[:2]), complex(*before[:2])
        # A straight line in the world, which turns back in the base frame, is no acceleration.
        turn = np.clip(np.angle(velocity * previous.conjugate()), *sorted((0.0, -before[2] * dt)))
        assert abs(velocity - previous * np.exp(1j * turn)) <= 1.0 * dt * (1.0 + 1e-6)
        assert abs(twist[2] - before[2]) <= limits.max_angular_acceleration * dt * (1.0 + 1e-6)
        before = twist


def drive_at_end_stops(seed):
    """Return the commands of a random drive at random end stops, and the limits of the base."""
    rng = np.random.default_rng(seed)
    limits = ControllerLimits(
        max_linear_speed=2.0, max_angular_speed=4.0, max_linear_acceleration=1.0,
        max_linear_deceleration=1.0, max_angular_acceleration=4.0, max_module_speed=2.5,
        max_linear_jerk=rng.choice([5.0, 20.0, 100.0]),
        max_angular_jerk=rng.choice([20.0, 80.0, 400.0]))
    ends = rng.uniform(0.3, 3.0, (2, 4)) if rng.random() < 0.5 else (
        np.full((2, 4), rng.choice([0.8, 1.05, 1.5])))
    control, commands = SwerveController(KIN, limits, (0.0, 0.0), -ends[0], ends[1]), []
    for step in range(300):
        if step % 30 == 0:
            target = rng.uniform(-1, 1, 3) * (2.0, 2.0, 4.0) * rng.choice([0.0, 1.0, 1.0], 3)
        angles = commands[-1].angle if commands else np.zeros(4)
        commands.append(control.update(target, angles, DT))
    return commands, limits


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_at_end_stops_the_base_keeps_its_limits_and_the_wheels_hardly_drag_each_other(seed):
    commands, limits = drive_at_end_stops(seed)
    twists = np.vstack((np.zeros((2, 3)), [command.twist for command in commands]))
    velocity, slack = twists[:, 0] + 1j * twists[:, 1], 1.0 + 1e-4
    assert np.abs(np.diff(velocity)).max() <= limits.max_linear_acceleration * DT * slack
    assert np.abs(np.diff(twists[:, 2])).max() <= limits.max_angular_acceleration * DT * slack
    assert np.abs(np.diff(velocity, 2)).max() <= limits.max_linear_jerk * DT ** 2 * slack
    assert np.abs(np.diff(twists[:, 2], 2)).max() <= limits.max_angular_jerk * DT ** 2 * slack
    speeds, angles = (np.array([getattr(command, name) for command in commands])
                      for name in ('speed', 'angle'))
    assert KIN.residuals((speeds, angles)).max() < 0.1


@pytest.mark.parametrize('jerk', [math.inf, 20.0])
@pytest.mark.parametrize('half_range', [0.5 * math.pi, 1.92])
@pytest.mark.parametrize('module', range(4))
@pytest.mark.parametrize('omega', [-1.0, 1.0, 2.0])
@pytest.mark.parametrize('speed', [0.0, 0.3, 1.0])
def test_a_curve_on_which_a_module_is_next_to_an_end_stop_is_run_evenly(
        jerk, half_range, module, omega, speed):
    limits = ControllerLimits(
        max_linear_acceleration=1.0, max_angular_acceleration=3.0, max_linear_jerk=jerk,
        max_module_acceleration=2.0, max_steering_rate=4.0)
    ends = np.full(4, half_range)
    controller = SwerveController(KIN, limits, (0.0, 0.0), -ends, ends)
    # The module moves just inside the end, and beyond it once the command is discretized.
    direction = np.exp(1j * math.copysign(half_range - 0.005, -omega))
    velocity = speed * direction - 1j * omega * complex(*KIN.module_positions[module])
    twist = velocity.real, velocity.imag, omega
    commands = [controller.update(twist, None, 0.02) for _ in range(400)][-50:]
    assert commands[-1].twist == pytest.approx(twist, abs=1e-6)
    assert np.ptp([command.speed for command in commands], axis=0).max() < 1e-9
    assert np.ptp([command.angle for command in commands], axis=0).max() < 1e-9
