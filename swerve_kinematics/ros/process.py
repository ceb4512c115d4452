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

"""Running a node as a process whose last word is a stop."""

from collections.abc import Iterator
from contextlib import contextmanager
import re
import signal
import sys
import traceback
from typing import Any, Callable, Sequence

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.signals import SignalHandlerOptions

from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.ros.executor_choice import make_executor
from swerve_kinematics.ros.signals import collected_signals

# Middleware that does not come to an end as it is taken down is left after so long a time [s].
LONGEST_LEAVE = 5


def run(node_type: Callable[[], Any], args: Sequence[str]) -> int:
    """
    Run a node until Ctrl-C, SIGTERM, SIGHUP, SIGQUIT or an exception, call its `stop()`, and end.

    rclpy's own signal handlers shut the context down first, after which nothing can be
    published any more: the wheels would keep their last speed. Here a signal only ends the
    spinning, however often it comes, and the node stops with a working context. It is noticed
    once the executor has called something, so the node needs a timer.

    Parameters
    ----------
    node_type : callable
        Creates the node, which has a method `stop()`. Where creating it fails, it has to stop
        what it drives itself.
    args : sequence of str
        Command line, as far as it is for ROS.

    Returns
    -------
    int
        Exit code: 0, or 1 if something went wrong.

    Raises
    ------
    ValueError
        If ROS does not take the command line.

    """
    signals = collected_signals()
    initialize(args)
    try:
        _spin(node_type(), signals)
    except ParameterError as error:
        # What shows only as the node is built, such as a base that needs a missing library.
        print(f'error: {error}', file=sys.stderr)
        return 1
    except Exception as error:
        traceback.print_exc()
        print(f'error: stopped by {type(error).__name__}: {error}', file=sys.stderr)
        return 1
    finally:
        with leaving():
            rclpy.try_shutdown()
    return 0


def initialize(args: Sequence[str]) -> None:
    """Initialize rclpy without its signal handlers; ValueError if ROS does not take `args`."""
    try:
        rclpy.init(args=list(args), signal_handler_options=SignalHandlerOptions.NO)
    except _rclpy.UnknownROSArgsError as error:
        raise ValueError(f'ROS knows no such argument: {error}') from None
    except _rclpy.RCLError as error:
        # Of what C says, not the places in its sources.
        raise ValueError(re.sub(r',? at /\S+', '', str(error))) from None


@contextmanager
def leaving() -> Iterator[None]:
    """
    End the process by SIGALRM if the block, which leaves the graph, takes too long.

    Once in thousands of times Fast DDS waits for ever as it is taken down, with a core busy and
    Python's lock held: no handler in Python can run then.
    """
    signal.alarm(LONGEST_LEAVE)
    try:
        yield
    finally:
        signal.alarm(0)


def _spin(node: Any, signals: list[int]) -> None:
    """Spin a node until there is a signal; stop it before any exception is told of."""
    executor = make_executor()
    executor.add_node(node)
    try:
        while not signals:
            executor.spin_once()
    except ExternalShutdownException:
        pass
    finally:
        try:
            if rclpy.ok():
                node.stop()
        finally:
            with leaving():
                executor.shutdown()
                node.destroy_node()
