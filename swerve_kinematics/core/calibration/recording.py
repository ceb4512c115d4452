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
A recorded drive as tracks: where each wheel has rolled, cut into windows of motion.

Vectors are complex numbers here, x + iy, in the world frame of the headings.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.calibration.module_fit import BLOCKS
from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.geometry.windows import LONGEST_STEP, window_edges
from swerve_kinematics.core.odometry.chord import chords

# Length of a window [s]. Long enough for encoder counts to be small against the way, short
# enough for many windows, and for a base at 3 rad/s to turn by a quarter only.
WINDOW = 0.5
# Windows with a longer way between samples [m] are left out: an encoder was reset. Where a gear
# was left out, a wheel may seem to roll `ways.MOST_SCALE` times as far as it does, 0.25 m
# in a LONGEST_STEP at 1 m/s. It is a way and no speed, of which stamps that come in bursts make
# what they like: shorter jumps are found by `slip`, which `checking.drive_data` does without.
LONGEST_WAY = 5.0
# In a window of use the modules move by this much in the mean [m].
LEAST_MOTION = 0.01

# Index of the start and of the end of each window, (k,) both.
Windows = tuple[NDArray[np.intp], NDArray[np.intp]]


class Recording(NamedTuple):
    """
    What the encoders and the gyro said, in terms of the present values.

    Attributes
    ----------
    stamp : ndarray (t,)
        Time [s], increasing.
    distances : ndarray (t, n)
        Cumulative distance of each rim [m].
    angles : ndarray (t, n)
        Steering angles [rad], wrapped or not.
    yaw : ndarray (t,) or None
        Of the gyro [rad], wrapped or not, NaN where it was silent.

    """

    stamp: NDArray[np.float64]
    distances: NDArray[np.float64]
    angles: NDArray[np.float64]
    yaw: NDArray[np.float64] | None = None


def rolled_tracks(recording: Recording, heading: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return where each wheel thinks it has rolled, in the world frame, complex (t, n) [m]."""
    steering = wrap_angle(np.diff(recording.angles, axis=0))
    turn = np.diff(heading)[:, np.newaxis]
    direction = np.exp(1j * (recording.angles[:-1] + 0.5 * steering
                             + heading[:-1, np.newaxis] + 0.5 * turn))
    steps = chords(np.diff(recording.distances, axis=0), steering, direction, turn)
    return np.concatenate((np.zeros_like(steps[:1]), np.cumsum(steps, axis=0)))


def moving_windows(stamp: NDArray[np.float64], tracks: NDArray[np.complex128]) -> Windows:
    """Return start and end index (k,) of the windows without gaps in which the base moves."""
    edges = window_edges(stamp, WINDOW)
    start, end = edges[:-1], edges[1:]
    farthest = np.abs(np.diff(tracks, axis=0)).max(axis=1)
    gaps = np.concatenate((
        [0], np.cumsum((np.diff(stamp) > LONGEST_STEP) | (farthest > LONGEST_WAY))))
    moved = np.abs(tracks[end] - tracks[start]).mean(axis=1)
    used = (gaps[end] == gaps[start]) & (moved >= LEAST_MOTION)
    count = np.count_nonzero(used)
    if count < BLOCKS:
        raise ValueError(
            f'the drive is too short: {WINDOW * BLOCKS:g} s of motion, with samples '
            f'{LONGEST_STEP:g} s apart or less, are needed; it has {WINDOW * count:g} s')
    return start[used], end[used]


def heading_by_gyro(recording: Recording) -> NDArray[np.float64]:
    """
    Return the heading (t,) [rad] by the gyro, less its rate at rest.

    It stays the same where the gyro is silent; without one it is 0.
    """
    if recording.yaw is None:
        return np.zeros(len(recording.stamp))
    turn, time = wrap_angle(np.diff(recording.yaw)), np.diff(recording.stamp)
    told = np.isfinite(turn)
    rest = told & (np.diff(recording.distances, axis=0) == 0.0).all(axis=1)
    rate = turn[rest].sum() / time[rest].sum() if rest.any() else 0.0
    return np.concatenate(([0.0], np.cumsum(np.where(told, turn - rate * time, 0.0))))
