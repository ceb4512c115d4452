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

"""Module states, and what is done to them one module at a time."""

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.angles import angle_difference, wrap_angle

# How far beyond 90 degrees a module must be from its target before it is reversed: float
# noise at exactly 90 degrees (1e-16 rad a turn) must not flip a wheel, 1e-9 rad is nothing.
FLIP_TOLERANCE = 1e-9


class ModuleStates(NamedTuple):
    """
    Speed and steering angle of every module, in the order of the configuration.

    Attributes
    ----------
    speed : ndarray (..., n)
        Rim speed [m/s], negative where the drive is reversed. Holds distances [m] where the
        states stand for deltas.
    angle : ndarray (..., n)
        Steering angle [rad], 0 along +x, counter-clockwise positive.

    """

    speed: NDArray[np.float64]
    angle: NDArray[np.float64]


# What the functions take as states: ModuleStates, or any pair of speeds and angles.
StatesLike: TypeAlias = ModuleStates | tuple[ArrayLike, ArrayLike]


def as_states(states: StatesLike, name: str = 'states') -> ModuleStates:
    """
    Return `states` as ModuleStates of float64 arrays of one shape, to be read only.

    Parameters
    ----------
    states : ModuleStates (..., n)
        Or any pair of array_likes.
    name : str
        What the caller knows the states as, for the error.

    Returns
    -------
    ModuleStates (..., n)

    Raises
    ------
    ValueError
        If the shapes of speed and angle do not fit each other.

    """
    speed, angle = (np.asarray(values, dtype=float) for values in states)
    _check_fit(angle, f'{name}.angle', speed, f'{name}.speed')
    return ModuleStates(*np.broadcast_arrays(speed, angle))


def with_speed(states: ModuleStates, speed: NDArray[np.float64]) -> ModuleStates:
    """
    Return other speeds at the angles of `states`, which are copied.

    Parameters
    ----------
    states : ModuleStates (..., n)
        As from `as_states`.
    speed : ndarray (..., n)
        What was made from their speeds [m/s], perhaps one set of them for each of many limits.

    Returns
    -------
    ModuleStates (..., n)

    """
    return ModuleStates(speed, np.broadcast_to(states.angle, speed.shape).copy())


def _check_fit(array: NDArray[np.generic], name: str, other: NDArray[np.generic],
               other_name: str) -> None:
    """Raise a ValueError that names the two arrays if they do not broadcast."""
    try:
        np.broadcast(array, other)
    except ValueError:
        raise ValueError(f'{name} of shape {array.shape} does not fit {other_name} of shape '
                         f'{other.shape}') from None


def flip_choice(angle: ArrayLike, measured_angles: ArrayLike, hysteresis: float = 0.0,
                flipped: ArrayLike = False) -> NDArray[np.bool_]:
    """
    Tell which modules reach their target sooner with the drive reversed.

    Parameters
    ----------
    angle, measured_angles : array_like (..., n)
        Target and measured steering angles [rad], wrapped or not.
    hysteresis : float
        Band [rad] on either side of 90 degrees in which the previous choice stays.
    flipped : array_like of bool (..., n)
        The previous choice.

    Returns
    -------
    ndarray of bool (..., n)

    """
    band = np.where(flipped, np.sin(hysteresis), -np.sin(hysteresis))
    error = np.asarray(np.subtract(angle, measured_angles))
    nearer: NDArray[np.bool_] = np.cos(error, out=error) < band - FLIP_TOLERANCE
    return nearer


def flip(states: StatesLike, flipped: ArrayLike) -> ModuleStates:
    """
    Return the states with the chosen modules turned by pi and their speeds negated.

    Parameters
    ----------
    states : ModuleStates (..., n)
        Targets.
    flipped : array_like of bool (..., n)
        Which modules to turn.

    Returns
    -------
    ModuleStates (..., n)
        The same velocity vectors. A flipped angle lies in (-pi, pi], the others are as given.

    """
    speed, angle = as_states(states)
    chosen = np.asarray(flipped)
    return ModuleStates(speed * (1.0 - 2.0 * chosen),
                        np.where(chosen, wrap_angle(angle + np.pi), angle))


def optimize(states: StatesLike, measured_angles: ArrayLike, hysteresis: float = 0.0,
             flipped: ArrayLike = False) -> ModuleStates:
    """
    Reverse the drive of each module whose target is more than 90 degrees away.

    Parameters
    ----------
    states : ModuleStates (..., n)
        Targets.
    measured_angles : array_like (..., n)
        Where the modules are [rad], wrapped or not.
    hysteresis : float
        Band [rad], from 0 to less than pi / 2, on either side of 90 degrees in which a module
        keeps its previous choice. With 0, no module turns by more than 90 degrees.
    flipped : array_like of bool (..., n)
        The previous choice, used only with a hysteresis.

    Returns
    -------
    ModuleStates (..., n)
        The same velocity vectors: flipped modules have their angle turned by pi, in
        (-pi, pi], and their speed negated; the others are unchanged. A module exactly
        90 degrees away (to 1e-9 rad) is not flipped. The angle is NaN where the module's
        measured angle is, for the choice is then unknown.

    Raises
    ------
    ValueError
        If the shape of `measured_angles` or of `flipped` does not fit the states, or the
        hysteresis is outside its range.

    """
    if not 0.0 <= hysteresis < 0.5 * np.pi:
        raise ValueError(f'hysteresis must be from 0 to less than pi / 2, got {hysteresis}')
    targets = as_states(states)
    measured, previous = np.asarray(measured_angles, dtype=float), np.asarray(flipped)
    _check_fit(measured, 'measured_angles', targets.angle, 'states.angle')
    _check_fit(previous, 'flipped', targets.angle, 'states.angle')
    speed, angle = flip(targets, flip_choice(targets.angle, measured, hysteresis, previous))
    np.copyto(angle, np.nan, where=np.isnan(measured))
    return ModuleStates(speed, angle)


def cosine_scale(states: StatesLike, measured_angles: ArrayLike) -> ModuleStates:
    """
    Slow each module by the cosine of its steering error.

    A wheel that still swings towards its angle then drives only along the part of its
    velocity that was commanded. The sign is kept as the cosine falls through zero: a wheel
    that points backwards drives backwards.

    Parameters
    ----------
    states : ModuleStates (..., n)
        Targets.
    measured_angles : array_like (..., n)
        Where the modules are [rad], wrapped or not.

    Returns
    -------
    ModuleStates (..., n)
        Speeds times the cosine of the error, angles unchanged.

    Raises
    ------
    ValueError
        If the shape of `measured_angles` does not fit the states.

    """
    targets = as_states(states)
    measured = np.asarray(measured_angles, dtype=float)
    _check_fit(measured, 'measured_angles', targets.angle, 'states.angle')
    return with_speed(targets, targets.speed * np.cos(targets.angle - measured))


def interpolate(start: StatesLike, end: StatesLike, t: ArrayLike) -> ModuleStates:
    """
    Return the states a fraction `t` of the way from `start` to `end`.

    Parameters
    ----------
    start, end : ModuleStates (..., n)
        Where t is 0 and where it is 1.
    t : array_like (...)
        Fraction, clamped to [0, 1]; one for each set of modules.

    Returns
    -------
    ModuleStates (..., n)
        Speeds go linearly, angles by the shortest way round, in (-pi, pi].

    Raises
    ------
    ValueError
        If the shape of `end` or of `t` does not fit `start`.

    """
    first, last = as_states(start, 'start'), as_states(end, 'end')
    _check_fit(last.speed, 'end.speed', first.speed, 'start.speed')
    _check_fit(last.angle, 'end.angle', first.angle, 'start.angle')
    share = np.clip(np.asarray(t, dtype=float), 0.0, 1.0)[..., np.newaxis]
    _check_fit(share, 't[..., newaxis]', first.speed, 'start.speed')
    return ModuleStates(
        (1.0 - share) * first.speed + share * last.speed,
        wrap_angle(first.angle + share * angle_difference(last.angle, first.angle)))
