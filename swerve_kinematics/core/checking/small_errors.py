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
Small errors of all radii and offsets at once, which every base has before its calibration.

Together they can look like a larger error of a single module.
"""

import math

import numpy as np

from swerve_kinematics.core.checking.drive_data import Floats, Windows
from swerve_kinematics.core.checking.wiring import noise, turn_left, turn_shares, Wiring

# Standard deviations [share of a radius, rad] of a base that was measured with a calliper, and of
# which the modules were set by eye: judgement. Were they twice as large, a drive of 20 s would not
# tell them from one offset that is wrong by 8 degrees.
RADIUS_STD, OFFSET_STD = 0.01, math.radians(0.7)
# Errors of 3 % settle to a hundredth of that in so many rounds.
ROUNDS = 6


def left_by_small_errors(wiring: Wiring, windows: Windows, way: Floats,
                         alike: float) -> tuple[Floats, float]:
    """
    Return what `turn_left` is for a hypothesis with the small errors that leave least.

    Parameters
    ----------
    wiring : Wiring
        One hypothesis.
    windows : Windows
        The data, in k windows.
    way : ndarray (k,)
        Root mean square of the wheels' ways in the windows [m].
    alike : float
        How many windows err alike, and count as one.

    Returns
    -------
    left : ndarray (1, k)
        What still separates the gyro's turn from that of the rigid body [m].
    cost : float
        Of errors as large as these [nat].

    Notes
    -----
    Least squares, weighted anew in each round as Cauchy's distribution of the windows' errors
    demands. What the drive does not tell stays as small as it can be.

    """
    shares = turn_shares(wiring, windows)
    slope = np.concatenate((RADIUS_STD * shares.real, -OFFSET_STD * shares.imag))
    errors, variance = np.zeros(len(slope)), noise(way) ** 2
    left = turn_left(wiring, windows, way)
    for _ in range(ROUNDS):
        pull = slope / (alike * (variance + left[0] ** 2))
        errors += np.linalg.solve(pull @ slope.T + np.eye(len(slope)), pull @ left[0] - errors)
        radius, offset = np.split(errors, 2)
        factor = wiring.factor * np.exp(RADIUS_STD * radius + 1j * OFFSET_STD * offset)
        left = turn_left(wiring._replace(factor=factor), windows, way)
    return left, 0.5 * float(errors @ errors)
