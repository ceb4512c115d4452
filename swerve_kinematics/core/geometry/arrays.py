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

"""Checks of shape and value that the public functions share."""

from collections.abc import Iterable
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Number = TypeVar('Number', np.float64, np.complex128)

# Multiplications that BLAS does at once in `transform`. Beyond 2^18 OpenBLAS starts threads
# and waits for them, which on a busy machine takes ten times as long as the product.
BLOCK = 2 ** 18


def as_vectors(value: ArrayLike, length: int, name: str) -> NDArray[np.float64]:
    """
    Return `value` as float64 with a last axis of `length`.

    Parameters
    ----------
    value : array_like (..., length)
        What to check.
    length : int
        How long the last axis must be.
    name : str
        What the caller knows the array as, for the error.

    Raises
    ------
    ValueError
        If the last axis is not `length` long.

    """
    array = np.asarray(value, dtype=float)
    if array.ndim == 0 or array.shape[-1] != length:
        raise ValueError(f'{name} must have a last axis of {length}, got shape {array.shape}')
    return array


def as_floats(value: ArrayLike, length: int, name: str) -> list[float]:
    """
    Return a vector as a list of Python's own floats, which cost less than numpy's one by one.

    Parameters
    ----------
    value : array_like (length,)
        What to check.
    length : int
        How many numbers there must be.
    name : str
        What the caller knows the vector as, for the error.

    Raises
    ------
    ValueError
        If it is no vector of so many numbers.

    """
    try:
        # What is not iterable raises the TypeError that is caught here.
        entries: Iterable[float] = (
            value.tolist() if isinstance(value, np.ndarray) else value)  # type: ignore[assignment]
        floats = list(map(float, entries))
    except TypeError:  # a single number, or a matrix
        floats = []
    if len(floats) != length:
        raise ValueError(f'{name} must have shape ({length},), got {value!r}')
    return floats


def as_positions(value: ArrayLike, name: str) -> NDArray[np.float64]:
    """
    Return `value` as a finite, read-only copy of shape (n, 2).

    Parameters
    ----------
    value : array_like (n, 2)
        Positions [m] in the base frame.
    name : str
        What the caller knows the array as, for the error.

    Raises
    ------
    ValueError
        If the shape is not (n, 2) or an entry is not finite.

    """
    positions = np.array(value, dtype=float)
    if positions.ndim != 2 or positions.shape[1] != 2:
        raise ValueError(f'{name} must have shape (n, 2), got {positions.shape}')
    if not np.isfinite(positions).all():
        raise ValueError(f'{name} must be finite, got {positions.tolist()}')
    positions.flags.writeable = False
    return positions


def as_limit(value: ArrayLike, name: str) -> NDArray[np.float64]:
    """
    Return `value` as float64 after checking that it can bound a magnitude.

    Parameters
    ----------
    value : array_like
        Zero or more; infinity means no limit.
    name : str
        What the caller knows the limit as, for the error.

    Raises
    ------
    ValueError
        If an entry is negative or NaN.

    """
    limit = np.asarray(value, dtype=float)
    if not (limit >= 0.0).all():
        raise ValueError(f'{name} must be zero or more, got {value!r}')
    return limit


def check_series(stamp: NDArray[np.float64], distances: NDArray[np.float64],
                 angles: NDArray[np.float64], count: int) -> None:
    """
    Check what the modules of a base reported during a drive.

    Parameters
    ----------
    stamp : ndarray (t,)
        Time [s].
    distances, angles : ndarray (t, n)
        Cumulative distance of each rim [m], steering angles [rad].
    count : int
        Number of modules, n.

    Raises
    ------
    ValueError
        If a shape is wrong, an entry is not finite, or the stamps do not increase.

    """
    if distances.shape != (len(stamp), count) or angles.shape != distances.shape:
        raise ValueError(f'distances and angles must have shape ({len(stamp)}, {count}), '
                         f'got {distances.shape} and {angles.shape}')
    if not all(np.isfinite(series).all() for series in (stamp, distances, angles)):
        raise ValueError('stamps, distances and angles must be finite')
    if len(stamp) < 2 or not (np.diff(stamp) > 0.0).all():
        raise ValueError('there must be two or more stamps, and they must increase')


def median(values: NDArray[np.float64]) -> float:
    """
    Return the median of a vector (n,), NaN if it is empty or has one.

    numpy's own loads numpy.ma at its first use: 1.4 MB, and a pause while the base drives.
    """
    ordered, middle = np.sort(values), len(values) // 2
    if not len(values) or np.isnan(ordered[-1]):
        return np.nan
    return float(0.5 * (ordered[~middle] + ordered[middle]))


def transform(vectors: NDArray[Number], matrix: NDArray[Number]) -> NDArray[Number]:
    """
    Return `vectors @ matrix`, for any number of vectors and a small matrix, real or complex.

    Parameters
    ----------
    vectors : ndarray (..., m)
        Row vectors.
    matrix : ndarray (m, n)
        What they are multiplied by, from the right.

    Returns
    -------
    ndarray (..., n)

    """
    rows = BLOCK // matrix.size
    if vectors.size <= rows:
        return vectors @ matrix
    flat = vectors.reshape(-1, len(matrix))
    result = np.empty((len(flat), matrix.shape[1]), dtype=matrix.dtype)
    for start in range(0, len(flat), rows):
        block = slice(start, start + rows)
        np.matmul(flat[block], matrix, out=result[block])
    return result.reshape(vectors.shape[:-1] + matrix.shape[1:])
