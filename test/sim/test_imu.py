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

"""The IMU of the simulated base feels what its motion is, wherever and however it sits."""

import math

from hypothesis import given, strategies as st
import numpy as np
import pytest

from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.sim.actuators import Actuator
from swerve_kinematics.sim.base import BaseCommand, BaseConfig
from swerve_kinematics.sim.bodies import RollingBody
from swerve_kinematics.sim.imu import SimulatedImu

FOUR = ((0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25))
RADIUS = 0.05
angles = st.floats(-math.pi, math.pi)


def test_a_rolling_base_feels_the_change_of_its_velocity_and_the_turn():
    kinematics, place = SwerveKinematics(FOUR), (0.2, -0.1)
    body = RollingBody(BaseConfig(
        kinematics, ModuleJoints([RADIUS] * 4), Actuator(0.05, 80.0, 200.0),
        Actuator(0.03, 12.0, 200.0)), place)
    states = kinematics.inverse((1.0, 0.5, 1.2))
    velocity = 0j
    for _ in range(100):
        body.step(BaseCommand(states.speed / RADIUS, states.angle), 0.01)
        (fx, fy, fz), rates = body.inertial
        heading = body.state.pose[2] - 0.5 * 0.01 * rates[2]
        velocity += 0.01 * complex(fx, fy) * complex(math.cos(heading), math.sin(heading))
    vx, vy, omega = body.state.twist
    heading = body.state.pose[2]
    at_place = (complex(vx, vy) + 1j * omega * complex(*place)) * complex(
        math.cos(heading), math.sin(heading))
    assert velocity == pytest.approx(at_place)
    assert omega > 1.0 and fz == pytest.approx(9.80665)
    # Turning steadily about a point, it feels the pull towards that.
    assert complex(fx, fy) == pytest.approx(1j * omega * (
        complex(vx, vy) + 1j * omega * complex(*place)), abs=0.02)


@given(angles, angles, angles)
def test_a_mounting_turns_what_it_measures_and_keeps_its_size(roll, pitch, yaw):
    rates, force = (0.1, -0.2, 0.3), (1.0, 2.0, 9.81)
    told = SimulatedImu((roll, pitch, yaw)).measure(0.0, rates, force, 0.01)
    assert np.linalg.norm(told.specific_force) == pytest.approx(np.linalg.norm(force))
    assert np.dot(told.angular_velocity, told.specific_force) == pytest.approx(
        np.dot(rates, force))


def test_noise_and_bias_of_the_accelerometer_are_as_told():
    imu = SimulatedImu((), (0.1, -0.2), noise_density=0.002, seed=1)
    told = np.array([imu.measure(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 9.81), 0.01).specific_force
                     for _ in range(4000)])
    np.testing.assert_allclose(told.mean(axis=0), (0.1, -0.2, 9.81), atol=0.002)
    # White noise, averaged over a sample.
    np.testing.assert_allclose(told.std(axis=0), 0.002 / math.sqrt(0.01), rtol=0.05)
