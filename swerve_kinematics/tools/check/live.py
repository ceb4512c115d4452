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

"""A drive for a check while it happens, by hand."""

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.tools.check.questions import progress, said
from swerve_kinematics.tools.check.robot import robot
from swerve_kinematics.tools.recordings.collector import Collector


def driven_by_hand(parameters: NodeParameters, seconds: float,
                   ros_arguments: list[str]) -> Collector:
    """Return what a robot does for some seconds while someone drives it."""
    with robot(parameters, ros_arguments) as seen:
        seen.wait_for_joints()
        said('Now drive forward, sideways and around curves, all mixed.')
        for time in seen.during(seconds):
            progress(f'{seconds - time:.0f} s left')
        return seen.collector
