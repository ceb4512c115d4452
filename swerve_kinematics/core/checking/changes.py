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
The changes to the description of a base that a check tries, each a kind of real mistake.

A change is data: its kind, the modules it concerns and, for a kind with a number, the values
to try.
"""

from itertools import combinations
import math
from typing import Callable, NamedTuple

import numpy as np

from swerve_kinematics.core.checking.drive_data import Complexes, Floats
from swerve_kinematics.core.checking.wiring import Wiring
from swerve_kinematics.core.geometry.angles import TURN

DRIVE_REVERSED, STEERING_REVERSED = 'drive reversed', 'steering reversed'
OFFSET, RADIUS = 'steering offset', 'wheel radius'
EXCHANGED, ORDER = 'modules swapped', 'modules rotated'
# Left and right of an axle, with motors that are mirror images of each other: the directions in
# the description stay where they are.
CROSSED, CROSSED_KINDS = 'mirrored modules swapped', (EXCHANGED, DRIVE_REVERSED)
DRIVES_EXCHANGED, STEERINGS_EXCHANGED = 'drive joints swapped', 'steering joints swapped'
# What moves one joint is read from another one: commands and readings differ in their order.
DRIVES_MISNAMED, STEERINGS_MISNAMED = 'drive joints misnamed', 'steering joints misnamed'
AXES, MIRRORED_X, MIRRORED_Y = 'x and y swapped', 'x of wrong sign', 'y of wrong sign'
GYRO_REVERSED, GYRO_DEGREES = 'gyro reversed', 'gyro in degrees'
OUTSIDER = 'module does not fit'

# Numbers tried for a kind that has one; the search refines them.
VALUES: dict[str, Floats] = {
    OFFSET: np.linspace(TURN / 24, TURN * 23 / 24, 23).astype(np.float64),
    RADIUS: np.exp(np.linspace(-0.92, 0.92, 20)).astype(np.float64)}
# The same for all wheels at once: a gear that was left out, or counted twice, makes them look up
# to 16 times too large or too small. One that is given the wrong way round makes them look too
# large, by its square. (A gyro that counts degrees makes them look 57 times too small: no gear.)
ALL_RADII: Floats = np.exp(np.linspace(-5.6, 2.8, 87)).astype(np.float64)
# No wheel is measured wrongly by this factor or more: a gear was left out, counted twice, or given
# the wrong way round.
GEAR = 2.5
# What a change costs [nat]: how much better the data must be explained before it is believed.
# A number costs as much as it can adapt to; what hardly happens costs more.
COST = 12.0
EXTRA = {OFFSET: 5.0, RADIUS: 4.0, EXCHANGED: 1.5, CROSSED: 2.5, DRIVES_EXCHANGED: 4.0,
         STEERINGS_EXCHANGED: 4.0, MIRRORED_X: 1.0, MIRRORED_Y: 1.0, ORDER: 1.0, OUTSIDER: 10.0}
SEVERAL = DRIVE_REVERSED, STEERING_REVERSED, OFFSET, RADIUS
SEVERAL_COST = 1.0
# One number stands for all wheels: a diameter instead of a radius, or a gear left out, is common.
ALL_RADII_COST = 3.0
# Encoders that are all mounted alike are off by a quarter of a turn, or by an eighth, within this
# [rad]. Any other angle that they share hardly happens; to the gyro it is any scale of its turns.
ALIKE_OFFSET, ODD_OFFSET_COST = math.radians(3.0), 16.0
# Mirrored modules, as on the two sides, drive the other way round but steer the same way.
SIDE_STEERS_COST = 1.5
# Scale of the logarithm of a wrong radius; that of a wrong gear ratio may be many times as large.
RADIUS_SPREAD = 0.4
# What a change costs that a joint going against its command has announced: the sign of its motor
# is wrong, or that of its encoder.
ANNOUNCED_COST = 1.0


class Change(NamedTuple):
    """
    One change to the description.

    Attributes
    ----------
    kind : str
        Such as 'drive reversed' or 'modules swapped'.
    modules : tuple of int
        Indices of those it concerns, all of them for a change to the whole base. Of those that
        are mixed up, most often two, the joints of the next belong in the place of each.
    value : float or None
        For an offset what to add to it [rad], for a radius the factor; for an order by how
        many places the modules are rotated.

    """

    kind: str
    modules: tuple[int, ...] = ()
    value: float | None = None

    @property
    def cost(self) -> float:
        """Return how much it must explain [nat]."""
        cost = COST + EXTRA.get(self.kind, 0.0)
        if self.kind == RADIUS and len(self.modules) > 1:
            cost += ALL_RADII_COST - EXTRA[RADIUS]
        elif len(self.modules) > 1 and self.kind in SEVERAL:
            cost += SEVERAL_COST
        if self.kind == OFFSET and len(self.modules) > 1 and self.value is not None and abs(
                math.remainder(self.value, TURN / 8)) > ALIKE_OFFSET:
            cost += ODD_OFFSET_COST
        if self.kind == STEERING_REVERSED and len(self.modules) == 2:
            cost += SIDE_STEERS_COST
        if self.kind == RADIUS and self.value is not None:
            cost += math.log1p((math.log(self.value) / RADIUS_SPREAD) ** 2)
        return cost

    @property
    def freedom(self) -> float:
        """Return how much of anything its number may adapt to [nat], 0 without one."""
        return EXTRA[self.kind] if self.kind in VALUES else 0.0

    @property
    def values(self) -> Floats:
        """Return the numbers to try."""
        return ALL_RADII if self.kind == RADIUS and len(self.modules) > 1 else VALUES[self.kind]

    @property
    def is_gear(self) -> bool:
        """Tell whether a radius is so wrong that it must be a gear."""
        return self.kind == RADIUS and self.value is not None and not (
            1.0 / GEAR < self.value < GEAR)

    def applied(self, wiring: Wiring, values: Floats | None = None) -> Wiring:
        """
        Return the wiring after the change.

        Parameters
        ----------
        wiring : Wiring
            Of one hypothesis.
        values : ndarray (g,), optional
            To be tried instead of `value`.

        Returns
        -------
        Wiring
            Of g hypotheses.

        """
        chosen = list(self.modules)
        numbers = np.array([0.0 if self.value is None else self.value]) if (
            values is None) else values
        if self.kind in FACTORS:
            factor = np.repeat(wiring.factor, len(numbers), axis=0)
            factor[:, chosen] *= FACTORS[self.kind](numbers)[:, np.newaxis]
            return wiring._replace(factor=factor)
        if self.kind == STEERING_REVERSED:
            sense, factor = wiring.sense.copy(), wiring.factor.copy()
            sense[chosen] ^= 1
            factor[:, chosen] = factor[:, chosen].conj()
            return wiring._replace(sense=sense, factor=factor)
        if self.kind in EXCHANGES:
            return _permuted(wiring, self.permutation(len(wiring.arm)), EXCHANGES[self.kind])
        if self.kind == CROSSED:
            for kind in CROSSED_KINDS:
                wiring = Change(kind, self.modules).applied(wiring)
            return wiring
        if self.kind in ARMS:
            return wiring._replace(arm=ARMS[self.kind](wiring.arm))
        if self.kind == GYRO_REVERSED:
            return wiring._replace(gyro=-wiring.gyro)
        if self.kind == GYRO_DEGREES:
            return wiring._replace(degrees=True)
        return wiring._replace(outsiders=(*wiring.outsiders, *self.modules))

    def permutation(self, count: int) -> list[int]:
        """Return, for each place, the index of the joints that belong there."""
        order = list(range(count))
        if self.kind in EXCHANGES:
            ring, shift = self.modules, int(self.value or 1)
            for place, module in enumerate(ring):
                order[module] = ring[(place + shift) % len(ring)]
        return order


FACTORS: dict[str, Callable[[Floats], Complexes]] = {
    DRIVE_REVERSED: lambda values: np.full(len(values), -1.0 + 0j),
    # What the reading is too great by, the wheel points less far.
    OFFSET: lambda values: np.exp(-1j * values),
    RADIUS: lambda values: values.astype(np.complex128),
}
EXCHANGES = {EXCHANGED: ('drive', 'steering'), ORDER: ('drive', 'steering'),
             DRIVES_EXCHANGED: ('drive',), STEERINGS_EXCHANGED: ('steering',),
             DRIVES_MISNAMED: ('drive',), STEERINGS_MISNAMED: ('steering',)}
ARMS: dict[str, Callable[[Complexes], Complexes]] = {
    AXES: lambda arm: arm.imag + 1j * arm.real,
    MIRRORED_X: lambda arm: -arm.conj(),
    MIRRORED_Y: lambda arm: arm.conj(),
}


def _permuted(wiring: Wiring, order: list[int], fields: tuple[str, ...]) -> Wiring:
    """Return the wiring with other joints at the places; what belongs to joints goes along."""
    changed = {field: getattr(wiring, field)[order] for field in fields}
    if len(fields) == 2:
        changed |= {'sense': wiring.sense[order], 'factor': wiring.factor[:, order]}
    return wiring._replace(**changed)


def all_changes(arm: Complexes, has_gyro: bool) -> list[Change]:
    """
    Return every single change to try.

    Parameters
    ----------
    arm : ndarray of complex (n,)
        Where the modules are [m].
    has_gyro : bool
        Whether the gyro reports anything.

    Returns
    -------
    list of Change

    """
    count = len(arm)
    groups = [(module,) for module in range(count)] + _sides(arm)
    changes = [Change(kind, group) for kind in (DRIVE_REVERSED, STEERING_REVERSED)
               for group in groups]
    whole = tuple(range(count))
    # All drives reversed look like a reversed gyro to everything but the eye.
    changes += [Change(kind, group) for kind in (OFFSET, RADIUS)
                for group in [*groups[:count], whole]]
    changes.append(Change(STEERING_REVERSED, whole))
    changes += [Change(kind, pair) for kind in (EXCHANGED, DRIVES_EXCHANGED, STEERINGS_EXCHANGED)
                for pair in combinations(range(count), 2)]
    changes += [Change(CROSSED, pair) for pair in _mirrored(arm)]
    ring = tuple(sorted(range(count), key=lambda module: np.angle(arm[module] - arm.mean())))
    changes += [Change(ORDER, ring, shift) for shift in range(1, count) if count > 2]
    changes += [Change(kind) for kind in ARMS]
    if has_gyro:
        changes += [Change(GYRO_REVERSED), Change(GYRO_DEGREES)]
    if count > 3:
        changes += [Change(OUTSIDER, (module,)) for module in range(count)]
    return changes


def _sides(arm: Complexes) -> list[tuple[int, ...]]:
    """Return the modules on each side of the base: left and right, where motors are mirrored."""
    sides = (tuple(np.flatnonzero(sign * arm.imag > 1e-6).tolist()) for sign in (1.0, -1.0))
    return [side for side in sides if 1 < len(side) < len(arm)]


def _mirrored(arm: Complexes) -> list[tuple[int, int]]:
    """Return the modules that are left and right of an axle, but for one through the middle."""
    from_middle = arm - arm.mean()
    return [(first, second) for first, second in combinations(range(len(arm)), 2)
            if arm[first].imag * arm[second].imag < 0.0
            and abs((arm[first] - arm[second]).real) < 1e-6 < abs(from_middle[first].real)]
