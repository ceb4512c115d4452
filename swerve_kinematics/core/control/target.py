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
from swerve_kinematics.core.control.limits import ControllerLimits, ratio, speed_scale
from swerve_kinematics.core.control.pace import Turning, turning_after, turning_scale
from swerve_kinematics.core.control.quiet import Quiet
from swerve_kinematics.core.geometry.planar import (
    finite_twist, PlanarTwist, REST, scaled, turned)

# No base is faster [m/s, rad/s]; it keeps the arithmetic of a controller without limits finite.
SPEED_CEILING = 1e6


class Target:
    """
    The commanded twist, with what is known of it and of the base that follows it.

    Attributes
    ----------
    twist : PlanarTwist
        The last valid one, in the base frame.

    """

    def __init__(self) -> None:
        """Begin with nothing commanded."""
        self.twist = self._before = REST
        self._turning, self._following, self._quiet = Turning(), Following(), Quiet()

    @property
    def is_held(self) -> bool:
        """Tell whether the base stays behind by more than its drives explain."""
        return self._following.is_held

    def is_straight(self, omega: float) -> bool:
        """Tell whether the commands lead along a line in the world while the base turns so."""
        return self._turning.is_straight(omega)

    @property
    def is_quiet(self) -> bool:
        """Tell whether the commands of late are not worth a turn of the wheels."""
        return self._quiet.is_quiet

    def accept(self, twist: ArrayLike, heading: float | None) -> bool:
        """Take a finite twist, turned into the base frame; tell whether it was finite."""
        finite = finite_twist(twist, 'twist')
        if finite is None or not math.isfinite(heading or 0.0):
            return False
        commanded = scaled(finite, min(1.0, ratio(SPEED_CEILING, max(map(abs, finite.parts)))))
        self.twist = commanded if heading is None else turned(commanded, -heading)
        return True

    def pass_time(self, executed: PlanarTwist, measured: PlanarTwist | None, arm: float,
                  limits: ControllerLimits, dt: float) -> None:
        """
        Take into account what a period brought.

        Parameters
        ----------
        executed : PlanarTwist
            What the base was told to do in it.
        measured : PlanarTwist or None
            What it does now, if there is anything new.
        arm : float
            Mean distance of the modules from the centre of rotation [m].
        limits : ControllerLimits
            `min_steering_speed` counts.
        dt : float
            Positive [s].

        """
        self._turning = turning_after(
            self._turning, self._before.velocity, self.twist.velocity, executed.omega, dt)
        self._following = self._following.after(executed, measured, arm, dt)
        self._quiet = self._quiet.after(self.twist, arm, limits.min_steering_speed, dt)
        self._before = self.twist

    def within(self, limits: ControllerLimits, offsets: list[complex],
               arm: float) -> tuple[PlanarTwist, float]:
        """Return the twist at the speed at which it can be run, and the factor on it."""
        scale = speed_scale(self.twist, offsets, limits)
        twist = scaled(self.twist, scale)
        pace = min(turning_scale(twist, self._turning, offsets, limits),
                   self._following.scale(twist, limits, arm),
                   steady_scale(twist, offsets, limits.max_grip_acceleration))
        return scaled(twist, pace), scale * pace
