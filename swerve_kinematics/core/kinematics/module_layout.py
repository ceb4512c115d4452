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

"""The layout of swerve modules, as the matrices between a twist and the modules' velocities."""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.arrays import transform
from swerve_kinematics.core.geometry.se2 import twist_of_base_link
from swerve_kinematics.core.kinematics.wheel_layout import WheelLayout

# The x and the y of something.
Components: TypeAlias = tuple[NDArray[np.float64], NDArray[np.float64]]


class ModuleLayout(WheelLayout):
    """
    Positions of the modules, with the linear maps that follow from them alone.

    Notes
    -----
    A module at r from the centre of rotation moves with `u = [vx - omega ry, vy + omega rx]`.
    Inverting this for all modules at once is a linear least-squares problem, which separates
    at the centroid c of the modules: there, the translation is the mean of the u and
    `omega = sum (r - c) x u / sum |r - c|^2`. This is the pseudo-inverse in closed form, and
    it stays exact for a base_link far outside the wheels. `RigidFit` has it for complex vectors.

    """

    def __init__(self, module_positions: ArrayLike) -> None:
        """Check the layout and build its matrices."""
        super().__init__(module_positions, 'module_positions')
        positions = self._positions
        if len(positions) < 2:
            raise ValueError(f'module_positions must have 2 modules or more, got {len(positions)}')
        self._centroid = positions.mean(axis=0)
        arms = positions - self._centroid
        # The mean of large numbers is rounded, and arms that do not add up to 0 take a part of
        # the translation for a turn.
        arms -= arms.mean(axis=0)
        spread = np.sum(arms ** 2)
        if np.sqrt(spread) <= 1e-9 * (1.0 + np.abs(positions).max()):
            raise ValueError(f'module_positions are all at one point: {positions[0].tolist()}')
        # Weights that turn module velocities into the sums of (r - c) x u and (r - c) . u.
        self._lever_x, self._lever_y = arms.T / spread
        self._to_x, self._to_y = self._inverse_matrices()
        self._from_x, self._from_y = self._forward_matrices()
        self._pairs = np.triu_indices(len(positions), 1)

    @property
    def module_positions(self) -> NDArray[np.float64]:
        """Return the positions (n, 2) [m]."""
        return self._positions

    @property
    def module_count(self) -> int:
        """Return the number of modules."""
        return len(self.module_positions)

    def _inverse_matrices(self) -> Components:
        """Return the matrices (3, n) from a twist to the x and to the y of the velocities."""
        rx, ry = self.module_positions.T
        zero, one = np.zeros_like(rx), np.ones_like(rx)
        return np.stack((one, zero, -ry)), np.stack((zero, one, rx))

    def _forward_matrices(self) -> Components:
        """Return the matrices (n, 3) from the x and from the y of the velocities to a twist."""
        cx, cy = self._centroid
        share = np.full(self.module_count, 1.0 / self.module_count)
        omega_x, omega_y = -self._lever_y, self._lever_x
        return (np.stack((share + cy * omega_x, -cx * omega_x, omega_x), axis=-1),
                np.stack((cy * omega_y, share - cx * omega_y, omega_y), axis=-1))

    def _velocities(self, twist: ArrayLike, center: ArrayLike) -> Components:
        """Return both components (..., n) of the module velocities about `center`."""
        twist = twist_of_base_link(twist, center)
        return transform(twist, self._to_x), transform(twist, self._to_y)

    def _fit(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the twist (..., 3) that fits the velocity components (..., n) best."""
        return transform(x, self._from_x) + transform(y, self._from_y)
