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
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.changes import (
    Change, DRIVE_REVERSED, OFFSET, OUTSIDER, STEERING_REVERSED)
from swerve_kinematics.core.checking.coupling import rolls_by_steering, with_rolls
from swerve_kinematics.core.checking.drive_data import (
    DriveData, Floats, LEAST_SPEED, Windows, windows_of)
from swerve_kinematics.core.checking.gyro_faults import gyro_fault, RATE_OPPOSED, YAW_FROZEN
from swerve_kinematics.core.checking.hypothesis import Hypothesis
from swerve_kinematics.core.checking.joints import (
    AGAINST, BASE, DRIVE, joint_faults, JointFault, STEERING, still_joints)
from swerve_kinematics.core.checking.search import ALIKE, Search
from swerve_kinematics.core.checking.wiring import (
    as_described, rigid_motion, ways_of, Wiring)
from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.geometry.arrays import check_series
from swerve_kinematics.core.kinematics.rigid_fit import RigidFit

# Moving windows that a verdict needs: 2 s.
LEAST_WINDOWS = 20
# Hypotheses that are worse by less than this [nat] cannot be told from the best.
MARGIN = 6.0
# A change that is not sure yet is suspected when it explains this much [nat].
SUSPICION = 6.0
# A change must be worth this much a moving window [nat]: what tyres creep and slip is not.
LEAST_GAIN = 0.15
# Changes that are less sure than this, for want of motion, are none to be made.
LEAST_CONFIDENCE = 0.9
# A direction of motion was driven if this great a share of all is not in step with another: all of
# a circle is in step, and tells no more than a straight line does.
LEAST_SHARE = 0.15
MOTIONS = 'forward', 'sideways', 'turning'


class Verdict(NamedTuple):
    """
    What a drive shows about a base.

    Attributes
    ----------
    joints : tuple of JointFault
        Joints that do not do what they are told, or stand still.
    gyro : str or None
        What is wrong with the gyro itself.
    rolls : tuple of float
        How much farther each wheel rolls than its drive tells, for each radian by which its
        module turns counter-clockwise [m]; empty if they do not.
    changes : tuple of Change
        What must change in the description, or in the wiring.
    hypothesis : Hypothesis or None
        What they follow from; None if nothing could be compared.
    confidence : float
        Between 0 and 1: of these changes against others as simple.
    alternatives : tuple of tuple of Change
        Other changes that this drive cannot tell from them.
    possible : tuple of Hypothesis
        All that explain the data as well, however unlikely they are.
    slipping : tuple of int
        Modules that did not fit for a part of the drive.
    suspect : Change or None
        What explains the data best where the drive is too short to be sure of it.
    unexplained : bool
        Whether the data contradict the description in a way that no change explains.
    leaves_more : bool
        Whether they do so after the changes too: something else must be wrong as well.
    needs_calibration : bool
        Whether small errors explain the drive better than none: of radii and offsets, or of the
        scale of the gyro, which looks like an error of all radii.
    untold : tuple of Change
        What may be wrong as well: this drive cannot rule it out.
    missing : tuple of str
        Motions that it lacks, of MOTIONS.
    is_moving : bool
        Whether the base moved for long enough to show anything.
    is_seen : bool
        Whether someone saw which way it went.

    """

    joints: tuple[JointFault, ...] = ()
    gyro: str | None = None
    rolls: tuple[float, ...] = ()
    changes: tuple[Change, ...] = ()
    hypothesis: Hypothesis | None = None
    confidence: float = 1.0
    alternatives: tuple[tuple[Change, ...], ...] = ()
    possible: tuple[Hypothesis, ...] = ()
    slipping: tuple[int, ...] = ()
    suspect: Change | None = None
    unexplained: bool = False
    leaves_more: bool = False
    needs_calibration: bool = False
    untold: tuple[Change, ...] = ()
    missing: tuple[str, ...] = ()
    is_moving: bool = True
    is_seen: bool = False

    @property
    def is_wrong(self) -> bool:
        """Return whether anything must be corrected."""
        return bool(self.joints or self.gyro or self.rolls or self.changes
                    or self.unexplained)

    @property
    def is_ambiguous(self) -> bool:
        """Return whether other changes are as good, and motion that the drive lacks would tell."""
        return bool(self.changes and self.missing) and self.confidence < LEAST_CONFIDENCE


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
    return _concluded(verdict, search, null, singles, pairs)._replace(
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


def _concluded(verdict: Verdict, search: Search, null: Hypothesis, singles: list[Hypothesis],
               pairs: bool) -> Verdict:
    """Return a verdict with the changes that a search supports, rather than none (`null`)."""
    alone, singles = singles, [single for single in singles if search.is_plausible(single)
                               and search.is_due(single.changes)]
    best, candidates = null, list(singles)
    least = LEAST_GAIN * search.moving_windows
    faults = [single for single in singles if not _is_harmless(single)]
    harmless = [single for single in singles if _is_harmless(single)]
    if faults and search.null.total - faults[0].total > least and (
            faults[0].total < min(other.total for other in (null, *harmless))):
        best = faults[0]
    elif harmless and _is_slip(harmless[0]) and null.total - harmless[0].total > 0.0 and not (
            search.is_contradicted_by(harmless[0])):
        verdict = verdict._replace(slipping=harmless[0].changes[0].modules)
        return verdict._replace(hypothesis=null, untold=_untold(harmless[0], faults))
    if pairs and (best is not null or search.is_contradicted):
        # What is negligible alone need not be so together with something else.
        doubles = search.best_pairs(alone)
        if doubles and doubles[0].is_negligible:
            doubles = []  # what is left is a matter of calibration
        doubles = [pair for pair in doubles if not pair.is_negligible]
        candidates += doubles
        gain = best.total - doubles[0].total if doubles else 0.0
        if gain > 0.0 and (best is not null
                           or gain > least and not search.is_contradicted_by(doubles[0])):
            best = doubles[0]
    if best is null:
        return verdict._replace(hypothesis=null, untold=_untold(null, faults),
                                needs_calibration=search.null.total - null.total > least,
                                suspect=None if verdict.joints else _suspect(
                                    null, faults, harmless),
                                unexplained=search.is_contradicted and not verdict.joints)
    rivals = [other for other in candidates
              if other.total < best.total + MARGIN and not _same(other.changes, best.changes)]
    weights = np.exp([best.total - other.total for other in rivals])
    return verdict._replace(
        changes=best.changes, hypothesis=best, confidence=float(1.0 / (1.0 + weights.sum())),
        alternatives=tuple(other.changes for other in rivals[:4]),
        leaves_more=search.leaves_more(best),
        possible=tuple(other for other in candidates if other.misfit < best.misfit + MARGIN))


def _suspect(null: Hypothesis, faults: list[Hypothesis],
             harmless: list[Hypothesis]) -> Change | None:
    """Return the change that explains most, if that is much and more than the harmless do."""
    # All that a circle shows is how much the base turns, which one number explains as well as any
    # other does: small errors of all modules, as of a sound base, or a great one of any of them.
    misfit, best = min(((fault.misfit + fault.changes[0].freedom, fault) for fault in faults),
                       key=lambda pair: pair[0], default=(null.misfit, null))
    least = min([null.misfit - SUSPICION, *(other.misfit for other in harmless)])
    return best.changes[0] if misfit < least else None


def _is_slip(hypothesis: Hypothesis) -> bool:
    """Tell whether a hypothesis is that of a module that the gyro contradicts at times."""
    return hypothesis.changes[0].kind == OUTSIDER


def _is_harmless(hypothesis: Hypothesis) -> bool:
    """Tell whether a hypothesis calls for no correction: slip, or what calibration will find."""
    return _is_slip(hypothesis) or hypothesis.is_negligible


def _untold(best: Hypothesis, singles: list[Hypothesis]) -> tuple[Change, ...]:
    """Return the changes that fit as well as none."""
    return tuple(single.changes[0] for single in singles
                 if single.misfit < best.misfit + MARGIN)


def _same(first: tuple[Change, ...], second: tuple[Change, ...]) -> bool:
    """Tell whether changes mean the same: a direction and half a turn of offset do."""
    return {_meaning(change) for change in first} == {_meaning(change) for change in second}


def _meaning(change: Change) -> tuple[str, tuple[int, ...]]:
    """Return what identifies a change whatever its number is."""
    if change.kind == OFFSET and change.value is not None and (
            abs(wrap_angle(change.value - np.pi)) < np.radians(3.0)):
        return DRIVE_REVERSED, change.modules
    return change.kind, change.modules


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
