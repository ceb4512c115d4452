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

"""A program of this package as a user configures it, and what one start of it is given."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Generic, Iterable, Sequence, TypeVar

from swerve_kinematics.configuration.declarations import Declaration, ParameterError, Values
from swerve_kinematics.configuration.node import (
    NODE_DECLARATIONS, NodeParameters, parameters_from)
from swerve_kinematics.configuration.parameter_file import (
    Given, given_to, is_for, qualified, read_argument, read_file, Sections)
from swerve_kinematics.configuration.quality_of_service import (
    overrides_of_quality, QOS_PREFIX)
from swerve_kinematics.configuration.simulator import (
    SIMULATOR_DECLARATIONS, simulator_parameters_from, SimulatorParameters)
from swerve_kinematics.configuration.summary import simulator_summary, summary
from swerve_kinematics.configuration.values import refuse_unknown, values_of

Parameters = TypeVar('Parameters')

# What no two robots share: a line about a file says which of them it leaves out.
MEASURED = ('module_x', 'module_y', 'wheel_radii')
# What every node of rclpy takes.
OF_RCLPY = (
    Declaration('use_sim_time', False, 'Take the time from /clock'),
    Declaration('start_type_description_service', True, 'Offer ~/get_type_description'),
)


@dataclass(frozen=True)
class Program(Generic[Parameters]):
    """
    What there is to configure in a program.

    Attributes
    ----------
    name : str
        Of its node, where no other one is given.
    purpose : str
        What it does, in a line.
    declarations : tuple of Declaration
        Its parameters.
    others : frozenset of str
        Names that other programs of the package have besides: in a section for all nodes they
        are no mistake.
    parameters_from : callable
        Makes its configuration out of values.
    summary : callable
        Says in a line what was understood.

    """

    name: str
    purpose: str
    declarations: tuple[Declaration, ...]
    others: frozenset[str]
    parameters_from: Callable[[Values], Parameters]
    summary: Callable[[Parameters], str]


@dataclass(frozen=True)
class Settings(Generic[Parameters]):
    """
    What a program is started with.

    Attributes
    ----------
    values : mapping
        Value by name, of every parameter.
    parameters : Parameters
        The configuration they make.
    of_rclpy : mapping
        Value by name, of what is given for rclpy itself.
    summary : str
        What was understood, and from where, in a line.

    """

    values: dict[str, Any]
    parameters: Parameters
    of_rclpy: dict[str, Any]
    summary: str


def _names(declarations: Iterable[Declaration]) -> frozenset[str]:
    """Return the names of parameters."""
    return frozenset(declaration.name for declaration in declarations)


NODE: Program[NodeParameters] = Program(
    'swerve_node',
    'Drive a swerve base: turn cmd_vel into commands and joint_states into odometry.',
    NODE_DECLARATIONS, _names(SIMULATOR_DECLARATIONS), parameters_from, summary)
SIMULATOR: Program[SimulatorParameters] = Program(
    'swerve_sim', 'Simulate a swerve base in place of the drivers of a robot.',
    SIMULATOR_DECLARATIONS, _names(NODE_DECLARATIONS), simulator_parameters_from,
    simulator_summary)


def read_settings(program: Program[Parameters], node: str, files: Sequence[Path],
                  arguments: Sequence[str] = ()) -> Settings[Parameters]:
    """
    Return what files and arguments configure.

    Parameters
    ----------
    program : Program
        Which is started.
    node : str
        Full name of its node.
    files : sequence of pathlib.Path
        As given with `--params-file`.
    arguments : sequence of str
        As given with `-p`.

    Returns
    -------
    Settings

    Raises
    ------
    ParameterError
        In one line, if a file or parameter cannot be used.
    OSError
        If a file cannot be read.

    """
    sections: Sections = {}
    for path in files:
        names = read_file(path, sections)
        meant = [name for name in names if is_for(name, node)]
        if not meant:
            raise ParameterError(
                f"{path}: none of its sections ({', '.join(names)}) is for {node}; write '/**:' "
                f"or '{node}:' above 'ros__parameters:'")
        if not any(sections[name] for name in meant):
            raise ParameterError(f"{path}: there is no parameter in {' or '.join(meant)}")
    for argument in arguments:
        read_argument(argument, sections)
    given = given_to(sections, node)
    own = _names(program.declarations) | _names(OF_RCLPY)
    refuse_unknown({name: entry for name, entry in given.items()
                    if not name.startswith(QOS_PREFIX)}, own, program.others)
    try:
        values = values_of(program.declarations, given)
        parameters = program.parameters_from(values)
        of_rclpy = {name: value for name, value in values_of(OF_RCLPY, given).items()
                    if name in given}
    except ParameterError as error:
        raise ParameterError(_with_origin(error, given, files)) from None
    of_rclpy |= overrides_of_quality(given)
    source = ', '.join(map(str, files)) or 'defaults, no parameter file'
    if files and (missing := [name for name in MEASURED if name not in given]):
        source += f"; by default: {', '.join(missing)}"
    return Settings(values, parameters, of_rclpy, f'{program.summary(parameters)} ({source})')


def read_parameters(path: Path) -> NodeParameters:
    """
    Return the parameters that swerve_node would have with a file, in whatever namespace.

    Parameters
    ----------
    path : pathlib.Path
        YAML as for `--params-file`.

    Returns
    -------
    NodeParameters

    Raises
    ------
    ParameterError
        In one line, if the file or a parameter cannot be used, or if it is for several robots.
    OSError
        If the file cannot be read.

    """
    return read_settings(NODE, _node_of(path), [path]).parameters


def _node_of(path: Path) -> str:
    """Return the full name of the swerve_node that a file is for, or of one that it fits."""
    name = qualified(NODE.name)
    fitting = {section for section in read_file(path, {}) if section.endswith(name)}
    named = sorted(section for section in fitting if '*' not in section)
    if len(named) > 1:
        raise ParameterError(f"{path}: it is for several robots ({', '.join(named)}): give each "
                             'of them a file of its own')
    return next(iter(named or sorted(fitting)), name).replace('/**', '').replace('*', 'any')


def _with_origin(error: ParameterError, given: dict[str, Given], files: Sequence[Path]) -> str:
    """Return what an error says, with where its parameter was given, or that it was not."""
    if error.name in given:
        return f'{given[error.name].origin}: {error}'
    places = [f"{', '.join(map(str, files))}: "] if files else []
    # Its default does not go with what is given.
    return ''.join([*places, str(error).replace(' = ', ' is not given, and its default is ', 1)])
