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

"""What an IMU on the simulated base measures in its own frame, however it is mounted."""

import cmath
import math
from typing import NamedTuple, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.rotations import (
    from_roll_pitch_yaw, level_axes, product, Rotation, up)
from swerve_kinematics.core.odometry.tilt import STANDARD_GRAVITY
from swerve_kinematics.sim.base import BaseState

Triple = tuple[float, float, float]


class Inertial(NamedTuple):
    """
    What an ideal IMU measured over a step: means.

    Attributes
    ----------
    specific_force : ndarray (3,)
        Acceleration less gravity, in the axes of the base [m/s^2].
    rates : ndarray (3,)
        In the axes of the base [rad/s].

    """

    specific_force: NDArray[np.float64]
    rates: NDArray[np.float64]


AT_REST = Inertial(np.array((0.0, 0.0, STANDARD_GRAVITY)), np.zeros(3))


def inertial_between(before: BaseState, after: BaseState, dt: float,
                     place: Sequence[float]) -> Inertial:
    """Return the means over a step [s] at a place (2,) [m] of a level base."""
    first, second = (_velocity(state, complex(*place)) for state in (before, after))
    halfway = 0.5 * float(before.pose[2] + after.pose[2])
    gained = (second - first) * cmath.rect(1.0, -halfway)
    return Inertial(np.array((gained.real / dt, gained.imag / dt, STANDARD_GRAVITY)),
                    np.array((0.0, 0.0, (after.pose[2] - before.pose[2]) / dt)))


def _velocity(state: BaseState, place: complex) -> complex:
    """Return the velocity of a place of the base in the world [m/s]."""
    vx, vy, omega = map(float, state.twist)
    return (complex(vx, vy) + 1j * omega * place) * cmath.rect(1.0, float(state.pose[2]))


class Measurement(NamedTuple):
    """
    What the sensor says.

    Attributes
    ----------
    orientation : Rotation
        In the world.
    angular_velocity, specific_force : tuple of float (3,)
        In the frame of the sensor [rad/s], [m/s^2].

    """

    orientation: Rotation
    angular_velocity: Triple
    specific_force: Triple


class SimulatedImu:
    """
    An IMU on the base; its orientation is that of a level one.

    Parameters
    ----------
    orientation : sequence of float (3,)
        Roll, pitch and yaw of the sensor in the frame of the base [rad]; empty: along its axes.
    bias : sequence of float (2,)
        What the accelerometer shows too much along x and y of the base [m/s^2].
    noise_density : float
        White noise of the accelerometer [m/s^2/sqrt(Hz)].
    seed : int
        Of the noise.

    """

    def __init__(self, orientation: Sequence[float], bias: Sequence[float] = (0.0, 0.0),
                 noise_density: float = 0.0, seed: int = 0) -> None:
        """Mount the sensor."""
        self._mounting = from_roll_pitch_yaw(*(orientation or (0.0, 0.0, 0.0)))
        self._axes = np.array((*level_axes(self._mounting), up(self._mounting)))
        self._bias, self._noise_density = np.array((*bias, 0.0)), noise_density
        self._generator = np.random.default_rng(seed)

    def measure(self, yaw: float, rates: ArrayLike, specific_force: ArrayLike,
                dt: float) -> Measurement:
        """
        Return what it measures of the base.

        Parameters
        ----------
        yaw : float
            [rad].
        rates, specific_force : array_like (3,)
            In the axes of the base [rad/s], [m/s^2]: means of a step.
        dt : float
            Its duration [s].

        """
        noise = self._noise_density / math.sqrt(dt) * self._generator.standard_normal(3)
        force = np.asarray(specific_force) + self._bias + noise
        return Measurement(product(from_roll_pitch_yaw(0.0, 0.0, yaw), self._mounting),
                           self._in_sensor(rates), self._in_sensor(force))

    def _in_sensor(self, vector: ArrayLike) -> Triple:
        """Return a vector of the base in the frame of the sensor."""
        x, y, z = (np.asarray(vector) @ self._axes).tolist()
        return x, y, z
