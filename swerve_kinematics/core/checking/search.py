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
from swerve_kinematics.core.checking.comparison import Comparison, NONE
from swerve_kinematics.core.checking.drive_data import Floats, Windows
from swerve_kinematics.core.checking.hypothesis import compatible, Hypothesis
from swerve_kinematics.core.checking.wiring import turn_left, Wiring
from swerve_kinematics.core.kinematics.rigid_fit import RigidFit

# Where time is short, small errors of all modules are fitted beside so many of the best changes.
LIKELY = 8
# Pairs are compared roughly first, on every so manyth window; so many are then fitted.
THINNING = 3
FITTED_PAIRS = 40
REFINEMENTS = 3
# Turns of a gyro that really counts degrees are in size within this factor of those by the
# wheels, and correlate with them by this at least, whatever else is wrong with these.
ALIKE_SIZES, ALIKE_TURNS = 6.0, 0.5


class Search(Comparison):
    """
    Looks for the hypotheses that explain a drive best.

    Parameters
    ----------
    agreeing, moving, windows, way, is_moving
        As a Comparison takes them.
    announced : tuple of Change
        What must be wrong of motors or encoders, by their commands: if of the encoders, the
        base moves by the description after these changes.

    """

    def __init__(self, agreeing: Wiring, moving: Wiring, windows: Windows, way: Floats,
                 is_moving: NDArray[np.bool_], announced: tuple[Change, ...] = ()) -> None:
        """Prepare the comparison."""
        super().__init__(agreeing, moving, windows, way, is_moving)
        self._announced, self._refinements = announced, REFINEMENTS

    @property
    def _is_out_of_order(self) -> bool:
        """Return whether joints are known not to do what they are told."""
        return bool(self._announced or self.agreeing.outsiders)

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
        cost = self._misfit(changes, agreeing, moving, at, tried)
        best = int(np.argmin(cost))
        return _with(changes, at, float(tried[best])), float(cost[best])

    def _hypothesis(self, changes: tuple[Change, ...], agreeing: tuple[int, ...],
                    moving: tuple[int, ...]) -> Hypothesis:
        """Return a hypothesis with its cost."""
        has_gyro = self.windows.turn is not None
        changes = tuple(change if has_gyro and at in moving else _as_wheels_tell(change)
                        for at, change in enumerate(changes))
        return Hypothesis(
            changes, agreeing, moving, float(self._misfit(changes, agreeing, moving)[0]),
            sum(ANNOUNCED_COST if change in self._announced else change.cost
                for change in changes))


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
