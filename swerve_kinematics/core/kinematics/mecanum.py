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

"""Mecanum kinematics: four wheels with rollers at 45 degrees."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.arrays import as_vectors, transform
from swerve_kinematics.core.geometry.se2 import BASE_LINK, twist_of_base_link
from swerve_kinematics.core.kinematics.desaturation import desaturate_speeds
from swerve_kinematics.core.kinematics.wheel_layout import WheelLayout

# FL FR RL RR: a wheel's rim speed is the velocity of its contact along x plus this sign times
# that along y.
ROLLER_SIGNS = np.array([-1.0, 1.0, 1.0, -1.0])


class MecanumKinematics(WheelLayout):
    """
    Maps between the twist of a mecanum base and the speeds of its four wheels.

    Both directions are linear with constant matrices, so they map distance deltas to twist
    deltas and rates of the base-frame twist to wheel accelerations just as well.

    Parameters
    ----------
    wheel_positions : array_like (4, 2)
        Front left, front right, rear left, rear right, from base_link [m]. Seen from above,
        the roller axes form an X: each points roughly at the middle of the base.

    Attributes
    ----------
    wheel_positions : ndarray (4, 2)
        The positions, read-only.

    Raises
    ------
    ValueError
        If the shape is not (4, 2), a position is not finite, or the layout leaves a motion
        that no wheel feels.

    """

    def __init__(self, wheel_positions: ArrayLike) -> None:
        """Check the layout and build its matrices."""
        super().__init__(wheel_positions, 'wheel_positions')
        positions = self._positions
        if len(positions) != 4:
            raise ValueError(f'wheel_positions must have shape (4, 2), got {positions.shape}')
        x, y = positions.T
        matrix = np.stack((np.ones(4), ROLLER_SIGNS, ROLLER_SIGNS * x - y), axis=-1)
        if np.linalg.matrix_rank(matrix) < 3:
            raise ValueError(f'wheel_positions determine no motion: {positions.tolist()}')
        self._inverse = matrix.T
        self._forward = np.linalg.pinv(matrix).T

    @property
    def wheel_positions(self) -> NDArray[np.float64]:
        """Return the positions (4, 2) [m]."""
        return self._positions

    def inverse(self, twist: ArrayLike, center: ArrayLike = BASE_LINK) -> NDArray[np.float64]:
        """
        Return the wheel speeds that make the base move with `twist`.

        Rows FL `[1, -1, -(x + y)]`, FR `[1, 1, x - y]`, RL `[1, 1, x - y]`,
        RR `[1, -1, -(x + y)]`, each with its own wheel's (x, y) from the centre.

        Parameters
        ----------
        twist : array_like (..., 3)
            `[vx, vy, omega]` [m/s, m/s, rad/s] in the base frame: the velocity of `center`.
            Or a twist delta, or the rate of change of a twist.
        center : array_like (2,) or (..., 2)
            Centre of rotation from base_link [m].

        Returns
        -------
        ndarray (..., 4)
            Rim speeds [m/s] of FL, FR, RL, RR (or distances, or accelerations).

        Raises
        ------
        ValueError
            If a last axis has the wrong length.

        """
        return transform(twist_of_base_link(twist, center), self._inverse)

    def forward(self, wheel_speeds: ArrayLike) -> NDArray[np.float64]:
        """
        Return the twist that fits the wheel speeds best, by least squares.

        Parameters
        ----------
        wheel_speeds : array_like (..., 4)
            Rim speeds [m/s] of FL, FR, RL, RR (or distances, or accelerations).

        Returns
        -------
        ndarray (..., 3)
            `[vx, vy, omega]` [m/s, m/s, rad/s] of base_link (or its delta, or its rate).

        Raises
        ------
        ValueError
            If the last axis is not 4 long.

        """
        return transform(as_vectors(wheel_speeds, 4, 'wheel_speeds'), self._forward)

    @staticmethod
    def desaturate(wheel_speeds: ArrayLike, max_speed: ArrayLike) -> NDArray[np.float64]:
        """
        Scale the wheels by one factor so that none exceeds `max_speed`.

        Parameters
        ----------
        wheel_speeds : array_like (..., 4)
            Rim speeds [m/s].
        max_speed : array_like (...)
            Limit of `|speed|` [m/s].

        Returns
        -------
        ndarray (..., 4)
            Unchanged where no `|speed|` exceeds the limit.

        Raises
        ------
        ValueError
            If the last axis is not 4 long, or `max_speed` is negative or NaN.

        """
        return desaturate_speeds(as_vectors(wheel_speeds, 4, 'wheel_speeds'), max_speed)
