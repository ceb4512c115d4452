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

"""What is planned for one period, before it is known how far the modules can follow."""

from collections.abc import Sequence
from dataclasses import dataclass

from swerve_kinematics.core.control.setpoints import Setpoint
from swerve_kinematics.core.geometry.planar import PlanarTwist


@dataclass(slots=True)
class Plan:
    """
    Where base and modules would be at its end if nothing held the modules back.

    Attributes
    ----------
    twist : PlanarTwist
        Of the centre of rotation, in the base frame.
    goals : sequence of Setpoint (n,)
        Where the modules are to go.
    flipped : sequence of (bool or None) (n,)
        Which drives run reversed then; None where nothing was chosen.
    scale : float
        In (0, 1]: the factor that takes the commanded twist down to what is possible.
    unreachable : list of bool (n,)
        Modules whose steering range has no angle for the commanded motion.
    is_near : bool
        Whether every module can take its goal in this very period.

    """

    twist: PlanarTwist
    goals: Sequence[Setpoint]
    flipped: Sequence[bool | None]
    scale: float
    unreachable: list[bool]
    is_near: bool
