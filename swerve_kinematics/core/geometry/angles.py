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

"""Angles on the circle: wrapping, differences and directions, in (-pi, pi]."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

TURN = 2.0 * np.pi

# As arrays: numpy's calls on a few angles are a third faster than with Python floats.
_PI, _TURN, _HALF = np.array(np.pi), np.array(TURN), np.array(0.5)


def wrap_angle(angle: ArrayLike) -> NDArray[np.float64]:
    """
    Return the equivalent angle in (-pi, pi].

    Exact: the result differs from `angle` by a whole multiple of the double nearest to
    2 pi, and an angle already in the interval comes back unchanged.

    Parameters
    ----------
    angle : array_like (...)
        Angle [rad].

    Returns
    -------
    ndarray (...)
        Angle in (-pi, pi] [rad]; NaN where the input is NaN or infinite.

    """
    # In place, for each new array of a large batch costs as much as to compute it.
    remainder = np.asarray(np.fmod(np.asarray(angle, dtype=float), _TURN))
    turns = np.asarray(remainder / _PI)
    np.ceil(turns, out=turns)  # half turns: -1 and 2 lie outside the interval, 0 and 1 inside
    turns *= _HALF
    np.floor(turns, out=turns)
    turns *= _TURN
    remainder -= turns
    return remainder[()]


def angle_difference(angle: ArrayLike, reference: ArrayLike) -> NDArray[np.float64]:
    """
    Return the shortest rotation that takes `reference` to `angle`.

    Parameters
    ----------
    angle, reference : array_like (...)
        Angles [rad], wrapped or not; they broadcast.

    Returns
    -------
    ndarray (...)
        `angle - reference` in (-pi, pi] [rad].

    """
    return wrap_angle(np.asarray(angle, dtype=float) - np.asarray(reference, dtype=float))


def nearest_equivalent(angle: ArrayLike, reference: ArrayLike) -> NDArray[np.float64]:
    """
    Return the angle that points like `angle` and lies nearest to `reference`.

    Parameters
    ----------
    angle, reference : array_like (...)
        Angles [rad]; `reference` may count several turns.

    Returns
    -------
    ndarray (...)
        An angle within half a turn of `reference` [rad].

    """
    return np.add(reference, angle_difference(angle, reference))


def scalar_nearest_equivalent(angle: float, reference: float) -> float:
    """Return the same for single floats, without numpy's cost of a call."""
    return reference + math.remainder(angle - reference, TURN)


def direction(x: ArrayLike, y: ArrayLike) -> NDArray[np.float64]:
    """
    Return the direction of the vector (x, y).

    Parameters
    ----------
    x, y : array_like (...)
        Components, in any common unit.

    Returns
    -------
    ndarray (...)
        Angle from +x in (-pi, pi] [rad]. `arctan2` alone answers -pi for a vector along -x
        whose y is -0.0 or too small to matter.

    """
    angle = np.asarray(np.arctan2(y, x))
    np.copyto(angle, _PI, where=angle == -_PI)
    return angle


def sinc(x: ArrayLike) -> NDArray[np.float64]:
    """
    Return sin(x) / x, and 1 at x = 0.

    The ratio of a chord to its arc, `sinc(angle / 2)`: no series is needed, for the
    quotient is accurate to the last digits down to the smallest x.

    Parameters
    ----------
    x : array_like (...)
        Angle [rad].

    """
    size = np.abs(x) + 1e-300  # an even function; changes nothing but 0
    return np.sin(size) / size


def scalar_sinc(x: float) -> float:
    """Return the same for a single float, without numpy's cost of a call."""
    return math.sin(x) / x if x else 1.0


def phase(number: complex) -> float:
    """
    Return the angle of a complex number in [-pi, pi] [rad].

    `cmath.phase` raises OverflowError where an imaginary part that is next to nothing, such as a
    filter that decays leaves behind, makes an angle too small for a float.
    """
    return math.atan2(number.imag, number.real)


def within_a_turn(reading: float, ratio: float) -> float:
    """
    Return a reading of a geared joint, less whole turns of what it turns if it is far from 0.

    One within a turn of 0 is left as it is: a joint with end stops would be sent a turn away.

    Parameters
    ----------
    reading : float
        [rad].
    ratio : float
        Turns of the joint for one turn of what it turns, of either sign.

    """
    turn = abs(ratio) * TURN
    return reading if abs(reading) <= max(turn, TURN) else math.remainder(reading, turn)
