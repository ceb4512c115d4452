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

"""Least-squares fits of a rigid motion to the modules in use; their geometry is built once."""

import cmath
import math
import operator

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.angles import phase

# Modules are at one point where rounding alone may have set them apart: by 1e-9 of their distance
# from base_link, squared.
ONE_POINT = 1e-18
# The others always leave a module some freedom, so that no error is divided by 0.
LEAST_FREEDOM = 1e-9


class Group:
    """
    Constant geometry of the modules that a step rests on.

    Attributes
    ----------
    used : tuple of int (k,)
        Indices of the modules.
    size : int
        How many they are, k.
    arms : list of complex (k,)
        Module positions from the centroid, turned by +90 degrees [m]: how far each moves per
        radian of turn about it.
    centroid : complex
        Mean of the module positions [m].
    lever : complex
        The same, turned by +90 degrees [m]: how far it moves per radian of turn.
    inertia : float
        Sum of the squared distances from the centroid [m^2]; 0 where all modules are at
        one point, and rotation cannot be told from translation.

    """

    def __init__(self, used: tuple[int, ...], positions: list[complex]) -> None:
        """Build it from the positions (k,) [m] as complex numbers."""
        self.used, self.size = used, len(used)
        self._root = math.sqrt(self.size)
        self.centroid = sum(positions) / self.size
        self.lever = 1j * self.centroid
        self.arms = arms = [1j * (position - self.centroid) for position in positions]
        self.inertia = sum(abs(arm) ** 2 for arm in arms)
        if self.inertia <= ONE_POINT * (1.0 + abs(self.centroid)) ** 2:
            self.inertia = 0.0
        # What each module's velocity counts for in the yaw rate [1/m].
        self._weights = [arm.conjugate() / self.inertia if self.inertia else 0j for arm in arms]
        # What is left of the identity once a module's own part in the fit, its leverage, is taken
        # off: across its arm as turned, and how much less along it, where the turn has a part too.
        self._directions = [cmath.rect(1.0, -phase(arm)) for arm in arms]
        self._free = free = 1.0 - 1.0 / self.size
        self._more_along = [free / max(free - abs(arm * weight), LEAST_FREEDOM)
                            for arm, weight in zip(arms, self._weights)]

    def rate(self, velocities: list[complex]) -> float:
        """Return the yaw rate [rad/s] of the rigid body that fits the velocities best."""
        return sum(map(operator.mul, self._weights, velocities), 0j).real

    def turn(self, chords: list[complex]) -> float:
        """Return the change of heading [rad] of the rigid motion that fits the chords best."""
        # A rigid turn moves a module by 2 sin(turn / 2) for each metre of its arm.
        half = 0.5 * self.rate(chords)
        return 2.0 * math.asin(half) if abs(half) < 1.0 else math.copysign(math.pi, half)

    def motion(self, chords: list[complex], turn: float) -> tuple[complex, list[complex]]:
        """Return the displacement of base_link that fits best, and the error of each chord [m]."""
        factor = 2.0 * math.sin(0.5 * turn)
        middle = sum(chords) / self.size
        return (middle - factor * self.lever,
                [chord - middle - factor * arm for chord, arm in zip(chords, self.arms)])

    def rms(self, values: list[complex]) -> float:
        """Return the root mean square of one value for each module."""
        return math.hypot(*map(abs, values)) / self._root

    def suspect(self, errors: list[complex], heading_known: bool) -> tuple[int, float]:
        """
        Return the module without which the others agree best, and how well they would agree.

        Leaving out module j lowers the sum of squared errors by `e_j' (I - H_j)^-1 e_j`, with
        H_j its block of the hat matrix (Cook & Weisberg, Residuals and Influence in
        Regression, 2.2): no fit needs to be repeated.

        Parameters
        ----------
        errors : list of complex (k,)
            How far off the fit each chord is [m].
        heading_known : bool
            Whether the turn was given, so that only the displacement was fitted.

        Returns
        -------
        place : int
            Of the module, in the group.
        spread : float
            Root mean square of the errors that the others would have [m].

        """
        squares = gains = [abs(error) ** 2 for error in errors]
        if not heading_known:
            local = map(operator.mul, errors, self._directions)
            gains = [error.imag ** 2 + error.real ** 2 * more
                     for error, more in zip(local, self._more_along)]
        largest = max(gains)
        left = sum(squares) - largest / self._free
        return gains.index(largest), math.sqrt(left / (self.size - 1)) if left > 0.0 else 0.0


class Groups:
    """
    The groups that remain of a base's modules when some are left out.

    Parameters
    ----------
    module_positions : ndarray (n, 2)
        From base_link [m].

    """

    def __init__(self, module_positions: NDArray[np.float64]) -> None:
        """Keep the positions; groups are built when first used."""
        self._positions = [complex(x, y) for x, y in module_positions.tolist()]
        self._groups: dict[tuple[int, ...], Group] = {}

    def of(self, used: tuple[int, ...]) -> Group:
        """Return the group of the modules with these indices."""
        if used not in self._groups:
            self._groups[used] = Group(used, [self._positions[module] for module in used])
        return self._groups[used]
