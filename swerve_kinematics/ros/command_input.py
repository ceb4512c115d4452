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

"""Which velocity command holds: the latest valid one, until its timeout."""

from collections import Counter
import math

from swerve_kinematics.ros.timeline import LONG_AGO, Moment

STOP = (0.0, 0.0, 0.0)


class CommandInput:
    """
    Keeps the latest valid command and counts what it refuses.

    `timeout` may change at run time.

    Parameters
    ----------
    timeout : int
        Age [ns] of a command after which the base stops.
    base_frame, odom_frame : str
        The frames a stamped command may be given in.

    Attributes
    ----------
    ignored : collections.Counter
        How often a command was ignored, by reason.
    in_field_frame : bool
        Whether the latest valid command is given in `odom_frame`.
    pauses : int
        How often one that moves the base came after another one's timeout.

    """

    def __init__(self, timeout: int, base_frame: str, odom_frame: str) -> None:
        """Start without a command."""
        self.timeout = timeout
        self.ignored: Counter[str] = Counter()
        self._frames = {'': False, base_frame: False, odom_frame: True}
        self._strange_frame = (
            f'cmd_vel in an unknown frame, neither {base_frame} nor {odom_frame}')
        self._twist, self._received, self.in_field_frame = STOP, LONG_AGO, False
        self.pauses = 0

    def accept(self, twist: tuple[float, float, float], now: Moment,
               in_field_frame: bool = False) -> str | None:
        """
        Take a command without a stamp.

        Parameters
        ----------
        twist : tuple of float (3,)
            `[vx, vy, omega]` [m/s, m/s, rad/s].
        now : Moment
            When it arrived.
        in_field_frame : bool
            Whether it is given in the odometry's frame instead of the base's.

        Returns
        -------
        str or None
            Why the command is refused, None if it holds from now on.

        """
        if not all(map(math.isfinite, twist)):
            return self._refuse('cmd_vel not finite')
        if now.has_backlog():
            return self._refuse('cmd_vel of unknown age')
        if self._twist != STOP and self.age(now) > self.timeout and twist != STOP:
            self.pauses += 1
        self._twist, self._received, self.in_field_frame = twist, now, in_field_frame
        return None

    def accept_stamped(self, twist: tuple[float, float, float], now: Moment, stamp: int,
                       frame: str) -> str | None:
        """
        Take a command with a stamp and a frame.

        Parameters
        ----------
        twist : tuple of float (3,)
            `[vx, vy, omega]` [m/s, m/s, rad/s] in `frame`.
        now : Moment
            When it arrived.
        stamp : int
            Time [ns] of the command on the node's clock; 0 means now.
        frame : str
            The base's frame, the odometry's, or empty for the base's.

        Returns
        -------
        str or None
            Why the command is refused, None if it holds from now on.

        """
        if frame not in self._frames:
            return self._refuse(self._strange_frame)
        if stamp and now.stamp - stamp > self.timeout:
            return self._refuse('cmd_vel too old')
        if stamp and stamp - now.stamp > self.timeout:
            return self._refuse('cmd_vel from the future')
        return self.accept(twist, now, self._frames[frame])

    def _refuse(self, reason: str) -> str:
        """Count a refusal."""
        self.ignored[reason] += 1
        return reason

    def age(self, now: Moment) -> int:
        """Return the time [ns] since the latest valid command; it is huge before the first."""
        return now.age(self._received)

    @property
    def has_come(self) -> bool:
        """Tell whether there was ever a valid command."""
        return self._received is not LONG_AGO

    def twist(self, now: Moment) -> tuple[float, float, float]:
        """
        Return what the base shall do now.

        Parameters
        ----------
        now : Moment
            The present.

        Returns
        -------
        tuple of float (3,)
            The latest valid command, or a stop once it is older than the timeout.

        """
        return self._twist if self.age(now) <= self.timeout else STOP
