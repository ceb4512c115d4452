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

"""From joystick axes to a twist."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray


def _live(stick: ArrayLike, deadband: float) -> NDArray[np.float64]:
    """Return the stick beyond its dead band, stretched so that full deflection stays 1."""
    stick = np.clip(np.asarray(stick, dtype=float), -1.0, 1.0)
    beyond = np.maximum(np.abs(stick) - deadband, 0.0)
    live: NDArray[np.float64] = np.copysign(beyond / (1.0 - deadband), stick)
    return live


def joystick_twist(forward: ArrayLike, left: ArrayLike, turn: ArrayLike, max_speed: float,
                   base_radius: float, deadband: float = 0.0) -> NDArray[np.float64]:
    """
    Return the twist that three joystick axes command.

    Parameters
    ----------
    forward, left, turn : array_like (...)
        Axes in [-1, 1]; beyond that they are clipped. They broadcast.
    max_speed : float
        Linear speed at full deflection of `forward` or of `left` [m/s].
    base_radius : float
        Half the diagonal of the wheel contacts [m]: at full deflection of `turn` the wheels
        run at `max_speed`.
    deadband : float
        Deflection in [0, 1) up to which an axis reads as 0.

    Returns
    -------
    ndarray (..., 3)
        `[vx, vy, omega]` [m/s, m/s, rad/s].

    Raises
    ------
    ValueError
        If `max_speed` is negative, `base_radius` not positive, one of them not finite, or
        `deadband` outside [0, 1).

    """
    if not 0.0 <= max_speed < math.inf:
        raise ValueError(f'max_speed must be zero or more and finite, got {max_speed}')
    if not 0.0 < base_radius < math.inf:
        raise ValueError(f'base_radius must be positive and finite, got {base_radius}')
    if not 0.0 <= deadband < 1.0:
        raise ValueError(f'deadband must be in [0, 1), got {deadband}')
    axes = np.broadcast_arrays(*(_live(axis, deadband) for axis in (forward, left, turn)))
    return np.stack(axes, axis=-1) * [max_speed, max_speed, max_speed / base_radius]
