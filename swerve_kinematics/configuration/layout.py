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

"""The layout of a swerve base as parameters: what the node and the simulated base share."""

from dataclasses import dataclass

import numpy as np

from swerve_kinematics.configuration.declarations import Declaration, refuse, STRINGS, Values
from swerve_kinematics.configuration.joints import (
    JOINT_DECLARATIONS, joints_from, ModuleJoints)
from swerve_kinematics.configuration.validation import refuse_unusable_names
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

LAYOUT_DECLARATIONS = (
    Declaration('module_names', ['front_left', 'front_right', 'rear_left', 'rear_right'],
                'Modules, 2 or more; every per-module list follows this order'),
    Declaration('module_x', [0.3, 0.3, -0.3, -0.3],
                'Steering axis forward of base_link, one for each module', 'm',
                plausible=20.0, mistake='millimetres'),
    Declaration('module_y', [0.25, -0.25, 0.25, -0.25],
                'Steering axis left of base_link, one for each module', 'm',
                plausible=20.0, mistake='millimetres'),
    *JOINT_DECLARATIONS,
    Declaration('drive_joint_names', STRINGS,
                'Drive joints in module order; empty: MODULE_drive_joint'),
    Declaration('steering_joint_names', STRINGS,
                'Steering joints in module order; empty: MODULE_steering_joint'),
    Declaration('gyro_joint_name', 'gyro_joint',
                'Joint whose position is the yaw and whose velocity is the yaw rate'),
    Declaration('odom_frame_id', 'odom', 'Frame of the odometry'),
    Declaration('base_frame_id', 'base_link', 'Frame of the base'),
    Declaration('frame_prefix', '',
                'Put before both names, as by robot_state_publisher; for example robot1/'),
)


@dataclass(frozen=True)
class Layout:
    """
    Where the modules are and what their joints are called.

    Attributes
    ----------
    module_names : tuple of str (n,)
        In the order that every per-module array follows.
    kinematics : SwerveKinematics
        Built from the module positions.
    joints : ModuleJoints
        From the joints to the modules and back.
    drive_joints, steering_joints : tuple of str (n,)
        Joint names in module order.
    gyro_joint : str
        Joint whose position is the yaw and whose velocity is the yaw rate.
    odom_frame, base_frame : str
        Names of the frames that the odometry relates.

    """

    module_names: tuple[str, ...]
    kinematics: SwerveKinematics
    joints: ModuleJoints
    drive_joints: tuple[str, ...]
    steering_joints: tuple[str, ...]
    gyro_joint: str
    odom_frame: str
    base_frame: str


def layout_from(values: Values) -> Layout:
    """
    Return the layout that the parameters describe.

    Parameters
    ----------
    values : mapping
        Value by name, of LAYOUT_DECLARATIONS.

    Returns
    -------
    Layout

    Raises
    ------
    ParameterError
        If lengths disagree, names repeat, or the modules cannot be solved for.

    """
    names = values['module_names']
    refuse_unusable_names('module_names', names)
    count = len(names)
    for name in ('module_x', 'module_y'):
        if len(values[name]) != count:
            refuse(name, values[name], f'must have {count} entries, one for each of '
                   f"module_names = [{', '.join(names)}]")
    positions = np.column_stack((values['module_x'], values['module_y']))
    try:
        kinematics = SwerveKinematics(positions)
    except ValueError as error:
        refuse('module_x', values['module_x'], f"with module_y = {values['module_y']}: {error}")
    _refuse_modules_in_one_place(values)
    drives = _joint_names(values, 'drive_joint_names', '_drive_joint')
    steerings = _joint_names(values, 'steering_joint_names', '_steering_joint')
    for joint in drives:
        if joint in steerings:
            refuse('steering_joint_names', list(steerings), f'{joint} is also a drive joint')
    if values['gyro_joint_name'] in (*drives, *steerings):
        refuse('gyro_joint_name', values['gyro_joint_name'], 'is also the joint of a module')
    return Layout(
        tuple(names), kinematics, joints_from(values, count),
        drives, steerings, values['gyro_joint_name'],
        _frame(values, 'odom_frame_id'), _frame(values, 'base_frame_id'))


def default_layout() -> Layout:
    """Return the layout of a base of which no parameter is given."""
    return layout_from({layout.name: layout.initial for layout in LAYOUT_DECLARATIONS})


def _frame(values: Values, name: str) -> str:
    """Return the full name of a frame, which has to be one that tf2 takes."""
    frame, prefix = values[name], values['frame_prefix']
    if not frame:
        refuse(name, "''", 'must not be empty')
    if (prefix + frame).startswith('/'):
        refuse('frame_prefix' if prefix else name, prefix or frame, 'must not begin with a slash')
    if name != 'odom_frame_id' and frame == values['odom_frame_id']:
        refuse(name, frame, 'is also the odom_frame_id')
    return str(prefix + frame)


def _refuse_modules_in_one_place(values: Values) -> None:
    """Raise ParameterError if two modules stand in each other, as by a wrong sign."""
    place_of: dict[tuple[float, float], str] = {}
    for name, *place in zip(values['module_names'], values['module_x'], values['module_y']):
        other = place_of.setdefault((place[0], place[1]), name)
        if other != name:
            refuse('module_x', values['module_x'], f"with module_y = {values['module_y']}: "
                   f'{other} and {name} are in the same place: wrong sign?')


def _joint_names(values: Values, name: str, suffix: str) -> tuple[str, ...]:
    """Return the joint names given, or those made from the module names."""
    modules = values['module_names']
    joints = values[name] or [module + suffix for module in modules]
    refuse_unusable_names(name, joints)
    if len(joints) != len(modules):
        refuse(name, joints, f'must have {len(modules)} entries, one for each of module_names')
    return tuple(joints)
