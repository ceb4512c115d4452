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
The swerve_node: convert, call the core, publish.

The way of the data: cmd_vel -> CommandInput -> SwerveController -> command topics, and
joint_states -> JointFeedback -> SwerveOdometry -> odom and /tf (see `estimation`).
"""

from collections import Counter
import sys
from time import monotonic
from typing import Any, Sequence

from geometry_msgs.msg import Twist, TwistStamped
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from std_srvs.srv import SetBool, Trigger

from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.node import (
    NODE_DECLARATIONS, NodeParameters, parameters_from)
from swerve_kinematics.configuration.program import NODE, Settings
from swerve_kinematics.ros.command_output import COMMANDS, LimitedTwist
from swerve_kinematics.ros.command_report import CommandReport
from swerve_kinematics.ros.declare import declare, overrides, plain_value, without_effect
from swerve_kinematics.ros.diagnostics import Diagnostics, ERROR, WARN
from swerve_kinematics.ros.drive import Drive
from swerve_kinematics.ros.estimation import Estimation
from swerve_kinematics.ros.findings import findings_and_values, wrapping_found
from swerve_kinematics.ros.last_word import LAST_WORD, repeat_stop
from swerve_kinematics.ros.markers import Markers
from swerve_kinematics.ros.messages import serialized_planar_twist, serialized_stamped_twist
from swerve_kinematics.ros.pacing import Pacer, rest_period
from swerve_kinematics.ros.peers import Peers
from swerve_kinematics.ros.qos import FROM_ANY_PUBLISHER
from swerve_kinematics.ros.stamps import nanoseconds
from swerve_kinematics.ros.start import start
from swerve_kinematics.ros.timeline import Moment, Timeline
from swerve_kinematics.ros.valid_time import ValidTimeNode
from swerve_kinematics.ros.wait_set import Unhurried

WARNING_PERIOD = 5.0  # s between two warnings from one place
DIAGNOSTICS_PERIOD = 1.0  # s
# So many control periods without a turn of the loop are a freeze, and not just a late turn.
FREEZE = 2.5
# For how long [s] a stop is repeated whose listeners still have to find this node.
INTRODUCTION = 5.0


class SwerveNode(ValidTimeNode):
    """Drives a swerve base: commands out of cmd_vel, odometry out of joint_states."""

    def __init__(self, settings: Settings[NodeParameters]) -> None:
        """Join the graph with what the parameters describe."""
        super().__init__(NODE.name, parameter_overrides=overrides(settings.of_rclpy))
        self._values, self._config = settings.values, settings.parameters
        declare(self, NODE_DECLARATIONS, self._values)
        self._timeline = Timeline(self.get_clock(), self._patience())
        self._drive = Drive(self._config)
        # What tells the wheels to turn, and to stop.
        self._commands_out = COMMANDS[self._config.command_interface](
            self, self._config.layout)
        try:
            self._create_outputs()
            self._create_inputs()
            self.add_on_set_parameters_callback(self._check_parameters)
            self.add_post_set_parameters_callback(self._apply_parameters)
            self.get_logger().info(settings.summary)
            for name in without_effect(self, settings.of_rclpy):
                self.get_logger().warning(
                    f"'{name}' matches no topic of this node, so it has no effect")
        except BaseException:
            self.stop(INTRODUCTION)  # the wheels may still turn as an earlier node told them
            raise

    def _create_outputs(self) -> None:
        """Create what goes out besides commands and odometry."""
        self._limited_out = LimitedTwist(self, self._config.layout)
        self._markers_out = Markers(self, self._config.layout)
        self._diagnostics = Diagnostics(self)

    def _create_inputs(self) -> None:
        """Create everything that comes in, and the timers."""
        p = self._config
        self._peers = Peers(self)
        self._command_report = CommandReport(self._peers, self._drive.input)
        if p.use_stamped_vel:
            self._peers.subscribe(
                TwistStamped, 'cmd_vel', self._on_stamped_cmd_vel, FROM_ANY_PUBLISHER, raw=True)
        else:
            self._peers.subscribe(
                Twist, 'cmd_vel', self._on_cmd_vel, FROM_ANY_PUBLISHER, raw=True)
        self._estimation = Estimation(
            self, p, self._timeline, self._drive, self._peers, self._warn)
        self.create_service(SetBool, '~/lock_wheels', self._on_lock_wheels)
        self.create_service(Trigger, '~/trust_steering', self._on_trust_steering)
        self._pacer = Pacer(self, nanoseconds(1.0 / p.control_rate), self._control)
        # On a clock of its own: a paused simulation still reports.
        self.create_timer(DIAGNOSTICS_PERIOD, self._report, callback_group=Unhurried(),
                          clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _patience(self) -> int:
        """Return the time [ns] without a turn of the control loop that makes a freeze."""
        period = rest_period(nanoseconds(1.0 / self._config.control_rate))
        return max(nanoseconds(self._config.cmd_vel_timeout), round(FREEZE * period))

    def _warn(self, message: str) -> None:
        """Log a warning, at most one in a few seconds."""
        self.get_logger().warning(message, throttle_duration_sec=WARNING_PERIOD)

    def _on_cmd_vel(self, data: bytes, info: dict[str, Any]) -> None:
        """Execute a serialized Twist at once."""
        now = self._timeline.now()
        twist = serialized_planar_twist(data)
        self._command_report.senders.heard(twist, info)
        self._executed(now, self._drive.input.accept(twist, now, self._config.field_centric))

    def _on_stamped_cmd_vel(self, data: bytes, info: dict[str, Any]) -> None:
        """Execute a serialized TwistStamped at once."""
        now = self._timeline.now()
        twist, stamp, frame = serialized_stamped_twist(data)
        self._command_report.senders.heard(twist, info)
        self._executed(now, self._drive.input.accept_stamped(twist, now, stamp, frame))

    def _executed(self, now: Moment, refusal: str | None) -> None:
        """Publish what follows from a new command, or warn of its refusal."""
        if refusal is not None:
            self._warn(f'ignored: {refusal}')
            return
        self._command(now)
        # The timer fills in where commands come slower than control_rate.
        self._pacer.restart()

    def _control(self) -> None:
        """Keep ramps and timeouts moving where no new command does."""
        self._command(self._timeline.now())

    def _command(self, now: Moment) -> None:
        """Advance the command to the present and publish it."""
        estimation = self._estimation
        command = self._drive.step(now, estimation.odometry.yaw)
        self._commands_out.publish(now.stamp, command.wheel_speeds, command.steering_angles)
        self._limited_out.publish(now.stamp, command.twist)
        if self._markers_out.are_due(now.stamp):
            self._markers_out.publish(
                command, estimation.sample if self._drive.has_feedback(now) else None,
                estimation.odometry, self._config.center_of_rotation)
        estimation.watch.commanded(command.speeds, command.angles)
        self._pacer.commanded(self._drive.is_settled, self._timeline.is_simulated)

    def _on_lock_wheels(
            self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """Lock the wheels in the X pattern, or release them."""
        if request.data:
            self._drive.controller.lock()
        else:
            self._drive.controller.unlock()
        response.success = True
        response.message = 'will lock once stopped' if request.data else 'unlocked'
        return response

    def _on_trust_steering(
            self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Believe steering joints that seemed lost: somebody has looked where the wheels point."""
        response.success = self._drive.trust_steering()
        response.message = 'driving on' if response.success else 'no steering joint is lost'
        return response

    def _report(self) -> None:
        """Publish the diagnostics."""
        estimation, now = self._estimation, self._timeline.now()
        rate = estimation.rate()
        findings, values = findings_and_values(self._config, self._drive, estimation, now, rate)
        if now.stands and not now.stamp:
            findings.append((WARN, 'use_sim_time is set, but /clock is silent'))
        if estimation.feedback.unwrapper.is_found:
            self.get_logger().warning(wrapping_found(estimation.feedback), once=True)
        findings += [(ERROR if grave else WARN, message)
                     for grave, message in estimation.watch.findings()]
        findings += [(WARN, message) for message in (
            *self._peers.mismatches(), *self._peers.rivals(self._commands_out.publishers),
            *estimation.findings(rate))]
        if self._drive.mode == 'driving':
            findings += [(WARN, told) for told in self._peers.unheard(
                self._commands_out.publishers)]
        findings += self._command_report.findings(monotonic())
        self._diagnostics.publish(
            findings, values, self._drive.input.ignored + estimation.ignored
            + Counter({'impossible times on /clock': self.impossible_times}))

    def _check_parameters(self, changes: list[Parameter]) -> SetParametersResult:
        """Refuse a change that the parameters as a whole do not allow."""
        try:
            parameters_from(self._changed(changes))
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply_parameters(self, changes: list[Parameter]) -> None:
        """Take over parameters that have changed."""
        self._values = self._changed(changes)
        self._config = parameters_from(self._values)
        self._timeline.patience = self._patience()
        self._drive.configure(self._config)
        self._estimation.configure(self._config)

    def _changed(self, changes: list[Parameter]) -> dict[str, Any]:
        """Return the values of the node's own parameters after the changes."""
        changed = {parameter.name: plain_value(parameter) for parameter in changes}
        return {name: changed.get(name, value) for name, value in self._values.items()}

    def stop(self, duration: float = LAST_WORD) -> None:
        """Tell the wheels to stop, over and over until whoever listens must have heard it."""
        command = self._drive.stop()
        repeat_stop(
            lambda: self._commands_out.publish(
                self._timeline.now().stamp, command.wheel_speeds, command.steering_angles),
            self._commands_out.wait_for_delivery, duration, 1.0 / self._config.control_rate)


def main(args: Sequence[str] | None = None) -> int:
    """Run the node until Ctrl-C or SIGTERM; return the exit code."""
    return start(NODE, SwerveNode, args)


if __name__ == '__main__':
    sys.exit(main())
