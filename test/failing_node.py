"""A swerve_node in which something goes wrong while its wheels turn."""

from functools import wraps
import os
import sys

from swerve_kinematics.configuration.program import NODE
from swerve_kinematics.ros.node import SwerveNode
from swerve_kinematics.ros.start import start

FAST = 5.0  # rad/s


class FailingNode(SwerveNode):
    """Fails in the method that the environment names, as soon as it drives."""


def failing(method):
    """Return a method that does what it did, until the wheels are fast."""
    @wraps(method)  # rclpy looks at what a callback takes
    def call(node, *arguments):
        command = node._drive._command
        if command is not None and max(command.wheel_speeds) > FAST:
            raise RuntimeError('a fault in the making')
        return method(node, *arguments)
    return call


if __name__ == '__main__':
    name = os.environ['FAILING_METHOD']
    setattr(FailingNode, name, failing(getattr(SwerveNode, name)))
    sys.exit(start(NODE, FailingNode))
