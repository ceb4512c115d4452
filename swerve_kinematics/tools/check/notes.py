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

"""What people should know of a verdict besides the state of each joint."""

from collections.abc import Iterator, Sequence

from swerve_kinematics.core.checking.changes import (
    Change, DRIVE_REVERSED, GYRO_REVERSED, RADIUS, STEERING_REVERSED)
from swerve_kinematics.core.checking.joints import AGAINST, DRIVE, JointFault
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.core.checking.wording import change_in_words, modules_of
from swerve_kinematics.core.geometry.windows import LONGEST_STEP

# What drives and readings cannot know.
ONLY_THE_EYE = ('A reversed gyro and drives that all count backwards look the same in the data:',
                'watch whether the base rolls forward when it is told to.')
# All that the gyro tells of a base whose wheels agree is the scale of its turns.
ONLY_A_TAPE = ('Wrong radii of all wheels, a wrong scale of the gyro and a wrong layout look the',
               'same in the data: measure a wheel and the layout before you paste.')


def notes(verdict: Verdict, names: Sequence[str], has_gyro: bool,
          is_undecided: bool) -> list[str]:
    """
    Return what people should know of the verdict, as lines.

    Parameters
    ----------
    verdict : Verdict
        What was found.
    names : sequence of str (n,)
        Of the modules.
    has_gyro : bool
        Whether the base has a gyro.
    is_undecided : bool
        Whether the drive does not tell if, or what, something is wrong.

    """
    findings = [*_explanations(verdict, names), *_doubts(verdict, names)]
    if not verdict.is_moving and not verdict.joints:
        findings.insert(0, 'The base did not move for long enough: it takes at least 2 s, and '
                        f'20 s are better, with samples {LONGEST_STEP:g} s apart or less.')
    if (is_undecided or verdict.alternatives) and verdict.missing:
        findings.append('A drive with more of this motion would decide: '
                        f'{", ".join(verdict.missing)}.')
    if is_undecided and not findings:
        findings.append(
            'This drive does not decide what is not ruled out: drive longer, or check on blocks.'
            if has_gyro else
            'Without a gyro, driving does not decide what is not ruled out: check on blocks.')
    return findings + [*_cautions(verdict, len(names))]


def _explanations(verdict: Verdict, names: Sequence[str]) -> Iterator[str]:
    """Yield which changes explain the drive, how surely, and which joints they tell of."""
    if verdict.is_ambiguous:
        yield 'Something is wrong, but this drive does not decide which of these:'
        for other in (verdict.changes, *verdict.alternatives):
            yield '  ' + _in_words(other, names)
    elif verdict.changes and verdict.hypothesis is not None:
        yield 'These changes explain the drive' + (
            ' better than any others.' if not verdict.alternatives else
            f' with a probability of {_per_cent(verdict.confidence)} %. Others that may explain '
            'it:')
        for other in verdict.alternatives:
            yield '  ' + _in_words(other, names)
    if verdict.leaves_more:
        yield 'Something else seems wrong as well: check again on blocks, one module at a time.'
    if verdict.hypothesis is not None:
        for fault in verdict.joints:
            if fault.fault == AGAINST:
                yield _which_is_reversed(fault, verdict, names)


def _doubts(verdict: Verdict, names: Sequence[str]) -> Iterator[str]:
    """Yield what may be wrong, or is, without a change that is sure to mend it."""
    if verdict.suspect is not None:
        yield ('The drive is too short to be sure, but perhaps: '
               + change_in_words(verdict.suspect, names)[0])
    if verdict.unexplained:
        yield ('The wheels contradict each other or the gyro, and no single change or pair of '
               'changes explains it: check on blocks.')


def _cautions(verdict: Verdict, count: int) -> Iterator[str]:
    """Yield what a drive of a base with so many modules cannot tell, or not well enough."""
    if verdict.needs_calibration:
        yield ('Radii, offsets or the scale of the gyro seem a little wrong: swerve_calibrate '
               'measures them.')
    if not verdict.is_seen and any(
            change.kind == GYRO_REVERSED for change in verdict.changes):
        yield from ONLY_THE_EYE
    if any(change.kind == RADIUS and len(change.modules) == count and not change.is_gear
           for change in verdict.changes):
        yield from ONLY_A_TAPE


def _per_cent(confidence: float) -> str:
    """Return a probability, below 100 % since there are others."""
    return f'{min(100.0 * confidence, 99.0):.0f}'


def _in_words(changes: Sequence[Change], names: Sequence[str]) -> str:
    """Return several changes as a line."""
    return ', and '.join(change_in_words(change, names)[0] for change in changes)


def _which_is_reversed(fault: JointFault, verdict: Verdict, names: Sequence[str]) -> str:
    """Return whether motor or encoder is the wrong way round, by how the base turned."""
    kind = DRIVE_REVERSED if fault.joint == DRIVE else STEERING_REVERSED
    is_encoder = (kind, fault.modules) in [
        (change.kind, change.modules) for change in verdict.changes]
    return (f'{modules_of(fault.modules, names)}: the motion of the base shows that its '
            f'{fault.joint} {"encoder" if is_encoder else "motor"} must be inverted.')
