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

"""By which factor the gyro tells turns too small, from the true headings."""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.calibration.module_fit import BLOCKS, covariance
from swerve_kinematics.core.calibration.recording import Recording, Windows
from swerve_kinematics.core.geometry.angles import wrap_angle

# What a base must turn for the scale to be known [rad].
LEAST_TURN = np.pi


def gyro_scale(recording: Recording, windows: Windows,
               heading: NDArray[np.float64]) -> tuple[float, float]:
    """
    Return the scale of the gyro and its standard deviation.

    Parameters
    ----------
    recording : Recording
        What the sensors said.
    windows : tuple of ndarray (k,)
        Index of their start and of their end.
    heading : ndarray (t,)
        The true one [rad], not wrapped.

    Returns
    -------
    scale, std : float
        True turn / turn by the gyro; 1 and infinite where the drive does not show it.

    """
    if recording.yaw is None:
        return 1.0, np.inf
    steps = wrap_angle(np.diff(recording.yaw))
    silent = np.isnan(steps)
    turn, silences = (np.concatenate(([0], np.cumsum(series)))
                      for series in (np.where(silent, 0.0, steps), silent))
    start, end = (edge[silences[windows[1]] == silences[windows[0]]] for edge in windows)
    true = heading[end] - heading[start]
    if len(true) < BLOCKS or np.abs(true).sum() < LEAST_TURN:
        return 1.0, np.inf
    # What the gyro tells is the turn divided by the scale, and the time times its bias.
    told = turn[end] - turn[start]
    jacobian = np.column_stack((true, recording.stamp[end] - recording.stamp[start]))
    solution = np.linalg.lstsq(jacobian, told, rcond=None)[0]
    if not solution[0]:
        return 1.0, np.inf
    residual = told - jacobian @ solution
    spread = covariance(jacobian.T @ jacobian, jacobian * residual[:, np.newaxis])
    return 1.0 / solution[0], np.sqrt(spread[0, 0]) / solution[0] ** 2
