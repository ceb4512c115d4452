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

"""What the program of a node answers without starting it, and so without ROS."""

from functools import partial
import sys
from typing import Any, Sequence

from swerve_kinematics.configuration.command_line import parse
from swerve_kinematics.configuration.program import NODE, Program, read_settings, SIMULATOR


def answer(program: Program[Any], arguments: Sequence[str] | None = None) -> int | None:
    """
    Answer `--help`, `--version` and `--check`, and complain of arguments that are of no use.

    Parameters
    ----------
    program : Program
        That is called.
    arguments : sequence of str, optional
        Command line without the name of the program; that of the process if not given.

    Returns
    -------
    int or None
        Exit code, or None if the node is to be started.

    """
    try:
        command = parse(program, sys.argv[1:] if arguments is None else arguments)
        if not command.only_check:
            return None
        print(read_settings(program, command.node, command.files, command.parameters).summary)
        return 0
    except (OSError, ValueError) as error:
        return refused(in_words(error))


def refused(reason: str) -> int:
    """Say in one line why a program does not start; return its exit code."""
    print(f'error: {reason}', file=sys.stderr)
    return 1


def in_words(error: Exception) -> str:
    """Return what an error says, without the number that Python puts before the system's words."""
    if isinstance(error, OSError) and error.strerror:
        return f'{error.filename}: {error.strerror}' if error.filename else error.strerror
    return str(error)


answer_for_node = partial(answer, NODE)
answer_for_simulator = partial(answer, SIMULATOR)
