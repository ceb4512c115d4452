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

"""The figure of eight that the demo drives, as a function of time."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.geometry.se2 import to_robot_frame


class FigureEight(NamedTuple):
    """
    A closed path that crosses itself in the middle, driven from rest to rest.

    The Lissajous curve `x = length / 2 sin(p)`, `y = width / 2 sin(2 p)` with the phase p
    going once round, while the heading turns by whole turns.

    Attributes
    ----------
    length, width : float
        Extent along x and y [m].
    turns : int
        How often the base turns about itself.
    duration : float
        [s].
    ramp : float
        Time [s] to get up to speed, and to stop again; at most half the duration.

    """

    length: float
    width: float
    turns: int
    duration: float
    ramp: float


def phase(figure: FigureEight, time: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return how far round the figure is, and how fast that grows.

    The rate rises and falls as a raised cosine, so that the speed has no corners.

    Parameters
    ----------
    figure : FigureEight
        Gives the duration and the ramp.
    time : array_like (...)
        From the start [s]; before it, and after the duration, the base stands.

    Returns
    -------
    phase, rate : ndarray (...)
        [rad] in [0, 2 pi], [rad/s].

    """
    elapsed = np.clip(np.asarray(time, dtype=float), 0.0, figure.duration)
    ramp = figure.ramp
    cruise = TURN / (figure.duration - ramp)
    edge = np.minimum(elapsed, figure.duration - elapsed)
    rising = np.minimum(edge, ramp)
    rate = cruise * 0.5 * (1.0 - np.cos(np.pi * rising / ramp))
    grown = 0.5 * (rising - ramp / np.pi * np.sin(np.pi * rising / ramp)) + (edge - rising)
    first_half = elapsed <= 0.5 * figure.duration
    return np.where(first_half, cruise * grown, TURN - cruise * grown), rate


def plan(figure: FigureEight, time: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return where the base should be, and how it should move.

    Parameters
    ----------
    figure : FigureEight
        Gives extent, turns and timing.
    time : array_like (...)
        From the start [s].

    Returns
    -------
    pose : ndarray (..., 3)
        `[x, y, heading]` [m, m, rad] in the frame of the start.
    velocity : ndarray (..., 3)
        `[vx, vy, omega]` [m/s, m/s, rad/s] in the same frame.

    """
    p, rate = phase(figure, time)
    half_length, half_width = 0.5 * figure.length, 0.5 * figure.width
    pose = np.stack((half_length * np.sin(p), half_width * np.sin(2.0 * p),
                     figure.turns * p), axis=-1)
    slope = np.stack((half_length * np.cos(p), 2.0 * half_width * np.cos(2.0 * p),
                      np.full_like(p, figure.turns)), axis=-1)
    return pose, slope * rate[..., np.newaxis]


def follow(target: NDArray[np.float64], velocity: NDArray[np.float64],
           pose: NDArray[np.float64], gain: float) -> NDArray[np.float64]:
    """
    Return the twist that moves as planned and closes in on the plan.

    Parameters
    ----------
    target, velocity : ndarray (3,)
        From `plan`.
    pose : ndarray (3,)
        Where the base believes to be [m, m, rad], the heading unwrapped.
    gain : float
        Share of the deviation taken back in a second [1/s].

    Returns
    -------
    ndarray (3,)
        `[vx, vy, omega]` [m/s, m/s, rad/s] in the base frame.

    """
    return to_robot_frame(velocity + gain * (target - pose), pose[2])
