"""Running a node as a process that stops cleanly."""

import signal
import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.signals import SignalHandlerOptions

from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.ros.executor import make_executor


def run(node_type, args=None):
    """
    Run a node until Ctrl-C or SIGTERM, call its `stop()`, and end.

    rclpy's own signal handlers shut the context down first, after which nothing can be
    published any more: the wheels would keep their last speed. Here a signal only ends the
    spinning, however often it comes, and the node stops with a working context. It is noticed
    when the executor wakes, so the node needs a timer.

    Parameters
    ----------
    node_type : callable
        Creates the node; the node has a method `stop()`.
    args : list of str, optional
        Command line; `sys.argv` if not given.

    Returns
    -------
    int
        Exit code: 0, or 1 if a parameter cannot be used.

    """
    signals = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, _: signals.append(received))
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = node_type()
    except ParameterError as error:
        print(f'error: {error}', file=sys.stderr)
        rclpy.try_shutdown()
        return 1
    executor = make_executor()
    executor.add_node(node)
    try:
        while not signals:
            executor.spin_once()
        node.stop()
    except ExternalShutdownException:
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    return 0
