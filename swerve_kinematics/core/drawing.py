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

"""What people draw of a swerve base, as plain geometry: vectors, outline, ellipse, dashes."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.arrays import as_vectors
from swerve_kinematics.core.geometry.se2 import BASE_LINK
from swerve_kinematics.core.kinematics.modules import as_states, StatesLike


def velocity_vectors(states: StatesLike) -> NDArray[np.float64]:
    """
    Return the velocity of every module as a vector.

    Parameters
    ----------
    states : ModuleStates (..., n)
        Speeds [m/s], negative where the drive is reversed, and angles [rad].

    Returns
    -------
    ndarray (..., n, 2)
        [m/s] in the base frame. It points the way the module moves: against its steering
        angle where the drive is reversed.

    """
    speed, angle = as_states(states)
    return np.stack((speed * np.cos(angle), speed * np.sin(angle)), axis=-1)


def twist_parts(module_positions: ArrayLike, twist: ArrayLike, center: ArrayLike = BASE_LINK,
                ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return the two parts of every module's velocity: they add up to what a twist commands.

    Parameters
    ----------
    module_positions : array_like (n, 2)
        From base_link [m].
    twist : array_like (..., 3)
        `[vx, vy, omega]` [m/s, m/s, rad/s] in the base frame: the velocity of `center`.
    center : array_like (2,)
        Centre of rotation from base_link [m].

    Returns
    -------
    translation, rotation : ndarray (..., n, 2)
        [m/s] in the base frame: the same `[vx, vy]` for all, and `omega` times the arm from
        the centre, turned by +90 degrees.

    Raises
    ------
    ValueError
        If a last axis has the wrong length.

    """
    whole = as_vectors(twist, 3, 'twist')[..., np.newaxis, :]
    x, y = (as_vectors(module_positions, 2, 'module_positions')
            - as_vectors(center, 2, 'center')).T
    rotation = whole[..., 2:] * np.stack((-y, x), axis=-1)
    return np.broadcast_to(whole[..., :2], rotation.shape).copy(), rotation


def outline(positions: ArrayLike) -> NDArray[np.float64]:
    """
    Return points in the order of a walk around them.

    Parameters
    ----------
    positions : array_like (n, 2)
        [m].

    Returns
    -------
    ndarray (n, 2)
        Counter-clockwise around their mean.

    """
    points = np.asarray(positions, dtype=float)
    x, y = (points - points.mean(axis=0)).T
    return points[np.argsort(np.arctan2(y, x), kind='stable')]


def covariance_ellipse(covariance: ArrayLike, probability: float = 0.95,
                       ) -> tuple[NDArray[np.float64], float]:
    """
    Return the ellipse that holds a normally distributed point with some probability.

    Its semi-axes are the square roots of the eigenvalues times `sqrt(-2 ln(1 - p))`, the
    quantile of the chi-square distribution with 2 degrees of freedom.

    Parameters
    ----------
    covariance : array_like (2, 2)
        Of x and y [m^2].
    probability : float
        In (0, 1).

    Returns
    -------
    semi_axes : ndarray (2,)
        The longer one first [m].
    angle : float
        From the x axis to the longer one [rad].

    """
    variances, axes = np.linalg.eigh(np.asarray(covariance, dtype=float))
    # Rounding may leave a variance of 0 a little below it.
    scale = -2.0 * np.log1p(-probability)
    semi_axes = np.sqrt(scale * np.maximum(variances[::-1], 0.0))
    return semi_axes, float(np.arctan2(axes[1, 1], axes[0, 1]))


def dashed_arrow(start: ArrayLike, vector: ArrayLike, dash: float,
                 head: float) -> NDArray[np.float64]:
    """
    Return an arrow as strokes: a dashed shaft and the two strokes of its head.

    Parameters
    ----------
    start, vector : array_like (2,)
        [m]; the vector is not zero.
    dash : float
        About how long a dash and a gap are [m]; they are fitted to the arrow's length.
    head : float
        Length of the head's strokes [m], at most that of the arrow.

    Returns
    -------
    ndarray (2 k, 2)
        Pairs of points, the ends of each stroke. The first point is the start and the first
        of the last stroke is the tip.

    """
    tail, shaft_vector = np.asarray(start, dtype=float), np.asarray(vector, dtype=float)
    length = math.hypot(*shaft_vector)
    # Dashes at both ends and gaps of the same length between.
    count = max(2, round(0.5 * (length / dash + 1.0)))
    shaft = tail + np.linspace(0.0, 1.0, 2 * count)[:, np.newaxis] * shaft_vector
    back = -shaft_vector * min(head / length, 1.0)
    cos, sin = np.cos(np.pi / 6.0), np.sin(np.pi / 6.0)
    tip = tail + shaft_vector
    sides = (back @ np.array([[cos, sin], [-sin, cos]]),
             back @ np.array([[cos, -sin], [sin, cos]]))
    return np.vstack((shaft, *((tip, tip + side) for side in sides)))
