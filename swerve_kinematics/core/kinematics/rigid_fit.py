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

"""The rigid motion that fits the ways of some of its points best, for whole recordings at once."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.arrays import transform


class RigidFit:
    """
    Least-squares fit of a small rigid motion to the ways, or the velocities, of points.

    Vectors are complex numbers here, x + iy. A point at an arm a from the middle of all moves by
    `way of the middle + turn * 1j * a`. There the problem separates: the way of the middle is the
    mean of all, and the turn is `sum Re(conj(1j a) way) / sum |a|^2`. `ModuleLayout` has the same
    as real matrices for batches of any shape, and `odometry.group` in Python's own numbers for one
    step at a time.

    Parameters
    ----------
    positions : ndarray of complex (n,)
        Of the points [m], n >= 2, not all at one place.

    Attributes
    ----------
    middle : complex
        Mean of the positions [m].
    arm : ndarray of complex (n,)
        The positions from there [m].
    lever : ndarray of complex (n,)
        `conj(1j * arm)` [m]: what a way counts for in the turn, by the real part of their product.
    inertia : float
        Sum of the squared arms [m^2].
    size : float
        Their root mean square [m]: how far the points are moved by a turn of one radian.

    """

    def __init__(self, positions: NDArray[np.complexfloating[Any, Any]]) -> None:
        """Build the geometry."""
        self.middle = complex(positions.mean())
        self.arm = positions.astype(np.complex128) - self.middle
        self.lever = (1j * self.arm).conj()
        self.inertia = float((self.arm.real ** 2 + self.arm.imag ** 2).sum())
        self.size = math.sqrt(self.inertia / len(self.arm))

    def turn(self, ways: NDArray[np.complex128]) -> NDArray[np.float64]:
        """Return the turns (...) [rad] that fit ways (..., n) [m]; for velocities, the rates."""
        turn: NDArray[np.float64] = (
            transform(ways, self.lever[:, np.newaxis])[..., 0].real / self.inertia)
        return turn

    def motion(self, ways: NDArray[np.complex128]) -> tuple[
            NDArray[np.complex128], NDArray[np.float64]]:
        """Return the way of the origin (...) [m] and the turn (...) [rad] for ways (..., n)."""
        turn = self.turn(ways)
        way: NDArray[np.complex128] = ways.mean(axis=-1) - turn * 1j * self.middle
        return way, turn

    def fitted(self, ways: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """Return the ways (..., n) [m] of the points in the rigid motion that fits theirs best."""
        result: NDArray[np.complex128] = (
            ways.mean(axis=-1, keepdims=True)
            + self.turn(ways)[..., np.newaxis] * (1j * self.arm))
        return result

    def projection(self) -> NDArray[np.float64]:
        """
        Return `fitted` as a matrix (2 n, 2 n), of ways by their real, then their imaginary parts.

        From an orthonormal basis of the rigid motions, which makes it symmetric to the last bit.
        """
        x, y = self.arm.real, self.arm.imag
        ones, zeros = np.ones_like(x), np.zeros_like(x)
        motions = np.array((np.r_[ones, zeros], np.r_[zeros, ones], np.r_[-y, x]))
        motions /= np.linalg.norm(motions, axis=1, keepdims=True)
        projection: NDArray[np.float64] = motions.T @ motions
        return projection
