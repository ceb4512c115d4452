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

"""The smallest set of changes to a description that the data of a drive really support."""

from collections.abc import Generator
from itertools import combinations
import math

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.changes import (
    all_changes, ANNOUNCED_COST, Change, GYRO_DEGREES, OFFSET, OUTSIDER, RADIUS, VALUES)
from swerve_kinematics.core.checking.drive_data import Floats, Windows
from swerve_kinematics.core.checking.hypothesis import compatible, Hypothesis
from swerve_kinematics.core.checking.small_errors import left_by_small_errors
from swerve_kinematics.core.checking.wiring import (
    disagreement, noise, turn_cost, turn_left, Wiring)
from swerve_kinematics.core.geometry.arrays import median
from swerve_kinematics.core.kinematics.rigid_fit import RigidFit

# Windows that follow each other err alike: so many count as one.
ALIKE = 2.0
# A module that does not fit may be anywhere within this share of the ways.
OUTSIDER_WAY = 0.5
# Where time is short, small errors of all modules are fitted beside so many of the best changes.
LIKELY = 8
# Pairs are compared roughly first, on every so manyth window; so many are then fitted.
THINNING = 3
FITTED_PAIRS = 40
REFINEMENTS = 3
# Wheels that agree this well [share of their ways] leave nothing for a change to explain.
AGREEMENT = 0.02
# Wheels or a gyro that are this far off in the median contradict the description.
CONTRADICTED = 0.1
# After a change that explains all, they are off by 0.002 in simulated drives; where they are this
# far off, something else is wrong as well.
LEFT_OVER = 0.05
# Mean of log(1 + (error / noise)^2) of the turns from which on something may be wrong.
DOUBTFUL = 0.3
# Turns of a gyro that really counts degrees are in size within this factor of those by the
# wheels, and correlate with them by this at least, whatever else is wrong with these.
ALIKE_SIZES, ALIKE_TURNS = 6.0, 0.5
NONE: tuple[int, ...] = ()


class Search:
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
    announced : tuple of Change
        What must be wrong of motors or encoders, by their commands: if of the encoders, the
        base moves by the description after these changes.

    """

    def __init__(self, agreeing: Wiring, moving: Wiring, windows: Windows, way: Floats,
                 is_moving: NDArray[np.bool_], announced: tuple[Change, ...] = ()) -> None:
        """Prepare the comparison."""
        self._announced = announced
        self.agreeing, self.moving, self.windows = agreeing, moving, windows
        self._way, self._noise, self._moves = way, noise(way), is_moving
        self._agreement: dict[tuple[Change, ...], Floats] = {}
        self._refinements = REFINEMENTS
        self.null = Hypothesis((), NONE, NONE, float(self._cost((), NONE, NONE)[0]))
        self._agrees = self._contradictions(self.null)[0] < AGREEMENT

    @property
    def _is_out_of_order(self) -> bool:
        """Return whether joints are known not to do what they are told."""
        return bool(self._announced or self.agreeing.outsiders)

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

    def best_single(self, is_thorough: bool) -> Generator[None, None, list[Hypothesis]]:
        """
        Return the best hypothesis of each single change, best first; pause after each.

        All modules may be a little off beside each of them or, unless the search is to be
        thorough, beside the likely ones only.
        """
        found = []
        faulty = {*self.agreeing.outsiders, *(
            module for change in self._announced for module in change.modules)}
        # One module alone agrees with itself, and tells no turn.
        others = len(self.moving.arm) - len(self.agreeing.outsiders) - 1
        for change in all_changes(self.moving.arm, self.windows.turn is not None):
            # Of a joint that is out of order only what it announced itself is worth asking.
            is_worth = change in self._announced or len(change.modules) != 1 or (
                change.modules[0] not in faulty)
            if is_worth and (change.kind != OUTSIDER or others > 1):
                found.append(self._best((change,)))
                yield
        found.sort(key=lambda hypothesis: hypothesis.total)
        for at, hypothesis in enumerate(found if is_thorough else found[:LIKELY]):
            found[at] = self.with_small_errors(hypothesis)
            yield
        return sorted(found, key=lambda hypothesis: hypothesis.total)

    def with_small_errors(self, hypothesis: Hypothesis) -> Hypothesis:
        """Return a hypothesis by which all modules may be a little off beside its changes."""
        wiring = _after(self.moving, hypothesis.changes, hypothesis.moving)
        left, cost = left_by_small_errors(wiring, self.windows, self._way, ALIKE)
        agreement = self._agreement_of(hypothesis.changes, hypothesis.agreeing)
        return hypothesis._replace(misfit=float(
            (agreement + turn_cost(left, self._noise, ALIKE))[0]) + cost)

    def is_plausible(self, hypothesis: Hypothesis) -> bool:
        """
        Tell whether a gyro that counts degrees turns as the wheels do.

        That it does makes all it says small, which would go with any description by which the
        base hardly turns, or with any gear.
        """
        changes = [change for change in hypothesis.changes if change.kind != GYRO_DEGREES]
        if len(changes) == len(hypothesis.changes):
            return True
        if any(change.is_gear for change in changes):
            return False
        turn = self.windows.turn_in_degrees
        assert turn is not None
        still = self.windows._replace(turn=np.zeros_like(self._way))
        wiring = self.moving
        for change in changes:
            wiring = change.applied(wiring)
        by_wheels = turn_left(wiring, still, self._way)[0] / RigidFit(wiring.arm).size
        by_wheels, turn = by_wheels - by_wheels.mean(), turn - turn.mean()
        sizes = np.sqrt([np.sum(by_wheels ** 2), np.sum(turn ** 2)])
        return bool(sizes.max() < ALIKE_SIZES * sizes.min()
                    and abs(by_wheels @ turn) > ALIKE_TURNS * sizes.prod())

    def is_due(self, changes: tuple[Change, ...]) -> bool:
        """
        Tell whether changes are to be made before joints that are out of order are mended.

        These drag the base about, in ways that are not known, so that it shows more than is
        wrong: only what they announced themselves is sure.
        """
        return not self._is_out_of_order or not {*changes}.isdisjoint(self._announced)

    def best_pairs(self, singles: list[Hypothesis]) -> list[Hypothesis]:
        """Return the best hypotheses of two compatible changes that are due, best first."""
        rough = self._thinned()
        changes = [single.changes[0] for single in singles]
        found = sorted((rough._best(pair) for pair in combinations(changes, 2)
                        if compatible(*pair) and self.is_due(pair)),
                       key=lambda hypothesis: hypothesis.total)
        fitted = [self.with_small_errors(self._fitted(*pair[:3])) for pair in found[:FITTED_PAIRS]]
        return sorted(filter(self.is_plausible, fitted), key=lambda hypothesis: hypothesis.total)

    def _thinned(self) -> 'Search':
        """Return a search on a part of the windows that does not refine numbers."""
        pick = slice(None, None, THINNING)
        windows = self.windows
        rough = Search(self.agreeing, self.moving, Windows(
            windows.start[pick], windows.end[pick], windows.time[pick], windows.ways[..., pick],
            None if windows.turn is None else windows.turn[pick],
            None if windows.turn_in_degrees is None else windows.turn_in_degrees[pick]),
            self._way[pick], self._moves[pick], self._announced)
        rough._refinements, rough._agrees = 2, self._agrees
        return rough

    def _best(self, changes: tuple[Change, ...]) -> Hypothesis:
        """Return the best hypothesis of some changes, over roles and numbers."""
        everything = tuple(range(len(changes)))
        roles = [(NONE, everything)]
        if not self._agrees:
            parts = list(combinations(everything, 1))
            roles += [(everything, everything)]
            roles += [(part, everything) for part in parts if len(changes) > 1]
            roles += [(everything, part if len(changes) > 1 else NONE) for part in parts]
        return min((self._fitted(changes, agreeing, moving) for agreeing, moving in roles),
                   key=lambda hypothesis: hypothesis.misfit)

    def _fitted(self, changes: tuple[Change, ...], agreeing: tuple[int, ...],
                moving: tuple[int, ...]) -> Hypothesis:
        """Return a hypothesis with the numbers that fit best."""
        free = [at for at, change in enumerate(changes) if change.kind in VALUES]
        for at in free:
            if changes[at].value is None:
                changes = _with(changes, at, 1.0 if changes[at].kind == RADIUS else 0.0)
        if len(free) == 2:
            changes = self._both(changes, agreeing, moving)
        # Two numbers depend on each other: each is refined twice.
        rounds = range(min(1, len(free) - 1), self._refinements)
        for roughness in np.repeat(rounds, len(free)).tolist():
            for at in free:
                changes = self._with_best(changes, agreeing, moving, at, roughness)[0]
        return self._hypothesis(changes, agreeing, moving)

    def _both(self, changes: tuple[Change, ...], agreeing: tuple[int, ...],
              moving: tuple[int, ...]) -> tuple[Change, ...]:
        """Return two changes with the rough numbers that fit best together."""
        tried = (self._with_best(_with(changes, 0, value), agreeing, moving, 1, 0)
                 for value in changes[0].values.tolist())
        return min(tried, key=lambda fit: fit[1])[0]

    def _with_best(self, changes: tuple[Change, ...], agreeing: tuple[int, ...],
                   moving: tuple[int, ...], at: int,
                   roughness: int) -> tuple[tuple[Change, ...], float]:
        """Return changes with the best number for one of them, and their misfit [nat]."""
        tried = _values(changes[at], roughness)
        cost = self._cost(changes, agreeing, moving, at, tried)
        best = int(np.argmin(cost))
        return _with(changes, at, float(tried[best])), float(cost[best])

    def _hypothesis(self, changes: tuple[Change, ...], agreeing: tuple[int, ...],
                    moving: tuple[int, ...]) -> Hypothesis:
        """Return a hypothesis with its cost."""
        has_gyro = self.windows.turn is not None
        changes = tuple(change if has_gyro and at in moving else _as_wheels_tell(change)
                        for at, change in enumerate(changes))
        return Hypothesis(
            changes, agreeing, moving, float(self._cost(changes, agreeing, moving)[0]),
            sum(ANNOUNCED_COST if change in self._announced else change.cost
                for change in changes))

    def _cost(self, changes: tuple[Change, ...], agreeing: tuple[int, ...],
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


def _as_wheels_tell(change: Change) -> Change:
    """Return a change without what only a gyro tells: whether all wheels go the other way."""
    if change.kind == OFFSET and len(change.modules) > 1 and change.value is not None:
        return change._replace(value=math.remainder(change.value, math.pi))
    return change


def _values(change: Change, round_of: int) -> Floats:
    """Return the values to try for a change in a round of its refinement."""
    if round_of == 0:
        return change.values
    assert change.value is not None
    finer: Floats = np.linspace(-1.0, 1.0, 11) * 7.0 ** (1 - round_of)
    if change.kind == OFFSET:
        return change.value + float(np.diff(change.values)[0]) * finer
    factors: Floats = change.value * np.exp(float(np.diff(np.log(change.values))[0]) * finer)
    return factors


def _with(changes: tuple[Change, ...], at: int, value: float) -> tuple[Change, ...]:
    """Return changes of which one has another value."""
    return (*changes[:at], changes[at]._replace(value=value), *changes[at + 1:])
