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

"""What the modules are told to do: commands, feedback and timeouts brought together."""

from dataclasses import dataclass
import math

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.geometry.clamping import clamped
from swerve_kinematics.ros.command_input import CommandInput, STOP
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds
from swerve_kinematics.ros.steering_zeros import SteeringZeros
from swerve_kinematics.ros.timeline import LONG_AGO, Moment

# A command that comes late must not catch up on its ramp in one jump: the ramp advances by
# this many control periods at most, or steps of a simulated clock where those are longer.
LONGEST_STEP = 2.0


@dataclass(slots=True)
class DriveCommand:
    """
    One command to all joints.

    Attributes
    ----------
    wheel_speeds : list of float (n,)
        Drive joint velocities [rad/s].
    steering_angles : list of float (n,) or None
        Steering joint positions [rad]; None while they are not known.
    twist : tuple of float (3,)
        The twist being executed, in the base frame [m/s, m/s, rad/s].
    speeds : list of float (n,)
        What the joints are to make of the modules: rim speeds [m/s].
    angles : list of float (n,)
        Module angles [rad]; of no meaning while they are not known.

    """

    wheel_speeds: list[float]
    steering_angles: list[float] | None
    twist: tuple[float, float, float]
    speeds: list[float]
    angles: list[float]


class Drive:
    """
    Turns the velocity command that holds into joint commands, or into a stop.

    Parameters
    ----------
    parameters : NodeParameters
        What to start with; `configure` takes over what may change later.

    Attributes
    ----------
    controller : SwerveController
        The pipeline from a twist to module commands.
    input : CommandInput
        The velocity command that holds.
    mode : str
        What the base does: `driving`, `stopped`, `locked`, `no feedback` or `steering lost`.
    zeros : SteeringZeros
        Tells which steering joints read something else than they did, without having turned.
    scale : float
        In (0, 1]: the factor that took the command down to what was possible in the latest step.
    unreachable : list of bool (n,)
        Modules whose steering range has no angle for the command.
    is_held : bool
        Whether the base was found not to follow its commands.
    is_settled : bool
        Whether the latest command repeats the one before and drives no wheel.

    """

    def __init__(self, parameters: NodeParameters) -> None:
        """Start stopped, knowing nothing of the modules."""
        layout = parameters.layout
        self.controller = SwerveController(
            layout.kinematics, parameters.limits, parameters.center_of_rotation,
            parameters.steering_lower_limits, parameters.steering_upper_limits,
            parameters.idle_mode, parameters.unreachable_policy)
        self.input = CommandInput(0, layout.base_frame, layout.odom_frame)
        self._joints = layout.joints
        self._rest = [0.0] * len(layout.module_names)
        self._rates = self._rest
        self.zeros = SteeringZeros(len(self._rest))
        self._angles: list[float] | None = None  # of the latest command that was driven
        self._measured_angles: list[float] | None = None
        self._measured_at = LONG_AGO
        self._measured_twist: tuple[float, float, float] | None = None
        self._steering_angles: list[float] | None = None
        self._stepped_at = LONG_AGO
        self._execute_nothing('stopped')
        self._command: DriveCommand | None = None
        self.is_settled = False
        self.configure(parameters)

    def configure(self, parameters: NodeParameters) -> None:
        """Take over what may change at run time."""
        self.input.timeout = nanoseconds(parameters.cmd_vel_timeout)
        self.controller.limits = parameters.limits
        self.controller.center_of_rotation = parameters.center_of_rotation
        self.controller.idle_mode = parameters.idle_mode
        self._feedback_timeout = nanoseconds(parameters.feedback_timeout)
        self._open_loop = parameters.open_loop
        self._period = nanoseconds(1.0 / parameters.control_rate)

    def measured(self, stamp: int, angles: list[float],
                 twist: tuple[float, float, float] | None, now: Moment) -> None:
        """
        Take the measured steering angles and the motion of the base.

        Parameters
        ----------
        stamp : int
            Time of the measurement [ns].
        angles : list of float (n,)
            Multi-turn [rad].
        twist : tuple of float (3,) or None
            Of the base, in its own frame [m/s, m/s, rad/s]; None where the feedback did not tell
            it, as after a gap: the 0 of then must not brake a base that drives.
        now : Moment
            Of their arrival.

        """
        self.zeros.read(stamp, angles)
        self._measured_angles, self._measured_at = angles, now
        if twist is not None:
            self._measured_twist = twist

    def feedback_age(self, now: Moment) -> int:
        """Return the time [ns] since the latest feedback; it is huge before the first."""
        return now.feedback_age(self._measured_at)

    def has_feedback(self, now: Moment) -> bool:
        """Tell whether the latest feedback still holds."""
        return self.feedback_age(now) <= self._feedback_timeout

    def lacks_feedback(self, now: Moment) -> bool:
        """Tell whether the steering angles must be known, and are not."""
        return not self._open_loop and self.feedback_age(now) > self._feedback_timeout

    @property
    def lost(self) -> list[bool]:
        """Return of each module whether it must not drive, as nobody knows where it points."""
        return [not self._open_loop and is_lost for is_lost in self.zeros.lost]

    def trust_steering(self) -> bool:
        """Take what the steering joints read as right, and return whether any seemed lost."""
        was_lost = any(self.lost)
        if was_lost:
            self.zeros.forget()
        return was_lost

    def step(self, now: Moment, heading: float) -> DriveCommand:
        """
        Advance to a moment and return the command for it.

        Parameters
        ----------
        now : Moment
            The present.
        heading : float
            Of the base in the odometry's frame [rad], for field-centric commands.

        Returns
        -------
        DriveCommand

        """
        if now.woke > self._stepped_at.real:
            # This process was held up, and whoever watches over the drives has stopped them.
            self.stop()
        if self.lacks_feedback(now):
            command = self.stop()
            self._execute_nothing('no feedback')
        elif any(self.lost):
            command = self.stop()
            self._execute_nothing('steering lost')
        else:
            command = self._driven(now, heading)
        self._stepped_at = now
        self.is_settled = not any(command.wheel_speeds) and command == self._command
        self._command = command
        return command

    def _execute_nothing(self, mode: str) -> None:
        """Tell the diagnostics that no command is executed, and why."""
        self.mode, self.scale, self.is_held = mode, 1.0, False
        self.unreachable = [False] * len(self._rest)

    def _driven(self, now: Moment, heading: float) -> DriveCommand:
        """Return the command of the controller, whose state it keeps for the diagnostics."""
        longest = LONGEST_STEP * max(self._period, now.grain)
        dt = min(now.age(self._stepped_at), longest) / NANOSECONDS
        angles, twist = self._measured_angles, self._measured_twist
        self._measured_twist = None  # the next step shall not take it for a new one
        if self._open_loop:
            angles = twist = None
        command = self.controller.update(
            self.input.twist(now), angles, dt, heading if self.input.in_field_frame else None,
            twist)
        self._steer(command.angle_list, dt)
        self.scale, self.is_held = command.scale, command.held
        self.unreachable = command.unreachable_list
        is_driving = any(command.speed_list)
        self.zeros.command(command.angle_list, is_driving)
        self.mode = ('locked' if self.controller.locked else
                     'driving' if is_driving else 'stopped')
        return DriveCommand(
            self._joints.drives(command.speed_list, self._rates), self._steering_angles,
            command.planar_twist.parts, command.speed_list, command.angle_list)

    def _steer(self, angles: list[float], dt: float) -> None:
        """
        Take the module angles commanded for the next period, and how fast they change.

        A coupled drive joint must turn along with its module, or the wheel would roll as it
        steers. The first command after a stop only takes up where the modules are, and no
        module is expected to steer faster than its limit.
        """
        if self._angles is None:
            self._rates = self._rest
        elif self._joints.is_coupled and dt > 0.0:
            fastest = self.controller.limits.max_steering_rate
            self._rates = [clamped(math.remainder(angle - before, TURN) / dt, fastest)
                           for angle, before in zip(angles, self._angles)]
        self._angles = angles
        self._steering_angles = self._joints.steering_positions(angles)

    def stop(self) -> DriveCommand:
        """
        Stop the wheels at once and hold the steering.

        Returns
        -------
        DriveCommand

        """
        if self._angles is not None:  # there is nothing to forget since the stop before
            self.controller.reset()
        angles, self._angles = self._angles or self._rest, None
        return DriveCommand(self._rest, self._steering_angles, STOP, self._rest, angles)
