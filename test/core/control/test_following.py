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

"""A base that is held: no ramp runs on, and its release is no lurch."""

from collections import deque
import math

import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits

DT = 0.02
KIN = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
LIMITS = ControllerLimits(
    max_linear_speed=2.0, max_angular_speed=4.0, max_linear_acceleration=2.0,
    max_linear_deceleration=3.0, max_angular_acceleration=6.0, max_steering_rate=8.0)


class LaggingBase:
    """A base whose drives follow late, are measured late, and can be held."""

    def __init__(self, time_constant, samples_late=1, message_period=1):
        self._share = 1.0 - math.exp(-DT / time_constant)
        self._measurements = deque([np.zeros(3)] * samples_late)
        self._period, self._steps = message_period, 0
        self.twist, self.angle = np.zeros(3), np.zeros(4)

    def step(self, command, is_held=False):
        self.angle, self._steps = command.angle, self._steps + 1
        goal = np.zeros(3) if is_held else KIN.forward((command.speed, command.angle))
        self.twist = goal if is_held else self.twist + self._share * (goal - self.twist)
        self._measurements.append(self.twist)
        measured = self._measurements.popleft()
        return measured if self._steps % self._period == 0 else None


@pytest.mark.parametrize('time_constant', [0.02, 0.1, 0.2])
@pytest.mark.parametrize('twist', [(1.0, 0.0, 0.0), (0.6, 0.8, 1.0), (0.0, 0.0, 3.0)])
@pytest.mark.parametrize('moving_first', [False, True])
def test_a_base_that_was_held_speeds_up_by_its_limits_when_released(
        twist, moving_first, time_constant):
    controller, base, measured = SwerveController(KIN, LIMITS), LaggingBase(time_constant), None
    told, moved = [], []
    for step in range(500):
        command = controller.update(twist, base.angle, DT, measured_twist=measured)
        measured = base.step(command, is_held=100 * moving_first <= step < 300)
        told.append(np.linalg.norm(command.speed, np.inf))
        moved.append(np.linalg.norm(base.twist * (1.0, 1.0, 0.36)))
    cruise = told[-1]
    assert cruise > 0.9 and not command.held
    assert max(told[200:300]) < 0.15 * cruise
    assert max(np.diff(told[300:])) < 3.0 * DT
    assert max(np.diff(moved[300:])) < 3.0 * DT
    assert np.argmax(np.array(moved[300:]) > 0.9 * cruise) * DT < 1.5


def test_a_stop_that_is_commanded_while_held_needs_no_release():
    controller, measured = SwerveController(KIN, LIMITS), np.zeros(3)
    for _ in range(100):
        assert controller.update(
            (1.0, 0.0, 0.0), np.zeros(4), DT, measured_twist=measured).speed.max() < 1.0
    for _ in range(30):
        command = controller.update((0.0, 0.0, 0.0), np.zeros(4), DT, measured_twist=measured)
    assert not command.held and not command.speed.any()


@pytest.mark.parametrize('seed', range(20))
def test_drives_that_follow_late_are_never_taken_for_held(seed):
    rng = np.random.default_rng(seed)
    controller, measured = SwerveController(KIN, LIMITS), None
    base = LaggingBase(rng.uniform(0.01, 0.3), rng.integers(1, 4), rng.integers(1, 11))
    for _ in range(12):
        twist = rng.uniform(-1, 1, 3) * (2.0, 2.0, 4.0) * rng.choice([0.0, 0.1, 1.0], 3)
        for _ in range(int(rng.choice([5, 20, 80]))):
            command = controller.update(twist, base.angle, DT, measured_twist=measured)
            measured = base.step(command)
            assert not command.held


def test_without_a_ramp_or_a_measurement_nothing_is_held():
    ramp_free = SwerveController(KIN, ControllerLimits())
    command = ramp_free.update((1.0, 0.0, 0.0), np.zeros(4), DT, measured_twist=np.zeros(3))
    for _ in range(100):
        command = ramp_free.update((1.0, 0.0, 0.0), np.zeros(4), DT, measured_twist=np.zeros(3))
    assert command.speed == pytest.approx([1.0] * 4)
    unmeasured = SwerveController(KIN, LIMITS)
    for _ in range(100):
        command = unmeasured.update((1.0, 0.0, 0.0), np.zeros(4), DT)
    assert command.speed == pytest.approx([1.0] * 4) and not command.held
