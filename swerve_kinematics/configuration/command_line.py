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

import argparse
from dataclasses import dataclass
from pathlib import Path
import re
from typing import Any, NoReturn, Sequence

from swerve_kinematics import __version__
from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.parameter_file import qualified
from swerve_kinematics.configuration.program import Program

ROS, END_OF_ROS = '--ros-args', '--'
REMAPS = ('-r', '--remap')
SET_PARAMETER = ('-p', '--param')
PARAMETER_FILE = '--params-file'
EPILOG = """\
parameters: {name} --ros-args --params-file robot.yaml -p name:=value
docs/parameters.md lists them; `ros2 param describe` explains those of a running node.
"""


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


class _Parser(argparse.ArgumentParser):
    """Complains by an exception: the caller says it in one line."""

    def error(self, message: str) -> NoReturn:
        raise ParameterError(f'{message} (see --help)')


def add_version(parser: argparse.ArgumentParser) -> None:
    """Give a command line the option --version."""
    parser.add_argument('--version', action='version', version=f'%(prog)s {__version__}')


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
    parser = _Parser(
        prog=program.name, description=program.purpose, epilog=EPILOG.format(name=program.name),
        usage='%(prog)s [-h] [--version] [--check YAML] [--ros-args ...]', allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--check', type=Path, metavar='YAML',
                        help='check a parameter file, say how it is understood, and start nothing')
    add_version(parser)
    options, strangers = parser.parse_known_args(own)
    if strangers:
        raise ParameterError(f"unknown argument '{strangers[0]}'; arguments for ROS, such as "
                             f'{PARAMETER_FILE} and -p, belong after {ROS}')
    files, parameters, rest = _parameters_apart(ros)
    if options.check:
        files.append(options.check)
    return CommandLine(_node_name(program.name, rest), tuple(map(Path, files)),
                       tuple(parameters), (ROS, *rest), options.check is not None)


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
        found = re.fullmatch(rf'(?:{name}:)?__(node|name|ns):=(.+)', rule)
        if option in REMAPS and found:
            rules.setdefault(found[1].replace('name', 'node'), found[2])
    namespace = qualified(rules.get('ns', '/')).rstrip('/')
    return f"{namespace}/{rules.get('node', name)}"
