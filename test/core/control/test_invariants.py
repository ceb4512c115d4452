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

"""What holds for every input, however odd: layouts, limits, quantities and steps at the edge."""

import dataclasses
import math

import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits

LIMIT_NAMES = [field.name for field in dataclasses.fields(ControllerLimits)]


def odd_number(rng, largest=12.0):
    """Return a number of any size up to 1e12, and of either sign."""
    return rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-largest, largest)


def odd_limits(rng):
    """Return limits from absurdly low to absurdly high, some of them missing."""
    spread = rng.choice([1.0, 12.0])
    return ControllerLimits(**{
        name: 10.0 ** rng.uniform(-spread, spread) for name in LIMIT_NAMES
        if rng.random() < 0.7})


def odd_case(rng):
    """Return a controller of a random kind, the range of its joints, and its module count."""
    count = int(rng.integers(2, 8))
    positions = rng.normal(size=(count, 2)) * 10.0 ** rng.uniform(-3, 12 * (rng.random() < 0.2))
    lower, upper = np.full(count, -np.inf), np.full(count, np.inf)
    if rng.random() < 0.5:
        lower = rng.uniform(-4.0, 2.0, count)
        upper = lower + 10.0 ** rng.uniform(-3.0, 1.0, count)
    center = (0.0, 0.0) if rng.random() < 0.5 else (odd_number(rng), odd_number(rng, 1.0))
    controller = SwerveController(SwerveKinematics(positions), odd_limits(rng), center, lower,
                                  upper, rng.choice(['hold', 'lock']))
    return controller, lower, upper, count


def odd_twist(rng):
    """Return a twist: ordinary, huge, tiny, along one axis, or not finite."""
    twist = rng.normal(size=3) * 10.0 ** rng.choice([-300, -12, -3, 0, 0, 0, 0, 6, 12, 300])
    return twist * rng.choice([0.0, 1.0, 1.0, 1.0, np.nan, np.inf],
                              3, p=[0.2, 0.3, 0.2, 0.25, 0.025, 0.025])


def odd_angles(rng, near):
    """Return what encoders might say: near the truth, far off, or nothing."""
    if rng.random() < 0.9:
        return near + rng.normal(size=len(near)) * 10.0 ** rng.uniform(-4, 0)
    odd = np.array([odd_number(rng) for _ in near])
    return np.where(rng.random(len(near)) < 0.5, odd, rng.choice([np.nan, np.inf, 1.7e308]))


def change_something(rng, controller):
    """Do what a node does now and then: other limits, a lock, a reset, another centre."""
    event = rng.integers(12)
    if event < 4:
        controller.limits = odd_limits(rng)
    elif event == 4:
        controller.reset()
    elif event == 5:
        controller.center_of_rotation = odd_number(rng, 2.0), odd_number(rng, 2.0)
    elif event < 8:
        controller.lock()
    else:
        controller.unlock()


def assert_invariants(before, after, controller, lower, upper, dt):
    """Check one command against the one before."""
    speed, angle = after.speed, after.angle
    assert np.isfinite(speed).all() and np.isfinite(angle).all()
    assert np.isfinite(after.twist).all()
    assert 0.0 < after.scale <= 1.0 and 0.0 <= after.fraction <= 1.0
    assert ((angle >= lower) & (angle <= upper)).all()
    # Beyond a limit that was lowered, speeds fall; they never rise.
    allowed = np.maximum(np.abs(before.speed), controller.limits.max_module_speed)
    assert (np.abs(speed) <= allowed * (1.0 + 1e-9)).all()
    step = controller.limits.max_module_acceleration * dt
    rounding = 1e-9 * (1.0 + np.abs(speed) + np.abs(before.speed))
    assert (np.abs(speed - before.speed) <= step + rounding).all()


@pytest.mark.parametrize('block', range(8))
def test_whatever_comes_every_command_is_finite_and_within_its_limits(block):
    for seed in range(60 * block, 60 * block + 60):
        rng = np.random.default_rng(seed)
        controller, lower, upper, count = odd_case(rng)
        twist = odd_twist(rng)
        command = controller.update((0.0, 0.0, 0.0), np.clip(np.zeros(count), lower, upper), 0.0)
        for _ in range(60):
            if rng.random() < 0.2:
                twist = odd_twist(rng)
            was_reset = rng.random() < 0.05
            if was_reset:
                change_something(rng, controller)
                command = controller.update(twist, command.angle, 0.0)
            dt = 10.0 ** rng.uniform(-6.0, 0.0)
            heading = None if rng.random() < 0.5 else odd_number(rng)
            measured = None if rng.random() < 0.3 else command.twist + rng.normal(size=3)
            before, command = command, controller.update(
                twist, odd_angles(rng, command.angle), dt, heading, measured)
            assert_invariants(before, command, controller, lower, upper, dt)


@pytest.mark.parametrize('angle', [1.25, -4.0, 1e11 + 2.0])  # nor are they a turn later
def test_a_joint_found_beyond_an_end_stop_is_told_to_come_back(angle):
    ends = np.full(4, 1.2)
    kin = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
    controller = SwerveController(kin, ControllerLimits(), (0.0, 0.0), -ends, ends)
    found = np.array([0.0, 0.0, 0.0, angle])
    for twist in ((0.0, 0.0, 0.0), (1.0, 0.4, 0.0)):
        command = controller.update(twist, found, 0.02)
        assert (np.abs(command.angle) <= ends).all()
    controller.reset()
    assert controller.update((0.0, 0.0, 0.0), found, 0.02).angle[3] == math.copysign(1.2, angle)


def test_a_joint_whose_range_leaves_out_zero_is_never_told_zero():
    kin = SwerveKinematics([(0.3, 0.0), (-0.3, 0.0)])
    controller = SwerveController(kin, ControllerLimits(), (0, 0), [0.5, 0.5], [2.0, 2.0])
    command = controller.update((0.0, 0.0, 0.0), (math.nan, 1.0), 0.02)
    assert command.angle == pytest.approx([0.5, 1.0])


@pytest.mark.parametrize('limits', [
    ControllerLimits(), ControllerLimits(max_linear_acceleration=2.0, max_steering_rate=6.0),
    ControllerLimits(max_linear_jerk=20.0), ControllerLimits(max_grip_acceleration=4.0)])
@pytest.mark.parametrize('axis', range(3))
def test_what_a_decaying_filter_leaves_on_an_axis_is_nothing(limits, axis):
    kin = SwerveKinematics([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
    clean, traced = SwerveController(kin, limits), SwerveController(kin, limits)
    rng = np.random.default_rng(3)
    for _ in range(200):
        twist, trace = np.zeros(3), np.zeros(3)
        twist[axis - 1] = rng.uniform(2.0, 3.0)
        trace[axis] = rng.integers(-4, 5) * 5e-324
        expected = clean.update(twist, None, 0.02)
        command = traced.update(twist + trace, None, 0.02)
        np.testing.assert_allclose(command.speed, expected.speed, atol=1e-12)
        np.testing.assert_allclose(command.angle, expected.angle, atol=1e-12)
