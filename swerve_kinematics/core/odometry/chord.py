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
One step of swerve odometry: the modules' paths, their votes, the wheel that slips.

Vectors are complex numbers here, x + iy: `1j * r` is r turned by +90 degrees and
`exp(1j * a)` the direction a. All of them are seen from the heading halfway through the
step, where the formulas are shortest. A step is about one set of a few modules, where
Python's own numbers are several times as fast as arrays.
"""

import math

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.angles import sinc
from swerve_kinematics.core.odometry.group import Group, Groups
from swerve_kinematics.core.odometry.module_paths import ModulePaths
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise


class Step:
    """
    The rigid motion that the modules agree on for one step.

    Parameters
    ----------
    group : Group
        The modules it rests on.
    paths : list of complex (k,)
        How far they moved [m].
    turn : float
        Change of heading [rad].
    wheel_turn : float
        Change of heading by the wheels alone [rad]; NaN where they cannot tell it.
    by_gyro : bool
        Whether a gyro told the turn.

    Attributes
    ----------
    group, turn, wheel_turn, by_gyro
        As given.
    displacement : complex
        Of base_link [m], seen from the heading halfway through the step.
    errors : list of complex (k,)
        How far each module's vote is off that displacement [m].
    spread : float
        Root mean square of the errors [m].
    length : float
        Root mean square of the paths [m].
    slipping : int or None
        Index of the module left out because it contradicts the others, if any.
    coasting_std : float or None
        Standard deviation of the velocity [m/s] where no wheel is believed and the base
        coasts on its accelerometer; None otherwise.
    creep : complex
        By how much the wheels ran ahead of the base [m/s], which the displacement leaves out.
    belated : complex
        What the step tells of the way before it [m], seen from base axes at its end: how much
        further the base has coasted than was told.

    """

    def __init__(self, group: Group, paths: list[complex], turn: float, wheel_turn: float,
                 by_gyro: bool) -> None:
        """Fit the displacement."""
        self.group, self.turn, self.wheel_turn, self.by_gyro = group, turn, wheel_turn, by_gyro
        self.displacement, self.errors = group.motion(paths, turn)
        self.spread, self.length = group.rms(self.errors), group.rms(paths)
        self.slipping: int | None = None
        self.coasting_std: float | None = None
        self.creep = self.belated = 0j

    def do_wheels_agree(self, limit: float) -> bool:
        """Return whether votes differ by no more [m], but for a gyro that turned unlike them."""
        if self.spread <= limit:
            return True
        off = 2.0 * (math.sin(0.5 * self.wheel_turn) - math.sin(0.5 * self.turn))
        own = self.spread ** 2 - off * off * self.group.inertia / self.group.size
        return own <= limit * limit


def chords(distance: NDArray[np.float64], steering: NDArray[np.float64],
           direction: NDArray[np.complex128],
           turn: float | NDArray[np.float64]) -> NDArray[np.complex128]:
    """
    Return the displacement of each module over a step: for arrays, of many steps at once.

    A wheel that rolls `distance` while its direction turns steadily by `steering` (relative
    to the base) plus `turn` (of the base) runs along an arc. The chord of that arc is shorter
    by sinc of half the turning and points to the direction at half time. Exact for a constant
    twist and for constant steering rates; the angle at the end of the step, which the common
    method takes, is wrong by half the turning.

    Parameters
    ----------
    distance, steering : ndarray (k,)
        Rolled [m] and steered [rad] in the step.
    direction : ndarray of complex (k,)
        Unit vectors along the wheels halfway through the step.
    turn : float, or ndarray that broadcasts
        Change of heading in the step [rad].

    Returns
    -------
    ndarray of complex (k,)
        Chords [m], seen from the heading halfway through the step.

    """
    arcs: NDArray[np.complex128] = distance * sinc(0.5 * (steering + turn)) * direction
    return arcs


def fit(paths: ModulePaths, group: Group | None, turn: float | None) -> Step | None:
    """
    Return the Step of a group of modules, None if they cannot tell it.

    Parameters
    ----------
    paths : ModulePaths
        Of all modules.
    group : Group or None
        Those in use, None if there are none.
    turn : float or None
        Change of heading [rad] by a gyro; None to take it from the wheels.

    """
    if group is None or turn is None and not group.inertia:
        return None
    if turn is not None:
        ways = paths.of(group.used, turn)
        return Step(group, ways, turn, group.turn(ways) if group.inertia else math.nan, True)
    # The paths need the turn that they are to tell: the second pass knows it.
    ways = paths.of(group.used, group.turn(paths.of(group.used, 0.0)))
    turn = group.turn(ways)
    return Step(group, ways, turn, turn, False)


def without_slipping(dt: float, paths: ModulePaths, groups: Groups, step: Step,
                     noise: OdometryNoise) -> Step:
    """
    Return the rigid motion without the one wheel that contradicts the others, if any.

    Parameters
    ----------
    dt : float
        Duration of the step [s].
    paths : ModulePaths
        Of all modules.
    groups : Groups
        Of the modules of the base.
    step : Step
        The motion that fits the paths of those in use best.
    noise : OdometryNoise
        What counts as slip.

    Returns
    -------
    Step
        The same one if no wheel slips.

    """
    group, by_gyro = step.group, step.by_gyro
    # Three votes are the fewest of which two can overrule one; the heading costs one more.
    enough = 3 if by_gyro else 4
    if group.size < enough or step.spread <= math.hypot(noise.slip_speed * dt,
                                                        noise.distance_resolution):
        return step
    place, spread = group.suspect(step.errors, by_gyro)
    if noise.slip_ratio * spread > step.spread:
        return step
    suspect = group.used[place]
    others = groups.of(tuple([module for module in group.used if module != suspect]))
    without = fit(paths, others, step.turn if by_gyro else None)
    if without is None:
        return step
    without.slipping = suspect
    return without
