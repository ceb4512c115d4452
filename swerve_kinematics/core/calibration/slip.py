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
Windows of a drive in which wheels slip: they tell nothing of radii and offsets.

Vectors are complex numbers here, x + iy, in the base frame.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.calibration.recording import Windows

# A wheel whose way differs from the true one by more than this [m], and this share of it, slips.
# Wheels that fight each other creep by less: 3 degrees are 5 %.
SLIP_WAY = 0.01
SLIP_SHARE = 0.05
# Where wheels slip in a greater part of the drive, the rest may be the exception.
LARGEST_PART = 0.5
# Errors below this [m] are noise.
NOISE_WAY = 1e-3
# What makes modules contradict each other, and what to do.
CAUSES = ('wheels slip, the layout or the ground truth is wrong, or its stamps are late; '
          'swerve_check tells what is wrong with the base')
# Rounds until the factors, and the windows they are taken from, change no more.
ROUNDS = 20


class Span(NamedTuple):
    """
    A part of the drive in which wheels slipped.

    Attributes
    ----------
    start, end : float
        Stamps [s].
    modules : tuple of int
        Which wheels.

    """

    start: float
    end: float
    modules: tuple[int, ...]


def slipping(measured: NDArray[np.complex128], true: NDArray[np.complex128]) -> NDArray[np.bool_]:
    """
    Return which wheels slip in which window (k, n).

    The least sum of errors, which a minority of windows hardly moves, gives the first factors,
    least squares over the windows without slip the next ones.

    Parameters
    ----------
    measured, true : ndarray of complex (k, n)
        Ways over the windows [m].

    Raises
    ------
    ValueError
        If some wheel slips in most windows.

    """
    weight = np.ones(len(measured))
    for _ in range(ROUNDS):
        error = np.abs(true - _factors(measured, true, weight) * measured)
        weight = 1.0 / np.maximum(np.sqrt(np.mean(error ** 2, axis=1)), NOISE_WAY)
    for _ in range(ROUNDS):
        slips = error > SLIP_WAY + SLIP_SHARE * np.abs(true)
        clean: NDArray[np.bool_] = np.logical_not(slips.any(axis=1))
        if np.mean(clean) < 1.0 - LARGEST_PART:
            raise ValueError(
                f'the modules contradict each other in most of the drive: {CAUSES}')
        error = np.abs(true - _factors(measured, true, clean.astype(float)) * measured)
    return slips


def _factors(measured: NDArray[np.complex128], true: NDArray[np.complex128],
             weight: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return the factors (n,) from measured to true ways, with a weight (k,) for each window."""
    weighted = weight[:, np.newaxis] * measured.conj()
    size = np.sum(weighted * measured, axis=0)
    # A wheel that does not roll has none; what some simulators make of 0 is no size to divide by.
    stands = size.real < np.finfo(float).tiny
    return np.where(stands, 1.0, np.sum(weighted * true, axis=0) / np.where(stands, 1.0, size))


def spans(stamp: NDArray[np.float64], windows: Windows,
          slips: NDArray[np.bool_]) -> tuple[Span, ...]:
    """
    Return when wheels slipped, one Span for windows without a pause between them.

    Parameters
    ----------
    stamp : ndarray (t,)
        Of the recording [s].
    windows : tuple of ndarray (k,)
        Index of their start and of their end.
    slips : ndarray of bool (k, n)
        Which wheels slip in which window.

    """
    found: list[Span] = []
    for start, end, wheels in zip(stamp[windows[0]], stamp[windows[1]], slips):
        modules = set(np.flatnonzero(wheels).tolist())
        if not modules:
            continue
        if found and found[-1].end == start:
            start = found[-1].start
            modules.update(found.pop().modules)
        found.append(Span(float(start), float(end), tuple(sorted(modules))))
    return tuple(found)


def in_words(found: Sequence[Span]) -> str:
    """Return when wheels slipped, as people read it."""
    return ', '.join(f'{span.start:.1f} s to {span.end:.1f} s' for span in found)
