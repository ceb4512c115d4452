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
The constant complex factors by which modules measure their ways wrong, by least squares.

Vectors are complex numbers here, x + iy. The true way of module i over a window is
`c_i * measured way`. True ways belong to a rigid body, which the factors must reproduce.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.kinematics.rigid_fit import RigidFit
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

# Errors may last for seconds, so that windows are not independent. The scatter of the sums of
# so many long blocks is what counts (the "batch means" of time series analysis), and
# Student's t makes up for their small number: 2.262 for 9 degrees of freedom, not 1.96.
BLOCKS = 10
STUDENT = 2.262 / 1.96
# Rounds of estimating the noise from the residuals and the factors from the noise.
ROUNDS = 4
# Wheels that fight each other differ by more than shows in their ways, for each is fitted to
# where the frame takes it: so many times as much, in the variance. Measured on the simulated
# base with wheels up to 2 % and 1 degree apart.
HIDDEN = 8.0
# The frame settles such a fight as least squares do where all wheels grip alike. Loads and
# floors differ: the weight of one wheel in it is off by this share.
UNEVEN = 0.2
# Driven wheels are told to agree, and where the base moves as they say, nothing shows that they
# fight each other: a pattern of errors that cancels in every motion remains. It is as large as
# radii and offsets may be wrong on a base that has not been calibrated: 4 %, or 2.3 degrees.
UNSEEN = 0.04
# Ways that contradict each other, and do so no more after this share of it (of the squares) has
# been taken away by constant factors, were rolled freely: nothing told them to agree.
FREELY_ROLLED = 0.25
# Ways that agree better than this share of themselves do so by chance, or in a test.
FINEST = 1e-6


class ModuleFit(NamedTuple):
    """
    What `fit_modules` finds.

    Attributes
    ----------
    factors : ndarray of complex (n,)
        True way / measured way.
    covariance : ndarray (2 n, 2 n)
        Of the factors' real parts, then of their imaginary parts.
    contradiction : float
        Root mean square of what separates the ways, each corrected for itself, from any
        rigid motion; relative to the ways.
    driven : bool
        Whether nothing shows that the wheels rolled freely, as far as or where they wanted.

    """

    factors: NDArray[np.complex128]
    covariance: NDArray[np.float64]
    contradiction: float
    driven: bool


def fit_modules(kin: SwerveKinematics, measured: NDArray[np.complex128],
                true: NDArray[np.complex128], pushed: bool = False,
                rounding: float = 0.0) -> ModuleFit:
    """
    Return the factors that take measured ways to true ones.

    First every module is fitted for itself: it rolls where the frame takes it. But wheels
    that disagree are forced along by the frame. Their tyres creep, and the base moves as the
    rigid body that fits all wheels best: then only the rigid part of the modules' common
    motion tells their factors. So a second fit, to that part, starts from the first one and
    may leave it as far as the modules contradict each other, the farther the better it
    explains the motion of the base. Driven wheels may contradict each other without a sign of
    it, by as much as `UNSEEN`: the motion of the base tells their factors, or nothing does. It
    tells them no better than the frame settles the fight by least squares. Wheels that
    rolled freely are known by what they measure: it does not fit together before it is
    corrected, and does so afterwards.

    Parameters
    ----------
    kin : SwerveKinematics
        The layout.
    measured, true : ndarray of complex (k, n)
        Ways over the windows [m], in the base frame.
    pushed : bool
        Whether the wheels are known to have rolled freely.
    rounding : float
        Ways that contradict each other by less than this share of themselves are no sign of
        it: where nothing changes, encoders round by the same all the time.

    Returns
    -------
    ModuleFit

    """
    rigid = RigidFit(kin.module_positions @ (1.0, 1j)).projection()
    count = measured.shape[1]
    jacobian, target = _jacobian(measured), _as_real(true)
    scale = np.mean(np.abs(measured) ** 2)
    start, no_trust = np.r_[np.ones(count), np.zeros(count)], np.zeros((2 * count, 2 * count))
    alone, spread, residual = _solve(jacobian, target, start, no_trust)
    contradiction = _contradiction(residual, rigid, scale)
    factors = _as_complex(alone[np.newaxis])
    hidden = (False, False) if pushed else _hidden(
        measured, factors, rigid, max(contradiction / FREELY_ROLLED, rounding ** 2), scale)
    driven = any(hidden)
    if driven:
        # The rest is noise of the encoders, which must not pass for a motion.
        known = 1.0 if all(hidden) else np.abs(factors)
        jacobian = _jacobian(_as_complex(_as_real(measured * known) @ rigid) / known)

    first = variance = _variance(residual @ rigid, scale)
    share = 1.0
    for _ in range(ROUNDS):
        freedom = np.diag(spread) + HIDDEN * contradiction * share + FINEST ** 2
        noise = variance + UNEVEN ** 2 * contradiction * scale
        weight = rigid / np.sqrt(noise)
        equations = weight @ jacobian, target @ weight, alone
        solution, final, _ = _solve(*equations, np.diag(1.0 / freedom))
        variance = _variance((target - jacobian @ solution) @ rigid, scale)
        share = max(1.0 - variance / first, 0.0)
    if driven:
        trust = np.asarray(np.linalg.inv(np.diag(freedom) + _unseen(alone, hidden)), dtype=float)
        solution, final, _ = _solve(*equations, trust)
        final = final + _by_uneven_grip(jacobian, rigid, noise, trust, solution, final)
    return ModuleFit(solution[:count] + 1j * solution[count:], final, np.sqrt(contradiction),
                     driven)


def _solve(jacobian: NDArray[np.float64], target: NDArray[np.float64], start: NDArray[np.float64],
           trust: NDArray[np.float64]) -> tuple[
               NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """
    Return the least-squares solution, its covariance and the residual (k, m).

    Parameters
    ----------
    jacobian : ndarray (k, m, p)
        Derivative of what is measured by the solution, in each of k windows.
    target : ndarray (k, m)
        What it should be.
    start : ndarray (p,)
        Kept where the windows say nothing else.
    trust : ndarray (p, p)
        Inverse covariance of `start`.

    """
    information = np.einsum('kab,kac->bc', jacobian, jacobian) + trust
    slope = np.einsum('kab,ka->b', jacobian, target - jacobian @ start)
    solution = start + np.linalg.lstsq(information, slope, rcond=1e-12)[0]
    residual = target - jacobian @ solution
    scores = np.einsum('kab,ka->kb', jacobian, residual)
    return solution, covariance(information, scores, trust), residual


def covariance(information: NDArray[np.float64], scores: NDArray[np.float64],
               trust: NDArray[np.float64] | float = 0.0) -> NDArray[np.float64]:
    """
    Return the covariance of a least-squares solution whose errors last for a while.

    The "sandwich" of the inverse information around the scatter of the scores, summed by
    blocks.

    Parameters
    ----------
    information : ndarray (p, p)
        Sum of J' W J over the windows.
    scores : ndarray (k, p)
        J' W residual of each window, in the order of time.
    trust : ndarray (p, p), optional
        The part of the information that does not come from the windows.

    Returns
    -------
    ndarray (p, p)

    """
    inverse = np.linalg.pinv(information, rcond=1e-12, hermitian=True)
    sums = np.array([block.sum(axis=0) for block in np.array_split(scores, BLOCKS)])
    scatter = sums.T @ sums * (STUDENT ** 2 * BLOCKS / (BLOCKS - 1))
    result: NDArray[np.float64] = inverse @ (scatter + trust) @ inverse
    return result


def _by_uneven_grip(jacobian: NDArray[np.float64], rigid: NDArray[np.float64],
                    variance: float, trust: NDArray[np.float64],
                    solution: NDArray[np.float64],
                    spread: NDArray[np.float64]) -> NDArray[np.float64]:
    """
    Return what wheels that grip unevenly add to the covariance of a solution.

    The way of a wheel with more weight in the fight shows more in the motion of the base, all
    the time, so that the scatter of the windows does not tell.

    Parameters
    ----------
    jacobian : ndarray (k, 2 n, 2 n)
        Derivative of the corrected ways by the factors.
    rigid : ndarray (2 n, 2 n)
        From ways to the nearest rigid motion.
    variance : float
        Of that motion, as it was weighted for the solution [m^2].
    trust : ndarray (2 n, 2 n)
        Inverse covariance of where the solution started.
    solution, spread : ndarray (2 n,), (2 n, 2 n)
        Real, then imaginary parts of the factors, and their covariance without this.

    """
    size, axes = np.linalg.eigh(spread)
    patterns = np.column_stack((solution, axes * np.sqrt(np.maximum(size, 0.0))))
    moved, ways = rigid @ jacobian, jacobian @ patterns
    information = np.einsum('kab,kac->bc', moved, moved) / variance + trust
    # How each part (x, y) of what each wheel loses in the fight would move the factors.
    pulls = np.einsum('kab,kap->bap', moved, ways - rigid @ ways) / variance
    of_wheels = pulls.reshape(len(pulls), 2, -1).sum(axis=1)
    error = UNEVEN * np.linalg.pinv(information, rcond=1e-12, hermitian=True) @ of_wheels
    added: NDArray[np.float64] = error @ error.T
    return added


def _hidden(measured: NDArray[np.complex128], factors: NDArray[np.complex128],
            rigid: NDArray[np.float64], least: float, scale: float) -> tuple[bool, bool]:
    """
    Return whether nothing shows that wheels rolled as their sizes and as their directions say.

    Motors may give way to the frame where steering does not, so each is judged for itself: by
    what its correction takes away of the contradiction that the other one leaves, which must
    have been at `least` so much. Where the directions were free, so were the sizes, though
    these may be right from the start.
    """
    size = np.abs(factors)
    told, by_direction, by_size = (_contradiction(_as_real(measured * part), rigid, scale)
                                   for part in (1.0, factors / size, size))
    # Half a correction may also contradict what fits together.
    are_directions_hidden = bool(least > min(told, by_size))
    are_sizes_hidden = bool(least > min(told, by_direction))
    return are_directions_hidden and are_sizes_hidden, are_directions_hidden


def _unseen(factors: NDArray[np.float64], hidden: tuple[bool, bool]) -> NDArray[np.float64]:
    """Return the covariance (2 n, 2 n) of `UNSEEN` errors of sizes and directions if hidden."""
    x, y = (np.diag(part) for part in np.split(factors, 2))
    parts = np.concatenate((x, y)), np.concatenate((-y, x))  # along each factor, and across
    added = np.zeros((len(factors), len(factors)))
    for part, is_hidden in zip(parts, hidden):
        if is_hidden:
            added += UNSEEN ** 2 * part @ part.T
    return added


def _contradiction(ways: NDArray[np.float64], rigid: NDArray[np.float64], scale: float) -> float:
    """Return the mean square of what separates ways (k, 2 n) from rigid motions, relative."""
    size, width = ways.shape
    return float(np.sum((ways - ways @ rigid) ** 2) / (size * (width - 3) * scale))


def _variance(rigid_residual: NDArray[np.float64], scale: float) -> float:
    """Return the variance of the three components of a rigid residual (k, 2 n), never 0."""
    mean_square = np.sum(rigid_residual ** 2) / (3 * len(rigid_residual))
    return float(mean_square + FINEST ** 2 * scale)


def _jacobian(measured: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return the derivative (k, 2 n, 2 n) of the corrected ways by the factors."""
    real, imaginary = (part[:, np.newaxis] * np.eye(measured.shape[1])
                       for part in (measured.real, measured.imag))
    return np.concatenate((np.concatenate((real, -imaginary), axis=2),
                           np.concatenate((imaginary, real), axis=2)), axis=1)


def _as_real(ways: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return complex vectors (k, n) as their real, then their imaginary parts (k, 2 n)."""
    return np.concatenate((ways.real, ways.imag), axis=1)


def _as_complex(ways: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return real, then imaginary parts (k, 2 n) as complex vectors (k, n)."""
    real, imaginary = np.split(ways, 2, axis=1)
    return real + 1j * imaginary
