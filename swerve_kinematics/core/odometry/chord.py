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

import cmath
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.angles import scalar_sinc, sinc
from swerve_kinematics.core.odometry.curvature import Bend
from swerve_kinematics.core.odometry.group import Group, Layout


class Readings(NamedTuple):
    """
    What encoders and gyro say about one step.

    Attributes
    ----------
    used : tuple of int (k,)
        Indices of the modules with data.
    rolled : list of float (n,)
        Distance in the step [m].
    angle, steered : list of float (n,)
        Steering angle at the start of the step and its change [rad].
    turn : float or None
        Change of heading [rad] by a gyro; None to take it from the wheels.
    bend : Bend
        What the step before says about the curvature of this one.

    """

    used: tuple[int, ...]
    rolled: list[float]
    angle: list[float]
    steered: list[float]
    turn: float | None
    bend: Bend


class Step(NamedTuple):
    """
    The rigid motion that the modules agree on for one step.

    Attributes
    ----------
    used : tuple of int (k,)
        Indices of the modules it rests on.
    group : Group
        Their geometry.
    slipping : int or None
        Index of the module left out because it contradicts the others, if any.
    turn : float
        Change of heading [rad].
    displacement : complex
        Of base_link [m], seen from the heading halfway through the step.
    errors : list of complex (k,)
        What each used module's vote is off that displacement [m].
    spread : float
        Root mean square of the errors [m].
    directions : list of complex (k,)
        Unit vectors along the used wheels halfway through the step.
    length : float
        Root mean square of the used modules' chords [m].
    wheel_turn : float
        Change of heading by the used wheels alone [rad]; NaN where they cannot tell it.

    """

    used: tuple[int, ...]
    group: Group
    slipping: int | None
    turn: float
    displacement: complex
    errors: list[complex]
    spread: float
    directions: list[complex]
    length: float
    wheel_turn: float


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


def without_slipping(layout: Layout, readings: Readings, step: Step, tolerance: float,
                     ratio: float) -> Step:
    """
    Return the rigid motion without the one wheel that contradicts the others, if any.

    Parameters
    ----------
    layout : Layout
        All modules of the base, those out of use too.
    readings : Readings
        Of the step.
    step : Step
        The motion that fits these readings best.
    tolerance : float
        Spread of the votes [m] that is no slip.
    ratio : float
        A module is left out if the spread falls by this factor without it.

    Returns
    -------
    Step
        The same one if no wheel slips.

    """
    used, heading_known = readings.used, readings.turn is not None
    # Three votes are the fewest of which two can overrule one; the heading costs one more.
    enough = 3 if heading_known else 4
    if len(used) < enough or step.spread <= tolerance:
        return step
    suspect = used[step.group.suspect(step.errors, heading_known)]
    others = tuple(module for module in used if module != suspect)
    without = fit(layout, readings._replace(used=others))
    if without is None or ratio * without.spread > step.spread:
        return step
    return without._replace(slipping=suspect)


def fit(layout: Layout, readings: Readings) -> Step | None:
    """Return the Step of all modules in use, None if they cannot tell it."""
    used, turn = readings.used, readings.turn
    if not used:
        return None
    group = layout.group(used)
    if turn is None and not group.inertia:
        return None
    directions = [cmath.rect(1.0, readings.angle[i] + 0.5 * readings.steered[i]) for i in used]
    paths = _paths(readings, directions, turn or 0.0)
    wheel_turn = group.turn(paths) if group.inertia else math.nan
    if turn is None:
        # The chords need the turn that they are to tell: the second pass knows it.
        paths = _paths(readings, directions, wheel_turn)
        turn = wheel_turn = group.turn(paths)
    displacement, errors = group.motion(paths, turn)
    return Step(used, group, None, turn, displacement, errors, _rms(errors), directions,
                _rms(paths), wheel_turn)


def _paths(readings: Readings, directions: list[complex], turn: float) -> list[complex]:
    """Return the displacement of each module in use (k,) [m]: its chord, and how it bends."""
    rolled, steered, sideways = readings.rolled, readings.steered, readings.bend.sideways
    paths = []
    for i, direction in zip(readings.used, directions):
        way, turned = rolled[i], steered[i] + turn
        chord = way * scalar_sinc(0.5 * turned) if turned else way
        paths.append(complex(chord, sideways(i, way, turned)) * direction)
    return paths


def _rms(values: list[complex]) -> float:
    """Return the root mean square of complex values."""
    return math.hypot(*map(abs, values)) / math.sqrt(len(values))
