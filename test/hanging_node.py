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

"""A swerve_node whose middleware hangs as it is taken down, and holds Python's lock."""

import ctypes
import sys

from swerve_kinematics.configuration.program import NODE
from swerve_kinematics.ros.node import SwerveNode
from swerve_kinematics.ros.start import start


class HangingNode(SwerveNode):
    """Is never destroyed."""

    def destroy_node(self):
        """Wait in C for signals, whatever they are."""
        while True:
            ctypes.PyDLL(None).pause()


if __name__ == '__main__':
    sys.exit(start(NODE, HangingNode))
