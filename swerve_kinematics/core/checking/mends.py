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

"""What the parameters must become for changes to a description of a base."""

from typing import Callable, Mapping, Sequence

import numpy as np

from swerve_kinematics.core.checking.changes import (
    AXES, Change, CROSSED, CROSSED_KINDS, DRIVE_REVERSED, DRIVES_EXCHANGED, DRIVES_MISNAMED,
    EXCHANGED, GYRO_DEGREES, GYRO_REVERSED, MIRRORED_X, MIRRORED_Y, OFFSET, ORDER, RADIUS,
    STEERING_REVERSED, STEERINGS_EXCHANGED, STEERINGS_MISNAMED)
from swerve_kinematics.core.geometry.angles import within_a_turn, wrap_angle

DRIVE_LISTS = ('drive_joint_names', 'drive_directions', 'drive_ratios', 'wheel_radii',
               'drive_coupling_ratio')
STEERING_LISTS = ('steering_joint_names', 'steering_directions', 'steering_ratios',
                  'steering_offsets')
LISTS = {EXCHANGED: DRIVE_LISTS + STEERING_LISTS, ORDER: DRIVE_LISTS + STEERING_LISTS,
         DRIVES_EXCHANGED: DRIVE_LISTS, STEERINGS_EXCHANGED: STEERING_LISTS,
         DRIVES_MISNAMED: DRIVE_LISTS, STEERINGS_MISNAMED: STEERING_LISTS}
# An offset this close to a quarter of a turn is one [rad]: it is an encoder mounted so.
QUARTER_NEAR = np.radians(2.0)

Values = list[float] | list[str]


def mended(parameters: Mapping[str, Values], changes: Sequence[Change],
           by_index: bool = False) -> dict[str, Values]:
    """
    Return the parameters that must change, with their new values.

    Parameters
    ----------
    parameters : mapping of str to sequence (n,)
        The present values, one for each module: positions, joint names, directions, ratios,
        radii and offsets; those of joints may be left out where they are empty.
    changes : sequence of Change
        In the order in which they were found.
    by_index : bool
        Whether joints are commanded by their places in a list that other names do not change:
        modules that are exchanged get each other's positions then, and where only drives or
        only steerings are, no parameter mends it.

    Returns
    -------
    dict of str to list
        Of those that are different. Empty for a gyro: its driver must be mended.

    """
    values = {name: entries for name, entries in parameters.items() if entries}
    for change in changes:
        _apply(values, change, by_index)
    return {name: entries for name, entries in values.items()
            if entries != parameters[name]}


def _apply(values: dict[str, Values], change: Change, by_index: bool) -> None:
    """Apply one change to the parameters, in place."""
    kind, modules = change.kind, change.modules
    if kind == CROSSED:
        for part in CROSSED_KINDS:
            _apply(values, Change(part, modules), by_index)
    elif kind in (EXCHANGED, ORDER) and by_index:
        order = change.permutation(len(values['module_x']))
        for name in ('module_x', 'module_y'):
            values[name] = _reordered(values[name], np.argsort(order).tolist())
    elif kind in LISTS:
        if by_index != (kind in (DRIVES_MISNAMED, STEERINGS_MISNAMED)):
            return  # other names would put right either commands or readings, and spoil the others
        order = change.permutation(len(values['module_x']))
        for name in LISTS[kind]:
            if name in values:
                values[name] = _reordered(values[name], order)
    elif kind == AXES:
        values['module_x'], values['module_y'] = values['module_y'], values['module_x']
    elif kind in (MIRRORED_X, MIRRORED_Y):
        name = 'module_x' if kind == MIRRORED_X else 'module_y'
        values[name] = [-entry for entry in _floats(values, name)]
    elif kind in (DRIVE_REVERSED, STEERING_REVERSED):
        name = 'drive_directions' if kind == DRIVE_REVERSED else 'steering_directions'
        _change(values, name, modules, lambda _, old: -old)
    elif kind == RADIUS and change.value is not None:
        factor = change.value
        if change.is_gear:
            _change(values, 'drive_ratios', modules, lambda _, old: old / factor)
        else:
            _change(values, 'wheel_radii', modules, lambda _, old: old * factor)
    elif kind == OFFSET:
        turn = _offset(change.value or 0.0)
        turns = [a * b for a, b in zip(_floats(values, 'steering_directions'),
                                       _floats(values, 'steering_ratios'))]
        _change(values, 'steering_offsets', modules,
                lambda at, old: within_a_turn(old + turns[at] * turn, turns[at]))
    else:
        assert kind in (GYRO_REVERSED, GYRO_DEGREES), kind


def _offset(value: float) -> float:
    """Return an offset in (-pi, pi] [rad], a quarter of a turn where it is nearly one."""
    value = float(wrap_angle(value))
    quarters = round(value / (0.5 * np.pi))
    near = abs(value - quarters * 0.5 * np.pi) < QUARTER_NEAR
    return quarters * 0.5 * np.pi if near and quarters else value


def _floats(values: dict[str, Values], name: str) -> list[float]:
    """Return a list of numbers among the parameters."""
    return [float(entry) for entry in values[name]]


def _reordered(entries: Values, order: Sequence[int]) -> Values:
    """Return entries in another order."""
    mixed = [entries[at] for at in order]
    return [str(entry) for entry in mixed] if isinstance(mixed[0], str) else [
        float(entry) for entry in mixed]


def _change(values: dict[str, Values], name: str, modules: Sequence[int],
            new: Callable[[int, float], float]) -> None:
    """Replace the entries of some modules by what becomes of their index and themselves."""
    values[name] = [new(at, old) if at in modules else old
                    for at, old in enumerate(_floats(values, name))]
