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

"""A verdict as a report for people: one line for each joint, notes, and parameters to paste."""

from collections.abc import Sequence

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.checking.changes import (
    AXES, Change, CROSSED, DRIVE_REVERSED, DRIVES_EXCHANGED, DRIVES_MISNAMED, EXCHANGED,
    GYRO_DEGREES, GYRO_REVERSED, MIRRORED_X, MIRRORED_Y, OFFSET, ORDER, OUTSIDER, RADIUS,
    STEERING_REVERSED, STEERINGS_EXCHANGED, STEERINGS_MISNAMED)
from swerve_kinematics.core.checking.joints import BASE, DRIVE, MODULE, STEERING
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.core.checking.wording import (
    change_in_words, fault_in_words, GYRO, modules_of)
from swerve_kinematics.tools.check.corrections import corrections, is_contradicted
from swerve_kinematics.tools.check.notes import notes

DRIVE_ROWS = (DRIVE_REVERSED, RADIUS, DRIVES_EXCHANGED, DRIVES_MISNAMED, EXCHANGED, CROSSED, ORDER,
              OUTSIDER)
STEERING_ROWS = (STEERING_REVERSED, OFFSET, STEERINGS_EXCHANGED, STEERINGS_MISNAMED, EXCHANGED,
                 CROSSED, ORDER, OUTSIDER)
GYRO_ROWS = (GYRO_REVERSED, GYRO_DEGREES)
LAYOUT_ROWS = (AXES, MIRRORED_X, MIRRORED_Y)
# Numbers that a drive does not tell are a matter of calibration.
NUMBERS = (OFFSET, RADIUS, OUTSIDER)
ALL_WELL, WRONG, UNKNOWN = 0, 1, 2
# No wheel was seen to do so, but the base moved as if it did.
ROLLS = 'wheel rolls differently than described while its module turns - correct the ratio'


def exit_code(verdict: Verdict) -> int:
    """Return 0 if all is well, 1 if something is wrong, 2 if this drive does not tell what."""
    if verdict.is_wrong and (verdict.joints or verdict.gyro or not verdict.is_ambiguous):
        return WRONG
    if verdict.is_wrong:
        return UNKNOWN
    if not verdict.is_moving or any(change.kind not in NUMBERS for change in verdict.untold):
        return UNKNOWN
    return ALL_WELL


def report(parameters: NodeParameters, verdict: Verdict, period: float = 0.0,
           is_still: bool = False) -> str:
    """
    Return what a check found, for people and as parameters.

    Parameters
    ----------
    parameters : NodeParameters
        The description that was checked.
    verdict : Verdict
        What was found.
    period : float
        At which drive joints were found to wrap [rad]; 0 if they do not.
    is_still : bool
        Whether the base stood, so that neither gyro nor layout were seen.

    Returns
    -------
    str
        Of several lines; the last ones are YAML where parameters mend what is wrong.

    """
    lines = [f'{row:<28} {state}' for row, state in _table(parameters, verdict, is_still)]
    told = notes(verdict, parameters.layout.module_names, parameters.gyro_source != 'none',
                 is_undecided=exit_code(verdict) == UNKNOWN)
    lines += ['', *told, *([''] if told else [])]
    lines += corrections(parameters, verdict, period)
    return '\n'.join(lines).rstrip()


def _table(parameters: NodeParameters, verdict: Verdict,
           is_still: bool) -> list[tuple[str, str]]:
    """Return the rows of the table: what, and how it is."""
    layout = parameters.layout
    rows = []
    for joints, joint, kinds in ((layout.drive_joints, DRIVE, DRIVE_ROWS),
                                 (layout.steering_joints, STEERING, STEERING_ROWS)):
        for module, name in enumerate(joints):
            faults = [' - '.join(fault_in_words(fault, layout.module_names))
                      for fault in verdict.joints if module in fault.modules
                      and fault.joint in (joint, MODULE, BASE)]
            rows.append((name, _state(verdict, kinds, layout.module_names, faults, module)))
    if is_still:
        return rows
    if verdict.rolls:
        whose = modules_of([at for at, roll in enumerate(verdict.rolls) if roll],
                           layout.module_names)
        rows.append(('drive_coupling_ratio', f'{whose}: {ROLLS}'))
    gyro = [] if verdict.gyro is None else [GYRO[verdict.gyro]]
    if parameters.gyro_source != 'none':
        rows.append(('gyro', _state(verdict, GYRO_ROWS, layout.module_names, gyro)))
    rows.append(('module_x, module_y', _state(verdict, LAYOUT_ROWS, layout.module_names, [])))
    return rows


def _state(verdict: Verdict, kinds: Sequence[str], names: Sequence[str], faults: list[str],
           module: int | None = None) -> str:
    """Return what is wrong of certain kinds, with one of the modules or not."""
    def concerns(change: Change) -> bool:
        return change.kind in kinds and (module is None or module in change.modules)

    changes = () if verdict.is_ambiguous else verdict.changes
    wrong = faults + [' - '.join(change_in_words(change, names))
                      for change in changes
                      if concerns(change) and not is_contradicted(change, verdict)]
    if wrong:
        return '; '.join(words.removeprefix(f'{names[module]}: ') if module is not None else words
                         for words in wrong)
    if not verdict.is_moving:
        return 'unknown'
    if module in verdict.slipping and OUTSIDER in kinds:
        return 'ok, but slipped or dragged at times'
    possible = verdict.untold if not verdict.is_ambiguous else [
        change for changes in (verdict.changes, *verdict.alternatives) for change in changes]
    untold = {change.kind for change in possible
              if concerns(change) and (verdict.is_ambiguous or change.kind not in NUMBERS)}
    return f'not ruled out: {", ".join(sorted(untold))}' if untold else 'ok'
