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

"""A gyro that says nothing, nothing new, or contradicts itself."""

import numpy as np

from swerve_kinematics.core.checking.drive_data import (
    DriveData, Floats, turns_by_rate, turns_by_yaw)

SILENT, FROZEN, YAW_FROZEN = 'gyro silent', 'gyro frozen', 'yaw frozen'
RATE_OPPOSED = 'rate against yaw'

# A gyro must be silent for this share of a drive to be called so.
SILENT_SHARE = 0.5
# It is frozen if it stays within this [rad] or [rad/s], less than any sensor's noise, ...
STILL = 1e-5
# ... while by the wheels the base turned by this in all [rad].
LEAST_TURN = 0.3
# But in a simulation without noise a rate may stay the same because the base turns steadily: if
# its turns differ from those of the wheels by less than this share of them.
STEADY_SHARE = 0.5
# A yaw turns against the rate if it goes the other way by this part of it or more.
OPPOSED = 0.5


def gyro_fault(data: DriveData, turns: Floats, times: Floats) -> str | None:
    """
    Return what is wrong with the gyro itself, None if nothing is.

    Parameters
    ----------
    data : DriveData
        The drive.
    turns : ndarray (k,)
        By the wheels, over windows [rad].
    times : ndarray (k,)
        Lengths of the windows [s].

    Returns
    -------
    str or None

    """
    series = [values for values in (data.yaw, data.yaw_rate) if values is not None]
    present = [np.isfinite(values) for values in series]
    if not present or max(float(np.mean(there)) for there in present) < 1.0 - SILENT_SHARE:
        return SILENT
    if np.abs(turns).sum() < LEAST_TURN:
        return None
    still = [not there.any() or float(np.ptp(values[there])) < STILL
             for values, there in zip(series, present)]
    if all(still) and not _turns_steadily(data.yaw_rate, turns, times):
        return FROZEN
    if data.yaw is not None and still[0] and present[0].any():
        return YAW_FROZEN
    return RATE_OPPOSED if _is_rate_opposed(data) else None


def _is_rate_opposed(data: DriveData) -> bool:
    """Tell whether yaw and rate turn opposite ways."""
    by_yaw, by_rate = turns_by_yaw(data), turns_by_rate(data)
    if by_yaw is None or by_rate is None:
        return False
    known = np.isfinite(by_yaw + by_rate)
    by_yaw, by_rate = by_yaw[known], by_rate[known]
    # The slope of the yaw over the rate: 1 where both are right, about 0 where one is noise.
    return bool(by_yaw @ by_rate < -OPPOSED * (by_rate @ by_rate))


def _turns_steadily(rates: Floats | None, turns: Floats, times: Floats) -> bool:
    """Tell whether the base turns at a rate that stays the same, by the wheels, either way."""
    if rates is None or not np.isfinite(rates).any():
        return False
    told = abs(float(np.nanmean(rates))) * times
    total = np.abs(turns).sum()
    return bool(np.abs(told - np.abs(turns)).sum() < STEADY_SHARE * total)
