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

"""A verdict as parameters to paste."""

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.checking.changes import (
    Change, CROSSED, DRIVE_REVERSED, EXCHANGED, ORDER, OUTSIDER, STEERING_REVERSED)
from swerve_kinematics.core.checking.joints import AGAINST, DRIVE, STEERING
from swerve_kinematics.core.checking.mends import mended, Values
from swerve_kinematics.core.checking.verdict import Verdict

MIXED_UP = EXCHANGED, CROSSED, ORDER
KEPT_NAMES = ('Paste the lines below, or swap the cables, not both. The lines move modules to',
              'where their joints are and leave all names, which no longer say where a module is.')


def corrections(parameters: NodeParameters, verdict: Verdict, period: float) -> list[str]:
    """
    Return the parameters that mend what is wrong, as lines of YAML with what to know of them.

    Parameters
    ----------
    parameters : NodeParameters
        The description that was checked.
    verdict : Verdict
        What was found.
    period : float
        At which drive joints were found to wrap [rad]; 0 if they do not.

    Returns
    -------
    list of str
        Empty if no parameter mends anything.

    """
    changes = [] if verdict.is_ambiguous else _mendable(verdict)
    by_index = parameters.command_interface == 'forward_command'
    coupling: Values = _coupling(parameters, verdict)
    mends = mended({**_parameters_of(parameters), 'drive_coupling_ratio': coupling},
                   changes, by_index)
    if verdict.rolls:
        mends.setdefault('drive_coupling_ratio', coupling)
    if period:
        mends['drive_joint_period'] = [period]
    notes = [*KEPT_NAMES, ''] if by_index and any(
        change.kind in MIXED_UP for change in changes) else []
    if mends:
        notes += ['# for the parameter file:', *(
            f'{name}: {_yaml(entries)}' for name, entries in mends.items())]
    return notes


def _parameters_of(parameters: NodeParameters) -> dict[str, Values]:
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


def _coupling(parameters: NodeParameters, verdict: Verdict) -> list[float]:
    """Return the coupling ratios (n,) by which wheels roll as they were seen to."""
    joints = parameters.layout.joints
    rolls = verdict.rolls or [0.0] * len(joints.drive_ratios)
    return [ratio - roll / radius * gear for ratio, roll, radius, gear in zip(
        joints.drive_coupling_ratios, rolls, joints.wheel_radii, joints.drive_ratios)]


def _mendable(verdict: Verdict) -> list[Change]:
    """Return the changes that parameters make: not where motor and encoder contradict."""
    moving = range(len(verdict.changes)) if verdict.hypothesis is None else (
        verdict.hypothesis.moving)
    return [change for at, change in enumerate(verdict.changes)
            if at in moving and change.kind != OUTSIDER and not is_contradicted(change, verdict)]


def is_contradicted(change: Change, verdict: Verdict) -> bool:
    """Tell whether a change reverses joints whose motor and encoder contradict each other."""
    joint = {DRIVE_REVERSED: DRIVE, STEERING_REVERSED: STEERING}.get(change.kind)
    against = {module for fault in verdict.joints
               if fault.fault == AGAINST and fault.joint == joint for module in fault.modules}
    return joint is not None and against.issuperset(change.modules)


def _yaml(entries: Values) -> str:
    """Return a list as YAML, floats with their points."""
    if len(entries) == 1 and isinstance(entries[0], float):
        return f'{entries[0]:.6f}'
    return '[' + ', '.join(entry if isinstance(entry, str) else repr(round(entry, 6))
                           for entry in entries) + ']'
