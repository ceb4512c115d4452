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

"""The joints of a base of two modules and a gyro, as the node reads them; no graph needed."""

from dataclasses import replace

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.ros.feedback import JointFeedback

MS = 1_000_000  # ns
TIMEOUT = 500 * MS
DRIVES, STEERINGS = ('a_drive', 'b_drive'), ('a_steer', 'b_steer')
NAMES = [*DRIVES, *STEERINGS]
LAYOUT = Layout(('a', 'b'), SwerveKinematics([(1.0, 0.0), (-1.0, 0.0)]),
                ModuleJoints([0.1, 0.2]), DRIVES, STEERINGS, 'gyro', 'odom', 'base_link')


def feedback(gyro='gyro', **description):
    """Return what reads the joints, by this description of them, and a gyro joint."""
    joints = ModuleJoints([0.1, 0.2], **description)
    return JointFeedback(replace(LAYOUT, joints=joints), gyro, TIMEOUT, 100 * MS)
