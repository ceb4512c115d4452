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
What joints and gyro reported during a drive, cut into short windows.

Vectors are complex numbers here, x + iy, in the base frame as it lies in each step. There a
rigid motion is a sum over its steps: `way of module = way of base + turn * 1j * arm`.
"""

from collections.abc import Iterable
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.angles import sinc, wrap_angle
from swerve_kinematics.core.geometry.windows import LONGEST_STEP, window_edges

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

# Length of a window [s]: encoder counts and the stamps' jitter are small against the way in
# it, while a module that steers points in many directions during a drive.
WINDOW = 0.1
# In a window of use the modules move at this speed or more in the mean [m/s].
LEAST_SPEED = 0.03
# A rim that is faster [m/s] is an encoder that jumped. It is twice `readings.FASTEST_RIM` of the
# odometry (judgement), for the description by which it is told may be wrong, as by a gear.
FASTEST_RIM = 20.0
# Stamps that come in bursts let a wheel roll for a whole period of the feedback in no time: no
# step counts as shorter than this [s], a period at 50 Hz. The odometry allows for less, by
# `gyro.STAMP_JITTER`: there a jump that is believed moves the pose, here it spoils one window.
SHORTEST_STEP = 0.02


class DriveData(NamedTuple):
    """
    What was reported and commanded, in terms of the present description of the base.

    Attributes
    ----------
    stamp : ndarray (t,)
        Time [s], increasing.
    distances, angles : ndarray (t, n)
        Cumulative distance of each rim [m], steering angles [rad], wrapped or not.
    yaw, yaw_rate : ndarray (t,) or None
        Of the gyro [rad], [rad/s]; NaN where it was silent.
    commanded_speeds, commanded_angles : ndarray (t, n) or None
        Rim speeds [m/s] and steering angles [rad] in force at the stamps; NaN where there
        was no command.

    """

    stamp: Floats
    distances: Floats
    angles: Floats
    yaw: Floats | None = None
    yaw_rate: Floats | None = None
    commanded_speeds: Floats | None = None
    commanded_angles: Floats | None = None


class Windows(NamedTuple):
    """
    A drive cut into k windows without gaps.

    Attributes
    ----------
    start, end : ndarray of int (k,)
        Indices of the samples at their ends.
    time : ndarray (k,)
        Their lengths [s].
    ways : ndarray of complex (2, n, n, k)
        What the wheel of drive joint j has rolled in the direction of steering joint i [m], by
        `[sense, i, j]`: sense 0 as the steering joint counts, 1 the other way round.
    turn : ndarray (k,) or None
        Of the gyro [rad].
    turn_in_degrees : ndarray (k,) or None
        The same, if the gyro counts in degrees [rad].

    """

    start: NDArray[np.intp]
    end: NDArray[np.intp]
    time: Floats
    ways: Complexes
    turn: Floats | None
    turn_in_degrees: Floats | None


def with_gaps(values: Iterable[float | None]) -> Floats:
    """Return values as an array (t,), NaN for those that are missing."""
    return np.array([math.nan if value is None else value for value in values])


def windows_of(data: DriveData) -> Windows:
    """
    Return the windows of a drive.

    Parameters
    ----------
    data : DriveData
        As `check_series` accepts it.

    Returns
    -------
    Windows
        Those at rest too: they tell the bias of the gyro.

    """
    stamp = data.stamp
    edges = window_edges(stamp, WINDOW)
    start, end = edges[:-1], edges[1:]
    rolled = np.diff(data.distances, axis=0)
    time = np.diff(stamp)
    turns, in_degrees = _turns(data)
    broken = (time > LONGEST_STEP) | (
        np.abs(rolled).max(axis=1) > FASTEST_RIM * np.maximum(time, SHORTEST_STEP))
    if turns is not None:
        broken |= ~np.isfinite(turns)
    whole = _sums(broken[:, np.newaxis], start, end)[0] == 0
    start, end = start[whole], end[whole]
    steered = wrap_angle(np.diff(data.angles, axis=0))
    halfway = np.exp(1j * (data.angles[:-1] + 0.5 * steered)) * sinc(0.5 * steered)
    steps = rolled[:, np.newaxis, :] * halfway[:, :, np.newaxis]
    count = rolled.shape[1]
    ways = _sums(steps.reshape(len(rolled), count * count), start, end)
    ways = ways.reshape(count, count, len(start))
    return Windows(
        start, end, stamp[end] - stamp[start], np.stack((ways, ways.conj())),
        None if turns is None else _sums(turns[:, np.newaxis], start, end)[0],
        None if in_degrees is None else _sums(in_degrees[:, np.newaxis], start, end)[0])


def _sums(steps: NDArray[Any], start: NDArray[np.intp], end: NDArray[np.intp]) -> NDArray[Any]:
    """Return the sums (m, k) of steps (t - 1, m) over windows; what is not finite counts 0."""
    steps = np.where(np.isfinite(steps), steps, 0)
    total = np.concatenate((np.zeros_like(steps[:1], dtype=np.result_type(steps, int)),
                            np.cumsum(steps, axis=0)))
    sums: NDArray[Any] = (total[end] - total[start]).T
    return sums


def _turns(data: DriveData) -> tuple[Floats | None, Floats | None]:
    """Return the turn (t - 1,) of each step by the gyro [rad], if it counts rad or degrees."""
    by_yaw, by_rate = turns_by_yaw(data), turns_by_rate(data)
    if by_rate is not None:
        return by_rate if by_yaw is None else by_yaw, np.radians(by_rate)
    if data.yaw is None or by_yaw is None:
        return None, None
    # In degrees a step may be a turn or more when it is taken for radians.
    return by_yaw, wrap_angle(np.radians(np.diff(data.yaw)))


def turns_by_yaw(data: DriveData) -> Floats | None:
    """Return the turn (t - 1,) of each step by the yaw [rad], None if there is none."""
    if data.yaw is None or not np.isfinite(data.yaw).any():
        return None
    return wrap_angle(np.diff(data.yaw))


def turns_by_rate(data: DriveData) -> Floats | None:
    """Return the turn (t - 1,) of each step by the yaw rate [rad], None if there is none."""
    if data.yaw_rate is None or not np.isfinite(data.yaw_rate).any():
        return None
    turns: Floats = 0.5 * (data.yaw_rate[1:] + data.yaw_rate[:-1]) * np.diff(data.stamp)
    return turns
