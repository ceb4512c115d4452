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

"""The command line of a program: which part is for ROS, and what of that are parameters."""

from dataclasses import dataclass
from pathlib import Path
import re
from typing import Any, Sequence

from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.parameter_file import qualified
from swerve_kinematics.configuration.program import Program

ROS, END_OF_ROS = '--ros-args', '--'
REMAPS = ('-r', '--remap')
SET_PARAMETER = ('-p', '--param')
PARAMETER_FILE = '--params-file'


@dataclass(frozen=True)
class CommandLine:
    """
    What a program is called with.

    Attributes
    ----------
    node : str
        Full name of the node.
    files : tuple of pathlib.Path
        Parameter files, in their order.
    parameters : tuple of str
        `[node:]name:=value`, in their order.
    ros_arguments : tuple of str
        Everything else that is meant for ROS.
    only_check : bool
        Whether the parameters are to be checked and nothing started.

    """

    node: str
    files: tuple[Path, ...]
    parameters: tuple[str, ...]
    ros_arguments: tuple[str, ...]
    only_check: bool


def parse(program: Program[Any], arguments: Sequence[str]) -> CommandLine:
    """
    Take a command line apart; `--help` prints the usage and exits.

    Parameters
    ----------
    program : Program
        That is called.
    arguments : sequence of str
        Without the name of the program.

    Returns
    -------
    CommandLine

    Raises
    ------
    ParameterError
        If an argument is of no use, with one line that says why.

    """
    own, ros = _split(arguments)
    checked = _file_to_check(program, own)
    files, parameters, rest = _parameters_apart(ros)
    if checked is not None:
        files.append(checked)
    return CommandLine(_node_name(program.name, rest), tuple(map(Path, files)),
                       tuple(parameters), (ROS, *rest), checked is not None)


def _file_to_check(program: Program[Any], arguments: Sequence[str]) -> Path | None:
    """Return what `--check` names among the arguments that are not for ROS."""
    if not arguments:
        return None
    # Only here: a node that is simply started has none, and argparse takes a megabyte.
    from swerve_kinematics.configuration.options import file_to_check
    return file_to_check(program, arguments)


def _split(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return the arguments for the program and those for ROS."""
    own: list[str] = []
    ros: list[str] = []
    target = own
    for argument in arguments:
        if argument == ROS:
            target = ros
        elif argument == END_OF_ROS and target is ros:
            target = own
        else:
            target.append(argument)
    return own, ros


def _parameters_apart(arguments: Sequence[str]) -> tuple[list[Path], list[str], list[str]]:
    """Return the parameter files, the single parameters, and what else there is for ROS."""
    files: list[Path] = []
    parameters: list[str] = []
    rest: list[str] = []
    remaining = iter(arguments)
    for argument in remaining:
        if argument not in (PARAMETER_FILE, *SET_PARAMETER):
            rest.append(argument)
            continue
        value = next(remaining, None)
        if value is None:
            raise ParameterError(f'{argument}: its value is missing')
        if argument == PARAMETER_FILE:
            files.append(Path(value))
        else:
            parameters.append(value)
    return files, parameters, rest


def _node_name(name: str, arguments: Sequence[str]) -> str:
    """Return the full name of a node after remapping; the first rule that fits counts."""
    rules: dict[str, str] = {}
    for option, rule in zip(arguments, arguments[1:]):
        if option in REMAPS and ':=' not in rule:
            raise ParameterError(f'{option} {rule}: must be from:=to')
        found = re.fullmatch(rf'(?:{name}:)?__(node|name|ns):=(.+)', rule)
        if option in REMAPS and found:
            rules.setdefault(found[1].replace('name', 'node'), found[2])
    namespace = qualified(rules.get('ns', '/')).rstrip('/')
    return f"{namespace}/{rules.get('node', name)}"
