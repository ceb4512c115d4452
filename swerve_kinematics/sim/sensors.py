"""What the encoders and the gyro of the simulated base report, faults included."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.sim.base import twist


@dataclass(frozen=True)
class SensorFaults:
    """
    How the sensors differ from ideal ones.

    Attributes
    ----------
    encoder_resolution : int
        Counts a turn of the drive and steering encoders; 0 is ideal. Speeds stay ideal: real
        drives time the edges.
    gyro_bias : float
        [rad/s].
    gyro_noise_density : float
        White noise of the rate [rad/s/sqrt(Hz)], as data sheets give it: the same gyro at
        any sample rate.
    dropped_sample_probability : float
        Chance in [0, 1] that a sample is lost.
    slipping_wheel : int
        Index of the wheel that spins faster than the ground passes; -1 for none.
    slip_factor : float
        How many times as fast its encoder runs.

    """

    encoder_resolution: int = 0
    gyro_bias: float = 0.0
    gyro_noise_density: float = 0.0
    dropped_sample_probability: float = 0.0
    slipping_wheel: int = -1
    slip_factor: float = 1.0


class Reading(NamedTuple):
    """
    One sample of all sensors.

    Attributes
    ----------
    wheel_angle, wheel_speed : ndarray (n,)
        Drive encoders [rad], [rad/s].
    steering_angle, steering_rate : ndarray (n,)
        Steering encoders [rad], [rad/s].
    yaw, yaw_rate : float
        Gyro [rad], [rad/s].
    dropped : bool
        Whether the sample is lost on its way.

    """

    wheel_angle: np.ndarray
    wheel_speed: np.ndarray
    steering_angle: np.ndarray
    steering_rate: np.ndarray
    yaw: float
    yaw_rate: float
    dropped: bool


def counted(angle, resolution):
    """
    Return what an encoder makes of an angle.

    Parameters
    ----------
    angle : ndarray (...)
        [rad].
    resolution : int
        Counts a turn; 0 is ideal.

    Returns
    -------
    ndarray (...)
        The last full count below [rad].

    """
    if resolution == 0:
        return angle
    return np.floor(angle * (resolution / TURN)) * (TURN / resolution)


def sense(config, faults, state, gyro_drift, dt, generator):
    """
    Return a reading of the sensors and the gyro's drift after it.

    The gyro's yaw is the sum of its rates, so that one error goes into both: the rate is off
    by the bias and by noise of standard deviation `density / sqrt(dt)`, the mean of white
    noise over the sample.

    Parameters
    ----------
    config : BaseConfig
        The base that carries the sensors.
    faults : SensorFaults
        What is wrong with the sensors.
    state : BaseState
        The truth at the time of the sample.
    gyro_drift : float
        Error of the yaw at the last sample [rad]; 0 for the first.
    dt : float
        Time since the last sample [s].
    generator : numpy.random.Generator
        Gives two numbers a reading, whatever the faults are.

    Returns
    -------
    reading : Reading
    gyro_drift : float
        [rad].

    """
    noise = faults.gyro_noise_density / np.sqrt(dt) * generator.standard_normal()
    dropped = generator.random() < faults.dropped_sample_probability
    rate_error = faults.gyro_bias + noise
    gyro_drift = gyro_drift + rate_error * dt
    slip = np.ones_like(state.wheel_angle)
    if faults.slipping_wheel >= 0:
        slip[faults.slipping_wheel] = faults.slip_factor
    reading = Reading(
        wheel_angle=counted(state.wheel_angle * slip, faults.encoder_resolution),
        wheel_speed=state.wheel_speed * slip,
        steering_angle=counted(
            state.steering_angle + config.steering_offsets, faults.encoder_resolution),
        steering_rate=state.steering_rate,
        yaw=state.pose[2] + gyro_drift,
        yaw_rate=twist(config, state)[2] + rate_error,
        dropped=dropped)
    return reading, gyro_drift
