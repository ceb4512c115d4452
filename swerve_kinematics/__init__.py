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

"""
Swerve-drive kinematics, command shaping and odometry.

Everything here is the numpy core; importing it never loads ROS.
"""

from swerve_kinematics.core.control.command import ModuleCommand
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.control.teleop import joystick_twist
from swerve_kinematics.core.geometry.angles import angle_difference, wrap_angle
from swerve_kinematics.core.geometry.se2 import (
    discretize, se2_compose, se2_exp, se2_log, to_field_frame, to_robot_frame)
from swerve_kinematics.core.kinematics.desaturation import desaturate, desaturate_chassis
from swerve_kinematics.core.kinematics.mecanum import MecanumKinematics
from swerve_kinematics.core.kinematics.modules import (
    cosine_scale, interpolate, ModuleStates, optimize)
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.gyro import GyroBiasFilter
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise

__all__ = [
    'ControllerLimits', 'GyroBiasFilter', 'MecanumKinematics', 'ModuleCommand', 'ModuleStates',
    'OdometryNoise', 'SwerveController', 'SwerveKinematics', 'SwerveOdometry',
    'angle_difference', 'cosine_scale', 'desaturate', 'desaturate_chassis', 'discretize',
    'interpolate', 'joystick_twist', 'optimize', 'se2_compose', 'se2_exp', 'se2_log',
    'to_field_frame', 'to_robot_frame', 'wrap_angle',
]

__version__ = '0.2.0'
