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

"""A base with its wheels off the floor, whose joints are commanded past swerve_node."""

from collections.abc import Callable, Iterator, Sequence

from swerve_kinematics.ros.command_output import Commands
from swerve_kinematics.ros.last_word import repeat_stop
from swerve_kinematics.tools.check.robot import Robot

# Nothing turns faster [rad/s], [m/s]: it has run away then.
FASTEST_STEERING, FASTEST_RIM = 8.0, 0.5


class LiftedBase:
    """
    Commands the joints of a base in terms of its modules.

    Parameters
    ----------
    seen : Robot
        With joint states coming in.

    Attributes
    ----------
    seen : Robot
    angles : list of float (n,)
        Where the modules were at the start [rad].

    Raises
    ------
    ValueError
        If another node commands the joints.

    """

    def __init__(self, seen: Robot) -> None:
        """Take the present angles as those to come back to."""
        self.seen = seen
        self._out: Commands = seen.joint_commands()
        self.angles = list(seen.sample().angles)

    def commanding(self, angles: Sequence[float] | None,
                   speeds: Sequence[float] | None = None) -> Callable[[], None]:
        """
        Return what commands module angles [rad] and rim speeds [m/s].

        Without angles it leaves the steering alone; without speeds the wheels stand.
        """
        joints, still = self.seen.layout.joints, [0.0] * len(self.angles)
        drives = joints.drives(still if speeds is None else speeds, still)
        steerings = None if angles is None else joints.steering_positions(angles)
        clock = self.seen.node.get_clock()
        return lambda: self._out.publish(clock.now().nanoseconds, drives, steerings)

    def moving(self, seconds: float, command: Callable[[], None]) -> Iterator[float]:
        """Command for so long and yield the time [s]; ValueError if it is not obeyed alone."""
        for time in self.seen.moving(seconds, command, FASTEST_RIM, FASTEST_STEERING):
            # One that starts later, or was discovered late.
            self.seen.refuse_rivals(self._out)
            yield time

    def stop(self) -> None:
        """Stop all joints where they are."""
        repeat_stop(self.commanding(None), self._out.wait_for_delivery)
