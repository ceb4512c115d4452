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

"""How well hypotheses about a base explain what it reported."""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.changes import Change
from swerve_kinematics.core.checking.drive_data import Floats, Windows
from swerve_kinematics.core.checking.hypothesis import Hypothesis
from swerve_kinematics.core.checking.small_errors import left_by_small_errors
from swerve_kinematics.core.checking.wiring import (
    disagreement, noise, turn_cost, turn_left, Wiring)
from swerve_kinematics.core.geometry.arrays import median

# Windows that follow each other err alike: so many count as one.
ALIKE = 2.0
# A module that does not fit may be anywhere within this share of the ways.
OUTSIDER_WAY = 0.5
# Wheels that agree this well [share of their ways] leave nothing for a change to explain.
AGREEMENT = 0.02
# Wheels or a gyro that are this far off in the median contradict the description.
CONTRADICTED = 0.1
# After a change that explains all, they are off by 0.002 in simulated drives; where they are this
# far off, something else is wrong as well.
LEFT_OVER = 0.05
# Mean of log(1 + (error / noise)^2) of the turns from which on something may be wrong.
DOUBTFUL = 0.3
NONE: tuple[int, ...] = ()


class Comparison:
    """
    Compares hypotheses about one drive.

    Parameters
    ----------
    agreeing : Wiring
        The description, as far as wheels shall agree with each other: without joints that
        are known to be wrong.
    moving : Wiring
        The description, as far as wheels move the base.
    windows : Windows
        The data.
    way : ndarray (k,)
        Root mean square of the wheels' ways in the windows [m].
    is_moving : ndarray of bool (k,)
        Windows in which the base moves.

    Attributes
    ----------
    agreeing, moving : Wiring
    windows : Windows
    null : Hypothesis
        That the description is right.

    """

    def __init__(self, agreeing: Wiring, moving: Wiring, windows: Windows, way: Floats,
                 is_moving: NDArray[np.bool_]) -> None:
        """Begin with the description."""
        self.agreeing, self.moving, self.windows = agreeing, moving, windows
        self._way, self._noise, self._moves = way, noise(way), is_moving
        self._agreement: dict[tuple[Change, ...], Floats] = {}
        self.null = Hypothesis((), NONE, NONE, float(self._misfit((), NONE, NONE)[0]))
        self._agrees = self._contradictions(self.null)[0] < AGREEMENT

    @property
    def moving_windows(self) -> float:
        """Return how many windows of motion there are, those that err alike as one."""
        return float(np.count_nonzero(self._moves)) / ALIKE

    @property
    def is_contradicted(self) -> bool:
        """Return whether wheels or gyro contradict the description for most of the drive."""
        return self.is_contradicted_by(self.null)

    def is_contradicted_by(self, hypothesis: Hypothesis) -> bool:
        """Return whether wheels or gyro contradict a hypothesis for most of the drive."""
        return max(self._contradictions(hypothesis)) > CONTRADICTED

    def leaves_more(self, hypothesis: Hypothesis) -> bool:
        """Return whether something else must be wrong besides what a hypothesis changes."""
        return max(self._contradictions(hypothesis)) > LEFT_OVER

    @property
    def is_doubtful(self) -> bool:
        """Return whether it is worth looking for changes."""
        turn = turn_left(self.moving, self.windows, self._way)[0]
        excess = np.log1p((turn / self._noise)[self._moves] ** 2).mean()
        return bool(excess > DOUBTFUL or not self._agrees)

    def _contradictions(self, hypothesis: Hypothesis) -> list[float]:
        """Return by how much wheels and gyro contradict a hypothesis [share of the ways]."""
        agreeing = _after(self.agreeing, hypothesis.changes, hypothesis.agreeing)
        moving = _after(self.moving, hypothesis.changes, hypothesis.moving)
        return [median(np.abs(series[0][self._moves]) / self._way[self._moves])
                for series in (disagreement(agreeing, self.windows),
                               turn_left(moving, self.windows, self._way))]

    def with_small_errors(self, hypothesis: Hypothesis) -> Hypothesis:
        """Return a hypothesis by which all modules may be a little off beside its changes."""
        wiring = _after(self.moving, hypothesis.changes, hypothesis.moving)
        left, cost = left_by_small_errors(wiring, self.windows, self._way, ALIKE)
        agreement = self._agreement_of(hypothesis.changes, hypothesis.agreeing)
        return hypothesis._replace(misfit=float(
            (agreement + turn_cost(left, self._noise, ALIKE))[0]) + cost)

    def _misfit(self, changes: tuple[Change, ...], agreeing: tuple[int, ...],
                moving: tuple[int, ...], free: int | None = None,
                values: Floats | None = None) -> Floats:
        """Return the misfit (g,) [nat] over the values (g,) of one of the changes."""
        agreement = (
            self._agreement_cost(_after(self.agreeing, changes, agreeing, free, values))
            if free in agreeing else self._agreement_of(changes, agreeing))
        wiring = _after(self.moving, changes, moving, free, values)
        left = turn_left(wiring, self.windows, self._way)
        return agreement + turn_cost(left, self._noise, ALIKE)

    def _agreement_of(self, changes: tuple[Change, ...], agreeing: tuple[int, ...]) -> Floats:
        """Return the cost (1,) of wheels that disagree after changes, known from before or not."""
        key = tuple(changes[at] for at in agreeing)
        if key not in self._agreement:
            self._agreement[key] = self._agreement_cost(_after(self.agreeing, changes, agreeing))
        return self._agreement[key]

    def _agreement_cost(self, wiring: Wiring) -> Floats:
        """Return the cost (g,) of wheels that disagree."""
        spread = disagreement(wiring, self.windows)[:, self._moves]
        scale = self._noise[self._moves]
        freedom = 2 * len(self.agreeing.arm) - 3
        lost = min(2 * len(wiring.outsiders), freedom)
        apart = OUTSIDER_WAY * self._way[self._moves] / scale
        cost = (freedom - lost) * np.log1p((spread / scale) ** 2) + lost * np.log1p(apart ** 2)
        total: Floats = cost.sum(axis=1) / (2.0 * ALIKE)
        return total


def _after(wiring: Wiring, changes: tuple[Change, ...], chosen: tuple[int, ...],
           free: int | None = None, values: Floats | None = None) -> Wiring:
    """Return a wiring after the chosen changes; values (g,) stand for the free one's."""
    for at in chosen:
        wiring = changes[at].applied(wiring, values if at == free else None)
    return wiring
