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

"""What is wrong with a base, from what it reported during a drive."""

from collections.abc import Generator

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.changes import (
    Change, DRIVE_REVERSED, OUTSIDER, STEERING_REVERSED)
from swerve_kinematics.core.checking.comparison import ALIKE
from swerve_kinematics.core.checking.conclusion import concluded, LEAST_GAIN
from swerve_kinematics.core.checking.coupling import rolls_by_steering, with_rolls
from swerve_kinematics.core.checking.drive_data import (
    DriveData, Floats, LEAST_SPEED, Windows, windows_of)
from swerve_kinematics.core.checking.gyro_faults import gyro_fault, RATE_OPPOSED, YAW_FROZEN
from swerve_kinematics.core.checking.joints import (
    AGAINST, BASE, DRIVE, joint_faults, JointFault, STEERING, still_joints)
from swerve_kinematics.core.checking.search import Search
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.core.checking.wiring import (
    as_described, rigid_motion, ways_of, Wiring)
from swerve_kinematics.core.geometry.arrays import check_series
from swerve_kinematics.core.kinematics.rigid_fit import RigidFit

# Moving windows that a verdict needs: 2 s.
LEAST_WINDOWS = 20
# A direction of motion was driven if this great a share of all is not in step with another: all of
# a circle is in step, and tells no more than a straight line does.
LEAST_SHARE = 0.15
MOTIONS = 'forward', 'sideways', 'turning'


def check(positions: Floats, data: DriveData, expects_gyro: bool = True,
          pairs: bool = True) -> Verdict:
    """
    Return what a drive shows about a base.

    Parameters
    ----------
    positions : ndarray (n, 2)
        Where the modules are by the description [m].
    data : DriveData
        What was reported and commanded.
    expects_gyro : bool
        Whether the base has a gyro.
    pairs : bool
        Whether to look for two changes at once, which takes seconds.

    Returns
    -------
    Verdict

    Raises
    ------
    ValueError
        If the data have a wrong shape, are not finite, or not in the order of time.

    """
    verdict = _thought_through(checking(positions, data, expects_gyro, pairs))
    if verdict.joints or verdict.gyro or verdict.changes or not verdict.is_moving:
        return verdict
    rolls = _rolls(as_described(positions), data, expects_gyro)
    if not rolls.any():
        return verdict
    return _thought_through(checking(
        positions, with_rolls(data, rolls), expects_gyro, pairs))._replace(
            rolls=tuple(rolls.tolist()))


def _thought_through(thinking: Generator[None, None, Verdict]) -> Verdict:
    """Return the verdict, without a pause."""
    while True:
        try:
            next(thinking)
        except StopIteration as end:
            verdict: Verdict = end.value
            return verdict


def _rolls(described: Wiring, data: DriveData, expects_gyro: bool) -> Floats:
    """Return how much farther each wheel rolls than its drive tells as its module turns."""
    windows = _windows_and_gyro(described, data, expects_gyro)[0]
    way, is_moving = _ways(windows)
    least = LEAST_GAIN * float(np.count_nonzero(is_moving)) / ALIKE
    return rolls_by_steering(described, data, windows, way, ALIKE, least)


def checking(positions: Floats, data: DriveData, expects_gyro: bool = True, pairs: bool = False,
             is_thorough: bool = True) -> Generator[None, None, Verdict]:
    """
    Return the same as `check`, but pause every millisecond or two on the way.

    For a process that has something else to do. Unless it is to be thorough, it does not ask
    what may be wrong for all that the drive tells.
    """
    check_series(*data[:3], len(positions))
    faults = joint_faults(data)
    if any(fault.joint == BASE for fault in faults):
        return Verdict(joints=tuple(faults), is_moving=False)
    yield
    described = as_described(positions)
    windows, gyro = _windows_and_gyro(described, data, expects_gyro)
    way, is_moving = _ways(windows)
    verdict = Verdict(joints=tuple(faults), gyro=gyro)
    if np.count_nonzero(is_moving) < LEAST_WINDOWS:
        return verdict._replace(is_moving=False)
    yield
    faults = faults or still_joints(data)
    verdict = verdict._replace(joints=tuple(faults))
    if len(positions) - len({module for fault in faults for module in fault.modules
                             if fault.fault != AGAINST}) < 2:
        return verdict
    search = _search(described, faults, windows, way, is_moving)
    if not (is_thorough or search.is_doubtful):
        return verdict
    singles = yield from search.best_single(is_thorough)
    null = search.with_small_errors(search.null)
    yield
    return concluded(verdict, search, null, singles, pairs)._replace(
        missing=_missing(described, windows, is_moving))


def _windows_and_gyro(described: Wiring, data: DriveData,
                      expects_gyro: bool) -> tuple[Windows, str | None]:
    """Return the windows of the drive, and what is wrong with the gyro, of no use in them."""
    windows = windows_of(data)
    gyro = gyro_fault(data, rigid_motion(described, windows)[2], windows.time) if (
        expects_gyro) else None
    if gyro == YAW_FROZEN:
        windows = windows_of(data._replace(yaw=None))
    elif gyro == RATE_OPPOSED:
        windows = windows_of(data._replace(yaw_rate=None))
    elif gyro is not None or not expects_gyro:
        windows = windows_of(data._replace(yaw=None, yaw_rate=None))
    return windows, gyro


def _ways(windows: Windows) -> tuple[Floats, NDArray[np.bool_]]:
    """Return the root mean square way in each window [m], and in which the base moves."""
    index = np.arange(windows.ways.shape[1])
    way: Floats = np.sqrt((np.abs(windows.ways[0, index, index]) ** 2).mean(axis=0))
    return way, way >= LEAST_SPEED * windows.time


def _search(described: Wiring, faults: list[JointFault], windows: Windows, way: Floats,
            is_moving: NDArray[np.bool_]) -> Search:
    """Return the search that knows which joints are faulty."""
    agreeing, announced, left_out = described, [], []
    for fault in faults:
        kind = {(DRIVE, AGAINST): DRIVE_REVERSED,
                (STEERING, AGAINST): STEERING_REVERSED}.get((fault.joint, fault.fault))
        if kind is not None:
            announced.append(Change(kind, fault.modules))
            agreeing = announced[-1].applied(agreeing)
        else:
            left_out += [module for module in fault.modules if module not in left_out]
    moving = described
    for module in left_out:
        agreeing = Change(OUTSIDER, (module,)).applied(agreeing)
        moving = Change(OUTSIDER, (module,)).applied(moving)
    # A joint that stands may hold the base, or only its reading may.
    return min((Search(agreeing, wiring, windows, way, is_moving, tuple(announced))
                for wiring in ([described, moving] if left_out else [described])),
               key=lambda search: search.null.misfit)


def _missing(wiring: Wiring, windows: Windows, is_moving: NDArray[np.bool_]) -> tuple[str, ...]:
    """Return the motions of which a drive has too little, by the wheels as described."""
    ways, fit = ways_of(wiring, windows)[is_moving], RigidFit(wiring.arm)
    mean = ways.mean(axis=1)
    left = np.stack((mean.real, mean.imag, fit.turn(ways) * fit.size))
    least, driven = LEAST_SHARE * np.linalg.norm(left, axis=1).max(), []
    for _ in MOTIONS:
        sizes = np.linalg.norm(left, axis=1)
        largest = sizes.argmax()
        if sizes[largest] < least:
            break
        driven.append(MOTIONS[largest])
        direction = left[largest] / sizes[largest]
        left -= np.outer(left @ direction, direction)
    return tuple(name for name in MOTIONS if name not in driven)
