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

"""Jerk limits hold whatever is commanded, and all other limits with them."""

import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits

DT = 0.02
KIN = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])


def random_limits(rng, **more):
    """Return limits of a base, jerk among them; some of the others may be missing."""
    rate = rng.uniform(0.5, 4.0)
    chosen = {
        'max_linear_speed': 2.0, 'max_angular_speed': 4.0, 'max_linear_acceleration': rate,
        'max_linear_deceleration': rate * rng.uniform(0.5, 2.0),
        'max_angular_acceleration': rng.uniform(2.0, 12.0), 'max_module_speed': 2.5}
    chosen = {name: value for name, value in chosen.items() if rng.random() < 0.8}
    return ControllerLimits(max_linear_jerk=10.0 ** rng.uniform(0.3, 2.0),
                            max_angular_jerk=10.0 ** rng.uniform(0.5, 2.3), **chosen, **more)


def random_targets(rng):
    """Return a sequence of twists that change all of a sudden, reversals and stops included."""
    twists = [rng.uniform(-1, 1, 3) * (2.0, 2.0, 4.0)]
    for _ in range(7):
        fresh = rng.uniform(-1, 1, 3) * (2.0, 2.0, 4.0) * rng.choice([0.0, 1.0, 1.0], 3)
        choices = np.array([fresh, -twists[-1], 0.0 * fresh, twists[-1] + 0.1 * fresh])
        twists.append(rng.choice(choices))
    return twists


def driven(controller, rng):
    """Return the commands for random targets, the modules following at once."""
    measured, commands = np.zeros(4), []
    for target in random_targets(rng):
        for _ in range(int(rng.choice([3, 12, 40, 120]))):
            commands.append(controller.update(target, measured, DT))
            measured = commands[-1].angle
    return commands


@pytest.mark.parametrize('modules', [
    {}, {'max_steering_rate': 8.0}, {'max_steering_rate': 4.0, 'max_module_acceleration': 4.0}])
@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_sudden_changes_of_target_keep_every_limit(modules, seed):
    rng = np.random.default_rng(seed)
    limits = random_limits(rng, **modules)
    commands = driven(SwerveController(KIN, limits), rng)
    twists = np.vstack((np.zeros((2, 3)), [command.twist for command in commands]))
    velocity = twists[:, 0] + 1j * twists[:, 1]
    slack = 1.0 + 1e-4
    assert np.abs(np.diff(velocity, 2)).max() <= limits.max_linear_jerk * DT ** 2 * slack + 1e-9
    assert np.abs(np.diff(twists[:, 2], 2)).max() <= (
        limits.max_angular_jerk * DT ** 2 * slack + 1e-9)
    growing = np.diff(np.abs(velocity)) > 0.0
    change = np.abs(np.diff(velocity))
    assert (change <= np.where(growing, limits.max_linear_acceleration, max(
        limits.max_linear_acceleration, limits.max_linear_deceleration)) * DT * slack).all()
    assert np.abs(np.diff(twists[:, 2])).max() <= limits.max_angular_acceleration * DT * slack
    assert np.abs(velocity).max() <= limits.max_linear_speed * slack
    assert np.abs(twists[:, 2]).max() <= limits.max_angular_speed * slack
    speeds = np.array([command.speed for command in commands])
    angles = np.array([command.angle for command in commands])
    assert np.abs(speeds).max() <= limits.max_module_speed * slack
    assert np.abs(np.diff(speeds, axis=0)).max() <= (
        limits.max_module_acceleration * DT * slack)
    assert np.abs(np.diff(angles, axis=0)).max() <= limits.max_steering_rate * DT * slack


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_periods_of_any_length_in_any_frame_keep_every_limit_of_speed(seed):
    rng = np.random.default_rng(seed)
    controller = SwerveController(KIN, random_limits(rng), rng.choice([(0.0, 0.0), (0.4, -0.3)]))
    limits, heading, measured = controller.limits, 0.0, np.zeros(4)
    shortest, longest = np.sort(rng.uniform(-3.0, 0.0, 2))
    for target in random_targets(rng):
        in_field = rng.random() < 0.7
        for dt in 10.0 ** rng.uniform(shortest, longest, 20):
            command = controller.update(target, measured, dt, heading if in_field else None)
            measured, heading = command.angle, heading + command.twist[2] * dt
            vx, vy, omega = command.twist
            assert math.hypot(vx, vy) <= limits.max_linear_speed * (1.0 + 1e-6)
            assert abs(omega) <= limits.max_angular_speed * (1.0 + 1e-6)
            assert np.abs(command.speed).max() <= limits.max_module_speed * (1.0 + 1e-6)


def test_the_very_limit_of_speed_is_reached():
    controller = SwerveController(KIN, ControllerLimits(
        max_linear_speed=1.5, max_linear_acceleration=2.0, max_linear_jerk=20.0))
    for step in range(100):
        if controller.update((3.0, 0.0, 0.0), None, DT).twist[0] == 1.5:
            break
    # As soon as the two limits allow, and a few periods.
    assert step * DT == pytest.approx(1.5 / 2.0 + 2.0 / 20.0, abs=4 * DT)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_every_target_is_reached_and_kept(seed):
    rng = np.random.default_rng(seed)
    controller = SwerveController(KIN, random_limits(rng, max_steering_rate=8.0))
    measured = driven(controller, rng)[-1].angle
    target = rng.uniform(-1, 1, 3) * (1.2, 1.2, 2.0)
    for _ in range(600):
        command = controller.update(target, measured, DT)
        measured = command.angle
    np.testing.assert_allclose(command.twist, target, rtol=1e-9)
    for _ in range(600):
        command = controller.update((0.0, 0.0, 0.0), measured, DT)
        measured = command.angle
    assert not command.twist.any() and not command.speed.any()


@pytest.mark.parametrize('reason', ['lock', 'unknown angle'])
@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_whatever_stops_a_base_that_turns_on_straight_lines_stops_it(reason, seed):
    rng = np.random.default_rng(seed)
    limits = ControllerLimits(
        max_linear_speed=2.0, max_linear_acceleration=2.0, max_linear_deceleration=3.0,
        max_angular_acceleration=6.0, max_module_speed=3.0, max_steering_rate=8.0,
        max_linear_jerk=10.0 ** rng.uniform(0.7, 2.0), max_angular_jerk=60.0)
    controller = SwerveController(KIN, limits)
    target, heading, measured, fastest = rng.uniform(-2, 2, 3), 0.0, np.zeros(4), []
    for step in range(300):
        if step == 150 and reason == 'lock':
            controller.lock()
        seen = np.where(step >= 150 and reason == 'unknown angle', np.nan, measured)
        command = controller.update(target, seen, DT, heading)
        measured, heading = command.angle, heading + command.twist[2] * DT
        fastest.append(np.abs(command.speed).max())
    # An acceleration may take a while to end, but does not grow.
    assert max(fastest[150:]) <= fastest[150] + 2.0 ** 2 / limits.max_linear_jerk
    assert fastest[-1] == 0.0


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_a_stop_does_not_pass_through_rest_however_irregular_the_periods_are(seed):
    rng = np.random.default_rng(seed)
    controller, target = SwerveController(KIN, random_limits(rng)), rng.uniform(-2, 2, 3)
    shortest, longest = np.sort(rng.uniform(-2.5, -0.5, 2))
    for _ in range(60):
        before = controller.update(target, None, 0.05).twist
    for dt in 10.0 ** rng.uniform(shortest, longest, 3000):
        command = controller.update((0.0, 0.0, 0.0), None, dt)
        assert command.twist @ before >= 0.0
        if not command.speed.any():
            break
    assert not command.speed.any()


def test_an_emergency_may_break_them():
    controller = SwerveController(KIN, ControllerLimits(max_linear_jerk=5.0))
    for _ in range(100):
        command = controller.update((1.0, 0.0, 0.0), np.zeros(4), DT)
    assert command.speed.min() > 0.5
    controller.reset()
    assert not controller.update((0.0, 0.0, 0.0), np.zeros(4), DT).speed.any()


def test_without_other_limits_the_jerk_alone_sets_the_time():
    controller, limit = SwerveController(KIN, ControllerLimits(max_linear_jerk=9.0)), 9.0
    for step in range(200):
        if controller.update((1.7, 0.0, 0.0), np.zeros(4), DT).twist[0] == 1.7:
            break
    # It takes as long to reach an acceleration a as to end it, and v = a^2 / j in all.
    assert step * DT == pytest.approx(2.0 * math.sqrt(1.7 / limit), abs=4 * DT)


@pytest.mark.parametrize('jerk', [
    {'max_linear_jerk': 20.0}, {'max_angular_jerk': 20.0},
    {'max_linear_jerk': 20.0, 'max_angular_jerk': 40.0, 'max_module_acceleration': 5.0}])
@pytest.mark.parametrize('target', [(0.0, 1.0, 0.0), (-1.0, 0.5, 0.0), (0.3, 0.3, 1.0)])
def test_a_base_that_turns_about_one_of_its_wheels_lets_that_turn_and_then_goes_on(jerk, target):
    limits = ControllerLimits(
        max_linear_acceleration=2.0, max_angular_acceleration=6.0, max_steering_rate=8.0, **jerk)
    controller = SwerveController(KIN, limits, KIN.module_positions[0])
    turning = commands_for(controller, (0.0, 0.0, 1.0), 100)
    assert turning[-1].speed[0] == 0.0 and turning[-1].twist == pytest.approx((0.0, 0.0, 1.0))
    commands = commands_for(controller, target, 100)
    assert commands[-1].twist == pytest.approx(target, abs=1e-6)
    angles = np.array([turning[-1].angle] + [command.angle for command in commands])
    assert np.abs(np.diff(angles, axis=0)).max() <= 8.0 * DT + 1e-9


def commands_for(controller, twist, count):
    """Return so many commands for one twist, the modules following at once."""
    return [controller.update(twist, None, DT) for _ in range(count)]
