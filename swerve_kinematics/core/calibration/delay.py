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

"""How much later than the wheels the gyro is stamped, from the turns that both tell."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.calibration.module_fit import BLOCKS, covariance
from swerve_kinematics.core.calibration.recording import Recording, Windows
from swerve_kinematics.core.calibration.slip import Span
from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.geometry.windows import LONGEST_STEP, window_edges
from swerve_kinematics.core.kinematics.rigid_fit import RigidFit
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

# The turns are compared over this time [s]: long against the counts of an encoder, short
# against the changes of a base's yaw rate.
TURN_TIME = 0.1
# Gyros are late by no more [s], and `imu_delay` takes no more; a delay that is not known this well
# [s] is not known.
LARGEST_DELAY = 0.2
USEFUL_STD = 0.005
# Tyres creep, so that a base turns a little after its wheels: measured on simulated tyres [s].
CREEP_STD = 0.002
ROUNDS = 10


class Delay(NamedTuple):
    """
    How much later [s] the gyro is stamped than the wheels for the same turn.

    Attributes
    ----------
    value, std : float
        0 and infinite if the drive does not show it.

    """

    value: float
    std: float


UNKNOWN = Delay(0.0, np.inf)


def gyro_delay(kin: SwerveKinematics, recording: Recording, factors: NDArray[np.complex128],
               left_out: tuple[Span, ...] = ()) -> Delay:
    """
    Return the delay of the gyro behind the wheels.

    The turns of the wheels are what the gyro shows at a shifted time, by a scale, plus a bias.

    Parameters
    ----------
    kin : SwerveKinematics
        The layout.
    recording : Recording
        What the sensors said.
    factors : ndarray of complex (n,)
        From the ways that the modules measure to the true ones.
    left_out : tuple of Span
        When wheels slipped.

    Returns
    -------
    Delay

    """
    stamp, yaw = recording.stamp, recording.yaw
    if yaw is None:
        return UNKNOWN
    told = np.isfinite(yaw)
    if np.count_nonzero(told) < 2:
        return UNKNOWN
    # What the gyro has gathered, as a function of time; nothing is known in its silences.
    time, gyro = stamp[told], np.unwrap(yaw[told])
    start, end = _intervals(stamp, time, left_out)
    if len(start) < BLOCKS:
        return UNKNOWN
    turned = np.concatenate(([0.0], np.cumsum(_wheel_turns(kin, recording, factors))))
    wheel_turn, elapsed = turned[end] - turned[start], stamp[end] - stamp[start]
    delay = 0.0
    for _ in range(ROUNDS):
        from_time, to_time = stamp[start] + delay, stamp[end] + delay
        by_gyro = np.interp(to_time, time, gyro) - np.interp(from_time, time, gyro)
        change = _rate(time, gyro, to_time) - _rate(time, gyro, from_time)
        jacobian = np.column_stack((by_gyro, elapsed, change))
        solution = np.linalg.lstsq(jacobian, wheel_turn, rcond=None)[0]
        if not solution[0]:
            return UNKNOWN
        delay = float(np.clip(delay + solution[2] / solution[0], -LARGEST_DELAY, LARGEST_DELAY))
    residual = wheel_turn - jacobian @ solution
    spread = covariance(jacobian.T @ jacobian, jacobian * residual[:, np.newaxis])
    std = float(np.hypot(np.sqrt(spread[2, 2]) / solution[0], CREEP_STD))
    known = std < USEFUL_STD and abs(delay) < LARGEST_DELAY
    return Delay(delay, std) if known else UNKNOWN


def _intervals(stamp: NDArray[np.float64], time: NDArray[np.float64],
               left_out: tuple[Span, ...]) -> Windows:
    """Return start and end index of the intervals in which wheels and gyro are heard, no slip."""
    edges = window_edges(stamp, TURN_TIME)
    start, end = edges[:-1], edges[1:]
    used = stamp[end] - stamp[start] <= LONGEST_STEP
    for silence in np.flatnonzero(np.diff(time) > LONGEST_STEP):
        used &= ((stamp[end] < time[silence] - LARGEST_DELAY)
                 | (stamp[start] > time[silence + 1] + LARGEST_DELAY))
    used &= (stamp[start] > time[0] + LARGEST_DELAY) & (stamp[end] < time[-1] - LARGEST_DELAY)
    for span in left_out:
        used &= (stamp[end] <= span.start) | (stamp[start] >= span.end)
    return start[used], end[used]


def _wheel_turns(kin: SwerveKinematics, recording: Recording,
                 factors: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return by how much the base turned in each step (t - 1,) as the wheels tell it [rad]."""
    steering = wrap_angle(np.diff(recording.angles, axis=0))
    ways = np.diff(recording.distances, axis=0) * factors * np.exp(
        1j * (recording.angles[:-1] + 0.5 * steering))
    return RigidFit(kin.module_positions @ (1.0, 1j)).turn(ways)


def _rate(time: NDArray[np.float64], gyro: NDArray[np.float64],
          at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the rate of the gyro at times [rad/s], from the samples around them."""
    half = 0.25 * TURN_TIME
    rate: NDArray[np.float64] = (
        np.interp(at + half, time, gyro) - np.interp(at - half, time, gyro)) / (2.0 * half)
    return rate
