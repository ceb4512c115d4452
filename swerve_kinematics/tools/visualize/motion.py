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

"""What is drawn: a base, and what a twist makes of its modules."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.core.geometry.se2 import to_robot_frame
from swerve_kinematics.core.kinematics.desaturation import desaturate
from swerve_kinematics.core.kinematics.modules import ModuleStates, optimize
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

# A base that turns more slowly [rad/s] has its centre of rotation beyond all measure.
MIN_OMEGA = 1e-3


class Base(NamedTuple):
    """
    The base that is drawn.

    Attributes
    ----------
    names : tuple of str (n,)
        Of the modules.
    kinematics : SwerveKinematics

    """

    names: tuple[str, ...]
    kinematics: SwerveKinematics

    @property
    def positions(self) -> NDArray[np.float64]:
        """Return where the modules are, shape (n, 2), from base_link [m]."""
        return np.asarray(self.kinematics.module_positions)

    @property
    def middle(self) -> NDArray[np.float64]:
        """Return the point [m] around which the modules stand."""
        return np.asarray(self.positions.mean(axis=0))

    @property
    def radius(self) -> float:
        """Return how far [m] the farthest module is from the middle."""
        return float(np.hypot(*(self.positions - self.middle).T).max())


def base_of(layout: Layout) -> Base:
    """Return the base that has a layout."""
    return Base(layout.module_names, layout.kinematics)


class Command(NamedTuple):
    """
    What is commanded.

    Attributes
    ----------
    twist : tuple of float (3,)
        `[vx, vy, omega]` [m/s, m/s, rad/s] of the centre, in the field.
    center : tuple of float (2,)
        Centre of rotation from base_link [m].
    heading : float
        Of the base in the field [rad].
    max_speed : float
        What a module can do [m/s].

    """

    twist: tuple[float, float, float]
    center: tuple[float, float] = (0.0, 0.0)
    heading: float = 0.0
    max_speed: float = np.inf


class Motion(NamedTuple):
    """
    What becomes of a command, in the base frame.

    Attributes
    ----------
    command : Command
    twist : ndarray (3,)
        That is executed, of the centre [m/s, m/s, rad/s].
    states : ModuleStates (n,)
        Of the modules, each turned by 90 degrees at most.
    share : float
        Of the commanded speed that is executed; below 1 a module would be too fast.

    """

    command: Command
    twist: NDArray[np.float64]
    states: ModuleStates
    share: float

    @property
    def instantaneous_center(self) -> NDArray[np.float64] | None:
        """Return the point (2,) [m] that stands still, or None where the base does not turn."""
        vx, vy, omega = self.twist
        if abs(omega) < MIN_OMEGA:
            return None
        return np.add(self.command.center, (-vy / omega, vx / omega))


def motion_of(kinematics: SwerveKinematics, command: Command, angles: ArrayLike) -> Motion:
    """
    Return what becomes of a command.

    Parameters
    ----------
    kinematics : SwerveKinematics
        Of the base.
    command : Command
        From the user.
    angles : array_like (n,)
        Where the modules are [rad].

    Returns
    -------
    Motion

    """
    twist = to_robot_frame(command.twist, command.heading)
    wanted = optimize(kinematics.inverse(twist, command.center, held_angles=angles), angles)
    states = desaturate(wanted, command.max_speed)
    fastest = np.abs(wanted.speed).max()
    share = float(np.abs(states.speed).max() / fastest) if fastest > 0.0 else 1.0
    return Motion(command, share * twist, states, share)
