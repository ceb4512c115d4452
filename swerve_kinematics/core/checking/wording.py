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

"""What a check found, in words: what is wrong with which module, and what to look at."""

from typing import Sequence

import numpy as np

from swerve_kinematics.core.checking.changes import (
    AXES, Change, CROSSED, DRIVE_REVERSED, DRIVES_EXCHANGED, DRIVES_MISNAMED, EXCHANGED,
    GYRO_DEGREES, GYRO_REVERSED, MIRRORED_X, MIRRORED_Y, OFFSET, ORDER, OUTSIDER, RADIUS,
    STEERING_REVERSED, STEERINGS_EXCHANGED, STEERINGS_MISNAMED)
from swerve_kinematics.core.checking.gyro_faults import (
    FROZEN, RATE_OPPOSED, SILENT, YAW_FROZEN)
from swerve_kinematics.core.checking.joints import (
    AGAINST, ASTRAY, BASE, CROOKED, DRIVE, JointFault, MODULE, RACES, STANDS, STEERING,
    UNSEEN)
from swerve_kinematics.core.geometry.angles import wrap_angle

CHANGES = {
    DRIVE_REVERSED: ('drive counts the wrong way round (or steering offset wrong by 180 degrees)',
                     'invert its drive_directions'),
    STEERING_REVERSED: ('steering joint counts clockwise', 'invert its steering_directions'),
    EXCHANGED: ('joints swapped', 'swap their cables, their module_x and module_y, or their '
                'names in parameters and controllers'),
    CROSSED: ('joints swapped, with mirrored drives',
              'swap their cables; or their module_x and module_y, or names, and invert the '
              'drive_directions of both'),
    DRIVES_EXCHANGED: ('drive joints swapped',
                       'swap their cables, or their names in drive_joint_names and controller'),
    STEERINGS_EXCHANGED: ('steering joints swapped', 'swap their cables, or their names in '
                          'steering_joint_names and controller'),
    DRIVES_MISNAMED: ('each drive reads what the other does',
                      'swap their names in drive_joint_names, or in controller or driver'),
    STEERINGS_MISNAMED: ('each steering reads what the other does',
                         'swap their names in steering_joint_names, or in controller or driver'),
    ORDER: ('joints in a different order', 'put module_x and module_y in their order, or the '
            'names in parameters and controllers'),
    AXES: ('x and y swapped', 'swap module_x and module_y'),
    MIRRORED_X: ('x of the modules has the wrong sign', 'module_x is positive forward'),
    MIRRORED_Y: ('y of the modules has the wrong sign', 'module_y is positive to the left'),
    GYRO_REVERSED: ('gyro turns the wrong way round (or every drive does)',
                    'if an IMU is mounted upside down: imu_orientation [3.14159, 0, 0]; if it is '
                    'a gyro joint: invert it in its driver; or invert all drive_directions'),
    GYRO_DEGREES: ('gyro reports degrees',
                   'convert to rad and rad/s in its driver: no parameter does that'),
}
# The same for more than two modules.
RINGS = {
    DRIVES_EXCHANGED: ('drive joints in a different order',
                       'reorder their cables, or their names in drive_joint_names and controller'),
    STEERINGS_EXCHANGED: ('steering joints in a different order', 'reorder their cables, or their '
                          'names in steering_joint_names and controller'),
    DRIVES_MISNAMED: ('commands and readings of the drives in different orders',
                      'reorder drive_joint_names, or the names in controller or driver'),
    STEERINGS_MISNAMED: ('commands and readings of the steerings in different orders',
                         'reorder steering_joint_names, or the names in controller or driver'),
}
GYRO = {
    SILENT: 'gyro is silent: check its topic or joint name, its power and gyro_source',
    FROZEN: 'gyro stands still while the wheels turn the base: restart or replace it',
    RATE_OPPOSED: "gyro's rate turns the other way than its yaw - if the IMU is mounted upside "
                  'down: imu_orientation [3.14159, 0, 0]; else its driver counts one of them '
                  'the wrong way round',
    YAW_FROZEN: "gyro's yaw stands still although its rate shows a turn: a driver without "
                'orientation',
}
UNSEEN_ADVICE = ('does the driver report and take rad, not degrees or turns? Or does it report '
                 'its commands, and the motor has no power?')
STOPPED = 'emergency stop engaged, motors without power, or commands not received?'
JOINTS = {
    (BASE, STANDS): ('no joint moves when commanded', STOPPED),
    (MODULE, STANDS): ('both joints stand still',
                       'feedback frozen, cable unplugged, or motor controller off?'),
    (DRIVE, STANDS): ('drive stands still', 'motor without power, gear stuck, or encoder dead?'),
    (DRIVE, AGAINST): ('drive reads the opposite of its command',
                       'motor or encoder is the wrong way round: invert one of them'),
    (DRIVE, ASTRAY): ('drive does not follow its command',
                      'wheel spins or is held, or a ratio differs between motor and encoder'),
    (STEERING, STANDS): ('steering stands still',
                         'motor without power, gear stuck, or encoder dead?'),
    (STEERING, AGAINST): ('steering reads the opposite of its command',
                          'motor or encoder is the wrong way round: invert one of them'),
    (STEERING, ASTRAY): ('steering does not follow its command',
                         'joint wired to another module, or a loose coupling?'),
    (STEERING, RACES): ('steering turns on and on, faster than it can',
                        'does the driver report degrees, or apply its ratio to commands but '
                        'not to readings?'),
    (DRIVE, UNSEEN): ('drive hardly moves although its reading says so', UNSEEN_ADVICE),
    (STEERING, UNSEEN): ('steering hardly moves although its reading says so', UNSEEN_ADVICE),
    (STEERING, CROOKED): ('wheel does not point straight ahead where its offset says',
                          'turn it straight ahead by hand, and put what its joint reads into '
                          'steering_offsets; or a wrong steering_ratio, or a driver that does '
                          'not use rad?'),
}
# Where none of the joints follows its command, it is seldom the joints.
NONE_FOLLOWS = {
    (DRIVE, ASTRAY): 'does the driver report rad, and take rad/s? Or do all wheels spin, or are '
                     'they held?',
    (STEERING, ASTRAY): 'does the driver report and take rad, not degrees or turns?',
    (MODULE, STANDS): STOPPED, (DRIVE, STANDS): STOPPED, (STEERING, STANDS): STOPPED,
}


def modules_of(chosen: Sequence[int], names: Sequence[str]) -> str:
    """Return the names of modules, as people read them."""
    if len(chosen) == len(names) > 1:
        return 'all modules'
    return ', '.join(names[module] for module in chosen)


def change_in_words(change: Change, names: Sequence[str]) -> tuple[str, str]:
    """
    Return what is wrong by a change, and what to do.

    Parameters
    ----------
    change : Change
        What a check found.
    names : sequence of str (n,)
        Of the modules.

    Returns
    -------
    wrong, advice : str

    """
    value = change.value or 0.0
    if change.kind == OFFSET:
        degrees = np.degrees(wrap_angle(value))
        wrong = f'steering offset wrong by {degrees:.0f} degrees'
        advice = 'correct its steering_offsets'
    elif change.kind == RADIUS:
        factor = f'{value:.2f}' if value > 0.1 else f'{value:.2g}'
        wrong = f'wheel radius {factor} times the configured one'
        advice = 'measure wheel_radii' + (
            ' and drive_ratios (or the scale of the gyro, or of the layout)'
            if len(change.modules) == len(names) else ' and its drive ratio')
    elif change.kind == OUTSIDER:
        wrong, advice = 'does not fit the motion of the others', 'look at its wheel and joints'
    else:
        known = RINGS if change.kind in RINGS and len(change.modules) > 2 else CHANGES
        wrong, advice = known[change.kind]
    whose = modules_of(change.modules, names)
    if change.kind == ORDER and len(change.modules) == len(names):
        whose = ''
    return (f'{whose}: {wrong}' if whose else wrong), advice


def fault_in_words(fault: JointFault, names: Sequence[str]) -> tuple[str, str]:
    """Return what is wrong with joints, and what to look at."""
    kind = fault.joint, fault.fault
    wrong, advice = JOINTS[kind]
    if len(fault.modules) == len(names) > 1:
        advice = NONE_FOLLOWS.get(kind, advice)
    return (wrong if fault.joint == BASE else f'{modules_of(fault.modules, names)}: {wrong}',
            advice)
