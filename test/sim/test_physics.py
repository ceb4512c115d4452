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

"""The base in rigid-body physics: it rolls, slips where it must, and feels what an IMU feels."""

import math

import numpy as np
import pytest

from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.sim.actuators import Actuator
from swerve_kinematics.sim.base import BaseCommand, BaseConfig
from swerve_kinematics.sim.physics.base import PhysicsBase
from swerve_kinematics.sim.physics.model import Floor, Region, Vehicle

FOUR = ((0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25))
RADIUS = 0.05


def base_on(floor=Floor(), vehicle=Vehicle(), modules=FOUR):
    """Return a base with these modules on a floor."""
    count = len(modules)
    return PhysicsBase(BaseConfig(
        SwerveKinematics(modules), ModuleJoints([RADIUS] * count), Actuator(0.05, 80.0, 200.0),
        Actuator(0.03, 12.0, 200.0)), vehicle, floor)


def drive(base, twist, modules=FOUR, time=1.0):
    """Steer, then drive for a time, by a constant twist; return the means the IMU saw."""
    states = SwerveKinematics(modules).inverse(twist)
    base.step(BaseCommand(np.zeros(len(modules)), states.angle), 0.5)
    forces = []
    for _ in range(round(time / 0.02)):
        base.step(BaseCommand(states.speed / RADIUS, states.angle), 0.02)
        forces.append(base.inertial.specific_force)
    return np.array(forces)


@pytest.mark.parametrize('modules', [
    FOUR, ((0.3, 0.0), (-0.3, 0.0)), ((0.3, 0.0), (-0.2, 0.25), (-0.2, -0.25)),
    tuple((0.4 * math.cos(a), 0.4 * math.sin(a)) for a in np.arange(6) * math.pi / 3)],
    ids=['four', 'two in a line', 'three', 'six'])
def test_any_layout_stands_and_goes_where_its_wheels_roll(modules):
    base = base_on(modules=modules)
    drive(base, (0.6, 0.3, 0.5), modules)
    np.testing.assert_allclose(base.state.twist, (0.6, 0.3, 0.5), atol=0.02)
    assert base.inertial.specific_force[2] > 9.0  # it has not tipped over


def test_the_imu_feels_gravity_acceleration_and_turning():
    vehicle = Vehicle(imu_position=(0.2, 0.0, 0.1))
    base = base_on(vehicle=vehicle)
    base.step(BaseCommand(np.zeros(4), np.zeros(4)), 0.1)
    np.testing.assert_allclose(base.inertial.specific_force, (0.0, 0.0, 9.81), atol=0.01)
    forces = drive(base, (1.0, 0.0, 0.0))
    assert 0.02 * forces[:, 0].sum() == pytest.approx(1.0, abs=0.05)  # the velocity it gained
    base = base_on(vehicle=vehicle)
    drive(base, (0.0, 0.0, 2.0))
    omega = base.inertial.rates[2]
    assert omega == pytest.approx(2.0, abs=0.05)
    assert base.inertial.specific_force[0] == pytest.approx(-0.2 * omega ** 2, abs=0.05)


def test_a_slope_leaks_gravity_into_the_accelerometer_and_pulls_the_base():
    base = base_on(Floor(slope=0.1, slope_direction=0.5 * math.pi))
    base.step(BaseCommand(np.zeros(4), np.zeros(4)), 0.2)
    np.testing.assert_allclose(
        base.inertial.specific_force[:2], (0.0, 9.81 * math.sin(0.1)), atol=0.02)


def test_wheels_spin_where_the_floor_has_no_friction_and_grip_where_it_has():
    slippery = base_on(Floor(friction=0.05))
    drive(slippery, (2.0, 0.0, 0.0), time=0.4)
    assert slippery.state.wheel_speed.mean() * RADIUS > 3.0 * slippery.state.twist[0]
    patch = base_on(Floor(regions=(Region(-1.0, 0.0, 5.0, 1.0, 0.02),)))
    drive(patch, (1.5, 0.0, 0.0), time=0.3)
    left, right = patch.slip.scrub[[0, 2]], patch.slip.scrub[[1, 3]]
    assert left.min() > 3.0 * right.max()


def test_a_payload_off_the_centre_makes_the_base_lean():
    vehicle = Vehicle(payload_mass=30.0, payload_position=(0.0, 0.2, 0.2))
    base = base_on(vehicle=vehicle)
    base.step(BaseCommand(np.zeros(4), np.zeros(4)), 0.5)
    # To the left, by some millimetres over the track width: the y axis points down a little.
    assert -0.3 < base.inertial.specific_force[1] < -0.03
    assert base.state.pose[1] == pytest.approx(0.0, abs=0.01)


def test_ridges_shake_the_base():
    smooth, rough = (drive(base_on(floor), (1.0, 0.0, 0.0), time=1.5)[25:, 2].std()
                     for floor in (Floor(), Floor(ridge_height=0.008, ridge_spacing=0.4)))
    assert rough > 5.0 * smooth


def test_motors_have_no_more_torque_than_they_have():
    weak = base_on(Floor(slope=0.3), Vehicle(drive_torque=1.0))
    drive(weak, (1.0, 0.0, 0.0), time=0.5)
    assert weak.state.twist[0] < 0.0  # it rolls back down


def test_the_same_commands_give_the_same_motion_whatever_the_pace():
    first, second = base_on(), base_on()
    command = BaseCommand(np.full(4, 10.0), np.zeros(4))
    for _ in range(50):
        first.step(command, 0.02)
    for _ in range(300):
        second.step(command, 1.0 / 300.0)
    np.testing.assert_allclose(first.state.pose, second.state.pose, atol=2e-4)


@pytest.mark.parametrize('pace', [0.001, 0.005, 0.0107])
def test_wheels_at_a_steady_speed_turn_as_far_in_every_step(pace):
    base = base_on()
    command = BaseCommand(np.full(4, 10.0), np.zeros(4))
    base.step(command, 1.5)
    angles = [base.state.wheel_angle]
    for _ in range(20):
        base.step(command, pace)
        angles.append(base.state.wheel_angle)
    steps = np.diff(angles, axis=0)
    np.testing.assert_allclose(steps, np.broadcast_to(steps.mean(axis=0), steps.shape), rtol=0.01)


def test_braking_gives_back_what_tyres_and_bearings_leave():
    base = base_on()
    drive(base, (1.0, 0.0, 0.0))
    kinetic = 0.5 * 50.0 * base.state.twist[0] ** 2
    assert kinetic < base.slip.energy < 1.3 * kinetic
    assert base.slip.work == pytest.approx(base.slip.energy, rel=0.05)
    driven = base.slip
    for _ in range(50):
        base.step(BaseCommand(np.zeros(4), np.zeros(4)), 0.02)
    assert base.slip.energy < 0.5 * driven.energy
    assert base.slip.work == pytest.approx(driven.work, rel=0.05)
