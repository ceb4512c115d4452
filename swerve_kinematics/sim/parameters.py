"""The parameters of swerve_sim, declared and made into configurations."""

from typing import NamedTuple

import numpy as np

from swerve_kinematics.configuration.declarations import Declaration, DOUBLES, per_module, refuse
from swerve_kinematics.configuration.layout import Layout, LAYOUT_DECLARATIONS, layout_from
from swerve_kinematics.ros.declare import declare
from swerve_kinematics.sim.base import Actuator, BaseConfig
from swerve_kinematics.sim.sensors import SensorFaults

DECLARATIONS = LAYOUT_DECLARATIONS + (
    Declaration('publish_rate', 100.0, 'Rate of joint_states and ground_truth', 'Hz',
                minimum=1.0, maximum=1000.0),
    Declaration('drive_time_constant', 0.05, 'Lag of the wheel speed', 's',
                minimum=1e-3, maximum=10.0),
    Declaration('drive_max_speed', 80.0, 'Greatest wheel speed', 'rad/s', minimum=0.0),
    Declaration('drive_max_acceleration', 200.0, 'Greatest wheel acceleration', 'rad/s^2',
                minimum=1e-3),
    Declaration('steering_time_constant', 0.03, 'Lag of the steering angle', 's',
                minimum=1e-3, maximum=10.0),
    Declaration('steering_max_rate', 12.0, 'Greatest steering rate', 'rad/s', minimum=0.0),
    Declaration('steering_max_acceleration', 200.0, 'Greatest steering acceleration', 'rad/s^2',
                minimum=1e-3),
    Declaration('steering_offsets', DOUBLES,
                'Fault: what a steering joint reads when its wheel points along +x, one for all '
                'or one for each; empty: 0', 'rad'),
    Declaration('encoder_resolution', 0,
                'Fault: counts a turn of the drive and steering encoders; 0: ideal'),
    Declaration('gyro_bias', 0.0, 'Fault: bias of the yaw rate', 'rad/s'),
    Declaration('gyro_noise_density', 0.0, 'Fault: white noise of the yaw rate',
                'rad/s/sqrt(Hz)', minimum=0.0),
    Declaration('dropped_sample_probability', 0.0, 'Fault: chance that a joint_states is lost',
                minimum=0.0, maximum=1.0),
    Declaration('slipping_wheel', -1,
                'Fault: index of a wheel that spins faster than the ground passes; -1: none'),
    Declaration('slip_factor', 1.3, 'Fault: how many times as fast the slipping wheel spins',
                minimum=1.0, maximum=100.0),
    Declaration('seed', 0, 'Seed of everything random'),
)


class SimParameters(NamedTuple):
    """
    Everything that configures swerve_sim.

    Attributes
    ----------
    layout : Layout
        Names of modules, joints and frames.
    base : BaseConfig
        Geometry and actuators of the base.
    faults : SensorFaults
        What is wrong with its sensors.
    publish_rate : float
        [Hz].
    seed : int
        Of the random numbers that the sensors use.

    """

    layout: Layout
    base: BaseConfig
    faults: SensorFaults
    publish_rate: float
    seed: int


def read_parameters(node):
    """
    Declare the parameters on a node and return what they configure.

    Parameters
    ----------
    node : rclpy.node.Node
        Gets the parameters; values given to it from outside replace the defaults.

    Returns
    -------
    SimParameters

    Raises
    ------
    ParameterError
        If a value cannot be used.

    """
    values = declare(node, DECLARATIONS)
    layout = layout_from(values)
    count = layout.kinematics.module_count
    _check_integers(values, count)
    base = BaseConfig(
        layout.kinematics, layout.wheel_radii,
        drive=Actuator(values['drive_time_constant'], values['drive_max_speed'],
                       values['drive_max_acceleration']),
        steering=Actuator(values['steering_time_constant'], values['steering_max_rate'],
                          values['steering_max_acceleration']),
        steering_offsets=np.array(per_module(values, 'steering_offsets', count, default=0.0)))
    faults = SensorFaults(**{name: values[name] for name in SensorFaults.__dataclass_fields__})
    return SimParameters(layout, base, faults, values['publish_rate'], values['seed'])


def _check_integers(values, count):
    """Raise ParameterError if an integer is out of its range."""
    if not -1 <= values['slipping_wheel'] < count:
        refuse('slipping_wheel', values['slipping_wheel'], f'must be -1 or below {count}')
    for name in ('encoder_resolution', 'seed'):
        if values[name] < 0:
            refuse(name, values[name], 'must be zero or more')
