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

"""How the modules moved by their joints, and how they must have moved by the rigid body."""

from typing import NamedTuple

import numpy as np

from swerve_kinematics.core.checking.drive_data import Complexes, DriveData, Floats, windows_of
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.core.checking.wiring import as_described, ways_of
from swerve_kinematics.core.kinematics.rigid_fit import RigidFit


class Motions(NamedTuple):
    """
    Velocities of the modules over a drive.

    Attributes
    ----------
    time : ndarray (k,)
        Middles of the windows [s].
    measured, expected : ndarray of complex (k, n)
        By the joints as described, and by the rigid body that the verdict implies [m/s].

    """

    time: Floats
    measured: Complexes
    expected: Complexes


def motions(positions: Floats, data: DriveData, verdict: Verdict) -> Motions:
    """
    Return how the modules moved, and how they must have.

    Parameters
    ----------
    positions : ndarray (n, 2)
        Of the modules by the description [m].
    data : DriveData
        The drive.
    verdict : Verdict
        What was found in it.

    Returns
    -------
    Motions

    """
    described = wiring = as_described(positions)
    if verdict.hypothesis is not None:
        for at in verdict.hypothesis.moving:
            wiring = verdict.hypothesis.changes[at].applied(wiring)
    windows = windows_of(data)
    measured, ways = (ways_of(each, windows) for each in (described, wiring))
    expected = RigidFit(wiring.arm).fitted(ways)
    middle = 0.5 * (data.stamp[windows.start] + data.stamp[windows.end])
    time = windows.time[:, np.newaxis]
    return Motions(middle, measured / time, expected / time)
