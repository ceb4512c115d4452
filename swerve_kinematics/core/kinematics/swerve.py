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

"""Swerve kinematics of first and second order, for any number and layout of modules."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.angles import direction
from swerve_kinematics.core.geometry.arrays import as_vectors
from swerve_kinematics.core.geometry.se2 import BASE_LINK
from swerve_kinematics.core.kinematics.module_layout import Components, ModuleLayout
from swerve_kinematics.core.kinematics.modules import ModuleStates, StatesLike

# Below this rim speed [m/s] the direction of a module's velocity is noise, and the module
# keeps its angle instead.
MIN_SPEED = 1e-6


class SwerveKinematics(ModuleLayout):
    """
    Maps between the twist of a rigid base and the velocities of its swerve modules.

    The object is constant: it holds the layout and the matrices made from it, and the methods
    depend on nothing else but their arguments. They take any leading (batch) axes, which
    broadcast as in numpy. NaN in the data stays NaN, and affects that item only.

    Parameters
    ----------
    module_positions : array_like (n, 2)
        Steering axes of the n >= 2 modules from base_link [m], x forward and y left.

    Attributes
    ----------
    module_positions : ndarray (n, 2)
        The positions, read-only.

    Raises
    ------
    ValueError
        If the shape is not (n, 2), n < 2, a position is not finite, or all modules sit at
        one point, so that rotation cannot be told from translation.

    """

    def _components(self, states: StatesLike) -> Components:
        """Return both components (..., n) of the velocities that `states` describe."""
        speed, angle = states
        speed = as_vectors(speed, self.module_count, 'speed')
        angle = as_vectors(angle, self.module_count, 'angle')
        return speed * np.cos(angle), speed * np.sin(angle)

    def inverse(self, twist: ArrayLike, center: ArrayLike = BASE_LINK,
                held_angles: ArrayLike | None = None) -> ModuleStates:
        """
        Return the module states that make the base move with `twist`.

        Parameters
        ----------
        twist : array_like (..., 3)
            `[vx, vy, omega]` [m/s, m/s, rad/s] in the base frame: the velocity of `center`.
        center : array_like (2,) or (..., 2)
            Centre of rotation from base_link [m].
        held_angles : array_like (n,) or (..., n), optional
            Angles [rad] for the modules slower than 1e-6 m/s, whose velocity has no
            direction; 0 where not given.

        Returns
        -------
        ModuleStates (..., n)
            Speeds >= 0 [m/s] and angles in (-pi, pi] [rad]; a held angle is returned as
            given. Speeds are not limited, nor angles matched to where the modules are.

        Raises
        ------
        ValueError
            If a last axis has the wrong length.

        """
        x, y = self._velocities(twist, center)
        angle = direction(x, y)
        # In place, for memory is what a batch costs.
        speed = np.hypot(x, y, out=x)
        if held_angles is None:
            np.copyto(angle, 0.0, where=speed < MIN_SPEED)
            return ModuleStates(speed, angle)
        held = as_vectors(held_angles, self.module_count, 'held_angles')
        angle = np.where(speed < MIN_SPEED, held, angle)
        if speed.shape != angle.shape:  # one twist, many sets of held angles
            speed = np.broadcast_to(speed, angle.shape).copy()
        return ModuleStates(speed, angle)

    def forward(self, states: StatesLike) -> NDArray[np.float64]:
        """
        Return the twist of the rigid body that fits the module states best.

        Parameters
        ----------
        states : ModuleStates (..., n)
            Speeds [m/s] (negative: reversed) or distance deltas [m], and angles [rad].

        Returns
        -------
        ndarray (..., 3)
            `[vx, vy, omega]` [m/s, m/s, rad/s], or the twist delta [m, m, rad], by least
            squares over the modules' velocity vectors.

        Raises
        ------
        ValueError
            If a last axis is not n long.

        """
        return self._fit(*self._components(states))

    def residuals(self, states: StatesLike) -> NDArray[np.float64]:
        """
        Return how far each module is from the rigid body that fits all of them best.

        Parameters
        ----------
        states : ModuleStates (..., n)
            Speeds [m/s] and angles [rad].

        Returns
        -------
        ndarray (..., n)
            Length of the velocity difference [m/s], zero for modules that agree. Two
            modules always have residuals of equal size: their one disagreement is the rate
            at which they part.

        Raises
        ------
        ValueError
            If a last axis is not n long.

        """
        x, y = self._components(states)
        fit_x, fit_y = self._velocities(self._fit(x, y), BASE_LINK)
        return np.hypot(x - fit_x, y - fit_y)

    def pairwise(self, states: StatesLike) -> NDArray[np.float64]:
        """
        Return the twist that each pair of modules implies alone.

        Parameters
        ----------
        states : ModuleStates (..., n)
            Speeds [m/s] and angles [rad].

        Returns
        -------
        ndarray (..., n (n - 1) / 2, 3)
            `[vx, vy, omega]` [m/s, m/s, rad/s] for the pairs (0, 1), (0, 2), ... (1, 2) ...,
            each the least-squares fit to its two modules. NaN for a pair at one point. Their
            mean is the "universal" estimate; their spread shows a slipping module.

        Raises
        ------
        ValueError
            If a last axis is not n long.

        """
        x, y = self._components(states)
        first, second = self._pairs
        arm = self.module_positions[second] - self.module_positions[first]
        middle = 0.5 * (self.module_positions[second] + self.module_positions[first])
        square = np.sum(arm ** 2, axis=-1)
        square = np.where(square == 0.0, np.nan, square)
        omega = (arm[:, 0] * (y[..., second] - y[..., first])
                 - arm[:, 1] * (x[..., second] - x[..., first])) / square
        return np.stack((0.5 * (x[..., first] + x[..., second]) + omega * middle[:, 1],
                         0.5 * (y[..., first] + y[..., second]) - omega * middle[:, 0],
                         omega), axis=-1)

    def module_accelerations(self, acceleration: ArrayLike, omega: ArrayLike,
                             center: ArrayLike = BASE_LINK) -> NDArray[np.float64]:
        """
        Return the acceleration vector of every module.

        `[ax - alpha ry - omega^2 rx, ay + alpha rx - omega^2 ry]`: the acceleration of a
        point of a rigid body (Beer & Johnston, Vector Mechanics: Dynamics, 15.4). The
        centripetal part is there also when the chassis does not accelerate.

        Parameters
        ----------
        acceleration : array_like (..., 3)
            `[ax, ay, alpha]` [m/s^2, m/s^2, rad/s^2]: the inertial acceleration of `center`
            in base-frame axes (not the rate of change of the base-frame twist).
        omega : array_like (...)
            Yaw rate [rad/s].
        center : array_like (2,) or (..., 2)
            The point whose acceleration is given, from base_link [m].

        Returns
        -------
        ndarray (..., n, 2)
            Accelerations in base-frame axes [m/s^2].

        Raises
        ------
        ValueError
            If a last axis has the wrong length.

        """
        acceleration = as_vectors(acceleration, 3, 'acceleration')
        center = as_vectors(center, 2, 'center')
        alpha = acceleration[..., 2:]
        square = np.square(np.asarray(omega, dtype=float))[..., np.newaxis]
        rx = self.module_positions[:, 0] - center[..., :1]
        ry = self.module_positions[:, 1] - center[..., 1:]
        return np.stack((acceleration[..., 0:1] - alpha * ry - square * rx,
                         acceleration[..., 1:2] + alpha * rx - square * ry), axis=-1)

    def chassis_acceleration(self, module_accelerations: ArrayLike) -> NDArray[np.float64]:
        """
        Return the rigid motion that fits the modules' accelerations best.

        The inverse of `module_accelerations` about base_link, by least squares.

        Parameters
        ----------
        module_accelerations : array_like (..., n, 2)
            Acceleration vectors in base-frame axes [m/s^2].

        Returns
        -------
        ndarray (..., 4)
            `[ax, ay, alpha, omega^2]` [m/s^2, m/s^2, rad/s^2, rad^2/s^2]. Noise can make
            omega^2 negative; it is not clipped.

        Raises
        ------
        ValueError
            If the last axes are not (n, 2).

        """
        vectors = as_vectors(module_accelerations, 2, 'module_accelerations')
        x = as_vectors(vectors[..., 0], self.module_count, 'module_accelerations')
        y = vectors[..., 1]
        square = -(x * self._lever_x + y * self._lever_y).sum(axis=-1, keepdims=True)
        fit = self._fit(x, y)
        return np.concatenate((fit[..., :2] + square * self._centroid, fit[..., 2:], square),
                              axis=-1)

    def steering_rates(self, twist: ArrayLike, twist_rate: ArrayLike,
                       center: ArrayLike = BASE_LINK) -> Components:
        """
        Return how fast drives and steering must change while the twist changes.

        With u a module's velocity and u' its rate in the base frame (where the steering
        angle is measured, so there is no omega^2 term): the drive accelerates by
        `u . u' / |u|` and the steering turns by `u x u' / |u|^2`, the radial and angular
        rates of u in polar coordinates.

        Parameters
        ----------
        twist : array_like (..., 3)
            `[vx, vy, omega]` [m/s, m/s, rad/s] of `center`.
        twist_rate : array_like (..., 3)
            Rate of change of the base-frame twist [m/s^2, m/s^2, rad/s^2].
        center : array_like (2,) or (..., 2)
            Centre of rotation from base_link [m].

        Returns
        -------
        drive_acceleration : ndarray (..., n)
            Rate of the rim speed [m/s^2].
        steering_rate : ndarray (..., n)
            Rate of the steering angle [rad/s]. Both are 0 for a module slower than 1e-6 m/s.

        Raises
        ------
        ValueError
            If a last axis has the wrong length.

        """
        x, y = self._velocities(twist, center)
        rate_x, rate_y = self._velocities(twist_rate, center)
        speed = np.hypot(x, y)
        reciprocal = np.where(speed < MIN_SPEED, 0.0, 1.0 / np.maximum(speed, MIN_SPEED))
        drive = (x * rate_x + y * rate_y) * reciprocal
        steering = (x * rate_y - y * rate_x) * reciprocal ** 2
        return drive, steering
