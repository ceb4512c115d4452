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

"""A verdict as a table, one line a joint, and as parameters to paste."""

from collections.abc import Sequence

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.checking.changes import (
    AXES, Change, CROSSED, DRIVE_REVERSED, DRIVES_EXCHANGED, DRIVES_MISNAMED, EXCHANGED,
    GYRO_DEGREES, GYRO_REVERSED, MIRRORED_X, MIRRORED_Y, OFFSET, ORDER, OUTSIDER, RADIUS,
    STEERING_REVERSED, STEERINGS_EXCHANGED, STEERINGS_MISNAMED)
from swerve_kinematics.core.checking.check import Verdict
from swerve_kinematics.core.checking.joints import (
    AGAINST, BASE, DRIVE, JointFault, MODULE, STEERING)
from swerve_kinematics.core.checking.mends import mended, Values
from swerve_kinematics.core.checking.wording import (
    change_in_words, fault_in_words, GYRO, modules_of)
from swerve_kinematics.core.geometry.windows import LONGEST_STEP

DRIVE_ROWS = (DRIVE_REVERSED, RADIUS, DRIVES_EXCHANGED, DRIVES_MISNAMED, EXCHANGED, CROSSED, ORDER,
              OUTSIDER)
STEERING_ROWS = (STEERING_REVERSED, OFFSET, STEERINGS_EXCHANGED, STEERINGS_MISNAMED, EXCHANGED,
                 CROSSED, ORDER, OUTSIDER)
GYRO_ROWS = (GYRO_REVERSED, GYRO_DEGREES)
LAYOUT_ROWS = (AXES, MIRRORED_X, MIRRORED_Y)
# Numbers that a drive does not tell are a matter of calibration.
NUMBERS = (OFFSET, RADIUS, OUTSIDER)
ALL_WELL, WRONG, UNKNOWN = 0, 1, 2
# What drives and readings cannot know.
ONLY_THE_EYE = ('A reversed gyro and drives that all count backwards look the same in the data:',
                'watch whether the base rolls forward when it is told to.')
# All that the gyro tells of a base whose wheels agree is the scale of its turns.
ONLY_A_TAPE = ('Wrong radii of all wheels, a wrong scale of the gyro and a wrong layout look the',
               'same in the data: measure a wheel and the layout before you paste.')
# No wheel was seen to do so, but the base moved as if it did.
ROLLS = 'wheel rolls otherwise than described while its module turns - correct the ratio'
MIXED_UP = EXCHANGED, CROSSED, ORDER
KEPT_NAMES = ('Paste the lines below, or swap the cables, not both. The lines move modules to',
              'where their joints are and leave all names, which no longer say where a module is.')


def parameters_of(parameters: NodeParameters) -> dict[str, Values]:
    """Return the parameters that a check can mend, one value for each module."""
    layout, joints = parameters.layout, parameters.layout.joints
    x, y = layout.kinematics.module_positions.T.tolist()
    values: dict[str, Values] = {
        'module_x': x, 'module_y': y, 'wheel_radii': list(joints.wheel_radii),
        'drive_joint_names': list(layout.drive_joints),
        'steering_joint_names': list(layout.steering_joints),
        'steering_offsets': list(joints.steering_offsets),
        'drive_coupling_ratio': list(joints.drive_coupling_ratios)}
    for kind, ratios in (('drive', joints.drive_ratios), ('steering', joints.steering_ratios)):
        values[f'{kind}_directions'] = [1.0 if ratio > 0.0 else -1.0 for ratio in ratios]
        values[f'{kind}_ratios'] = [abs(ratio) for ratio in ratios]
    return values


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
    names = parameters.layout.module_names
    lines = [f'{row:<28} {state}' for row, state in _table(parameters, verdict, is_still)]
    lines += ['', *_notes(verdict, names, parameters.gyro_source != 'none')]
    changes = [] if verdict.is_ambiguous else mendable(verdict)
    by_index = parameters.command_interface == 'forward_command'
    coupling: Values = _coupling(parameters, verdict)
    mends = mended({**parameters_of(parameters), 'drive_coupling_ratio': coupling},
                   changes, by_index)
    if verdict.rolls:
        mends.setdefault('drive_coupling_ratio', coupling)
    if by_index and any(change.kind in MIXED_UP for change in changes):
        lines += [*KEPT_NAMES, '']
    if period:
        mends['drive_joint_period'] = [period]
    if mends:
        lines += ['# for the parameter file:', *(
            f'{name}: {_yaml(entries)}' for name, entries in mends.items())]
    return '\n'.join(lines).rstrip()


def _coupling(parameters: NodeParameters, verdict: Verdict) -> list[float]:
    """Return the coupling ratios (n,) by which wheels roll as they were seen to."""
    joints = parameters.layout.joints
    rolls = verdict.rolls or [0.0] * len(joints.drive_ratios)
    return [ratio - roll / radius * gear for ratio, roll, radius, gear in zip(
        joints.drive_coupling_ratios, rolls, joints.wheel_radii, joints.drive_ratios)]


def mendable(verdict: Verdict) -> list[Change]:
    """Return the changes that parameters make: not where motor and encoder contradict."""
    moving = range(len(verdict.changes)) if verdict.hypothesis is None else (
        verdict.hypothesis.moving)
    return [change for at, change in enumerate(verdict.changes)
            if at in moving and change.kind != OUTSIDER and not _is_contradicted(change, verdict)]


def _is_contradicted(change: Change, verdict: Verdict) -> bool:
    """Tell whether a change reverses joints whose motor and encoder contradict each other."""
    joint = {DRIVE_REVERSED: DRIVE, STEERING_REVERSED: STEERING}.get(change.kind)
    against = {module for fault in verdict.joints
               if fault.fault == AGAINST and fault.joint == joint for module in fault.modules}
    return joint is not None and against.issuperset(change.modules)


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
                      if concerns(change) and not _is_contradicted(change, verdict)]
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


def _per_cent(confidence: float) -> str:
    """Return a probability, below 100 % since there are others."""
    return f'{min(100.0 * confidence, 99.0):.0f}'


def _notes(verdict: Verdict, names: Sequence[str], has_gyro: bool) -> list[str]:
    """Return what people should know of the verdict, as lines."""
    notes = []
    if not verdict.is_moving and not verdict.joints:
        notes.append('The base did not move for long enough: it takes at least 2 s, and 20 s are '
                     f'better, with samples {LONGEST_STEP:g} s apart or less.')
    if verdict.is_ambiguous:
        notes.append('Something is wrong, but this drive does not decide which of these:')
        notes += ['  ' + _in_words(other, names)
                  for other in (verdict.changes, *verdict.alternatives)]
    elif verdict.changes and verdict.hypothesis is not None:
        notes.append('These changes explain the drive'
                     + (' better than any others.' if not verdict.alternatives else
                        f' with a probability of {_per_cent(verdict.confidence)} %. Others that '
                        'may explain it:'))
        notes += ['  ' + _in_words(other, names) for other in verdict.alternatives]
    if verdict.leaves_more:
        notes.append('Something else seems wrong as well: check again on blocks, one module at a '
                     'time.')
    if verdict.hypothesis is not None:
        notes += [_which_is_reversed(fault, verdict, names) for fault in verdict.joints
                  if fault.fault == AGAINST]
    if verdict.suspect is not None:
        notes.append('The drive is too short to be sure, but perhaps: '
                     + change_in_words(verdict.suspect, names)[0])
    if verdict.unexplained:
        notes.append('The wheels contradict each other or the gyro, and no single change or pair '
                     'of changes explains it: check on blocks.')
    untold = exit_code(verdict) == UNKNOWN
    if (untold or verdict.alternatives) and verdict.missing:
        notes.append('A drive with more of this motion would decide: '
                     f'{", ".join(verdict.missing)}.')
    if untold and not notes:
        notes.append(
            'This drive does not decide what is not ruled out: drive longer, or check on blocks.'
            if has_gyro else
            'Without a gyro, driving does not decide what is not ruled out: check on blocks.')
    if verdict.needs_calibration:
        notes.append('Radii, offsets or the scale of the gyro seem a little wrong: '
                     'swerve_calibrate measures them.')
    if not verdict.is_seen and any(
            change.kind == GYRO_REVERSED for change in verdict.changes):
        notes += ONLY_THE_EYE
    if any(change.kind == RADIUS and len(change.modules) == len(names) and not change.is_gear
           for change in verdict.changes):
        notes += ONLY_A_TAPE
    return notes + [''] if notes else []


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


def _yaml(entries: Values) -> str:
    """Return a list as YAML, floats with their points."""
    if len(entries) == 1 and isinstance(entries[0], float):
        return f'{entries[0]:.6f}'
    return '[' + ', '.join(entry if isinstance(entry, str) else repr(round(entry, 6))
                           for entry in entries) + ']'
