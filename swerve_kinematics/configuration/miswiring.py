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

"""The parameters that wire the simulated base wrongly."""

from dataclasses import dataclass, fields

from swerve_kinematics.configuration.declarations import Declaration, refuse, STRINGS, Values
from swerve_kinematics.configuration.validation import refuse_unusable_names

PREFIX = 'miswired.'


def _modules(name: str, description: str) -> Declaration:
    """Declare a list of modules that a fault concerns."""
    return Declaration(PREFIX + name, STRINGS, f'Fault, by module name: {description}')


MISWIRING_DECLARATIONS = (
    _modules('drive_motors', 'the drive turns in the opposite direction of its command'),
    _modules('drive_encoders', 'the drive reads the opposite of how it turns'),
    _modules('steering_motors', 'the steering moves to the mirror image of its command'),
    _modules('steering_encoders', 'the steering reads the mirror image of its angle'),
    _modules('swapped', "two modules whose joints have each other's names"),
    _modules('dead_drives', 'the drive never moves'),
    _modules('dead_steerings', 'the steering never moves'),
    _modules('free_wheels', 'the wheel is off the floor (only with physics: rolling)'),
    _modules('frozen', 'both joints keep reading what they read at the start'),
    Declaration(PREFIX + 'emergency_stop', False, 'Fault: no joint is driven'),
    Declaration(PREFIX + 'gyro_scale', 1.0,
                'Fault: factor on the readings of the gyro; -1: reversed, 57.29578: degrees'),
    Declaration(PREFIX + 'gyro_frozen', False,
                'Fault: the gyro keeps reading what it read at the start'),
    Declaration(PREFIX + 'gyro_silent', False, 'Fault: the gyro joint reads NaN'),
)


@dataclass(frozen=True)
class Miswiring:
    """
    What is wrong between the computer and the base; modules by index.

    Each field has the name of its parameter and what that says. A joint both of whose motor and
    encoder are the wrong way round is one of which the node's description has the wrong
    direction; a base is also miswired by another layout, radius or offset than the node's.
    """

    drive_motors: tuple[int, ...] = ()
    drive_encoders: tuple[int, ...] = ()
    steering_motors: tuple[int, ...] = ()
    steering_encoders: tuple[int, ...] = ()
    swapped: tuple[int, ...] = ()
    dead_drives: tuple[int, ...] = ()
    dead_steerings: tuple[int, ...] = ()
    free_wheels: tuple[int, ...] = ()
    frozen: tuple[int, ...] = ()
    emergency_stop: bool = False
    gyro_scale: float = 1.0
    gyro_frozen: bool = False
    gyro_silent: bool = False


def miswiring_from(values: Values, modules: tuple[str, ...]) -> Miswiring:
    """
    Return what the parameters say is wired wrongly.

    Parameters
    ----------
    values : mapping
        Value by name, of MISWIRING_DECLARATIONS.
    modules : tuple of str (n,)
        Names of the modules.

    Returns
    -------
    Miswiring

    Raises
    ------
    ParameterError
        If a module is unknown or named twice, not two are swapped, or fewer than two wheels are
        on the floor.

    """
    given = {}
    for field in fields(Miswiring):
        name = PREFIX + field.name
        value = values[name]
        if isinstance(value, list):
            unknown = [module for module in value if module not in modules]
            if unknown:
                refuse(name, value, f"'{unknown[0]}' is not the name of a module")
            refuse_unusable_names(name, value)
            value = tuple(modules.index(module) for module in value)
        given[field.name] = value
    if len(given['swapped']) not in (0, 2):
        refuse(PREFIX + 'swapped', values[PREFIX + 'swapped'], 'must be two modules, or none')
    if len(modules) - len(given['free_wheels']) < 2:
        refuse(PREFIX + 'free_wheels', values[PREFIX + 'free_wheels'],
               'must leave two wheels on the floor')
    return Miswiring(**given)
