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

"""A swerve_node that fails in a method which the environment names: built, once it is fast."""

from functools import wraps
import os
import sys

from swerve_kinematics.configuration.program import NODE
from swerve_kinematics.ros.estimation import Estimation
from swerve_kinematics.ros.node import SwerveNode
from swerve_kinematics.ros.start import start

FAST = 5.0  # rad/s


def failing(method):
    """Return a method that does what it did in a node that is built, until the wheels are fast."""
    @wraps(method)  # rclpy looks at what a callback takes
    def call(owner, *arguments):
        command = owner._drive._command
        is_built = not isinstance(owner, SwerveNode) or hasattr(owner, '_pacer')
        if not is_built or command is not None and max(command.wheel_speeds) > FAST:
            raise RuntimeError('a fault in the making')
        return method(owner, *arguments)
    return call


if __name__ == '__main__':
    owner, method = os.environ['FAILING_METHOD'].split('.')
    owner = {kind.__name__: kind for kind in (SwerveNode, Estimation)}[owner]
    setattr(owner, method, failing(getattr(owner, method)))
    sys.exit(start(NODE, SwerveNode))
