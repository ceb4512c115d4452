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

"""
Rigid motion in the plane: SE(2), frames, and the skew of translating while turning.

A pose is `[x, y, heading]` (m, m, rad) and a twist `[vx, vy, omega]` (m/s, m/s, rad/s).
Headings are never wrapped here: a base that turned twice has turned by 4 pi.

A base that moves with a constant twist runs along a circular arc. Its displacement is the
chord of that arc: it points half the heading change away from the initial velocity, and is
shorter than the arc by sinc(theta / 2). Everything below is this one picture.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.angles import sinc, wrap_angle
from swerve_kinematics.core.geometry.arrays import as_vectors, transform

BASE_LINK = (0.0, 0.0)
# Takes a point (x, y) to [y, -x, 0]: what a unit of omega about it adds to base_link's twist.
LEVER: NDArray[np.float64] = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])


def rotated(vectors: NDArray[np.float64], angle: ArrayLike) -> NDArray[np.float64]:
    """
    Return twists or poses whose first two components are turned by `angle`.

    Parameters
    ----------
    vectors : ndarray (..., 3)
        Twists or poses.
    angle : array_like (...)
        Rotation [rad], counter-clockwise; broadcasts against the leading axes.

    Returns
    -------
    ndarray (..., 3)

    """
    angle = np.asarray(angle, dtype=float)
    return _turned(vectors, np.cos(angle), np.sin(angle), vectors[..., 2])


def _turned(vectors: NDArray[np.float64], cos: NDArray[np.float64],
            sin: NDArray[np.float64], third: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return `[cos x - sin y, sin x + cos y, third]`, shape (..., 3)."""
    x, y = vectors[..., 0], vectors[..., 1]
    turned_x = cos * x - sin * y
    result = np.empty(turned_x.shape + (3,))
    result[..., 0] = turned_x
    result[..., 1] = sin * x + cos * y
    result[..., 2] = third
    return result


def twist_of_base_link(twist: ArrayLike, center: ArrayLike) -> NDArray[np.float64]:
    """
    Return the twist of base_link on a rigid base whose point `center` moves with `twist`.

    `[vx + omega cy, vy - omega cx, omega]`.

    Parameters
    ----------
    twist : array_like (..., 3)
        `[vx, vy, omega]` [m/s, m/s, rad/s], or its rate of change in the base frame.
    center : array_like (2,) or (..., 2)
        Position of the point from base_link [m].

    Returns
    -------
    ndarray (..., 3)

    Raises
    ------
    ValueError
        If a last axis has the wrong length.

    """
    twist = as_vectors(twist, 3, 'twist')
    if center is BASE_LINK:  # the default, worth no arithmetic
        return twist
    return twist + twist[..., 2:] * transform(as_vectors(center, 2, 'center'), LEVER)


def se2_exp(twist: ArrayLike) -> NDArray[np.float64]:
    """
    Return the pose reached by following a constant twist for one unit of time.

    Exponential map of SE(2), written as a chord: the translation is
    `sinc(theta / 2) * R(theta / 2) * [x, y]` (equal to the V matrix of Sola et al., "A micro
    Lie theory for state estimation in robotics", eq. 158, without its cancellation near 0).

    Parameters
    ----------
    twist : array_like (..., 3)
        Twist times duration, `[x, y, theta]` [m, m, rad] in the frame of the start.

    Returns
    -------
    ndarray (..., 3)
        Pose `[x, y, theta]` [m, m, rad] in the frame of the start, theta as given.

    Raises
    ------
    ValueError
        If the last axis is not 3 long.

    """
    twist = as_vectors(twist, 3, 'twist')
    theta = twist[..., 2]
    half = 0.5 * theta
    chord = sinc(half)
    return _turned(twist, chord * np.cos(half), chord * np.sin(half), theta)


def _chord_to_arc(vectors: NDArray[np.float64], half: NDArray[np.float64],
                  third: NDArray[np.float64]) -> NDArray[np.float64]:
    """Undo the chord of `se2_exp`: turn back by `half` the turn, stretch by 1 / sinc(half)."""
    return _turned(vectors, np.cos(half) / sinc(half), -half, third)


def se2_log(pose: ArrayLike) -> NDArray[np.float64]:
    """
    Return the constant twist that reaches `pose` in one unit of time, turning at most pi.

    Principal logarithm of SE(2): `se2_log(se2_exp(x)) == x` while `|theta|` < pi. A heading
    beyond pi is that of the shortest way round.

    Parameters
    ----------
    pose : array_like (..., 3)
        `[x, y, heading]` [m, m, rad].

    Returns
    -------
    ndarray (..., 3)
        Twist `[x, y, theta]` with theta in (-pi, pi] [m, m, rad].

    Raises
    ------
    ValueError
        If the last axis is not 3 long.

    """
    pose = as_vectors(pose, 3, 'pose')
    theta = wrap_angle(pose[..., 2])
    return _chord_to_arc(pose, 0.5 * theta, theta)


def se2_compose(pose: ArrayLike, delta: ArrayLike) -> NDArray[np.float64]:
    """
    Return `pose` followed by `delta`, which is given in the frame of `pose`.

    Parameters
    ----------
    pose, delta : array_like (..., 3)
        `[x, y, heading]` [m, m, rad]; they broadcast.

    Returns
    -------
    ndarray (..., 3)
        The composed pose; headings add and are not wrapped.

    Raises
    ------
    ValueError
        If a last axis is not 3 long.

    """
    pose = as_vectors(pose, 3, 'pose')
    return pose + rotated(as_vectors(delta, 3, 'delta'), pose[..., 2])


def discretize(twist: ArrayLike, dt: ArrayLike) -> NDArray[np.float64]:
    """
    Return the twist that, held for `dt`, reaches the pose a field-straight motion would.

    Held for a control period, a twist with both translation and rotation bends the path:
    the base leaves the line that was commanded, to the side it turns to. The twist returned
    here has `se2_exp(result * dt) == twist * dt`, so that the periods add up to the line.

    Parameters
    ----------
    twist : array_like (..., 3)
        `[vx, vy, omega]` [m/s, m/s, rad/s], as commanded.
    dt : array_like (...)
        Control period [s]; broadcasts against the leading axes of `twist`.

    Returns
    -------
    ndarray (..., 3)
        Twist [m/s, m/s, rad/s], omega as commanded, also where omega * dt exceeds pi. At
        dt = 0 the twist itself. Near a full turn per period no constant twist can displace
        the base, and the linear speeds grow without bound.

    Raises
    ------
    ValueError
        If the last axis is not 3 long.

    """
    twist = as_vectors(twist, 3, 'twist')
    omega = twist[..., 2]
    return _chord_to_arc(twist, 0.5 * omega * np.asarray(dt, dtype=float), omega)


def to_robot_frame(twist: ArrayLike, heading: ArrayLike) -> NDArray[np.float64]:
    """
    Express a field-frame twist in the base frame.

    Parameters
    ----------
    twist : array_like (..., 3)
        `[vx, vy, omega]` [m/s, m/s, rad/s] in the field frame.
    heading : array_like (...)
        Heading of the base in the field [rad].

    Returns
    -------
    ndarray (..., 3)
        The same motion in the base frame.

    Raises
    ------
    ValueError
        If the last axis is not 3 long.

    """
    return rotated(as_vectors(twist, 3, 'twist'), -np.asarray(heading, dtype=float))


def to_field_frame(twist: ArrayLike, heading: ArrayLike) -> NDArray[np.float64]:
    """
    Express a base-frame twist in the field frame; the inverse of `to_robot_frame`.

    Parameters
    ----------
    twist : array_like (..., 3)
        `[vx, vy, omega]` [m/s, m/s, rad/s] in the base frame.
    heading : array_like (...)
        Heading of the base in the field [rad].

    Returns
    -------
    ndarray (..., 3)
        The same motion in the field frame.

    Raises
    ------
    ValueError
        If the last axis is not 3 long.

    """
    return rotated(as_vectors(twist, 3, 'twist'), heading)
