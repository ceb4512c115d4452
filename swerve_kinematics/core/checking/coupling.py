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
Wheels that roll as their modules turn, otherwise than the description says.

They move the base only while its modules turn, in a way that its gyro alone sees. Nothing else
seems wrong.
"""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.changes import COST
from swerve_kinematics.core.checking.drive_data import DriveData, Floats, Windows, windows_of
from swerve_kinematics.core.checking.small_errors import left_by_small_errors
from swerve_kinematics.core.checking.wiring import (
    noise, rigid_motion, turn_cost, turn_left, Wiring)
from swerve_kinematics.core.kinematics.rigid_fit import RigidFit

# What the number costs beside the change [nat], as that of an offset does.
NUMBER_COST = 5.0
# Wheels that roll less for each radian [m] stand a little beside their steering axes: judgement.
LEAST_ROLL = 0.003
ROUNDS = 6


def with_rolls(data: DriveData, rolls: Floats) -> DriveData:
    """Return a drive in which wheels roll so much farther (n,) for each radian of steering [m]."""
    turned = np.unwrap(data.angles, axis=0)
    return data._replace(distances=data.distances + rolls * (turned - turned[0]))


def rolls_by_steering(described: Wiring, data: DriveData, windows: Windows, way: Floats,
                      alike: float, least: float) -> Floats:
    """
    Return how much farther wheels roll than their drives tell while their modules turn.

    Parameters
    ----------
    described : Wiring
        The description.
    data : DriveData
        The drive.
    windows : Windows
        The same, in k windows.
    way : ndarray (k,)
        Root mean square of the wheels' ways in the windows [m].
    alike : float
        How many windows err alike, and count as one.
    least : float
        How much better that must explain the drive than small errors do [nat].

    Returns
    -------
    ndarray (n,)
        For each radian counter-clockwise [m]; 0 if the drive does not show that they do.

    """
    def misfit(ways: Windows) -> float:
        left, cost = left_by_small_errors(described, ways, way, alike)
        return float(turn_cost(left, noise(way), alike)[0]) + cost

    nothing = np.zeros(len(described.arm))
    found, best = nothing, misfit(windows) - max(COST + NUMBER_COST, least)
    for signs in _gears(described):
        apart = _apart(data, windows, signs)
        roll = _fitted(described, windows, apart, way)
        after = misfit(windows._replace(ways=windows.ways + roll * apart.ways))
        if abs(roll) > LEAST_ROLL and after < best:
            found, best = roll * signs, after
    return found


def _gears(described: Wiring) -> list[Floats]:
    """Return which wheels may roll, and which way: all alike, mirrored left and right, or one."""
    alike: Floats = np.ones(len(described.arm))
    mirrored: Floats = np.sign(described.arm.imag)
    sides = [mirrored] if np.ptp(mirrored) == 2.0 and mirrored.all() else []
    return [alike, *sides, *np.eye(len(described.arm))]


def _apart(data: DriveData, windows: Windows, signs: Floats) -> Windows:
    """Return windows with what the wheels roll if it is 1 m for each radian of steering."""
    still = data._replace(distances=np.zeros_like(data.distances))
    # No step of a millimetre for each radian seems to be a jump.
    apart = windows_of(with_rolls(still, 1e-3 * signs))
    same: NDArray[np.bool_] = np.isin(apart.start, windows.start)
    return windows._replace(ways=1e3 * apart.ways[..., same])


def _fitted(described: Wiring, windows: Windows, apart: Windows, way: Floats) -> float:
    """Return the roll [m/rad] with which the turn by the wheels is most that of the gyro."""
    size = RigidFit(described.arm).size
    # What is left of the turn, by the roll and by a bias of the gyro.
    slope = np.stack((rigid_motion(described, apart)[2] * size, windows.time * size))
    left, variance = turn_left(described, windows, way)[0], noise(way) ** 2
    numbers, over = np.zeros(2), left
    for _ in range(ROUNDS):
        pull = slope / (variance + over ** 2)
        numbers = np.linalg.lstsq(pull @ slope.T, pull @ left, rcond=None)[0]
        over = left - numbers @ slope
    return float(numbers[0])
