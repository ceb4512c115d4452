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

"""The way most teams drive a swerve base today, out of WPILib's own parts."""

import numpy as np
from wpimath.geometry import Rotation2d, Translation2d
from wpimath.kinematics import ChassisSpeeds, SwerveDrive4Kinematics


class Recipe:
    """
    Slew limits for each axis, discretize, inverse kinematics, desaturate, optimize, cosine.

    The slew limits are those of WPILib's SlewRateLimiter, written out here because that one
    reads the time from the robot's clock.

    Parameters
    ----------
    corners : ndarray (4, 2)
        Module positions [m].
    limits : ControllerLimits
        Those of acceleration and module speed count.
    period : float
        [s].

    """

    def __init__(self, corners, limits, period):
        """Start at rest."""
        self._kinematics = SwerveDrive4Kinematics(*(Translation2d(x, y) for x, y in corners))
        self._steps = period * np.array([
            limits.max_linear_acceleration, limits.max_linear_acceleration,
            limits.max_angular_acceleration])
        self._max_speed, self._period = limits.max_module_speed, period
        self._twist = np.zeros(3)

    def update(self, twist, angles):
        """Return rim speeds and steering angles (4,) for a twist and measured angles."""
        self._twist = self._twist + np.clip(twist - self._twist, -self._steps, self._steps)
        speeds = ChassisSpeeds.discretize(ChassisSpeeds(*self._twist), self._period)
        states = SwerveDrive4Kinematics.desaturateWheelSpeeds(
            self._kinematics.toSwerveModuleStates(speeds), self._max_speed)
        commands = []
        for state, angle in zip(states, angles):
            measured = Rotation2d(angle)
            state.optimize(measured)
            state.cosineScale(measured)
            # The nearest equivalent angle, as a motor with continuous input takes it.
            off = (state.angle - measured).radians()
            commands.append((state.speed, angle + np.arctan2(np.sin(off), np.cos(off))))
        return np.array(commands).T
