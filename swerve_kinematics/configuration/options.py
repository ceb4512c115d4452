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

"""The options of a program itself, beside what is for ROS."""

import argparse
from pathlib import Path
from typing import Any, NoReturn, Sequence

from swerve_kinematics import __version__
from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.program import Program

EPILOG = """\
parameters: {name} --ros-args --params-file robot.yaml -p name:=value
docs/parameters.md lists them; `ros2 param describe` explains those of a running node.
"""


class _Parser(argparse.ArgumentParser):
    """Complains by an exception: the caller says it in one line."""

    def error(self, message: str) -> NoReturn:
        raise ParameterError(f'{message} (see --help)')


def add_version(parser: argparse.ArgumentParser) -> None:
    """Give a command line the option --version."""
    parser.add_argument('--version', action='version', version=f'%(prog)s {__version__}')


def file_to_check(program: Program[Any], arguments: Sequence[str]) -> Path | None:
    """
    Return what `--check` names; `--help` prints the usage and exits.

    Parameters
    ----------
    program : Program
        That is called.
    arguments : sequence of str
        Those that are not for ROS.

    Returns
    -------
    pathlib.Path or None

    Raises
    ------
    ParameterError
        If an argument is of no use, with one line that says why.

    """
    parser = _Parser(
        prog=program.name, description=program.purpose, epilog=EPILOG.format(name=program.name),
        usage='%(prog)s [-h] [--version] [--check YAML] [--ros-args ...]', allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--check', type=Path, metavar='YAML',
                        help='check a parameter file, say how it is understood, and start nothing')
    add_version(parser)
    options, strangers = parser.parse_known_args(arguments)
    if strangers:
        raise ParameterError(f"unknown argument '{strangers[0]}'; arguments for ROS, such as "
                             '--params-file and -p, belong after --ros-args')
    checked: Path | None = options.check
    return checked
