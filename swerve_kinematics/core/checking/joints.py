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

"""Joints that do not do what they are told, or that stand still while the base moves."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.drive_data import DriveData, Floats
from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.geometry.arrays import median
from swerve_kinematics.core.geometry.windows import without_long_gaps

DRIVE, STEERING, MODULE, BASE = 'drive', 'steering', 'module', 'base'
STANDS, AGAINST, ASTRAY = 'stands still', 'goes against its command', 'does not follow its command'
RACES = 'turns faster than it can'
UNSEEN = 'reads a motion that nobody sees'
CROOKED = 'points elsewhere than straight ahead at 0'

# Span over which a joint must have done what it was told [s]: lags are shorter.
SPAN = 0.2
# A joint is judged after so much of commanded motion [s].
LEAST_TIME = 1.0
# Commanded speed [m/s] from which a drive must turn.
LEAST_COMMAND = 0.03
# A drive follows its command within the first two of these shares of it. It stands where it does
# less than the third, in more than this share of the spans. These are judgements, as are those
# below.
LOWEST_GAIN, HIGHEST_GAIN, STILL_GAIN, MOST_SPANS = 0.6, 1.6, 0.1, 0.8
# A steering joint follows within this angle [rad], the median of the drive.
STEERING_ERROR = 0.15
# No module turns like this for a second [rad/s]. One that is read as turning further than it does
# is sent after its reading, which it never reaches.
RACING = 30.0
# A command is steady while it changes by less than this over a span: share of a speed, [rad].
STEADY_SHARE, STEADY = 0.3, 0.15
# A joint that stands still reads the same all the time: but for counts, of [m] and [rad].
STILL_WAY, STILL_ANGLE = 1e-3, 0.01
# ... while the others, in the median, roll by this, and turn by this to and fro: one that is
# where it has to be already need not turn once.
OTHERS_WAY, OTHERS_ANGLE = 0.3, 3.0
# What a drive rolls to and fro counts by this share, for counts that flicker add up too.
TO_AND_FRO = 0.1
# A base moves if some drive rolls this many times as far as one that stands still.
MOVING = 10.0


class JointFault(NamedTuple):
    """What is wrong with joints, of which kind, of which modules."""

    joint: str
    fault: str
    modules: tuple[int, ...]


def joint_faults(data: DriveData) -> list[JointFault]:
    """
    Return the joints that do not follow their commands, as far as commands are known.

    Parameters
    ----------
    data : DriveData
        The drive.

    Returns
    -------
    list of JointFault
        A base of which no joint moves is one fault, and so are a module of which both joints
        stand still, and what all modules, drives or steering joints have in common.

    """
    if data.commanded_speeds is None or data.commanded_angles is None:
        return []
    first, last = _spans(data.stamp)
    drives = _drive_faults(data, first, last)
    steerings = _steering_faults(data, first, last)
    if STANDS in (*drives, *steerings) and not _moves(data):
        return [JointFault(BASE, STANDS, tuple(range(len(drives))))]
    faults = []
    for module, (drive, steering) in enumerate(zip(drives, steerings)):
        if drive == steering == STANDS:
            faults.append(JointFault(MODULE, STANDS, (module,)))
            continue
        faults += [JointFault(joint, fault, (module,)) for joint, fault in (
            (DRIVE, drive), (STEERING, steering)) if fault]
    return _together(faults, len(drives))


def _together(faults: list[JointFault], count: int) -> list[JointFault]:
    """Return the faults, one that all modules have as a single one: it is seldom the joints."""
    kinds = [(fault.joint, fault.fault) for fault in faults]
    # Each that goes against its command may be cured for itself.
    shared = [kind for kind in dict.fromkeys(kinds)
              if kinds.count(kind) == count and kind[1] != AGAINST]
    return [*(JointFault(*kind, tuple(range(count))) for kind in shared),
            *(fault for fault, kind in zip(faults, kinds) if kind not in shared)]


def _moves(data: DriveData) -> bool:
    """Tell whether any joint moves."""
    return bool((np.ptp(data.distances, axis=0) > MOVING * STILL_WAY).any()
                or (np.ptp(data.angles, axis=0) > STILL_ANGLE).any())


def still_joints(data: DriveData) -> list[JointFault]:
    """Return the joints that read the same all the time, untold, while most others move."""
    no_drive, no_steering = _still(data.distances, data.angles) & ~_told_to_stand(data)
    return [JointFault(MODULE if no_drive[module] and no_steering[module] else
                       DRIVE if no_drive[module] else STEERING, STANDS, (module,))
            for module in np.flatnonzero(no_drive | no_steering).tolist()]


def _still(distances: Floats, angles: Floats) -> NDArray[np.bool_]:
    """Return which drives, and which steering joints (2, n), stand while most others move."""
    ways, turns = np.ptp(distances, axis=0), np.ptp(np.unwrap(angles, axis=0), axis=0)
    turned = np.abs(wrap_angle(np.diff(angles, axis=0))).sum(axis=0)
    ways = np.maximum(ways, np.abs(np.diff(distances, axis=0)).sum(axis=0) * TO_AND_FRO)
    return np.stack(((ways < STILL_WAY) & (median(ways) > OTHERS_WAY),
                     (turns < STILL_ANGLE) & (median(turned) > OTHERS_ANGLE)))


def _told_to_stand(data: DriveData) -> NDArray[np.bool_]:
    """
    Return which drives, and which steering joints (2, n), are told to stand while others move.

    A module that the base turns about need not roll, nor those on an axle that it turns about
    steer.
    """
    none = np.zeros((2, data.angles.shape[1]), dtype=bool)
    if data.commanded_speeds is None or data.commanded_angles is None:
        return none
    known = np.isfinite(data.commanded_speeds + data.commanded_angles).all(axis=1)
    if not known.any():
        return none
    time = np.diff(data.stamp[known], prepend=data.stamp[known][0])[:, np.newaxis]
    told = np.cumsum(data.commanded_speeds[known] * time, axis=0)
    return _still(told, data.commanded_angles[known])


def _spans(stamp: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return indices of the first and last samples of the spans, which overlap by half."""
    stamp = without_long_gaps(stamp)
    start = np.arange(stamp[0], max(stamp[-1] - SPAN, stamp[0]), 0.5 * SPAN)
    first = np.searchsorted(stamp, start)
    last = np.minimum(np.searchsorted(stamp, start + SPAN), len(stamp) - 1)
    whole = (last > first) & (stamp[last] - stamp[first] < 2.0 * SPAN)
    return first[whole], last[whole]


def _drive_faults(data: DriveData, first: NDArray[np.intp],
                  last: NDArray[np.intp]) -> list[str | None]:
    """Return the fault of each drive: None if it follows, '' if it was not commanded enough."""
    assert data.commanded_speeds is not None
    time = (data.stamp[last] - data.stamp[first])[:, np.newaxis]
    speed = (data.distances[last] - data.distances[first]) / time
    begun, held = data.commanded_speeds[first], data.commanded_speeds[last]
    middle = data.commanded_speeds[(first + last) // 2]
    low, high = np.minimum(begun, held), np.maximum(begun, held)
    steady = (np.minimum(low, middle) * np.maximum(high, middle) > 0.0) & (
        np.minimum(abs(begun), abs(held)) > LEAST_COMMAND) & (
            np.abs(held - begun) < STEADY_SHARE * np.abs(middle))
    faults: list[str | None] = []
    for module in range(speed.shape[1]):
        used = steady[:, module]
        if np.count_nonzero(used) * 0.5 * SPAN < LEAST_TIME:
            faults.append('')
            continue
        gains = speed[used, module] / middle[used, module]
        gain = median(gains)
        still = np.mean(np.abs(gains) < STILL_GAIN) > MOST_SPANS
        faults.append(
            STANDS if still else AGAINST if gain < -LOWEST_GAIN
            else None if LOWEST_GAIN < gain < HIGHEST_GAIN else ASTRAY)
    return faults


def _steering_faults(data: DriveData, first: NDArray[np.intp],
                     last: NDArray[np.intp]) -> list[str | None]:
    """Return the fault of each steering joint; None if it follows or was not commanded."""
    assert data.commanded_angles is not None
    begun, held = data.commanded_angles[first], data.commanded_angles[last]
    assert data.commanded_speeds is not None
    driven = np.minimum(np.abs(data.commanded_speeds[first]),
                        np.abs(data.commanded_speeds[last])) > 0.0
    # At rest a command need not mean anything: the modules are left where they are.
    steady = driven & (np.abs(held - begun) < STEADY)
    error = np.abs(wrap_angle(held - data.angles[last]))
    mirrored = np.abs(wrap_angle(held + data.angles[last]))
    races = _race(data, first, last)
    faults: list[str | None] = []
    for module in range(error.shape[1]):
        used = steady[:, module]
        if races[module]:
            faults.append(RACES)
            continue
        if np.count_nonzero(used) * 0.5 * SPAN < LEAST_TIME:
            faults.append(None)
            continue
        commanded = wrap_angle(held[used, module])
        # Only a command away from straight tells which way a joint counts.
        aside = np.abs(np.sin(commanded)) > np.sin(STEERING_ERROR)
        if np.count_nonzero(aside) * 0.5 * SPAN < LEAST_TIME:
            aside = np.ones_like(aside)
        if median(error[used, module][aside]) < STEERING_ERROR:
            faults.append(None)
        elif np.ptp(data.angles[:, module]) < STILL_ANGLE:
            faults.append(STANDS)
        elif median(mirrored[used, module][aside]) < STEERING_ERROR:
            faults.append(AGAINST)
        else:
            faults.append(ASTRAY)
    return faults


def _race(data: DriveData, first: NDArray[np.intp], last: NDArray[np.intp]) -> list[bool]:
    """Return which steering joints turn, to and fro or on and on, as no joint can."""
    if len(first) * 0.5 * SPAN < LEAST_TIME:
        return [False] * data.angles.shape[1]
    turned = np.cumsum(np.abs(wrap_angle(np.diff(data.angles, axis=0, prepend=data.angles[:1]))),
                       axis=0)
    rates = (turned[last] - turned[first]) / (data.stamp[last] - data.stamp[first])[:, np.newaxis]
    return [median(rate) > RACING for rate in rates.T]
