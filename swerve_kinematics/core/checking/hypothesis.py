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

"""Changes that may explain a drive, with what they leave unexplained."""

import math
from typing import NamedTuple

from swerve_kinematics.core.checking.changes import (
    Change, DRIVES_EXCHANGED, EXCHANGED, GYRO_DEGREES, OFFSET, OUTSIDER, RADIUS,
    STEERINGS_EXCHANGED)
from swerve_kinematics.core.geometry.angles import wrap_angle

# Changes by less than this are a matter of calibration: share of a radius, [rad].
LEAST_RADIUS, LEAST_OFFSET = 0.03, math.radians(2.5)
# Of these, two that share a module make sense together.
CHAINED = EXCHANGED, DRIVES_EXCHANGED, STEERINGS_EXCHANGED


class Hypothesis(NamedTuple):
    """
    Changes to the description, and how well they explain the drive.

    Attributes
    ----------
    changes : tuple of Change
        What is different from the description.
    agreeing, moving : tuple of int
        Which changes make the wheels agree with each other, and which make them move the base
        as the gyro says. A base that was pushed shows a change in both. One that was driven by
        the wrong description shows it to the gyro alone: its wheels agree on the wrong motion.
        A change of agreement alone is a reading that belies a wheel's true way.
    misfit : float
        Cost of what is not explained, or only by small errors of all modules [nat].
    cost : float
        Of the changes [nat]: how much they must explain.

    """

    changes: tuple[Change, ...]
    agreeing: tuple[int, ...]
    moving: tuple[int, ...]
    misfit: float
    cost: float = 0.0

    @property
    def total(self) -> float:
        """Return the cost of the changes and of what they do not explain [nat]."""
        return self.misfit + self.cost

    @property
    def is_negligible(self) -> bool:
        """Return whether one of the changes is so small that calibration is what is called for."""
        return any(map(_is_negligible, self.changes))


def _is_negligible(change: Change) -> bool:
    """Tell whether a change is so small that calibration is what is called for."""
    if change.value is None:
        return False
    if change.kind == OFFSET:
        return bool(abs(wrap_angle(change.value)) < LEAST_OFFSET)
    return change.kind == RADIUS and abs(change.value - 1.0) < LEAST_RADIUS


def _scales_turns(change: Change) -> bool:
    """Tell whether all that the gyro sees of a change is another scale of its turns."""
    return change.kind == GYRO_DEGREES or (
        change.kind in (OFFSET, RADIUS) and len(change.modules) > 1)


def compatible(first: Change, second: Change) -> bool:
    """Tell whether two changes make sense together."""
    if first.kind == second.kind and set(first.modules) & set(second.modules):
        return first.kind in CHAINED and first.modules != second.modules
    if OFFSET in (first.kind, second.kind) and _scales_turns(first) and _scales_turns(second):
        return False  # the angle at which modules hardly turn the base fits any other scale
    return OUTSIDER not in (first.kind, second.kind) or not (
        set(first.modules) & set(second.modules))
