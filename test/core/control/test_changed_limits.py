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

"""Limits that change under way, another centre, end stops: no speed runs away from its limit."""

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits

KIN = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])


def random_limits(rng):
    """Return limits of any kind, those of jerk now and then among them; speeds always."""
    chosen = {
        'max_linear_acceleration': rng.uniform(0.5, 5.0),
        'max_linear_deceleration': rng.uniform(0.5, 8.0),
        'max_angular_acceleration': rng.uniform(1.0, 20.0),
        'max_linear_jerk': 10.0 ** rng.uniform(0.3, 2.0),
        'max_angular_jerk': 10.0 ** rng.uniform(0.5, 2.3),
        'max_module_speed': rng.uniform(1.0, 4.0),
        'max_module_acceleration': rng.uniform(1.0, 5.0),
        'max_steering_rate': rng.uniform(2.0, 8.0),
        'max_grip_acceleration': rng.uniform(1.0, 5.0)}
    chosen = {name: value for name, value in chosen.items() if rng.random() < 0.6}
    return ControllerLimits(rng.uniform(0.3, 2.0), rng.uniform(0.5, 4.0), **chosen)


def random_twist(rng):
    """Return a twist that is faster than the limits more often than not; a stop now and then."""
    return rng.uniform(-1, 1, 3) * (3.0, 3.0, 5.0) * rng.choice([0.0, 1.0, 1.0, 1.0])


def drive(controller, rng, change):
    """Drive about, and check that no speed beyond a limit grows."""
    before, heading, twist = np.zeros(2), 0.0, np.zeros(3)
    shortest, longest = np.sort(rng.uniform(-2.5, -0.3, 2))
    in_field = rng.random() < 0.5
    for step in range(200):
        if step % 10 == 0:
            twist = random_twist(rng)
        if step % 25 == 12:
            change(controller)
            command = controller.update(twist, None, 0.0)
            before = np.hypot(*command.twist[:2]), abs(command.twist[2])
        dt = 10.0 ** rng.uniform(shortest, longest)
        command = controller.update(twist, None, dt, heading if in_field else None)
        heading += command.twist[2] * dt
        now, limits = (np.hypot(*command.twist[:2]), abs(command.twist[2])), controller.limits
        allowed = np.maximum(before, (limits.max_linear_speed, limits.max_angular_speed))
        assert (now <= allowed * (1.0 + 2e-6)).all()
        before = now


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_a_speed_beyond_limits_that_were_changed_does_not_grow(seed):
    rng = np.random.default_rng(seed)

    def change(controller):
        controller.limits = random_limits(rng)
    drive(SwerveController(KIN, random_limits(rng)), rng, change)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_another_centre_of_rotation_makes_no_speed_run_away(seed):
    rng = np.random.default_rng(seed)

    def change(controller):
        controller.center_of_rotation = rng.uniform(-0.5, 0.5, 2)
    drive(SwerveController(KIN, random_limits(rng)), rng, change)


@pytest.mark.parametrize('policy', ['project', 'stop'])
@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_end_stops_make_no_speed_run_away(policy, seed):
    rng = np.random.default_rng(seed)
    lower, upper = rng.uniform(-3.0, -0.3, 4), rng.uniform(0.3, 3.0, 4)
    drive(SwerveController(KIN, random_limits(rng), (0.2, 0.1), lower, upper,
                           unreachable_policy=policy), rng, lambda controller: None)
