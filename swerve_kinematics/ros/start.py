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

"""From the command line of a program to its running node."""

from functools import partial
import sys
from typing import Any, Callable, Sequence

from rclpy.exceptions import NameValidationException
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name

from swerve_kinematics.configuration.answers import answer, in_words, refused
from swerve_kinematics.configuration.command_line import parse
from swerve_kinematics.configuration.program import Parameters, Program, read_settings, Settings
from swerve_kinematics.ros.process import run


def start(program: Program[Parameters], node_type: Callable[[Settings[Parameters]], Any],
          arguments: Sequence[str] | None = None) -> int:
    """
    Run a program as its command line says.

    Parameters
    ----------
    program : Program
        What there is to configure.
    node_type : callable
        Creates the node from Settings; it has a method `stop()`.
    arguments : sequence of str, optional
        Command line without the name of the program; that of the process if not given.

    Returns
    -------
    int
        Exit code: 0, or 1 if an argument, file or parameter cannot be used.

    """
    arguments = sys.argv[1:] if arguments is None else arguments
    answered = answer(program, arguments)
    if answered is not None:
        return answered
    try:
        command = parse(program, arguments)
        namespace, _, name = command.node.rpartition('/')
        validate_namespace(namespace or '/')
        validate_node_name(name)
        settings = read_settings(program, command.node, command.files, command.parameters)
        return run(partial(node_type, settings), command.ros_arguments)
    except OSError as error:
        return refused(in_words(error))
    except (NameValidationException, ValueError) as error:
        return refused(' '.join(str(error).split()))
