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

"""The parameters of swerve_sim in rigid-body physics."""

from dataclasses import dataclass, fields
from typing import Any

from swerve_kinematics.configuration.declarations import Declaration, DOUBLES, refuse, Values
from swerve_kinematics.configuration.validation import refuse_unless_in

KINDS = ('rolling', 'mujoco')
PREFIX = 'mujoco.'
MOST_FRICTION = 10.0


def _declared(name: str, default: float, description: str, unit: str, minimum: float = 0.0,
              maximum: float = 1e4) -> Declaration:
    """Declare a number that counts with `physics: mujoco` only."""
    return Declaration(PREFIX + name, default, description, unit, minimum, maximum)


PHYSICS_DECLARATIONS = (
    Declaration('physics', 'rolling',
                'rolling: wheels roll and never slip; mujoco: rigid-body physics on tyres'),
    _declared('mass', 42.0, 'Mass of the chassis without modules and payload', 'kg', 1.0),
    _declared('payload_mass', 0.0, 'Mass of a payload', 'kg'),
    _declared('payload_x', 0.0, 'Centre of the payload forward of base_link', 'm', -10.0, 10.0),
    _declared('payload_y', 0.0, 'Centre of the payload left of base_link', 'm', -10.0, 10.0),
    _declared('drive_torque', 6.0, 'Largest torque of a drive motor, at its wheel', 'N m', 0.01),
    _declared('steering_torque', 4.0, 'Largest torque of a steering motor, at its module', 'N m',
              0.01),
    _declared('friction', 0.9, 'Friction coefficient of the tyres on the floor', '',
              maximum=MOST_FRICTION),
    Declaration(PREFIX + 'friction_regions', DOUBLES,
                'Rectangles with another friction, five numbers for each: x_min, y_min, x_max, '
                'y_max [m], friction'),
    _declared('slope', 0.0, 'Slope of the floor', 'rad', -1.0, 1.0),
    _declared('slope_direction', 0.0, 'Uphill direction, from the x axis', 'rad', -10.0, 10.0),
    _declared('ridge_height', 0.0, 'Height of ridges across the x axis; 0: none', 'm', 0.0, 0.1),
    _declared('ridge_spacing', 1.0, 'Distance from one ridge to the next', 'm', 0.1, 100.0),
)


@dataclass(frozen=True)
class PhysicsParameters:
    """
    What the base is made of and drives on; a field for each parameter `mujoco.*`.

    Attributes
    ----------
    friction_regions : tuple of tuple of float (5,)
        `(x_min, y_min, x_max, y_max, friction)` of each rectangle [m].

    """

    mass: float
    payload_mass: float
    payload_x: float
    payload_y: float
    drive_torque: float
    steering_torque: float
    friction: float
    friction_regions: tuple[tuple[float, ...], ...]
    slope: float
    slope_direction: float
    ridge_height: float
    ridge_spacing: float


def physics_from(values: Values) -> PhysicsParameters | None:
    """
    Return the parameters of rigid-body physics; None where the base rolls.

    Parameters
    ----------
    values : mapping
        Value by name, of PHYSICS_DECLARATIONS.

    Raises
    ------
    ParameterError
        If one of them cannot be used.

    """
    refuse_unless_in(values, 'physics', KINDS)
    if values['physics'] == 'rolling':
        return None
    given: dict[str, Any] = {
        field.name: values[PREFIX + field.name] for field in fields(PhysicsParameters)}
    numbers = given['friction_regions']
    if len(numbers) % 5:
        refuse(PREFIX + 'friction_regions', numbers, 'must have five numbers for each rectangle')
    regions = [tuple(numbers[start:start + 5]) for start in range(0, len(numbers), 5)]
    for x_min, y_min, x_max, y_max, friction in regions:
        if not (x_min < x_max and y_min < y_max and 0.0 <= friction <= MOST_FRICTION):
            refuse(PREFIX + 'friction_regions', numbers, 'each rectangle must be x_min, y_min, '
                   f'x_max, y_max and a friction within [0, {MOST_FRICTION:g}]')
    given['friction_regions'] = tuple(regions)
    return PhysicsParameters(**given)
