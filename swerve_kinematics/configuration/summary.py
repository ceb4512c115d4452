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

"""What was understood of the parameters, in a line that a person can check at a glance."""

import math
from typing import Iterable, Sequence

import numpy as np

from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.configuration.limits import LIMIT_DECLARATIONS
from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.configuration.simulator import SimulatorParameters

# How a remark on what is probably a mistake begins.
REMARK = '(CHECK: '
# A base that goes on in silence for longer than this [s] is worth a remark.
LONGEST_SILENCE = 1.0
# Words in names of modules: which axis they speak of, which of them lies further along it, and
# how the other one is said to lie where it does not.
OPPOSITES = ((0, 'front', 'rear', 'ahead of'), (0, 'front', 'back', 'ahead of'),
             (1, 'left', 'right', 'left of'))
# A base that is larger than so many radii of its wheels was not measured in the same unit.
LARGEST_BASE = 100.0

# Accelerations that no wheels can give a base, of any size, and the unit that a limit beyond one
# may have been meant in. It is not refused: some write a great number for no limit.
IMPOSSIBLE = {'m/s^2': (100.0, 'mm/s^2'), 'rad/s^2': (200.0, 'deg/s^2')}


def _remark(text: str) -> str:
    """Return what to add to something that is probably a mistake."""
    return f' {REMARK}{text})'


def _base(layout: Layout) -> str:
    """Return number, extent and joints of the modules, and what is odd about them."""
    length, width = np.ptp(layout.kinematics.module_positions, axis=0)
    radii = layout.joints.wheel_radii
    odd = _remark('small for the base; one of them in inches or centimetres?') if (
        max(length, width) > LARGEST_BASE * max(radii)) else ''
    return (f'{len(layout.module_names)} modules over {length:.3g} m x {width:.3g} m'
            f'{_contradiction(layout)}{_mixed_up(layout)}, '
            f'wheel radius {_range(radii)} m{odd}{_joints(layout)}')


def _contradiction(layout: Layout) -> str:
    """Return which module is where its name says it is not, nothing if there is none."""
    places = list(zip(layout.module_names, layout.kinematics.module_positions.tolist()))
    for axis, more, less, relation in OPPOSITES:
        one = min(((place[axis], name) for name, place in places if more in name), default=None)
        other = max(((place[axis], name) for name, place in places if less in name), default=None)
        if one and other and one[0] <= other[0]:
            return _remark(f'{one[1]} is not {relation} {other[1]}; x and y swapped, a sign, '
                           'or a name?')
    return ''


def _mixed_up(layout: Layout) -> str:
    """Return which joint a module has by whose name it is another one's, nothing if none is."""
    modules = layout.module_names
    for kind, joints in (('drive', layout.drive_joints), ('steering', layout.steering_joints)):
        owners = [_owner(joint, modules) for joint in joints]
        # One name alone may contain a module's by chance, as any drive joint does that of `d`.
        if set(owners) != set(modules):
            continue
        for module, joint, owner in zip(modules, joints, owners):
            if owner != module:
                return _remark(f'{kind} joint of {module} is {joint}; {kind}_joint_names in '
                               'another order than module_names?')
    return ''


def _owner(joint: str, modules: Sequence[str]) -> str:
    """Return the module whose name that of a joint contains, the longest one; empty if none."""
    return max((module for module in modules if module in joint), key=len, default='')


def _joints(layout: Layout) -> str:
    """Return the ratios that are not 1, which joints are reversed, and a coupling."""
    parts = []
    for kind, ratios in (('drive', layout.joints.drive_ratios),
                         ('steering', layout.joints.steering_ratios)):
        sizes = [abs(ratio) for ratio in ratios]
        if any(size != 1.0 for size in sizes):
            # Gears make motors turn faster than what they move.
            odd = _remark('below 1; the wrong way round?') if min(sizes) < 1.0 else ''
            parts.append(f', {kind} ratio {_range(sizes)}{odd}')
        backwards = [name for name, ratio in zip(layout.module_names, ratios) if ratio < 0.0]
        if backwards:
            parts.append(f', reversed {kind}: {_list(backwards)}')
    if period := layout.joints.drive_period:
        # A period in radians contains pi.
        odd = _remark('not a multiple of pi; in degrees, turns or counts?') if (
            period == round(period)) else ''
        parts.append(f', drive joints wrap after {period:.6g} rad{odd}')
    if layout.joints.is_coupled:
        parts.append(f', coupling ratio {_range(layout.joints.drive_coupling_ratios)}')
    return ''.join(parts)


def _range(values: Sequence[float]) -> str:
    """Return the one value there is, or the least and the greatest."""
    return ' to '.join(f'{value:.4g}' for value in dict.fromkeys((min(values), max(values))))


def _list(names: Iterable[str]) -> str:
    """Return names in a row, or that there are none."""
    return ', '.join(names) or 'none'


def summary(parameters: NodeParameters) -> str:
    """
    Return what swerve_node has understood.

    Parameters
    ----------
    parameters : NodeParameters
        Of swerve_node.

    Returns
    -------
    str
        A line.

    """
    gyro = {'joint': f'joint {parameters.layout.gyro_joint}',
            'imu': _imu(parameters)}.get(parameters.gyro_source, parameters.gyro_source)
    if parameters.gyro_source != 'imu' and (given := _imu_given(parameters)):
        gyro += _remark(f'{given} without effect; gyro_source: imu?')
    off = _list(limit.name for limit in LIMIT_DECLARATIONS
                if math.isinf(getattr(parameters.limits, limit.name)))
    return (f'{_base(parameters.layout)}{_end_stops(parameters)}; gyro: {gyro}; commands: '
            f'{parameters.command_interface}{_ways(parameters)}; limits turned off: {off}'
            f'{_beyond_reach(parameters)}{_blind_ways(parameters)}{_frames(parameters.layout)}')


def _ways(parameters: NodeParameters) -> str:
    """Return what is out of the ordinary in the way the base takes its commands, if anything."""
    parts = []
    if parameters.use_stamped_vel:
        parts.append(', cmd_vel: TwistStamped')
    if parameters.field_centric:
        parts.append(', field-centric' + (
            _remark("no effect: a TwistStamped's frame decides") if parameters.use_stamped_vel
            else _remark('without a gyro?') if parameters.gyro_source == 'none' else ''))
    x, y = parameters.center_of_rotation.tolist()
    if x or y:
        farthest = np.abs(parameters.layout.kinematics.module_positions).max(axis=0)
        is_outside = abs(x) > farthest[0] or abs(y) > farthest[1]
        parts.append(f', turning about ({x:g}, {y:g}) m'
                     + (', outside of the modules' if is_outside else ''))
    if parameters.open_loop:
        parts.append(', open loop: silent joint_states do not stop it')
    if parameters.idle_mode != 'hold':
        parts.append(', wheels in an X when stopped')
    return ''.join(parts)


def _beyond_reach(parameters: NodeParameters) -> str:
    """Return the limits of accelerations that are too great to limit any, if there are some."""
    remarks = []
    for limit in LIMIT_DECLARATIONS:
        value = getattr(parameters.limits, limit.name)
        possible, unit = IMPOSSIBLE.get(limit.unit, (math.inf, ''))
        if possible < value < math.inf:
            remarks.append(f'; {limit.name}: {value:g} {limit.unit}'
                           + _remark(f'limits nothing; in {unit}?'))
    return ''.join(remarks)


def _blind_ways(parameters: NodeParameters) -> str:
    """Return how far the base may go by a command or feedback that is long gone, if it may."""
    fastest = parameters.limits.max_linear_speed
    times = ((name, getattr(parameters, name)) for name in ('cmd_vel_timeout', 'feedback_timeout'))
    return ''.join(
        f'; {name}: {seconds:g} s' + _remark('drives on for so long in silence' + (
            f', up to {seconds * fastest:.3g} m' if math.isfinite(fastest) else ''))
        for name, seconds in times if seconds > LONGEST_SILENCE)


def _end_stops(parameters: NodeParameters) -> str:
    """Return the ranges of the modules that cannot turn all the way round, if there are any."""
    limits = zip(np.degrees(parameters.steering_lower_limits).tolist(),
                 np.degrees(parameters.steering_upper_limits).tolist())
    ranges = dict.fromkeys(f'{lower:.4g} to {upper:.4g}' for lower, upper in limits
                           if math.isfinite(lower))
    return f", steering {' or '.join(ranges)} degrees" if ranges else ''


def _frames(layout: Layout) -> str:
    """Return the frames where they have names of their own."""
    frames = layout.odom_frame, layout.base_frame
    return '' if frames == ('odom', 'base_link') else f"; frames: {', '.join(frames)}"


def _imu_given(parameters: NodeParameters) -> str:
    """Return the names of the parameters that describe an IMU."""
    return ', '.join(name for name, is_given in (
        ('imu_orientation', bool(parameters.imu_orientation)),
        ('imu_use', parameters.imu_use != 'auto'),
        ('imu_position', any(parameters.imu_position)),
        ('imu_delay', bool(parameters.imu_delay))) if is_given)


def _imu(parameters: NodeParameters) -> str:
    """Return how the IMU is mounted, and how late it is."""
    x, y = parameters.imu_position
    mounting = ', '.join(f'{angle:g}' for angle in parameters.imu_orientation)
    turned = f'by ({mounting}) rad' if mounting else 'as /tf_static tells, if at all'
    return f'imu at ({x:g}, {y:g}) m, turned {turned}, {parameters.imu_delay:g} s late'


def simulator_summary(parameters: SimulatorParameters) -> str:
    """
    Return what swerve_sim has understood.

    Parameters
    ----------
    parameters : SimulatorParameters
        Of swerve_sim.

    Returns
    -------
    str
        A line.

    """
    return f'{_base(parameters.layout)}; joint states at {parameters.publish_rate:g} Hz'
