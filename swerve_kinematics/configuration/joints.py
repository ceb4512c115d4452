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

"""
Between joint space and module space: directions, ratios, offsets, coupling and wheel radii.

Joint space is what drivers report and obey. Module space is what the core computes with: the
distance that a wheel rolls forwards [m] and the angle of its module, counter-clockwise from +x
[rad]. With the module angle `a` and the wheel angle `w = distance / wheel_radius`,

    steering joint = steering_direction * steering_ratio * a + steering_offset
    drive joint    = drive_direction * drive_ratio * w + drive_coupling_ratio * a

The same holds for velocities, where the offset drops out.
"""

from typing import Sequence

from swerve_kinematics.configuration.declarations import Declaration, refuse, Values
from swerve_kinematics.configuration.validation import per_module
from swerve_kinematics.core.geometry.angles import TURN

JOINT_DECLARATIONS = (
    Declaration('wheel_radii', [0.05],
                'Rolling radius under load, one for all modules or one for each', 'm',
                minimum=1e-4, plausible=1.0, mistake='millimetres'),
    Declaration('drive_directions', [1.0],
                '1, or -1 if the drive joint counts down as the wheel rolls forward; one for all '
                'or one for each'),
    Declaration('drive_ratios', [1.0],
                'Turns of the drive joint for one turn of the wheel, one for all or one for each',
                '', minimum=1e-3, maximum=1e3),
    Declaration('drive_coupling_ratio', [0.0],
                'Turns the drive joint reads for one turn of the module, counter-clockwise, with '
                'the wheel held still; one for all or one for each', '',
                minimum=-100.0, maximum=100.0),
    Declaration('drive_joint_period', 0.0,
                'Period after which the position of a drive joint repeats: 6.28319 if it wraps at '
                '+-pi, 12.56637 if at +-2 pi; 0: it does not wrap', 'rad',
                minimum=0.0, maximum=1e4),
    Declaration('steering_directions', [1.0],
                '1, or -1 if the steering joint counts up clockwise, seen from above; one for '
                'all or one for each'),
    Declaration('steering_ratios', [1.0],
                'Turns of the steering joint for one turn of the module, one for all or one for '
                'each', '', minimum=1e-3, maximum=1e3),
    Declaration('steering_offsets', [0.0],
                'What a steering joint reads when its wheel points along +x, one for all or one '
                'for each', 'rad'),
)


class ModuleJoints:
    """
    Converts between the joints of n modules and what the modules do.

    The methods take and return lists in module order. Those for drives are linear and serve
    positions and velocities alike.

    Parameters
    ----------
    wheel_radii : sequence of float (n,)
        Rolling radii [m].
    drive_ratios, steering_ratios : sequence of float (n,), optional
        Turns of the joint for one turn of the wheel or module, negative where it counts the
        other way; 1 by default.
    steering_offsets : sequence of float (n,), optional
        What the steering joints read when the wheels point along +x [rad]; 0 by default.
    drive_coupling_ratios : sequence of float (n,), optional
        Turns of the drive joint for one turn of the module with the wheel held still; 0 by
        default.
    drive_period : float
        Difference of two readings of a drive joint that mean the same [rad]; 0 if it counts
        on. The methods here take positions that count on.

    Attributes
    ----------
    is_coupled : bool
        Whether any drive joint turns because its module steers.

    """

    def __init__(self, wheel_radii: Sequence[float],
                 drive_ratios: Sequence[float] | None = None,
                 steering_ratios: Sequence[float] | None = None,
                 steering_offsets: Sequence[float] | None = None,
                 drive_coupling_ratios: Sequence[float] | None = None,
                 drive_period: float = 0.0) -> None:
        """Keep the numbers as Python's own, which are the fastest for a few modules."""
        count = len(wheel_radii)
        self.wheel_radii = _floats(wheel_radii, count, 1.0)
        self.drive_ratios = _floats(drive_ratios, count, 1.0)
        self.steering_ratios = _floats(steering_ratios, count, 1.0)
        self.steering_offsets = _floats(steering_offsets, count, 0.0)
        self.drive_coupling_ratios = _floats(drive_coupling_ratios, count, 0.0)
        self.is_coupled = any(self.drive_coupling_ratios)
        self.drive_period = drive_period
        # Distance that the wheel rolls for an angle of its drive joint [m/rad].
        self.distance_per_drive = [
            radius / ratio for radius, ratio in zip(self.wheel_radii, self.drive_ratios)]

    def module_angles(self, positions: Sequence[float]) -> list[float]:
        """Return the module angles [rad] for positions of the steering joints [rad]."""
        return [(position - offset) / ratio for position, offset, ratio in zip(
            positions, self.steering_offsets, self.steering_ratios)]

    def steering_positions(self, angles: Sequence[float]) -> list[float]:
        """Return the positions of the steering joints [rad] for module angles [rad]."""
        return [ratio * angle + offset for angle, offset, ratio in zip(
            angles, self.steering_offsets, self.steering_ratios)]

    def module_rates(self, velocities: Sequence[float]) -> list[float]:
        """Return the rates of the module angles for velocities of the joints [rad/s]."""
        return [velocity / ratio for velocity, ratio in zip(velocities, self.steering_ratios)]

    def steering_velocities(self, rates: Sequence[float]) -> list[float]:
        """Return the velocities of the joints for rates of the module angles [rad/s]."""
        return [ratio * rate for rate, ratio in zip(rates, self.steering_ratios)]

    def travel(self, drives: Sequence[float], modules: Sequence[float]) -> list[float]:
        """
        Return what the wheels roll for what drive joints and modules turn.

        Parameters
        ----------
        drives : sequence of float (n,)
            Positions or velocities of the drive joints [rad, rad/s].
        modules : sequence of float (n,)
            Module angles, or their rates [rad, rad/s]. They do not matter, and may be NaN,
            where there is no coupling.

        Returns
        -------
        list of float (n,)
            Distances or rim speeds [m, m/s].

        """
        if not self.is_coupled:
            return [drive * distance for drive, distance in zip(drives, self.distance_per_drive)]
        return [(drive - coupling * module if coupling else drive) * distance
                for drive, module, coupling, distance in zip(
                    drives, modules, self.drive_coupling_ratios, self.distance_per_drive)]

    def drives(self, travel: Sequence[float], modules: Sequence[float]) -> list[float]:
        """Return what the drive joints turn: the inverse of `travel`, likewise."""
        if not self.is_coupled:
            return [way / distance for way, distance in zip(travel, self.distance_per_drive)]
        return [way / distance + coupling * module if coupling else way / distance
                for way, module, coupling, distance in zip(
                    travel, modules, self.drive_coupling_ratios, self.distance_per_drive)]


def _floats(values: Sequence[float] | None, count: int, default: float) -> list[float]:
    """Return Python's floats, or as many defaults."""
    if values is None:
        return [default] * count
    if len(values) != count:
        raise ValueError(f'{count} numbers are needed, one for each module, not {len(values)}')
    return [float(value) for value in values]


def joints_from(values: Values, count: int) -> ModuleJoints:
    """
    Return the joints that the parameters describe.

    Parameters
    ----------
    values : mapping
        Value by name, of JOINT_DECLARATIONS.
    count : int
        Number of modules.

    Returns
    -------
    ModuleJoints

    Raises
    ------
    ParameterError
        If a length fits neither 1 nor the number of modules, or a direction is not 1 or -1.

    """
    def turns(kind: str) -> list[float]:
        """Return the ratios of a kind of joints with the signs of their directions."""
        name = f'{kind}_directions'
        directions = per_module(values, name, count)
        if not {1.0, -1.0}.issuperset(directions):
            refuse(name, values[name], 'must be 1 or -1')
        return [direction * ratio for direction, ratio in zip(
            directions, per_module(values, f'{kind}_ratios', count))]

    steering_ratios = turns('steering')
    offsets = per_module(values, 'steering_offsets', count)
    if any(abs(offset) > max(1.0, abs(ratio)) * TURN
           for offset, ratio in zip(offsets, steering_ratios)):
        refuse('steering_offsets', values['steering_offsets'],
               'more than a turn of the joint: wrong steering_ratios, or degrees?')
    return ModuleJoints(
        per_module(values, 'wheel_radii', count), turns('drive'), steering_ratios, offsets,
        per_module(values, 'drive_coupling_ratio', count), values['drive_joint_period'])
