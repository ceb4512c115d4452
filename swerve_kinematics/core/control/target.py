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

"""What is commanded, and how fast the base shall go about it."""

import math

from numpy.typing import ArrayLike

from swerve_kinematics.core.control.following import Following
from swerve_kinematics.core.control.grip import steady_scale
from swerve_kinematics.core.control.limits import ControllerLimits, speed_scale
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.control.pace import Turning
from swerve_kinematics.core.control.quiet import Quiet
from swerve_kinematics.core.geometry.planar import (
    finite_twist, PlanarTwist, REST, scaled, turned)


class Target:
    """
    The commanded twist, with what is known of it and of the base that follows it.

    Attributes
    ----------
    twist : PlanarTwist
        The last valid one, in the base frame.
    turning : Turning
        How it turns.
    following : Following
        Whether the base stays behind.
    quiet : Quiet
        Whether it is worth a turn of the wheels.

    """

    def __init__(self) -> None:
        """Begin with nothing commanded."""
        self.twist = self._before = REST
        self.turning, self.following, self.quiet = Turning(), Following(), Quiet()

    def accept(self, twist: ArrayLike, heading: float | None) -> bool:
        """Take a finite twist, turned into the base frame; tell whether it was finite."""
        commanded = finite_twist(twist, 'twist')
        if commanded is None or heading is not None and not math.isfinite(heading):
            return False
        self.twist = commanded if heading is None else turned(commanded, -heading)
        return True

    def pass_time(self, executed: PlanarTwist, measured: PlanarTwist | None, offsets: Offsets,
                  limits: ControllerLimits, dt: float) -> None:
        """
        Take into account what a period brought.

        Parameters
        ----------
        executed : PlanarTwist
            What the base was told to do in it.
        measured : PlanarTwist or None
            What it does now, if there is anything new.
        offsets : Offsets
            Module positions from the centre of rotation [m].
        limits : ControllerLimits
            `min_steering_speed` counts.
        dt : float
            Positive [s].

        """
        self.turning.pass_time(self._before.velocity, self.twist.velocity, executed.omega, dt)
        self.following.pass_time(executed, measured, offsets.mean_arm, dt)
        self.quiet.pass_time(self.twist, offsets.mean_arm, limits.min_steering_speed, dt)
        self._before = self.twist

    def within(self, limits: ControllerLimits, offsets: Offsets) -> tuple[PlanarTwist, float]:
        """Return the twist at the speed at which it can be run, and the factor on it."""
        scale = speed_scale(self.twist, offsets, limits)
        twist = scaled(self.twist, scale)
        pace = self.turning.scale(twist, offsets, limits)
        if self.following.is_held:
            pace = min(pace, self.following.scale(twist, limits, offsets.mean_arm))
        if limits.max_grip_acceleration < math.inf:
            pace = min(pace, steady_scale(twist, offsets, limits.max_grip_acceleration))
        return scaled(twist, pace), scale * pace
