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

"""What moves when the joints are commanded: a base that rolls, or one in rigid-body physics."""

from typing import Protocol, Sequence

from swerve_kinematics.configuration.declarations import refuse
from swerve_kinematics.configuration.physics import PhysicsParameters
from swerve_kinematics.configuration.simulator import SimulatorParameters
from swerve_kinematics.sim.base import at_rest, BaseCommand, BaseConfig, BaseState, step
from swerve_kinematics.sim.imu import AT_REST, Inertial, inertial_between
from swerve_kinematics.sim.parameters import base_from


class Body(Protocol):
    """
    A base that keeps its state.

    Attributes
    ----------
    config : BaseConfig
        What does not change about it.
    state : BaseState
        The truth.
    inertial : Inertial
        What an IMU felt in the last step.

    """

    config: BaseConfig
    state: BaseState
    inertial: Inertial

    def step(self, command: BaseCommand, dt: float) -> None:
        """Advance by `dt` [s], holding a command."""


class RollingBody:
    """
    The base of `base`, which rolls and never slips.

    Parameters
    ----------
    config : BaseConfig
        The base.
    imu_position : sequence of float (2,)
        Of its IMU, from base_link [m].

    """

    def __init__(self, config: BaseConfig, imu_position: Sequence[float]) -> None:
        """Start at rest."""
        self.config, self.state = config, at_rest(config)
        self._imu_position, self.inertial = imu_position, AT_REST

    def step(self, command: BaseCommand, dt: float) -> None:
        """Advance by `dt` [s], holding a command."""
        before, self.state = self.state, step(self.config, self.state, command, dt)
        self.inertial = inertial_between(before, self.state, dt, self._imu_position)


def body_from(parameters: SimulatorParameters) -> Body:
    """
    Return the base that the parameters describe, at rest.

    Raises
    ------
    ParameterError
        If it needs mujoco, and that is not installed or refuses the model.

    """
    config = base_from(parameters)
    if parameters.physics is None:
        return RollingBody(config, parameters.imu_position)
    try:
        return _physics_body(config, parameters.physics, parameters.imu_position)
    except ImportError:
        refuse('physics', 'mujoco', 'mujoco is not installed: pip install mujoco')
    except ValueError as error:
        refuse('physics', 'mujoco', f'this base cannot be built: {error}')


def _physics_body(config: BaseConfig, physics: PhysicsParameters,
                  imu_position: Sequence[float]) -> Body:
    """Return the base in MuJoCo."""
    from swerve_kinematics.sim.physics.base import PhysicsBase
    from swerve_kinematics.sim.physics.model import (
        Floor, IMU_HEIGHT, PAYLOAD_HEIGHT, Region, Vehicle)
    p = physics
    vehicle = Vehicle(
        mass=p.mass, drive_torque=p.drive_torque, steering_torque=p.steering_torque,
        payload_mass=p.payload_mass, payload_position=(p.payload_x, p.payload_y, PAYLOAD_HEIGHT),
        imu_position=(imu_position[0], imu_position[1], IMU_HEIGHT))
    floor = Floor(
        p.friction, tuple(Region(*region) for region in p.friction_regions), p.slope,
        p.slope_direction, p.ridge_height, p.ridge_spacing)
    return PhysicsBase(config, vehicle, floor)
