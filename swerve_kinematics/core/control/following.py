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
Whether the base does what it is told, so that no ramp runs on while its wheels are held.

An emergency stop, a contactor or the watchdog of a motor driver can hold the wheels while the
commands go on. When they are released, the base must not be told at once what a ramp has
reached in the meantime.
"""

from swerve_kinematics.core.control.limits import ControllerLimits, ratio
from swerve_kinematics.core.geometry.planar import (
    between, PlanarTwist, product, REST, speed_at)

# A drive that takes longer than twice this [s] to follow is taken for one that does not.
DRIVE_LAG = 0.25
# By then the base must do this part of what it should, less this speed [m/s].
LEAST_PART, SPEED_TOLERANCE = 0.5, 0.1
# What a base that is held is told beyond what it does, so as to notice when it no longer is:
# what the limits of acceleration allow in this time [s], and this speed [m/s] at the least.
FEELING_TIME, FEELING_SPEED = 0.05, 0.02


class Following:
    """
    How the base follows its commands.

    Attributes
    ----------
    is_held : bool
        Whether it stays behind by more than a drive's lag explains.

    """

    def __init__(self) -> None:
        """Expect nothing of a base at rest."""
        self.is_held = False
        # What the slowest drive would have made of the commands by now.
        self._expected = REST
        # Measured speed along the executed twist [m/s], a turn counted at the modules.
        self._progress = 0.0

    def pass_time(self, executed: PlanarTwist, measured: PlanarTwist | None, arm: float,
                  dt: float) -> None:
        """
        Take into account what a period brought.

        Parameters
        ----------
        executed : PlanarTwist
            What the base was told in that period.
        measured : PlanarTwist or None
            What it does now, if there is anything new; about the same point.
        arm : float
            Mean distance of the modules from that point [m].
        dt : float
            Duration of the period [s].

        """
        if measured is None and self._expected is REST:
            return  # nothing is measured
        self._expected = between(self._expected, executed, dt / (DRIVE_LAG + dt))
        told = speed_at(executed, arm)
        if told == 0.0:
            self.is_held = False
        elif measured is not None:
            self._progress = product(measured, executed, arm) / told
            if self._progress >= LEAST_PART * told:
                self.is_held = False
            elif not self.is_held:
                due = min(told, product(self._expected, executed, arm) / told)
                self.is_held = due > 0.0 and (
                    self._progress < LEAST_PART * due - SPEED_TOLERANCE)

    def scale(self, twist: PlanarTwist, limits: ControllerLimits, arm: float) -> float:
        """Return the factor, at most 1, on the twist of a held base: it is told little more."""
        growth = min(ratio(limits.max_linear_acceleration, abs(twist.velocity)),
                     ratio(limits.max_angular_acceleration, abs(twist.omega)))
        told = speed_at(twist, arm)
        feeling = max(growth * FEELING_TIME, ratio(FEELING_SPEED, told))
        return min(1.0, ratio(max(0.0, self._progress), told) + feeling)
