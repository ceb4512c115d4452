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

"""The parameters of swerve_sim."""

from dataclasses import dataclass, fields

from swerve_kinematics.configuration.declarations import Declaration, DOUBLES, refuse, Values
from swerve_kinematics.configuration.layout import Layout, LAYOUT_DECLARATIONS, layout_from
from swerve_kinematics.configuration.miswiring import (
    Miswiring, MISWIRING_DECLARATIONS, miswiring_from)
from swerve_kinematics.configuration.physics import (
    PHYSICS_DECLARATIONS, physics_from, PhysicsParameters)
from swerve_kinematics.configuration.validation import refuse_unless_a_pair
from swerve_kinematics.core.geometry.angles import TURN

SIMULATOR_DECLARATIONS = LAYOUT_DECLARATIONS + (
    Declaration('publish_rate', 100.0, 'Rate of joint_states, imu and ground_truth', 'Hz',
                minimum=1.0, maximum=1000.0),
    Declaration('drive_time_constant', 0.05, 'Lag of the wheel speed', 's',
                minimum=1e-3, maximum=10.0),
    Declaration('drive_max_speed', 80.0, 'Largest wheel speed', 'rad/s', minimum=0.0),
    Declaration('drive_max_acceleration', 200.0, 'Largest wheel acceleration', 'rad/s^2',
                minimum=1e-3),
    Declaration('steering_time_constant', 0.03, 'Lag of the steering angle', 's',
                minimum=1e-3, maximum=10.0),
    Declaration('steering_max_rate', 12.0, 'Largest steering rate', 'rad/s', minimum=0.0),
    Declaration('steering_max_acceleration', 200.0, 'Largest steering acceleration', 'rad/s^2',
                minimum=1e-3),
    Declaration('imu_orientation', DOUBLES,
                'Roll, pitch, yaw of the IMU in base_link; empty: along its axes', 'rad',
                plausible=TURN, mistake='degrees'),
    Declaration('imu_position', [0.0, 0.0], 'Position of the IMU, x and y from base_link', 'm',
                plausible=10.0, mistake='millimetres'),
    Declaration('encoder_resolution', 0,
                'Fault: counts per turn of the drive and steering encoders; 0: ideal'),
    Declaration('gyro_bias', 0.0, 'Fault: bias of the yaw rate', 'rad/s'),
    Declaration('gyro_noise_density', 0.0, 'Fault: white noise of the yaw rate',
                'rad/s/sqrt(Hz)', minimum=0.0),
    Declaration('accelerometer_bias', [0.0, 0.0],
                'Fault: bias of the accelerometer along x and y', 'm/s^2'),
    # 200 ug/sqrt(Hz), as data sheets say: a sensor that shows the same number over and over
    # passes for a frozen one.
    Declaration('accelerometer_noise_density', 0.002, 'Fault: white noise of the accelerometer',
                'm/s^2/sqrt(Hz)', minimum=0.0),
    Declaration('dropped_sample_probability', 0.0,
                'Fault: probability that a sample is lost (joint_states and imu)',
                minimum=0.0, maximum=1.0),
    Declaration('slipping_wheel', -1,
                'Fault: index of a wheel that spins faster than it rolls; -1: none'),
    Declaration('slip_factor', 1.3, 'Fault: factor by which the slipping wheel spins faster',
                minimum=1.0, maximum=100.0),
    Declaration('seed', 0, 'Seed of all random numbers'),
) + MISWIRING_DECLARATIONS + PHYSICS_DECLARATIONS


@dataclass(frozen=True)
class SimulatorParameters:
    """
    Everything that configures swerve_sim, a field for each parameter besides these.

    Attributes
    ----------
    layout : Layout
        What the base has in common with the node.
    miswiring : Miswiring
        What is wired wrongly.
    physics : PhysicsParameters or None
        None where the base rolls and never slips.
    imu_frame : str
        What `imu` is measured in.

    """

    layout: Layout
    miswiring: Miswiring
    physics: PhysicsParameters | None
    imu_frame: str
    publish_rate: float
    drive_time_constant: float
    drive_max_speed: float
    drive_max_acceleration: float
    steering_time_constant: float
    steering_max_rate: float
    steering_max_acceleration: float
    imu_orientation: list[float]
    imu_position: list[float]
    encoder_resolution: int
    gyro_bias: float
    gyro_noise_density: float
    accelerometer_bias: list[float]
    accelerometer_noise_density: float
    dropped_sample_probability: float
    slipping_wheel: int
    slip_factor: float
    seed: int


def simulator_parameters_from(values: Values) -> SimulatorParameters:
    """
    Return the configuration that the parameters describe, validated as a whole.

    Parameters
    ----------
    values : mapping
        Value by name, of SIMULATOR_DECLARATIONS.

    Returns
    -------
    SimulatorParameters

    Raises
    ------
    ParameterError
        If one does not fit its range or the others.

    """
    for declaration in SIMULATOR_DECLARATIONS:
        declaration.check(values[declaration.name])
    layout = layout_from(values)
    if len(values['imu_orientation']) not in (0, 3):
        refuse('imu_orientation', values['imu_orientation'], 'must be [roll, pitch, yaw]')
    for name in ('imu_position', 'accelerometer_bias'):
        refuse_unless_a_pair(values, name)
    _check_integers(values, layout.kinematics.module_count)
    as_given = {field.name: values[field.name] for field in fields(SimulatorParameters)
                if field.name not in ('layout', 'miswiring', 'physics', 'imu_frame')}
    return SimulatorParameters(
        layout, miswiring_from(values, layout.module_names), physics_from(values),
        values['frame_prefix'] + 'imu_link', **as_given)


def _check_integers(values: Values, count: int) -> None:
    """Raise ParameterError if an integer is out of its range."""
    if not -1 <= values['slipping_wheel'] < count:
        refuse('slipping_wheel', values['slipping_wheel'],
               f'must be from 0 to {count - 1}, or -1 for none')
    for name in ('encoder_resolution', 'seed'):
        if values[name] < 0:
            refuse(name, values[name], 'must be zero or more')
