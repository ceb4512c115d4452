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

"""What the encoders and the gyro of the simulated base report, faults included."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.sim.base import BaseConfig, BaseState


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
    drive_position, drive_velocity : ndarray (n,)
        Drive joints [rad], [rad/s].
    steering_position, steering_velocity : ndarray (n,)
        Steering joints [rad], [rad/s].
    yaw, yaw_rate : float
        Gyro [rad], [rad/s].
    dropped : bool
        Whether the sample is lost on its way.

    """

    drive_position: NDArray[np.float64]
    drive_velocity: NDArray[np.float64]
    steering_position: NDArray[np.float64]
    steering_velocity: NDArray[np.float64]
    yaw: float
    yaw_rate: float
    dropped: bool


def counted(angle: NDArray[np.float64], resolution: int) -> NDArray[np.float64]:
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


def wrapped(angle: NDArray[np.float64], period: float) -> NDArray[np.float64]:
    """Return what a joint reads that wraps within half a period, or counts on if it is 0."""
    if period == 0.0:
        return angle
    return (angle + 0.5 * period) % period - 0.5 * period


def sense(config: BaseConfig, faults: SensorFaults, state: BaseState, gyro_drift: float,
          dt: float, generator: np.random.Generator) -> tuple[Reading, float]:
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
    slip = config.wheel_radii.copy()
    if faults.slipping_wheel >= 0:
        slip[faults.slipping_wheel] *= faults.slip_factor
    joints, resolution = config.joints, faults.encoder_resolution
    angles, rates = state.steering_angle.tolist(), state.steering_rate.tolist()
    drives = np.array(joints.drives((slip * state.wheel_angle).tolist(), angles))
    reading = Reading(
        wrapped(counted(drives, resolution), joints.drive_period),
        np.array(joints.drives((slip * state.wheel_speed).tolist(), rates)),
        counted(np.array(joints.steering_positions(angles)), resolution),
        np.array(joints.steering_velocities(rates)),
        yaw=state.pose[2] + gyro_drift,
        yaw_rate=state.twist[2] + rate_error,
        dropped=dropped)
    return reading, gyro_drift
