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

"""The controller with modules that lag: what reaches the motors, measured over long runs."""

import dataclasses
import math

import numpy as np
import pytest

from swerve_kinematics import (
    discretize, ModuleStates, se2_compose, se2_exp, SwerveKinematics, wrap_angle)
from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.sim import base as sim
from swerve_kinematics.sim.actuators import Actuator

DT = 0.02
RADIUS = 0.05
SLACK = 1e-9
KIN = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
LIMITS = ControllerLimits(
    max_linear_speed=2.0, max_angular_speed=4.0, max_linear_acceleration=4.0,
    max_linear_deceleration=5.0, max_angular_acceleration=12.0, max_module_speed=2.5,
    max_module_acceleration=10.0, max_steering_rate=10.0)
LIMIT_NAMES = [field.name for field in dataclasses.fields(ControllerLimits)]


def follow(angle, command, dt, time_constant, max_rate=1e6):
    """Return where steering joints of first order and limited rate are after `dt`."""
    share = 1.0 - math.exp(-dt / time_constant) if time_constant > 0.0 else 1.0
    return angle + np.clip(share * (command - angle), -max_rate * dt, max_rate * dt)


def random_twists(rng, count):
    """Return a twist sequence of reversals, strafes, spins, stops and sweeps through pi."""
    twists = [rng.uniform(-1, 1, 3) * (2.0, 2.0, 4.0)]
    for _ in range(count - 1):
        last, fresh = twists[-1], rng.uniform(-1, 1, 3) * (2.0, 2.0, 4.0)
        direction = math.pi + rng.uniform(-0.1, 0.1)
        choices = np.array([
            fresh, -last, last * (-1, -1, 1), (0.0, math.copysign(1.5, -last[1]), 0.0),
            (0.0, 0.0, fresh[2]), np.zeros(3), fresh * (1, 1, 0), last + 0.1 * fresh,
            (math.cos(direction), math.sin(direction), 0.1 * fresh[2])])
        twists.append(rng.choice(choices))
    return np.array(twists)


def assert_feasible(commands, measured, dts, limits, continuous=True):
    """Check what SwerveController promises of successive commands, (steps, n) modules."""
    speed = np.array([command.speed for command in commands])
    angle = np.array([command.angle for command in commands])
    dts = np.array(dts)[1:, np.newaxis]
    drive_rate = min(limits.max_module_acceleration, 1e12)
    steering_rate = min(limits.max_steering_rate, 1e12)
    assert np.isfinite(speed).all() and np.isfinite(angle).all()
    assert np.isfinite([command.twist for command in commands]).all()
    assert np.abs(speed).max() <= limits.max_module_speed + SLACK
    assert (np.abs(np.diff(speed, axis=0)) <= drive_rate * dts + SLACK).all()
    assert (np.abs(np.diff(angle, axis=0)) <= steering_rate * dts + SLACK).all()
    if continuous:
        assert np.abs(angle - measured).max() <= math.pi / 2 + SLACK


def simulated_base(rng):
    """
    Return a simulated base of random lag, and its state with the modules anywhere.

    Its motors can do more than the controller's limits ask: were it pressed to its own
    limits, the limits would not have been kept.
    """
    lag = rng.choice([0.005, 0.02, 0.08])
    config = sim.BaseConfig(KIN, ModuleJoints([RADIUS] * 4), Actuator(0.02, 1e3, 1e4),
                            Actuator(lag, 1e3, 1e4))
    return config, dataclasses.replace(
        sim.at_rest(config), steering_angle=rng.uniform(-8.0, 8.0, 4))


@pytest.mark.parametrize('block', range(4))
def test_random_sequences_are_feasible_and_end_on_the_commanded_curve(block):
    settled = 0
    for seed in range(25 * block, 25 * block + 25):
        rng = np.random.default_rng(seed)
        controller, (config, base) = SwerveController(KIN, LIMITS), simulated_base(rng)
        commands, measured = [], []
        for twist in random_twists(rng, 6):
            for period in range(int(rng.choice([10, 30, 90]))):
                measured.append(base.steering_angle)
                command = controller.update(twist, base.steering_angle, DT)
                commands.append(command)
                setpoints = sim.BaseCommand(command.speed / RADIUS, command.angle)
                base = sim.step(config, base, setpoints, DT)
                if period >= 80:
                    settled += 1
                    assert_on_curve(base.twist, twist)
        assert_feasible(commands, np.array(measured), [DT] * len(commands), LIMITS)
    assert settled > 250


def assert_on_curve(executed, twist):
    """Check that the base moves along the commanded curve."""
    if not twist.any():
        np.testing.assert_allclose(executed, 0.0, atol=1e-6)
        return
    scale = math.hypot(*executed[:2], 0.3 * executed[2]) / math.hypot(*twist[:2], 0.3 * twist[2])
    assert 0.3 < scale < 1.01
    skew = discretize(scale * twist, DT)
    np.testing.assert_allclose(executed, skew, atol=0.01 * np.abs(skew).max())
    if np.hypot(*twist[:2]) > 0.1:
        commanded = twist[2] / np.hypot(*twist[:2])
        curvature = executed[2] / np.hypot(*executed[:2])
        assert curvature == pytest.approx(commanded, rel=0.01, abs=1e-4)


@pytest.mark.parametrize('twist', [(1.0, 0.4, 0.9), (-1.2, 0.0, -1.5), (0.0, 0.0, 3.0)])
def test_starting_and_stopping_keep_the_curve(twist):
    controller, angle = SwerveController(KIN, LIMITS), np.zeros(4)
    checked = 0
    for commanded in (twist, (0.0, 0.0, 0.0)):
        for _ in range(70):
            command = controller.update(commanded, angle, DT)
            angle = follow(angle, command.angle, DT, 0.03, 12.0)
            executed = KIN.forward(ModuleStates(command.speed, angle))
            # The modules may still be on their way while the first few cm/s are driven.
            if np.abs(wrap_angle(angle - command.angle)).max() < 0.002 and command.speed.any():
                cross = np.cross(executed, discretize(twist, DT))
                limit = 0.015 * np.linalg.norm(executed) * np.linalg.norm(twist)
                assert np.linalg.norm(cross) <= limit + 1e-9
                checked += 1
    assert checked > 40


@pytest.mark.parametrize('limits', [
    {}, {'max_module_speed': 1.2}, {'max_module_speed': 0.5},
    {'max_module_speed': 1.2, 'max_linear_acceleration': 2.0, 'max_linear_deceleration': 2.0,
     'max_angular_acceleration': 4.0, 'max_module_acceleration': 10.0, 'max_steering_rate': 10.0}])
def test_a_field_line_stays_straight_while_the_base_turns(limits):
    controller, pose = SwerveController(KIN, ControllerLimits(**limits)), np.zeros(3)
    angle, drift = np.zeros(4), []
    for _ in range(2000):
        command = controller.update((1.0, 0.0, 2.0), angle, DT, heading=pose[2])
        angle = command.angle
        executed = KIN.forward(ModuleStates(command.speed, command.angle))
        pose = se2_compose(pose, se2_exp(executed * DT))
        drift.append(abs(pose[1]))
        if pose[0] >= 10.0:
            break
    assert pose[0] >= 10.0
    assert (command.scale < 1.0) == ('max_module_speed' in limits)
    assert max(drift) < 0.005


def random_case(rng):
    """Return a controller of random layout and limits, and the range of its joints."""
    count = rng.integers(2, 7)
    kin = SwerveKinematics(rng.normal(size=(count, 2)) * 10.0 ** rng.uniform(-2, 1))
    limits = ControllerLimits(**{
        name: 10.0 ** rng.uniform(-2, 2) for name in LIMIT_NAMES if rng.random() < 0.7})
    ends = None, None
    if rng.random() < 0.3:
        lower = rng.uniform(-4.0, 0.0, count)
        ends = lower, lower + rng.uniform(0.5, 7.0, count)
    center = rng.normal(size=2) if rng.random() < 0.5 else (0.0, 0.0)
    return SwerveController(kin, limits, center, *ends, rng.choice(['hold', 'lock'])), count, ends


def wild_twist(rng):
    """Return a twist of any size, at times not finite."""
    twist = rng.normal(size=3) * 10.0 ** rng.choice([-300, -7, -1, 0, 0, 0, 1, 300])
    twist[rng.integers(3)] *= rng.choice([0.0, 1.0, 1.0, np.nan, np.inf])
    return twist


@pytest.mark.parametrize('block', range(4))
def test_a_hundred_thousand_wild_updates_keep_every_invariant(block):
    for seed in range(125 * block, 125 * block + 125):
        rng = np.random.default_rng(seed)
        controller, count, (lower, upper) = random_case(rng)
        continuous = lower is None
        angle = rng.normal(size=count) * 10.0 if continuous else rng.uniform(lower, upper)
        time_constant, in_field = rng.choice([0.0, 0.02, 0.1]), rng.random() < 0.3
        commands, measured, dts, dt = [], [], [], DT
        for step in range(200):
            if step % 20 == 0:
                twist = wild_twist(rng)
                dt = DT if step == 0 else rng.choice([0.0, 1e-12, 1e-3, DT, DT, 0.1, 1.0])
            seen = angle.copy()
            if step % 37 == 36:
                seen[step % count] = np.nan
            measured.append(angle)
            dts.append(dt)
            commands.append(controller.update(twist, seen, dt, rng.normal() if in_field else None))
            angle = follow(angle, commands[-1].angle, dt, time_constant)
        assert_feasible(commands, np.array(measured), dts, controller.limits, continuous)
        assert all(0.0 < c.scale <= 1.0 and 0.0 <= c.fraction <= 1.0 for c in commands)
        if not continuous:
            told = np.array([command.angle for command in commands])
            assert ((told >= lower - SLACK) & (told <= upper + SLACK)).all()
