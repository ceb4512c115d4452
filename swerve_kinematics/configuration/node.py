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

"""The parameters of swerve_node: declared, validated together, frozen."""

from dataclasses import dataclass, fields
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.configuration.declarations import Declaration, DOUBLES, refuse, Values
from swerve_kinematics.configuration.layout import Layout, LAYOUT_DECLARATIONS, layout_from
from swerve_kinematics.configuration.limits import (
    LIMIT_DECLARATIONS, limits_from, QUIET_DECLARATION)
from swerve_kinematics.configuration.noise import NOISE_DECLARATIONS, noise_from
from swerve_kinematics.configuration.validation import (
    per_module, refuse_unless_a_pair, refuse_unless_in)
from swerve_kinematics.core.control.controller import IDLE_MODES, UNREACHABLE_POLICIES
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise

IMU_USES = ('auto', 'orientation', 'rate')
GYRO_SOURCES = ('joint', 'imu', 'none')
COMMAND_INTERFACES = ('forward_command', 'joint_state')
# A base that goes on by itself for longer [s] is nobody's wish.
LONGEST_TIMEOUT = 120.0

NODE_DECLARATIONS = LAYOUT_DECLARATIONS + (
    Declaration('steering_lower_limits', DOUBLES,
                'Lowest module angle, one for all or one for each; empty: continuous', 'rad',
                plausible=3.0 * TURN, mistake='degrees'),
    Declaration('steering_upper_limits', DOUBLES,
                'Highest module angle, one for all or one for each; empty: continuous', 'rad',
                plausible=3.0 * TURN, mistake='degrees'),
    Declaration('gyro_source', 'joint', 'Source of the yaw: joint, imu or none'),
    Declaration('imu_orientation', DOUBLES,
                'Roll, pitch, yaw of the IMU in base_link; empty: from the static transforms, or '
                'along the axes of base_link', 'rad',
                plausible=TURN, mistake='degrees'),
    Declaration('imu_use', 'auto',
                'What to use of the IMU: orientation, rate, or auto (both, as far as they agree)'),
    # Off by 5 cm, an accelerometer helps half as much where wheels slip.
    Declaration('imu_position', [0.0, 0.0],
                'Position of the IMU, x and y from base_link, to judge the wheels by its '
                'accelerometer', 'm', plausible=10.0, mistake='millimetres'),
    # Drivers stamp 5 to 20 ms late; how much, only a drive tells.
    Declaration('imu_delay', 0.0,
                'How much later imu is stamped than joint_states; subtracted from its stamps. '
                'swerve_calibrate finds it', 's', plausible=0.2, mistake='milliseconds'),
    Declaration('gyro_timeout', 0.2,
                'Silence of the gyro after which the yaw comes from the wheels at the latest '
                '(fast gyros: after 0.05 s)', 's', minimum=1e-3, changeable=True,
                plausible=LONGEST_TIMEOUT, mistake='milliseconds'),
    Declaration('estimate_gyro_bias', True, 'Estimate and remove the bias of the gyro'),
    Declaration('enable_odom_tf', True, 'Broadcast the transform from odom to base_link'),
    Declaration('use_stamped_vel', False, 'Accept TwistStamped on cmd_vel instead of Twist'),
    Declaration('command_interface', 'forward_command',
                'forward_command: two Float64MultiArray messages; joint_state: two JointState '
                'messages'),
    Declaration('open_loop', False, 'Command the modules without feedback of their angles'),
    Declaration('control_rate', 50.0,
                'Rate of commands between cmd_vel messages; at rest at most 20 Hz', 'Hz',
                minimum=1.0, maximum=1000.0),
    Declaration('cmd_vel_timeout', 0.5, 'Silence of cmd_vel after which the base stops', 's',
                minimum=1e-3, changeable=True, plausible=LONGEST_TIMEOUT,
                mistake='milliseconds'),
    Declaration('feedback_timeout', 0.5,
                'Silence of the joint states after which the wheels stop', 's',
                minimum=1e-3, changeable=True, plausible=LONGEST_TIMEOUT,
                mistake='milliseconds'),
    Declaration('restamp_feedback', False,
                "Translate the feedback's stamps to the node's clock, keeping their intervals"),
    Declaration('center_of_rotation', [0.0, 0.0],
                'Point about which a pure rotation turns, from base_link', 'm', changeable=True,
                plausible=100.0, mistake='millimetres'),
    Declaration('field_centric', False,
                'Read Twist commands in the odom frame instead of the base frame',
                changeable=True),
    Declaration('unreachable_policy', 'project',
                'What to do with a command that a steering range does not allow; project: execute '
                'the nearest possible one; stop: come to rest'),
    Declaration('idle_mode', 'hold',
                'hold: keep the steering angles when stopped; lock: turn to the X pattern',
                changeable=True),
) + LIMIT_DECLARATIONS + (QUIET_DECLARATION,) + NOISE_DECLARATIONS


@dataclass(frozen=True)
class NodeParameters:
    """
    Everything that configures swerve_node.

    Each field has the name of the parameter it comes from; the others are `layout`, `limits`
    (infinite where a parameter is 0) and `noise`.
    """

    layout: Layout
    limits: ControllerLimits
    noise: OdometryNoise
    steering_lower_limits: NDArray[np.float64]
    steering_upper_limits: NDArray[np.float64]
    gyro_source: str
    imu_orientation: list[float]
    imu_use: str
    imu_position: list[float]
    imu_delay: float
    gyro_timeout: float
    estimate_gyro_bias: bool
    enable_odom_tf: bool
    use_stamped_vel: bool
    command_interface: str
    open_loop: bool
    control_rate: float
    cmd_vel_timeout: float
    feedback_timeout: float
    restamp_feedback: bool
    center_of_rotation: NDArray[np.float64]
    field_centric: bool
    idle_mode: str
    unreachable_policy: str


def parameters_from(values: Values) -> NodeParameters:
    """
    Return the configuration that the parameters describe, validated as a whole.

    Parameters
    ----------
    values : mapping
        Value by name, of NODE_DECLARATIONS.

    Returns
    -------
    NodeParameters

    Raises
    ------
    ParameterError
        If one does not fit its range, its choices or the others.

    """
    for declaration in NODE_DECLARATIONS:
        declaration.check(values[declaration.name])
    layout = layout_from(values)
    lower, upper = _steering_limits(values, len(layout.module_names))
    refuse_unless_in(values, 'gyro_source', GYRO_SOURCES)
    refuse_unless_in(values, 'unreachable_policy', UNREACHABLE_POLICIES)
    refuse_unless_in(values, 'imu_use', IMU_USES)
    if len(values['imu_orientation']) not in (0, 3):
        refuse('imu_orientation', values['imu_orientation'], 'must be [roll, pitch, yaw]')
    refuse_unless_a_pair(values, 'imu_position')
    refuse_unless_in(values, 'command_interface', COMMAND_INTERFACES)
    refuse_unless_in(values, 'idle_mode', IDLE_MODES)
    if layout.joints.is_coupled and not values['max_steering_rate']:
        refuse('max_steering_rate', 0.0, 'must be given if there is a drive_coupling_ratio, '
               'because the drive joint is commanded to turn along with its module')
    refuse_unless_a_pair(values, 'center_of_rotation')
    computed: dict[str, Any] = {
        'layout': layout,
        'limits': limits_from(values),
        'noise': noise_from(values),
        'steering_lower_limits': lower,
        'steering_upper_limits': upper,
        'center_of_rotation': np.array(values['center_of_rotation']),
    }
    as_given = {field.name: values[field.name] for field in fields(NodeParameters)
                if field.name not in computed}
    return NodeParameters(**computed, **as_given)


def _steering_limits(values: Values, count: int) -> tuple[
        NDArray[np.float64], NDArray[np.float64]]:
    """Return the lower and upper steering limits (n,), infinite for continuous joints."""
    lower = np.array(per_module(values, 'steering_lower_limits', count, default=-math.inf))
    upper = np.array(per_module(values, 'steering_upper_limits', count, default=math.inf))
    if np.any(np.isinf(lower) != np.isinf(upper)):
        refuse('steering_lower_limits', values['steering_lower_limits'],
               'must be given together with steering_upper_limits, or not at all')
    if np.any(lower >= upper):
        refuse('steering_lower_limits', values['steering_lower_limits'],
               f"must be below steering_upper_limits = {values['steering_upper_limits']}")
    if np.any(np.floor(upper / np.pi) < np.ceil(lower / np.pi)):
        refuse('steering_lower_limits', values['steering_lower_limits'],
               f"with steering_upper_limits = {values['steering_upper_limits']} a wheel cannot "
               'point ahead; limits count from there, not from where the joint reads 0')
    return lower, upper
