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
What a base would be like under a hypothesis, and how far from the data that is.

A hypothesis says which joints belong to which module, how they count, and where modules are.
The wheels then have rolled certain ways, which a rigid body takes part in as well as it can:
as their least squares. The gyro sees the turn of that body. Wheels that fight each other may
contradict it, since they are driven by a wrong description, but the gyro may not.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.drive_data import Complexes, Floats, Windows

# Noise of a way over a window: [m], the count of a 12-bit encoder and of the gyro, and by
# its length, what tyres creep.
WAY_NOISE = 1.5e-4
WAY_CREEP = 0.0015
# Bias of a gyro [rad/s], standard deviation.
BIAS_STD = 0.02
ROUNDS = 3


@dataclass(frozen=True)
class Wiring:
    """
    One hypothesis about a base, or g of them that differ by a number.

    Attributes
    ----------
    arm : ndarray of complex (n,)
        Where the modules are [m].
    drive, steering : ndarray of int (n,)
        The description's joints that belong to each place.
    sense : ndarray of int (n,)
        0, or 1 where a steering joint counts the other way round.
    factor : ndarray of complex (g, n)
        True way / way as described: a radius, a direction (-1), a steering offset.
    gyro : ndarray (g,)
        Gyro's turn / true turn.
    degrees : bool
        Whether the gyro counts in degrees.
    outsiders : tuple of int
        Modules that tell nothing about the base.

    """

    arm: Complexes
    drive: NDArray[np.intp]
    steering: NDArray[np.intp]
    sense: NDArray[np.intp]
    factor: Complexes
    gyro: Floats
    degrees: bool = False
    outsiders: tuple[int, ...] = ()


def as_described(positions: Floats) -> Wiring:
    """Return the hypothesis that the description of the base is right; positions (n, 2) [m]."""
    index = np.arange(len(positions))
    return Wiring(positions @ np.array((1.0, 1j)), index, index, np.zeros_like(index),
                  np.ones((1, len(index)), dtype=complex), np.ones(1))


class Misfit(NamedTuple):
    """
    How far g hypotheses are from the data of k windows.

    Attributes
    ----------
    spread : ndarray (g, k)
        Root mean square, over the degrees of freedom, of what separates the wheels' ways from
        any rigid motion [m].
    turn : ndarray (g, k)
        What separates the gyro's turn from that of the rigid body [m] at the modules.
    bias : ndarray (g,)
        Of the gyro, that fits best [rad/s].

    """

    spread: Floats
    turn: Floats
    bias: Floats


def rigid_motion(wiring: Wiring, windows: Windows) -> Floats:
    """Return `[x, y, turn]` (3, k) [m, m, rad] of the base in each window under a hypothesis."""
    ways = wiring.factor[0][:, np.newaxis] * (
        windows.ways[wiring.sense, wiring.steering, wiring.drive])
    arm = wiring.arm - wiring.arm.mean()
    turn = np.einsum('n,nk->k', (1j * arm).conj(), ways).real / np.sum(np.abs(arm) ** 2)
    way = ways.mean(axis=0) - turn * 1j * wiring.arm.mean()
    return np.stack((way.real, way.imag, turn))


def misfit(wiring: Wiring, windows: Windows, way: Floats) -> Misfit:
    """
    Return how far hypotheses are from the data.

    Parameters
    ----------
    wiring : Wiring
        The hypotheses.
    windows : Windows
        The data.
    way : ndarray (k,)
        Size of the wheels' ways in the windows [m], the scale of their noise.

    Returns
    -------
    Misfit

    """
    ways = windows.ways[wiring.sense, wiring.steering, wiring.drive] * (
        wiring.factor[:, :, np.newaxis])
    arm = wiring.arm
    if wiring.outsiders:
        kept = [module for module in range(len(arm)) if module not in wiring.outsiders]
        ways, arm = ways[:, kept], arm[kept]
    arm = arm - arm.mean()
    inertia = np.sum(np.abs(arm) ** 2)
    errors = ways - ways.mean(axis=1, keepdims=True)
    turn = np.einsum('n,gnk->gk', (1j * arm).conj(), errors).real / inertia
    errors = errors - turn[:, np.newaxis, :] * (1j * arm)[:, np.newaxis]
    freedom = max(2 * len(arm) - 3, 1)
    # Ways that are taken as smaller do not agree any better.
    scale = np.mean(np.abs(wiring.factor) ** 2, axis=1)[:, np.newaxis]
    spread = np.sqrt(np.sum(np.abs(errors) ** 2, axis=1) / (freedom * scale))
    by_gyro = windows.turn_in_degrees if wiring.degrees else windows.turn
    if by_gyro is None:
        return Misfit(spread, np.zeros_like(spread), np.zeros(len(spread)))
    size = np.sqrt(inertia / len(arm))
    left = wiring.gyro[:, np.newaxis] * by_gyro - turn
    bias = _bias(left * size, windows.time * size, noise(way))
    return Misfit(spread, (left - bias[:, np.newaxis] * windows.time) * size, bias)


def noise(way: Floats) -> Floats:
    """Return the standard deviation (k,) [m] of a way over windows in which wheels roll so far."""
    return np.hypot(WAY_NOISE, WAY_CREEP * way)


def _bias(left: Floats, lever: Floats, deviation: Floats) -> Floats:
    """Return the bias (g,) that makes most of `left` (g, k) small, whatever a few of it are."""
    bias = np.zeros(len(left))
    prior = 1.0 / BIAS_STD ** 2
    for _ in range(ROUNDS):
        weight = 1.0 / (deviation ** 2 + (left - bias[:, np.newaxis] * lever) ** 2)
        bias = (weight * left * lever).sum(axis=1) / ((weight * lever ** 2).sum(axis=1) + prior)
    return bias
