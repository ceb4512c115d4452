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

"""What a sample of the sensors says: numbers that can be one, or nothing."""

from collections.abc import Sequence
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.arrays import as_floats

# No base rolls a billion kilometres, and no clock of one shows 30,000 years: a distance [m],
# an angle [rad] or a stamp [s] beyond this is no measurement. Nor is a speed [m/s] beyond a
# thousandth of that of light. Within these bounds no sum of steps overflows.
LARGEST_READING = 1e12
LARGEST_SPEED = 3e5
# No wheel rolls faster [m/s], for the fastest competition bases reach 6: a position that changes
# faster is an encoder that was reset, and a velocity that says so tells nothing.
FASTEST_RIM = 10.0
# Stamps closer than this [s] are the same: nanoseconds in a float of today's seconds since
# 1970 are no finer.
SHORTEST = 1e-7
# A vector that nobody has told.
UNKNOWN = complex(math.nan, math.nan)

Pair = Sequence[float] | NDArray[np.float64]


def read_modules(distances: ArrayLike, angles: ArrayLike,
                 count: int) -> tuple[list[float], list[float]]:
    """Return distances [m] and angles [rad] as lists (n,), NaN where a module lacks either."""
    ways: list[float] = as_floats(distances, count, 'distances')
    steering: list[float] = as_floats(angles, count, 'angles')
    if math.hypot(*ways, *steering) <= LARGEST_READING:
        return ways, steering
    for module in range(count):
        if not (abs(ways[module]) <= LARGEST_READING
                and abs(steering[module]) <= LARGEST_READING):
            ways[module] = steering[module] = np.nan
    return ways, steering


def read_vector(value: Pair | None, name: str) -> complex | None:
    """Return two numbers as a complex one, None where they are missing or no measurement."""
    if value is None:
        return None
    try:
        x, y = value.tolist() if isinstance(value, np.ndarray) else value
        size = math.hypot(x, y)
    except (TypeError, ValueError):
        raise ValueError(f'{name} must have shape (2,), got {value}') from None
    return complex(x, y) if size <= LARGEST_READING else None  # as for NaN


def finite_array(values: ArrayLike, shape: tuple[int, ...], name: str) -> NDArray[np.float64]:
    """Return a finite float64 copy of `values` of this shape."""
    array = np.array(values, dtype=float)
    if array.shape != shape or not np.isfinite(array).all():
        raise ValueError(f'{name} must be finite and of shape {shape}, got {array.tolist()}')
    return array
