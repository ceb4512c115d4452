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
Whether a command is worth a turn of the wheels.

A joystick that does not quite return to zero, or a controller about its goal, commands tiny
velocities of any direction. Followed to the letter they make every module swing about at its
full rate while the wheels stand.
"""

from collections.abc import Sequence

from swerve_kinematics.core.control.setpoints import at_rest, Setpoint
from swerve_kinematics.core.geometry.planar import between, PlanarTwist, REST, speed_at

# The noise of commands is averaged out over this time [s].
AVERAGING_TIME = 0.1
# A command this many times the threshold is no noise, and is obeyed at once.
CERTAINTY = 3.0
# The part of the threshold below which wheels that turn leave off.
HYSTERESIS = 0.5
# A turn [rad] that is no trouble: what makes a path of slow commands a smooth curve.
SMALL_TURN = 0.02
# Turns count as on a base of this size [m] at the least: a small one obeys slow turns too.
LEAST_ARM = 0.35


class Quiet:
    """
    Whether commands are too slow for wheels to turn for them.

    Attributes
    ----------
    is_quiet : bool
        Whether the wheels hold their angles.

    """

    def __init__(self) -> None:
        """Begin with nothing commanded."""
        self.is_quiet = True
        self._average = REST  # of the commands of late

    def pass_time(self, commanded: PlanarTwist, arm: float, threshold: float, dt: float) -> None:
        """
        Take one more command into account.

        Parameters
        ----------
        commanded : PlanarTwist
            Of the centre of rotation, in the base frame.
        arm : float
            Mean distance of the modules from that centre [m].
        threshold : float
            Rim speed [m/s] for which wheels turn.
        dt : float
            Positive [s].

        """
        if arm < LEAST_ARM:
            arm = LEAST_ARM
        speed = speed_at(commanded, arm)
        if speed >= CERTAINTY * threshold:
            self._average, self.is_quiet = commanded, False
            return
        self._average = between(self._average, commanded, dt / (AVERAGING_TIME + dt))
        mean_speed = speed_at(self._average, arm)
        if self.is_quiet:
            self.is_quiet = mean_speed < threshold
        else:
            self.is_quiet = min(speed, mean_speed) < HYSTERESIS * threshold


def must_turn(setpoints: list[Setpoint], goals: Sequence[Setpoint]) -> bool:
    """Tell whether any wheel that has somewhere to go must turn for it."""
    return any(abs(goal.angle - setpoint.angle) > SMALL_TURN
               for setpoint, goal in zip(setpoints, goals) if not at_rest(goal))
