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

"""What wrong wiring makes of commands to the simulated base, and of its readings."""

from dataclasses import replace
import math

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.configuration.miswiring import Miswiring
from swerve_kinematics.sim.base import BaseCommand
from swerve_kinematics.sim.sensors import Reading


def miswired_command(miswiring: Miswiring, command: BaseCommand,
                     held: BaseCommand) -> BaseCommand:
    """
    Return what the motors are really told.

    Parameters
    ----------
    miswiring : Miswiring
        What is wrong.
    command : BaseCommand
        As it came.
    held : BaseCommand
        What leaves the joints where they are.

    Returns
    -------
    BaseCommand

    """
    count = len(command.drive_velocity)
    order = _order(miswiring, count)
    velocity = command.drive_velocity[order] * _signs(miswiring.drive_motors, count)
    position = command.steering_position[order] * _signs(miswiring.steering_motors, count)
    stopped = miswiring.emergency_stop
    dead = slice(None) if stopped else list(miswiring.dead_drives)
    stuck = slice(None) if stopped else list(miswiring.dead_steerings)
    velocity[dead] = held.drive_velocity[dead]
    position[stuck] = held.steering_position[stuck]
    return replace(command, drive_velocity=velocity, steering_position=position)


def miswired_reading(miswiring: Miswiring, reading: Reading, first: Reading) -> Reading:
    """
    Return what arrives of a reading.

    Parameters
    ----------
    miswiring : Miswiring
        What is wrong.
    reading : Reading
        Of the sensors.
    first : Reading
        What they read at the start.

    Returns
    -------
    Reading

    """
    count = len(reading.drive_position)
    order, frozen = _order(miswiring, count), list(miswiring.frozen)
    drive, steering = (_signs(modules, count) for modules in (
        miswiring.drive_encoders, miswiring.steering_encoders))

    def arriving(now: NDArray[np.float64], then: NDArray[np.float64],
                 sign: NDArray[np.float64]) -> NDArray[np.float64]:
        values = sign * now
        values[frozen] = (sign * then)[frozen]
        return values[order]

    yaw, rate = ((first.yaw, 0.0) if miswiring.gyro_frozen else
                 (reading.yaw, reading.yaw_rate))
    scale = math.nan if miswiring.gyro_silent else miswiring.gyro_scale
    return Reading(
        arriving(reading.drive_position, first.drive_position, drive),
        arriving(reading.drive_velocity, 0.0 * first.drive_velocity, drive),
        arriving(reading.steering_position, first.steering_position, steering),
        arriving(reading.steering_velocity, 0.0 * first.steering_velocity, steering),
        scale * yaw, scale * rate, reading.dropped)


def _order(miswiring: Miswiring, count: int) -> list[int]:
    """Return whose joint has the name of each module."""
    order = list(range(count))
    if miswiring.swapped:
        first, second = miswiring.swapped
        order[first], order[second] = second, first
    return order


def _signs(modules: tuple[int, ...], count: int) -> NDArray[np.float64]:
    """Return 1 (n,), -1 for the given modules."""
    signs = np.ones(count)
    signs[list(modules)] = -1.0
    return signs
