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
# What a stop has to bring down, and the limits that alone may make it long.
STOPS = (
    ('max_linear_speed', ('max_linear_deceleration', 'max_grip_acceleration'), 'max_linear_jerk'),
    ('max_angular_speed', ('max_angular_acceleration',), 'max_angular_jerk'),
    ('max_module_speed', ('max_module_acceleration',), None))
QUIET_DECLARATION = Declaration(
    'min_steering_speed', 0.012,
    'Wheels only steer for commands of at least this rim speed, averaged over 0.1 s; 0: for any',
    'm/s', minimum=0.0, changeable=True)


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
    for speed, accelerations, jerk in STOPS:
        for name in accelerations:
            _refuse_endless_stop(values, speed, name, values[speed] / LONGEST_STOP)
        if jerk:
            # Half of the speed while the deceleration grows, half while it falls: v = j (t / 2)^2.
            _refuse_endless_stop(values, speed, jerk, 4.0 * values[speed] / LONGEST_STOP ** 2)
    return ControllerLimits(**{limit.name: values[limit.name] or math.inf
                               for limit in LIMIT_DECLARATIONS},
                            min_steering_speed=values[QUIET_DECLARATION.name])


def _refuse_endless_stop(values: Values, speed: str, name: str, least: float) -> None:
    """Refuse a limit with which a stop from a speed takes too long; 0 is none."""
    if 0.0 < values[name] < least:
        refuse(name, values[name], f'must be {least:.2g} or more, or 0 for no limit: the base '
               f"has to stop from '{speed}' = {values[speed]:g} within {LONGEST_STOP:g} s")
