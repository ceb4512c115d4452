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

"""The commands for the modules, and what became of the commanded twist."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.planar import PlanarTwist


class ModuleCommand(NamedTuple):
    """
    The commands for the modules, and what became of the commanded twist.

    `speed`, `angle`, `twist` and `unreachable` are arrays. The fields they are made from hold
    Python's own numbers, which a loop over a few modules handles ten times as fast.

    Attributes
    ----------
    speed_list : list of float (n,)
        Rim speeds [m/s], negative where the drive is reversed.
    angle_list : list of float (n,)
        Steering angles [rad], multi-turn.
    planar_twist : PlanarTwist
        The twist being executed, in the base frame: like the commanded one, the velocity of the
        centre of rotation.
    scale : float
        In (0, 1]: the factor that takes the commanded twist down to what is possible.
    fraction : float
        In [0, 1]: how much of the desired change the modules can make in this period.
    unreachable_list : list of bool (n,)
        Modules whose steering range has no angle for the commanded motion; the twist is then
        the nearest one that all modules can do.
    refused : bool
        Whether the commanded twist was not finite. The last valid one stays the target.
    held : bool
        Whether the base does not follow its commands, so that the ramp waits for it.

    """

    speed_list: list[float]
    angle_list: list[float]
    planar_twist: PlanarTwist
    scale: float
    fraction: float
    unreachable_list: list[bool]
    refused: bool
    held: bool

    @property
    def speed(self) -> NDArray[np.float64]:
        """Return the rim speeds as an array (n,) [m/s]."""
        return np.array(self.speed_list)

    @property
    def angle(self) -> NDArray[np.float64]:
        """Return the steering angles as an array (n,) [rad]."""
        return np.array(self.angle_list)

    @property
    def twist(self) -> NDArray[np.float64]:
        """Return the executed twist as an array (3,) `[vx, vy, omega]` [m/s, m/s, rad/s]."""
        return np.array(self.planar_twist.parts)

    @property
    def unreachable(self) -> NDArray[np.bool_]:
        """Return which modules cannot follow as an array (n,) of bool."""
        return np.array(self.unreachable_list)

    def __repr__(self) -> str:
        """Show what is told to the modules, and what is not as usual."""
        remarks = [f'scale={self.scale:.3g}'] if self.scale < 1.0 else []
        remarks += [f'unreachable={self.unreachable_list}'] if any(self.unreachable_list) else []
        remarks += [name for name in ('refused', 'held') if getattr(self, name)]
        return (f'ModuleCommand(speed={_rounded(self.speed_list)} m/s, '
                f'angle={_rounded(self.angle_list)} rad, '
                f'twist={_rounded(self.planar_twist.parts)}'
                + ''.join(f', {remark}' for remark in remarks) + ')')


def _rounded(values: list[float] | tuple[float, ...]) -> str:
    """Return a list of numbers to the millimetre or milliradian."""
    return '[' + ', '.join(f'{value:.3f}' for value in values) + ']'
