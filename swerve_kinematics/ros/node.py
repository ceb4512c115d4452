"""
The swerve_node: convert, call the core, publish.

The way of the data: cmd_vel -> CommandInput -> SwerveController -> command topics, and
joint_states -> JointFeedback -> SwerveOdometry -> odom and /tf.
"""

from collections import Counter
import sys
from time import monotonic, sleep

from geometry_msgs.msg import PoseWithCovarianceStamped, Twist, TwistStamped
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu, JointState
from std_srvs.srv import SetBool, Trigger

from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.node import (
    NODE_DECLARATIONS, NodeParameters, parameters_from)
from swerve_kinematics.configuration.program import NODE, Settings
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.ros.declare import declare, overrides, plain_value
from swerve_kinematics.ros.diagnostics import (
    Diagnostics, ERROR, findings_and_values, WARN, wrapping_found)
from swerve_kinematics.ros.drive import Drive
from swerve_kinematics.ros.feedback import JointFeedback
from swerve_kinematics.ros.imu_feedback import ImuFeedback
from swerve_kinematics.ros.joint_sources import JointSources
from swerve_kinematics.ros.markers import Markers
from swerve_kinematics.ros.messages import (
    ForwardCommands, JointCommands, LimitedTwist, OdometryMessages, planar_pose_and_covariance,
    serialized_planar_twist, serialized_stamped_twist, transform_broadcaster)
from swerve_kinematics.ros.pacing import Pacer
from swerve_kinematics.ros.peers import Peers
from swerve_kinematics.ros.qos import FROM_ANY_PUBLISHER, subscription
from swerve_kinematics.ros.sender_clock import SenderClock
from swerve_kinematics.ros.serialized_reading import JointStateReader
from swerve_kinematics.ros.set_pose import refusal
from swerve_kinematics.ros.slow_feedback import SlowFeedback
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds
from swerve_kinematics.ros.start import start
from swerve_kinematics.ros.timeline import Moment, Timeline
from swerve_kinematics.ros.valid_time import ValidTimeNode
from swerve_kinematics.ros.watch import Watch

WARNING_PERIOD = 5.0  # s between two warnings from one place
DIAGNOSTICS_PERIOD = 1.0  # s
# For how long [s] the last stop is repeated, and how often at least. A best-effort listener
# acknowledges nothing, may lose a message, and loses those it has not read yet when the process
# that sent them ends: it needs the time to run once, on a busy machine.
LAST_WORD, LEAST_STOPS = 0.4, 10
# For how long [s] one is repeated whose listeners still have to find this node.
INTRODUCTION = 2.0


class SwerveNode(ValidTimeNode):
    """Drives a swerve base: commands out of cmd_vel, odometry out of joint_states."""

    def __init__(self, settings: Settings[NodeParameters]) -> None:
        """Join the graph with what the parameters describe."""
        super().__init__(NODE.name, parameter_overrides=overrides(settings.of_rclpy))
        self._values, self._config = settings.values, settings.parameters
        declare(self, NODE_DECLARATIONS, self._values)
        self._create_core()
        self._create_command_publishers()
        try:
            self._create_publishers()
            self._create_inputs()
            self.add_on_set_parameters_callback(self._check_parameters)
            self.add_post_set_parameters_callback(self._apply_parameters)
            self.get_logger().info(settings.summary)
        except BaseException:
            self.stop(INTRODUCTION)  # the wheels may still turn as an earlier node told them
            raise

    def _create_core(self):
        """Create what computes."""
        p = self._config
        self._timeline = Timeline(self.get_clock(), self._patience())
        self._drive = Drive(p)
        self._feedback = JointFeedback(
            p.layout, p.layout.gyro_joint if p.gyro_source == 'joint' else None,
            nanoseconds(p.feedback_timeout), nanoseconds(p.gyro_timeout))
        self._imu = ImuFeedback(self, p, self._feedback)
        self._joint_reader = JointStateReader()
        self._odometry = SwerveOdometry(
            p.layout.kinematics, estimate_gyro_bias=p.estimate_gyro_bias, noise=p.noise,
            imu_position=p.imu_position)
        self._watch = Watch(p.layout.module_names, p.layout.kinematics.module_positions,
                            p.gyro_source != 'none')
        self._sample, self._samples, self._samples_reported = None, 0, 0
        self._ignored_poses, self._slow_feedback = Counter(), SlowFeedback()
        self._sender_clocks = {'joint_states': SenderClock(), 'imu': SenderClock()}

    def _create_command_publishers(self) -> None:
        """Create what tells the wheels to turn, and to stop."""
        commands = {'forward_command': ForwardCommands, 'joint_state': JointCommands}
        self._commands_out = commands[self._config.command_interface](self, self._config.layout)

    def _create_publishers(self):
        """Create everything else that goes out."""
        p = self._config
        self._limited_out = LimitedTwist(self, p.layout)
        broadcaster = transform_broadcaster(self) if p.enable_odom_tf else None
        self._odometry_out = OdometryMessages(self, p.layout, broadcaster)
        self._markers_out = Markers(self, p.layout)
        self._diagnostics = Diagnostics(self)

    def _create_inputs(self):
        """Create everything that comes in, and the timers."""
        p = self._config
        commands = (
            (TwistStamped, 'cmd_vel', self._on_stamped_cmd_vel, FROM_ANY_PUBLISHER, True)
            if p.use_stamped_vel else
            (Twist, 'cmd_vel', self._on_cmd_vel, FROM_ANY_PUBLISHER, True))
        states = JointState, 'joint_states', self._on_joint_states, qos_profile_sensor_data, True
        imu = Imu, 'imu', self._on_imu, qos_profile_sensor_data, True
        pose = PoseWithCovarianceStamped, '~/set_pose', self._on_set_pose
        self._peers = Peers(self, [subscription(self, *wanted) for wanted in (
            commands, states, pose, *([imu] if p.gyro_source == 'imu' else []))])
        joints = *p.layout.drive_joints, *p.layout.steering_joints, p.layout.gyro_joint
        self._sources = JointSources(
            joints, nanoseconds(p.feedback_timeout),
            lambda: self._peers.count('joint_states'), self._feedback.clear)
        self.create_service(Trigger, '~/reset_odometry', self._on_reset_odometry)
        self.create_service(SetBool, '~/lock_wheels', self._on_lock_wheels)
        self._pacer = Pacer(self, nanoseconds(1.0 / p.control_rate), self._control)
        # On a clock of its own: a paused simulation still reports.
        self.create_timer(DIAGNOSTICS_PERIOD, self._report,
                          clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _patience(self) -> int:
        """Return the time [ns] without a turn of the control loop that makes a freeze."""
        return nanoseconds(max(self._config.cmd_vel_timeout, 2.5 / self._config.control_rate))

    def _warn(self, message):
        """Log a warning, at most one in a few seconds."""
        self.get_logger().warning(message, throttle_duration_sec=WARNING_PERIOD)

    def _on_cmd_vel(self, data):
        """Execute a serialized Twist at once."""
        now = self._timeline.now()
        self._executed(now, self._drive.input.accept(
            serialized_planar_twist(data), now, self._config.field_centric))

    def _on_stamped_cmd_vel(self, data):
        """Execute a serialized TwistStamped at once."""
        now = self._timeline.now()
        twist, stamp, frame = serialized_stamped_twist(data)
        self._executed(now, self._drive.input.accept_stamped(twist, now, stamp, frame))

    def _executed(self, now, refusal):
        """Publish what follows from a new command, or warn of its refusal."""
        if refusal is not None:
            self._warn(f'ignored: {refusal}')
            return
        self._command(now)
        # The timer fills in where commands come slower than control_rate.
        self._pacer.restart()

    def _control(self):
        """Keep ramps and timeouts moving where no new command does."""
        self._command(self._timeline.now())

    def _command(self, now: Moment) -> None:
        """Advance the command to the present and publish it."""
        command = self._drive.step(now, self._odometry.yaw)
        self._commands_out.publish(now.stamp, command.wheel_speeds, command.steering_angles)
        self._limited_out.publish(now.stamp, command.twist)
        self._markers_out.publish(
            now.stamp, command, self._sample if self._drive.has_feedback(now) else None,
            self._odometry, self._config.center_of_rotation)
        self._watch.commanded(command.speeds, command.angles)
        self._pacer.commanded(self._drive.is_settled, self._timeline.is_simulated)

    def _on_joint_states(self, data, info):
        """Advance the odometry when a set of module measurements is complete."""
        joints = self._joint_reader.read(data)
        if joints is None:
            self._feedback.ignored['damaged joint states'] += 1
            return
        stamp, names, positions, velocities = joints
        if not self._sources.believes(names, positions, info):
            return
        sample = self._feedback.read(
            self._stamp_of('joint_states', stamp), names, positions, velocities)
        if sample is None:
            return
        if not sample.continuous:
            self._resume()
        inertial = self._imu.means(sample)
        self._odometry.update(sample.stamp / NANOSECONDS, sample.distances, sample.angles,
                              sample.yaw, sample.yaw_rate, sample.velocities, inertial.force,
                              inertial.rates, sample.rate_integral)
        estimate = self._odometry.estimate
        self._odometry_out.publish(sample.stamp, estimate)
        self._drive.measured(sample.angles, estimate.twist, self._timeline.now())
        self._watch.add(sample.stamp, sample.distances, sample.angles, sample.yaw,
                        sample.yaw_rate)
        self._sample = sample
        self._samples += 1

    def _resume(self):
        """Go on from the pose that was known last, after feedback began or was interrupted."""
        if self._samples:
            self._warn('feedback was interrupted or its clock jumped: odometry goes on from '
                       'its last pose')
        self._odometry.reprime()
        self._watch.restart()

    def _on_imu(self, data):
        """Keep what gyro and accelerometer say for the next complete set."""
        imu = self._imu.read(data)
        if imu is not None:
            self._imu.take(self._stamp_of('imu', imu.stamp), imu)

    def _stamp_of(self, topic, stamp):
        """Return the time [ns] of feedback: its stamp [ns], or now where it has none."""
        now = self._timeline.now().stamp
        if not stamp:
            return now
        clock = self._sender_clocks[topic]
        if self._config.restamp_feedback:
            return clock.restamped(stamp, now)
        clock.observe(stamp, now)
        return stamp

    def _on_set_pose(self, message):
        """Move the odometry to a pose given from outside."""
        pose, covariance = planar_pose_and_covariance(message.pose)
        reason = refusal(
            message.header.frame_id, self._config.layout.odom_frame, pose, covariance)
        if reason is None:
            self._odometry.reset(pose, covariance)
            return
        self._ignored_poses[reason] += 1
        self._warn(f'ignored: {reason}')

    def _on_reset_odometry(self, _, response):
        """Move the odometry to its origin."""
        self._odometry.reset()
        response.success = True
        return response

    def _on_lock_wheels(self, request, response):
        """Lock the wheels in the X pattern, or release them."""
        if request.data:
            self._drive.controller.lock()
        else:
            self._drive.controller.unlock()
        response.success = True
        response.message = 'locked once stopped' if request.data else 'unlocked'
        return response

    def _report(self):
        """Publish the diagnostics."""
        rate, self._samples_reported = self._samples - self._samples_reported, self._samples
        findings, values = findings_and_values(
            self._config, self._drive, self._feedback, self._imu.accelerometer,
            self._odometry, self._sample, self._timeline.now(), rate / DIAGNOSTICS_PERIOD)
        if self._feedback.unwrapper.is_found:
            self.get_logger().warning(wrapping_found(self._feedback), once=True)
        findings += [(ERROR if grave else WARN, message)
                     for grave, message in self._watch.findings()]
        findings += [(WARN, message) for message in (
            *self._peers.mismatches(), *self._slow_feedback.findings(
                rate / DIAGNOSTICS_PERIOD, self._config.control_rate, monotonic()))]
        for topic, clock in self._sender_clocks.items():
            behind = clock.report(nanoseconds(self._config.feedback_timeout))
            if behind is not None:
                findings.append((WARN, f'stamps of {topic} are {behind:.6g} s behind: another '
                                       'clock, see restamp_feedback'))
        if self._sources.report():
            findings.append((WARN, 'the same joints are published by '
                             + ' and '.join(self._peers.publishers('joint_states'))))
        self._diagnostics.publish(
            findings, values,
            self._drive.input.ignored + self._feedback.ignored + self._sources.ignored
            + self._ignored_poses
            + Counter({'impossible times on /clock': self.impossible_times,
                       'forces out of range': self._imu.accelerometer.out_of_range,
                       'yaw that jumped': self._odometry.yaw_jumps}))

    def _check_parameters(self, changes):
        """Refuse a change that the parameters as a whole do not allow."""
        try:
            parameters_from(self._changed(changes))
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply_parameters(self, changes):
        """Take over parameters that have changed."""
        self._values = self._changed(changes)
        self._config = parameters_from(self._values)
        self._timeline.patience = self._patience()
        self._drive.configure(self._config)
        self._odometry.noise = self._config.noise
        self._feedback.timeout = nanoseconds(self._config.feedback_timeout)
        self._feedback.gyro.timeout = nanoseconds(self._config.gyro_timeout)

    def _changed(self, changes):
        """Return the values of the node's own parameters after the changes."""
        changed = {parameter.name: plain_value(parameter) for parameter in changes}
        return {name: changed.get(name, value) for name, value in self._values.items()}

    def stop(self, duration: float = LAST_WORD) -> None:
        """Tell the wheels to stop, over and over until whoever listens must have heard it."""
        command = self._drive.stop()
        period = min(1.0 / self._config.control_rate, LAST_WORD / LEAST_STOPS)
        end = monotonic() + duration
        while monotonic() < end:
            self._commands_out.publish(
                self._timeline.now().stamp, command.wheel_speeds, command.steering_angles)
            sleep(period)
        self._commands_out.wait_for_delivery()


def main(args=None):
    """Run the node until Ctrl-C or SIGTERM; return the exit code."""
    return start(NODE, SwerveNode, args)


if __name__ == '__main__':
    sys.exit(main())
