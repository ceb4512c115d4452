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

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.drive_data import Complexes, Floats, Windows
from swerve_kinematics.core.geometry.arrays import Number, transform
from swerve_kinematics.core.kinematics.rigid_fit import RigidFit

# Noise of a way over a window: [m], the count of a 12-bit encoder and of the gyro, and by
# its length, what tyres creep.
WAY_NOISE = 1.5e-4
WAY_CREEP = 0.0015
# Bias of a gyro [rad/s], standard deviation.
BIAS_STD = 0.02
ROUNDS = 3


class Wiring(NamedTuple):
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


def ways_of(wiring: Wiring, windows: Windows) -> Complexes:
    """Return the ways (k, n) [m] of the modules in each window under one hypothesis."""
    ways: Complexes = _described_ways(wiring, windows).T * wiring.factor[0]
    return ways


def rigid_motion(wiring: Wiring, windows: Windows) -> Floats:
    """Return `[x, y, turn]` (3, k) [m, m, rad] of the base in each window under a hypothesis."""
    way, turn = RigidFit(wiring.arm).motion(ways_of(wiring, windows))
    return np.stack((way.real, way.imag, turn))


def disagreement(wiring: Wiring, windows: Windows) -> Floats:
    """
    Return how far hypotheses are from wheels that agree on one motion.

    Parameters
    ----------
    wiring : Wiring
        The hypotheses, g of them.
    windows : Windows
        The data, in k windows.

    Returns
    -------
    ndarray (g, k)
        Root mean square, over the degrees of freedom, of what separates the wheels' ways from
        any rigid motion [m].

    """
    wheels = _wheels_of(wiring, windows)
    factor, ways = wheels.factor, wheels.ways
    count = len(wheels.fit.arm)
    # The parts of the ways are at right angles: the way of all, the turn, and what is left.
    squares = _summed(_squares(factor), _squares(ways))
    squares -= _squares(_summed(factor, ways)) / count + wheels.fit.inertia * wheels.turn() ** 2
    # Ways that are taken as smaller do not agree any better.
    scale = np.mean(_squares(wiring.factor), axis=1)[:, np.newaxis]
    spread: Floats = np.sqrt(np.maximum(squares, 0.0) / (max(2 * count - 3, 1) * scale))
    return spread


def turn_left(wiring: Wiring, windows: Windows, way: Floats) -> Floats:
    """
    Return how far hypotheses are from a base that turns as its gyro says.

    Parameters
    ----------
    wiring : Wiring
        The hypotheses, g of them.
    windows : Windows
        The data, in k windows.
    way : ndarray (k,)
        Size of the wheels' ways in the windows [m], the scale of their noise.

    Returns
    -------
    ndarray (g, k)
        What separates the gyro's turn from that of the rigid body [m] at the modules, but for
        the bias of the gyro that fits best.

    """
    by_gyro = windows.turn_in_degrees if wiring.degrees else windows.turn
    if by_gyro is None:
        return np.zeros((len(wiring.factor), len(way)))
    wheels = _wheels_of(wiring, windows)
    size = wheels.fit.size
    left = (wiring.gyro[:, np.newaxis] * by_gyro - wheels.turn()) * size
    lever = windows.time * size
    unbiased: Floats = left - _bias(left, lever, noise(way))[:, np.newaxis] * lever
    return unbiased


def turn_cost(left: Floats, deviation: Floats, alike: float) -> Floats:
    """
    Return the misfit (g,) of hypotheses whose turns the gyro contradicts [nat].

    Parameters
    ----------
    left : ndarray (g, k)
        As from `turn_left` [m].
    deviation : ndarray (k,)
        Their noise [m].
    alike : float
        How many windows err alike, and count as one.

    """
    cost: Floats = np.log1p((left / deviation) ** 2).sum(axis=1) / (2.0 * alike)
    return cost


def turn_shares(wiring: Wiring, windows: Windows) -> Complexes:
    """
    Return what each wheel of a hypothesis turns the base by, and would if it steered aside.

    Parameters
    ----------
    wiring : Wiring
        One hypothesis.
    windows : Windows
        The data, in k windows.

    Returns
    -------
    ndarray of complex (n, k)
        As real part its share of the turn of the rigid body [m] at the modules, by which
        `turn_left` is smaller; as imaginary part what that loses for each radian by which the
        wheel points farther to the left.

    """
    wheels, kept = _wheels_of(wiring, windows), _kept(wiring)
    lever = wheels.factor[0] * wheels.fit.lever / (wheels.fit.size * len(kept))
    shares = np.zeros(windows.ways.shape[2:], dtype=complex)
    shares[kept] = lever[:, np.newaxis] * wheels.ways
    return shares


class _Wheels(NamedTuple):
    """
    Wheels that tell of the base, of g hypotheses: factors (g, n), ways as described (n, k) [m].

    The ways of all hypotheses, (g, n, k), are never there at once, because there are too many.
    """

    fit: RigidFit
    factor: Complexes
    ways: Complexes

    def turn(self) -> Floats:
        """Return by how much the rigid body turns [rad], (g, k): `RigidFit.turn` of each."""
        turn: Floats = (
            _summed(self.factor * self.fit.lever, self.ways).real / self.fit.inertia)
        return turn


def _wheels_of(wiring: Wiring, windows: Windows) -> _Wheels:
    """Return the wheels of hypotheses that are no outsiders."""
    arm, factor = wiring.arm, wiring.factor
    ways = _described_ways(wiring, windows)
    if wiring.outsiders:
        kept = _kept(wiring)
        arm, factor, ways = arm[kept], factor[:, kept], ways[kept]
    return _Wheels(_fit_of(tuple(arm.tolist())), factor, ways)


@lru_cache(maxsize=64)
def _fit_of(arm: tuple[complex, ...]) -> RigidFit:
    """Return the fit of modules at these places, of which a search tries few."""
    return RigidFit(np.array(arm))


def _kept(wiring: Wiring) -> list[int]:
    """Return the modules that are no outsiders."""
    return [module for module in range(len(wiring.arm)) if module not in wiring.outsiders]


def _described_ways(wiring: Wiring, windows: Windows) -> Complexes:
    """Return the ways (n, k) [m] of the joints at each place, without the factors."""
    ways: Complexes = windows.ways[wiring.sense, wiring.steering, wiring.drive]
    return ways


def _summed(factor: NDArray[Number], ways: NDArray[Number]) -> NDArray[Number]:
    """Return the sums over modules, (g, k), of factors (g, n) times ways (n, k)."""
    return transform(ways.T, factor.T).T


def _squares(vectors: Complexes) -> Floats:
    """Return the squares of the lengths of vectors."""
    squares: Floats = vectors.real ** 2 + vectors.imag ** 2
    return squares


def noise(way: Floats) -> Floats:
    """Return the standard deviation (k,) [m] of a way over windows in which wheels roll so far."""
    return np.hypot(WAY_NOISE, WAY_CREEP * way)


def _bias(left: Floats, lever: Floats, deviation: Floats) -> Floats:
    """Return the bias (g,) that makes most of `left` (g, k) small, whatever a few of it are."""
    bias = np.zeros(len(left))
    variance, prior = deviation ** 2, 1.0 / BIAS_STD ** 2
    over = left
    for _ in range(ROUNDS):
        pull = lever / (variance + over ** 2)
        bias = np.einsum('gk,gk->g', pull, left) / (pull @ lever + prior)
        over = left - bias[:, np.newaxis] * lever
    return bias
