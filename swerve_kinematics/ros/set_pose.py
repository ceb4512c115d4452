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

"""Which poses from outside the odometry takes."""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.odometry.pose_covariance import is_covariance

# Largest coordinate [m] and variance [m^2, rad^2] that a pose may come with. What is beyond says
# nothing about a base on the ground, and products of it overflow.
LARGEST = 1e9


def refusal(frame: str, odom_frame: str, pose: NDArray[np.float64],
            covariance: NDArray[np.float64]) -> str | None:
    """
    Return why a pose cannot be taken.

    Parameters
    ----------
    frame : str
        That it is given in; empty for the odometry's.
    odom_frame : str
        The odometry's.
    pose : ndarray (3,)
        `[x, y, yaw]` [m, m, rad].
    covariance : ndarray (3, 3)
        Of the pose [m^2, m rad, rad^2].

    Returns
    -------
    str or None
        The reason, None if it can be taken.

    """
    if frame not in ('', odom_frame):
        return f'set_pose in an unknown frame, not {odom_frame}'
    if not (np.isfinite(pose).all() and np.isfinite(covariance).all()):
        return 'set_pose not finite'
    if max(np.abs(pose).max(), np.abs(covariance).max()) > LARGEST:
        return 'set_pose out of range'
    if not is_covariance(covariance):
        return 'set_pose with an impossible covariance'
    return None
