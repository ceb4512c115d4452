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

"""No wheel contact is accelerated by more than the floor can hold, and the curve is kept."""

import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.grip import gripping, slowest_factor, steady_scale
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.geometry.planar import PlanarTwist

DT = 0.02
POSITIONS = [(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)]
OFFSETS = [complex(x, y) for x, y in POSITIONS]
KIN = SwerveKinematics(POSITIONS)


def contact_accelerations(twists, dt=DT):
    """Return the acceleration (steps, n) of every contact over the ground, from its velocity."""
    twists = np.array(twists)
    heading = np.concatenate(([0.0], np.cumsum(twists[:-1, 2]) * dt))
    velocity = (twists[:, 0] + 1j * twists[:, 1])[:, np.newaxis]
    velocity = velocity + 1j * twists[:, 2:] * np.array(OFFSETS)
    return np.abs(np.diff(np.exp(1j * heading)[:, np.newaxis] * velocity, axis=0)) / dt


def driven(limits, targets, periods):
    """Return the executed twists for a sequence of targets, the modules following at once."""
    controller, measured, twists = SwerveController(KIN, limits), np.zeros(4), [np.zeros(3)]
    for target, count in zip(targets, periods):
        for _ in range(count):
            command = controller.update(target, measured, DT)
            measured = command.angle
            twists.append(command.twist)
    return np.array(twists)


@pytest.mark.parametrize('ramps', [
    {}, {'max_linear_acceleration': 3.0, 'max_linear_deceleration': 3.0,
         'max_angular_acceleration': 10.0, 'max_steering_rate': 8.0},
    {'max_steering_rate': 4.0, 'max_module_acceleration': 5.0}])
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_whatever_is_commanded_every_contact_grips(ramps, seed):
    rng = np.random.default_rng(seed)
    grip = rng.uniform(0.8, 8.0)
    limits = ControllerLimits(max_grip_acceleration=grip, **ramps)
    targets = rng.uniform(-1, 1, (6, 3)) * (2.0, 2.0, 5.0) * rng.choice([0.0, 1.0, 1.0], (6, 3))
    twists = driven(limits, targets, rng.choice([5, 20, 80], 6))
    assert contact_accelerations(twists).max() <= grip * (1.0 + 1e-9)


@pytest.mark.parametrize('twist', [(2.0, 0.0, 3.0), (1.0, 1.0, -4.0), (0.0, 0.0, 6.0)])
def test_a_tight_curve_is_run_slower_and_stays_the_same(twist):
    twists = driven(ControllerLimits(max_grip_acceleration=2.0), [twist], [250])
    assert np.abs(np.cross(twists, twist)).max() < 1e-9
    scale = twists[-1] @ twist / np.dot(twist, twist)
    pull = abs(twist[2]) * KIN.inverse(twist).speed.max()
    assert scale == pytest.approx(math.sqrt(0.9 * 2.0 / pull))
    stop = driven(ControllerLimits(max_grip_acceleration=2.0), [twist, (0, 0, 0)], [250, 250])
    assert np.abs(np.cross(stop, twist)).max() < 1e-9 and not stop[-1].any()


def test_a_straight_line_takes_the_whole_grip_for_its_ramp():
    twists = driven(ControllerLimits(max_grip_acceleration=2.0), [(1.0, 0.0, 0.0)], [60])
    assert np.argmax(twists[:, 0] == 1.0) == math.ceil(1.0 / (0.95 * 2.0 * DT))


def test_a_grip_that_is_never_needed_changes_nothing():
    rng = np.random.default_rng(2)
    ramps = {'max_linear_acceleration': 1.0, 'max_linear_deceleration': 1.0,
             'max_angular_acceleration': 1.0}
    targets, periods = rng.uniform(-1, 1, (5, 3)), [40] * 5
    free = driven(ControllerLimits(**ramps), targets, periods)
    held = driven(ControllerLimits(max_grip_acceleration=20.0, **ramps), targets, periods)
    np.testing.assert_array_equal(free, held)


@pytest.mark.parametrize('dt', [0.002, 0.02, 0.1])
@pytest.mark.parametrize('twist', [(0.0, 0.0, 6.0), (2.0, 0.0, 2.0)])
def test_a_base_beyond_a_grip_that_was_lowered_slows_down_and_stops(twist, dt):
    peak = KIN.inverse(twist).speed.max()
    for goal in ((0.0, 0.0, 0.0), twist):
        controller = SwerveController(KIN)
        controller.update(twist, None, dt)
        controller.limits = ControllerLimits(max_grip_acceleration=1.5)
        # With a third of the grip, as on the tightest curve it would have begun.
        for _ in range(math.ceil(peak / (0.3 * 1.5) / dt)):
            command = controller.update(goal, None, dt)
        pull = abs(command.twist[2]) * KIN.inverse(command.twist).speed.max()
        assert pull <= 0.9 * 1.5 * (1.0 + 1e-9)
        assert any(goal) or not command.speed.any()


TWISTS = st.builds(PlanarTwist, st.complex_numbers(max_magnitude=3.0, allow_nan=False),
                   st.floats(-6.0, 6.0))


@given(twist=TWISTS, grip=st.floats(0.1, 50.0))
def test_the_steady_scale_is_where_the_centripetal_acceleration_reaches_its_part(twist, grip):
    scale = steady_scale(twist, OFFSETS, grip)
    pull = scale ** 2 * abs(twist.omega) * KIN.inverse(twist.parts).speed.max()
    assert pull <= 0.9 * grip * (1.0 + 1e-9)
    assert scale == 1.0 or pull == pytest.approx(0.9 * grip)


@given(twist=TWISTS, goal=TWISTS, grip=st.floats(0.5, 50.0))
def test_one_step_towards_any_goal_grips(twist, goal, grip):
    scale = steady_scale(twist, OFFSETS, grip)
    start = PlanarTwist(scale * twist.velocity, scale * twist.omega)
    reached = gripping(goal, start, start, OFFSETS, grip, DT)
    assert contact_accelerations([start.parts, reached.parts]).max() <= grip * (1.0 + 1e-6)
    slower = max(0.0, slowest_factor(start, OFFSETS, grip, DT))
    held = [start.parts, tuple(slower * part for part in start.parts)]
    assert contact_accelerations(held).max() <= grip * (1.0 + 1e-6)
