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

"""Watches while the base drives whether its joints and its gyro fit its description."""

from collections.abc import Generator, Iterator, Sequence
from operator import sub

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.checking.check import checking
from swerve_kinematics.core.checking.gyro_faults import FROZEN
from swerve_kinematics.core.checking.joints import (
    BASE, DRIVE, JointFault, LEAST_TIME, MODULE, RACING, STEERING)
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.core.checking.wording import change_in_words, fault_in_words, GYRO
from swerve_kinematics.ros.grading import Grading, Patience
from swerve_kinematics.ros.recent_drive import RecentDrive
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds

# The latest drive [s] is what a judgement rests on: enough for every kind of motion, and little
# enough for a fault that has just begun.
MEMORY = nanoseconds(6.0)
# Less than this [ns] shows nothing of any joint.
SHORTEST = nanoseconds(LEAST_TIME)
# Samples are kept at this pace [ns] at most, and those of a base at rest not at all.
PACE = nanoseconds(0.018)
# A judgement begins this long [ns] after the one before, and rests on so many new samples; where
# all was well, later each time: a judgement takes 2 ms, of a base before its calibration 30 ms.
INTERVAL, LONGEST_INTERVAL, LEAST_NEW = nanoseconds(1.0), nanoseconds(2.0), 5
# Pauses of the reasoning that one turn takes, about a millisecond each.
STEPS = 2
# A judgement rests on seconds of motion: it is reported at once, and grave when it lasts.
PATIENCE = Patience(warn=0.0, error=4.0, clear=3.0)
# What contradicts a description without a known cause may be a bad floor: it must last.
VAGUE_PATIENCE = Patience(warn=0.4, error=30.0, clear=3.0)
# More explanations than these besides the likeliest are not read.
OTHERS = 2
CONTRADICTION = 'the wheels contradict each other or the gyro'
SEVERAL = 'more than one thing seems wrong, among them perhaps'
FAILED = 'the drive could not be judged, please report this'
UNEXPLAINED = f'{CONTRADICTION} - check wiring and parameters with swerve_check'


class Watch:
    """
    Keeps the latest samples of a drive, and judges them bit by bit.

    Parameters
    ----------
    names : sequence of str (n,)
        Of the modules.
    positions : ndarray (n, 2)
        Of the modules, by the description [m].
    expects_gyro : bool
        Whether the base has a gyro.

    """

    def __init__(self, names: Sequence[str], positions: NDArray[np.float64],
                 expects_gyro: bool) -> None:
        """Start with nothing seen."""
        self._names, self._positions, self._expects_gyro = names, positions, expects_gyro
        self._drive = RecentDrive(len(names))
        self._last: tuple[int, Sequence[float], Sequence[float]] | None = None
        self._commanded: tuple[Sequence[float], Sequence[float]] = (
            [0.0] * len(names), [0.0] * len(names))
        self._new = 0
        self._thinking: Generator[None, None, Verdict] | None = None
        self._joints, self._base = Grading(PATIENCE), Grading(PATIENCE)
        self._vague = Grading(VAGUE_PATIENCE)
        self._failures: list[tuple[bool, str]] = []
        self._judged, self._interval = 0, INTERVAL

    def restart(self) -> None:
        """Forget the samples: what moved since is not known."""
        self._drive.clear()
        self._last = self._thinking = None
        self._new = self._judged = 0

    def add(self, stamp: int, distances: Sequence[float], angles: Sequence[float],
            yaw: float | None, yaw_rate: float | None) -> None:
        """
        Take a sample; lists are kept as they are.

        Parameters
        ----------
        stamp : int
            [ns].
        distances, angles : sequence of float (n,)
            Of the modules [m], [rad].
        yaw, yaw_rate : float or None
            Of the gyro [rad], [rad/s].

        """
        if self._last is not None:
            before, distances_before, angles_before = self._last
            if stamp < before + PACE:
                if stamp <= before:
                    self.restart()
                return
            if distances == distances_before and not any(self._commanded[0]) and not _race(
                    angles_before, angles, stamp - before):
                return
        self._last = stamp, distances, angles
        self._drive.add(stamp, distances, angles, yaw, yaw_rate, *self._commanded)
        self._new += 1

    def commanded(self, speeds: Sequence[float], angles: Sequence[float]) -> None:
        """Take the rim speeds [m/s] and module angles [rad] in force, and go on judging a bit."""
        self._commanded = speeds, angles
        try:
            self._think()
        except Exception as error:  # of who only looks on must not stop a base that drives
            self.restart()
            self._failures = [(False, f'{FAILED}: {error!r}')]

    def _think(self) -> None:
        """Begin a judgement, or go on with the one begun."""
        if self._thinking is None:
            self._begin()
            return
        try:
            for _ in range(STEPS):
                next(self._thinking)
        except StopIteration as end:
            self._thinking, self._failures = None, []
            self._take(end.value)

    def findings(self) -> list[tuple[bool, str]]:
        """Return whether each finding is grave, and its message."""
        return (self._joints.findings() + self._base.findings() + self._vague.findings()
                + self._failures)

    def _begin(self) -> None:
        """Begin a judgement if there is something new to judge."""
        if self._last is None or self._new < LEAST_NEW or (
                self._last[0] - self._judged < self._interval):
            return
        stamps = self._drive.stamps
        self._drive.forget_before(stamps[-1] - MEMORY)
        # What a long rest has pushed out is not there to be judged.
        self._new = min(self._new, len(stamps))
        if self._new < LEAST_NEW or stamps[-1] - stamps[0] < SHORTEST:
            return
        self._new, self._judged = 0, stamps[-1]
        self._thinking = checking(
            self._positions, self._drive.data(), self._expects_gyro, is_thorough=False)

    def _take(self, verdict: Verdict) -> None:
        """Grade what a judgement found, if it had anything to judge."""
        is_well = verdict.is_moving and not (verdict.is_wrong or verdict.suspect)
        self._interval = min(2 * self._interval, LONGEST_INTERVAL) if is_well else INTERVAL
        if not verdict.is_moving and not verdict.joints:
            return
        now = self._judged / NANOSECONDS
        for fault in verdict.joints:
            self._joints.forget(_replaced(fault, len(self._names)))
        self._joints.update({
            _key(fault.joint, fault.modules): ' - '.join(fault_in_words(fault, self._names))
            for fault in verdict.joints}, now)
        if not verdict.is_moving:
            return  # that shows nothing of gyro and description
        found = {}
        # Other faults of the gyro are found where its samples come in.
        if verdict.gyro == FROZEN:
            found['gyro'] = GYRO[FROZEN]
        if verdict.changes and not verdict.is_ambiguous:
            found['description'] = self._description(verdict)
        self._base.update(found, now)
        self._vague.update({'': vague for vague in [self._vague_message(verdict)] if vague}, now)

    def _description(self, verdict: Verdict) -> str:
        """Return what is wrong with the description, where there is something."""
        explanations = self._explanations(verdict)
        if verdict.leaves_more:
            return f'{SEVERAL}: {explanations[0][0]} - swerve_check tells them apart'
        return ', or: '.join(' - '.join(change) for change in explanations)

    def _explanations(self, verdict: Verdict) -> list[tuple[str, str]]:
        """Return the likeliest changes in words: what is wrong, and what to do."""
        return [change_in_words(changes[0], self._names)
                for changes in (verdict.changes, *verdict.alternatives[:OTHERS])]

    def _vague_message(self, verdict: Verdict) -> str | None:
        """Return what to say where the cause is not sure, None if there is nothing."""
        if verdict.is_ambiguous:
            wrong = ', or '.join(change for change, _ in self._explanations(verdict))
            return (f'{CONTRADICTION} - perhaps {wrong}; more of this motion would decide: '
                    f'{", ".join(verdict.missing)}')
        if verdict.suspect is not None:
            return f'{CONTRADICTION} - perhaps {change_in_words(verdict.suspect, self._names)[0]}'
        return UNEXPLAINED if verdict.unexplained else None


def _key(joint: str, modules: tuple[int, ...]) -> str:
    """Return what tells findings about joints apart; what is wrong with them does not."""
    return f'{joint} {modules}'


def _replaced(fault: JointFault, count: int) -> Iterator[str]:
    """Yield the keys of findings that a fault corrects: about more, or fewer, of these joints."""
    whole = fault.joint in (BASE, MODULE)
    for joint in (BASE, MODULE, DRIVE, STEERING) if whole else (BASE, fault.joint):
        for modules in (tuple(range(count)), *((module,) for module in fault.modules)):
            if (joint, modules) != (fault.joint, fault.modules):
                yield _key(joint, modules)


def _race(before: Sequence[float], angles: Sequence[float], elapsed: int) -> bool:
    """Tell whether a module turned faster than it can: it waits for its steering, not at rest."""
    farthest = RACING * elapsed / NANOSECONDS
    return any(abs(turn) > farthest for turn in map(sub, angles, before))
