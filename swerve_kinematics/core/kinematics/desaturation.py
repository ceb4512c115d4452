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

"""Speeds brought within their limits by one common factor: a curve stays the same curve."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.arrays import as_limit, as_vectors
from swerve_kinematics.core.kinematics.modules import (
    as_states, ModuleStates, StatesLike, with_speed)

# Added to a speed that is to divide, for it may be 0; it alters no other.
TINY = 1e-300


def desaturate(states: StatesLike, max_speed: ArrayLike) -> ModuleStates:
    """
    Scale all modules by one factor so that none exceeds `max_speed`.

    One factor for all keeps the direction of the chassis twist: a curve stays the same curve.

    Parameters
    ----------
    states : ModuleStates (..., n)
        Targets.
    max_speed : array_like (...)
        Limit of `|speed|` [m/s].

    Returns
    -------
    ModuleStates (..., n)
        Unchanged where no `|speed|` exceeds the limit.

    Raises
    ------
    ValueError
        If `max_speed` is negative or NaN.

    """
    targets = as_states(states)
    return with_speed(targets, desaturate_speeds(targets.speed, max_speed))


def desaturate_speeds(speeds: ArrayLike, max_speed: ArrayLike) -> NDArray[np.float64]:
    """
    Scale a set of speeds by one factor so that none exceeds `max_speed`.

    Parameters
    ----------
    speeds : array_like (..., n)
        Rim speeds [m/s].
    max_speed : array_like (...)
        Limit of `|speed|` [m/s].

    Returns
    -------
    ndarray (..., n)

    Raises
    ------
    ValueError
        If `max_speed` is negative or NaN.

    """
    speeds = np.asarray(speeds, dtype=float)
    limit = as_limit(max_speed, 'max_speed')
    return _bounded(speeds, _factor(_peak(speeds), limit), limit)


def _peak(speeds: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the greatest |speed| of each set, shape (...); a NaN does not hide the others."""
    peak: NDArray[np.float64] = np.fmax.reduce(np.abs(speeds), axis=-1, initial=TINY)
    return peak


def _factor(value: NDArray[np.float64], limit: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the largest factor, at most 1, that brings `value` > 0 within `limit`."""
    return np.minimum(value, limit) / value


def _bounded(speeds: NDArray[np.float64], factor: NDArray[np.float64],
             limit: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return `speeds * factor` per set, kept within `limit` to the last bit."""
    limit = limit[..., np.newaxis]
    return np.maximum(np.minimum(speeds * factor[..., np.newaxis], limit), -limit)


def desaturate_chassis(states: StatesLike, twist: ArrayLike, max_module_speed: ArrayLike,
                       max_linear_speed: ArrayLike, max_angular_speed: ArrayLike) -> ModuleStates:
    """
    Scale all modules by one factor until modules and chassis are within their limits.

    WPILib's overload with the same arguments scales by the larger of the two chassis ratios
    instead: it slows commands that saturate nothing and lets others exceed the module limit.

    Parameters
    ----------
    states : ModuleStates (..., n)
        Targets.
    twist : array_like (..., 3)
        The `[vx, vy, omega]` [m/s, m/s, rad/s] that `states` were made from.
    max_module_speed, max_linear_speed : array_like (...)
        Limits of the rim speeds and of the chassis' linear speed [m/s].
    max_angular_speed : array_like (...)
        Limit of `|omega|` [rad/s].

    Returns
    -------
    ModuleStates (..., n)
        Unchanged where nothing exceeds its limit.

    Raises
    ------
    ValueError
        If the twist's last axis is not 3 long, or a limit is negative or NaN.

    """
    targets = as_states(states)
    twist = as_vectors(twist, 3, 'twist')
    linear_speed = np.hypot(twist[..., 0], twist[..., 1]) + TINY
    angular_speed = np.abs(twist[..., 2]) + TINY
    module_limit = as_limit(max_module_speed, 'max_module_speed')
    chassis_factor = np.minimum(
        _factor(linear_speed, as_limit(max_linear_speed, 'max_linear_speed')),
        _factor(angular_speed, as_limit(max_angular_speed, 'max_angular_speed')))
    factor = np.minimum(_factor(_peak(targets.speed), module_limit), chassis_factor)
    return with_speed(targets, _bounded(targets.speed, factor, module_limit))
