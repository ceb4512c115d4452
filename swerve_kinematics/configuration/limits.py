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

"""The limits of the commands as parameters."""

import math

from swerve_kinematics.configuration.declarations import Declaration, refuse, UNBOUNDED, Values
from swerve_kinematics.core.control.limits import ControllerLimits

# Who gives a limit so close to 0 takes 0 for standstill, where it means no limit at all.
SMALLEST = 1e-6
# A base that takes longer than this [s] to stop from its top speed cannot be stopped in time: the
# limit that makes it so is taken for a mistake, such as one of unit.
LONGEST_STOP = 60.0


def _limit(name: str, default: float, description: str, unit: str,
           plausible: float = UNBOUNDED, mistake: str = '') -> Declaration:
    """Declare a limit that 0 turns off."""
    return Declaration(name, default, f'{description}; 0: no limit', unit, minimum=0.0,
                       changeable=True, plausible=plausible, mistake=mistake)


LIMIT_DECLARATIONS = (
    _limit('max_linear_speed', 3.0, 'Largest linear speed of the base', 'm/s',
           50.0, 'millimetres per second'),
    _limit('max_angular_speed', 6.0, 'Largest yaw rate of the base', 'rad/s',
           50.0, 'degrees per second'),
    _limit('max_linear_acceleration', 2.0, 'Largest linear acceleration', 'm/s^2'),
    _limit('max_linear_deceleration', 3.0, 'Largest linear deceleration', 'm/s^2'),
    _limit('max_angular_acceleration', 6.0, 'Largest change of the yaw rate', 'rad/s^2'),
    _limit('max_linear_jerk', 0.0, 'Largest change of the linear acceleration', 'm/s^3'),
    _limit('max_angular_jerk', 0.0, 'Largest change of the angular acceleration', 'rad/s^3'),
    _limit('max_module_speed', 4.0, 'Largest rim speed of a module', 'm/s',
           50.0, 'millimetres per second'),
    _limit('max_module_acceleration', 0.0, 'Largest acceleration of the rim speed of a module',
           'm/s^2'),
    _limit('max_steering_rate', 8.0, 'Largest steering rate of a module', 'rad/s',
           100.0, 'degrees per second'),
    _limit('max_grip_acceleration', 0.0,
           'Largest horizontal acceleration of a wheel contact over the ground', 'm/s^2'),
)
# Limits that alone may make a stop long, the speed it has to bring down, and the least they must
# be for each unit of it. With a jerk j, half of the speed goes while the deceleration grows, and
# half while it falls: v = j (t / 2)^2.
BY_ACCELERATION, BY_JERK = 1.0 / LONGEST_STOP, 4.0 / LONGEST_STOP ** 2
STOPS = (
    ('max_linear_deceleration', 'max_linear_speed', BY_ACCELERATION),
    ('max_grip_acceleration', 'max_linear_speed', BY_ACCELERATION),
    ('max_linear_jerk', 'max_linear_speed', BY_JERK),
    ('max_angular_acceleration', 'max_angular_speed', BY_ACCELERATION),
    ('max_angular_jerk', 'max_angular_speed', BY_JERK),
    ('max_module_acceleration', 'max_module_speed', BY_ACCELERATION))
QUIET_DECLARATION = Declaration(
    'min_steering_speed', 0.012,
    'Wheels only steer for commands of at least this rim speed, averaged over 0.1 s; 0: for any',
    'm/s', minimum=0.0, changeable=True, plausible=1.0, mistake='millimetres per second')


def limits_from(values: Values) -> ControllerLimits:
    """
    Return the limits that the parameters describe, infinite where one is 0.

    Parameters
    ----------
    values : mapping
        Value by name, of LIMIT_DECLARATIONS.

    Returns
    -------
    ControllerLimits

    Raises
    ------
    ParameterError
        If one is so small that nothing could move, or that a stop from the top speed would take
        longer than LONGEST_STOP.

    """
    for limit in LIMIT_DECLARATIONS:
        if 0.0 < values[limit.name] < SMALLEST:
            refuse(limit.name, values[limit.name],
                   f'must be {SMALLEST:g} or more, or 0 for no limit')
    for name, speed, for_each in STOPS:
        least = for_each * values[speed]
        if 0.0 < values[name] < least:
            refuse(name, values[name], f'must be {least:.2g} or more, or 0 for no limit: the base '
                   f"has to stop from '{speed}' = {values[speed]:g} within {LONGEST_STOP:g} s")
    return ControllerLimits(**{limit.name: values[limit.name] or math.inf
                               for limit in LIMIT_DECLARATIONS},
                            min_steering_speed=values[QUIET_DECLARATION.name])
