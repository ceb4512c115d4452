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

"""What the parameters of swerve_sim make of the simulated base."""

from dataclasses import fields

from swerve_kinematics.configuration.simulator import SimulatorParameters
from swerve_kinematics.sim.actuators import Actuator
from swerve_kinematics.sim.base import BaseConfig
from swerve_kinematics.sim.sensors import SensorFaults


def base_from(parameters: SimulatorParameters) -> BaseConfig:
    """
    Return geometry and actuators of the base.

    Parameters
    ----------
    parameters : SimulatorParameters
        Of swerve_sim.

    Returns
    -------
    BaseConfig

    """
    p = parameters
    return BaseConfig(
        p.layout.kinematics, p.layout.joints,
        drive=Actuator(p.drive_time_constant, p.drive_max_speed, p.drive_max_acceleration),
        steering=Actuator(p.steering_time_constant, p.steering_max_rate,
                          p.steering_max_acceleration),
        free_wheels=p.miswiring.free_wheels)


def faults_from(parameters: SimulatorParameters) -> SensorFaults:
    """
    Return what is wrong with the sensors of the base.

    Parameters
    ----------
    parameters : SimulatorParameters
        Of swerve_sim.

    Returns
    -------
    SensorFaults

    """
    return SensorFaults(**{field.name: getattr(parameters, field.name)
                           for field in fields(SensorFaults)})
