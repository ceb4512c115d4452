"""
Swerve-drive kinematics, command shaping and odometry.

Everything here is the numpy core; importing it never loads ROS.
"""

from swerve_kinematics.core.angles import angle_difference, wrap_angle
from swerve_kinematics.core.controller import ModuleCommand, SwerveController
from swerve_kinematics.core.gyro import GyroBiasFilter
from swerve_kinematics.core.limits import ControllerLimits
from swerve_kinematics.core.mecanum import MecanumKinematics
from swerve_kinematics.core.modules import (
    cosine_scale, desaturate, desaturate_chassis, interpolate, ModuleStates, optimize)
from swerve_kinematics.core.odometry import SwerveOdometry
from swerve_kinematics.core.se2 import (
    discretize, se2_compose, se2_exp, se2_log, to_field_frame, to_robot_frame)
from swerve_kinematics.core.swerve import SwerveKinematics
from swerve_kinematics.core.teleop import joystick_twist
from swerve_kinematics.core.uncertainty import OdometryNoise

__all__ = [
    'ControllerLimits', 'GyroBiasFilter', 'MecanumKinematics', 'ModuleCommand', 'ModuleStates',
    'OdometryNoise', 'SwerveController', 'SwerveKinematics', 'SwerveOdometry',
    'angle_difference', 'cosine_scale', 'desaturate', 'desaturate_chassis', 'discretize',
    'interpolate', 'joystick_twist', 'optimize', 'se2_compose', 'se2_exp', 'se2_log',
    'to_field_frame', 'to_robot_frame', 'wrap_angle',
]
