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

"""The way of the measurements: joint_states, imu and poses from outside -> odom and /tf."""

from collections import Counter
from collections.abc import Callable, Iterator
from time import monotonic
from typing import Any

from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu, JointState
from std_srvs.srv import Trigger

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.ros.collisions import LARGEST_HIT
from swerve_kinematics.ros.drive import Drive
from swerve_kinematics.ros.feedback import JointFeedback
from swerve_kinematics.ros.imu_feedback import ImuFeedback
from swerve_kinematics.ros.joint_sources import JointSources, turns_of_joints
from swerve_kinematics.ros.messages import (
    OdometryMessages, planar_pose_and_covariance, transform_broadcaster)
from swerve_kinematics.ros.peers import Peers
from swerve_kinematics.ros.rate import Rate
from swerve_kinematics.ros.sample import Sample
from swerve_kinematics.ros.sender_clock import SenderClock
from swerve_kinematics.ros.serialized_reading import JointStateReader
from swerve_kinematics.ros.set_pose import refusal
from swerve_kinematics.ros.slow_feedback import SlowFeedback
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds
from swerve_kinematics.ros.timeline import Timeline
from swerve_kinematics.ros.wait_set import Unhurried
from swerve_kinematics.ros.watch import Watch


class Estimation:
    """
    Advances the odometry with each complete set of measurements, and publishes it.

    Parameters
    ----------
    node : rclpy.node.Node
        Gets the publishers and the service.
    parameters : NodeParameters
        What to start with; `configure` takes over what may change later.
    timeline : Timeline
        Reads the clocks.
    drive : Drive
        Is told what was measured.
    peers : Peers
        Subscribes.
    warn : callable
        Logs a warning.

    Attributes
    ----------
    feedback : JointFeedback
        Collects the measurements.
    imu : ImuFeedback
        Adds to them what an IMU says.
    odometry : SwerveOdometry
        What they amount to.
    watch : Watch
        Judges whether they fit the description of the base.
    sample : Sample or None
        The latest complete set.

    """

    def __init__(self, node: Node, parameters: NodeParameters, timeline: Timeline, drive: Drive,
                 peers: Peers, warn: Callable[[str], None]) -> None:
        """Create what computes, what goes out and what comes in."""
        p = self._config = parameters
        self._timeline, self._drive, self._peers, self._warn = timeline, drive, peers, warn
        self.feedback = JointFeedback(
            p.layout, p.layout.gyro_joint if p.gyro_source == 'joint' else None,
            nanoseconds(p.feedback_timeout), nanoseconds(p.gyro_timeout))
        self.imu = ImuFeedback(node, p, self.feedback)
        self.odometry = SwerveOdometry(
            p.layout.kinematics, estimate_gyro_bias=p.estimate_gyro_bias, noise=p.noise,
            imu_position=p.imu_position, force_range=LARGEST_HIT)
        self.watch = Watch(p.layout.module_names, p.layout.kinematics.module_positions,
                           p.gyro_source != 'none')
        self.sample: Sample | None = None
        self._samples, self._rate = 0, Rate(monotonic())
        self._ignored_poses: Counter[str] = Counter()
        self._slow_feedback = SlowFeedback()
        self._sender_clocks = {'joint_states': SenderClock()}
        broadcaster = transform_broadcaster(node) if p.enable_odom_tf else None
        self._odometry_out = OdometryMessages(node, p.layout, broadcaster)
        self._joint_reader = JointStateReader()
        self._sources = JointSources(
            turns_of_joints(p.layout), nanoseconds(p.feedback_timeout),
            lambda: peers.count('joint_states'), self.feedback.clear)
        peers.subscribe(
            JointState, 'joint_states', self._on_joint_states, qos_profile_sensor_data, raw=True)
        peers.subscribe(PoseWithCovarianceStamped, '~/set_pose', self._on_set_pose,
                        group=Unhurried())
        if p.gyro_source == 'imu':
            self._sender_clocks['imu'] = SenderClock()
            peers.subscribe(Imu, 'imu', self._on_imu, qos_profile_sensor_data, raw=True)
        node.create_service(Trigger, '~/reset_odometry', self._on_reset_odometry)

    def configure(self, parameters: NodeParameters) -> None:
        """Take over what may change at run time."""
        self._config = parameters
        self.odometry.noise = parameters.noise
        self.feedback.timeout = self._sources.timeout = nanoseconds(parameters.feedback_timeout)
        self.feedback.gyro.timeout = nanoseconds(parameters.gyro_timeout)

    @property
    def ignored(self) -> Counter[str]:
        """Return how often input was ignored, by reason."""
        return (self.feedback.ignored + self._sources.ignored + self._ignored_poses
                + Counter({'forces out of range': self.imu.accelerometer.out_of_range,
                           'jumps of the yaw': self.odometry.yaw_jumps}))

    def rate(self) -> float:
        """Return how many complete sets came per second since the last call [Hz]."""
        return self._rate.look(self._samples, monotonic())

    def findings(self, rate: float) -> Iterator[str]:
        """Yield what is wrong with the senders since the last call, by their rate [Hz]."""
        yield from self._peers.absences(self._sender_clocks)
        yield from self._slow_feedback.findings(
            rate, self._config.control_rate, self._config.feedback_timeout, monotonic())
        for topic, clock in self._sender_clocks.items():
            behind = clock.report(nanoseconds(self._config.feedback_timeout))
            if behind is not None:
                way = 'behind' if behind > 0.0 else 'ahead'
                is_missed = not self._timeline.is_simulated and self._peers.count('/clock') > 0
                yield (f'stamps of {topic} are {abs(behind):.6g} s {way}: another clock, see '
                       + ('use_sim_time: /clock is there' if is_missed else 'restamp_feedback'))
        if self._sources.report():
            names = self._peers.publishers('joint_states')
            if len(names) > 1:
                yield f"the same joints are published by {' and '.join(names)}"
            # Alone is who was left by the others.
            elif names:
                yield (f'{names[0]} publishes joints that another node published before: ignored '
                       'until they move')

    def _on_joint_states(self, data: bytes, info: dict[str, Any]) -> None:
        """Advance the odometry when a set of module measurements is complete."""
        now = self._timeline.now()
        joints = self._joint_reader.read(data)
        if joints is None:
            self.feedback.ignored['damaged joint states'] += 1
            return
        if not self._sources.believes(joints.names, joints.positions, info):
            return
        sample = self.feedback.read(
            self._sender_clocks['joint_states'].stamp_of(
                joints.stamp, now.stamp, self._config.restamp_feedback),
            joints.names, joints.positions, joints.velocities)
        if sample is None:
            return
        if not sample.continuous:
            self._resume(sample.gyro_went_on)
        inertial = self.imu.means(sample)
        tells_motion = self.odometry.update(
            sample.stamp / NANOSECONDS, sample.distances, sample.angles, sample.yaw,
            sample.yaw_rate, sample.velocities, inertial.force, inertial.rates,
            sample.rate_integral)
        estimate = self.odometry.estimate
        if not self.odometry.is_waiting:
            self._odometry_out.publish(sample.stamp, estimate)
        self._drive.measured(
            sample.stamp, sample.angles, estimate.twist if tells_motion else None, now)
        self.watch.add(sample.stamp, sample.distances, sample.angles, sample.yaw,
                       sample.yaw_rate)
        self.sample = sample
        self._samples += 1

    def _resume(self, gyro_went_on: bool) -> None:
        """Go on from the pose that was known last, after feedback began or was interrupted."""
        if self._samples:
            self._warn('feedback was interrupted or its clock jumped: odometry continues '
                       'from its last pose')
        self.odometry.reprime(gyro_went_on)
        self.watch.restart()

    def _on_imu(self, data: bytes) -> None:
        """Keep what gyro and accelerometer say for the next complete set."""
        imu = self.imu.read(data)
        if imu is not None:
            self.imu.take(self._sender_clocks['imu'].stamp_of(
                imu.stamp, self._timeline.now().stamp, self._config.restamp_feedback), imu)

    def _on_set_pose(self, message: PoseWithCovarianceStamped) -> None:
        """Move the odometry to a pose given from outside."""
        pose, covariance = planar_pose_and_covariance(message.pose)
        reason = refusal(
            message.header.frame_id, self._config.layout.odom_frame, pose, covariance)
        if reason is None:
            self.odometry.reset(pose, covariance)
            return
        self._ignored_poses[reason] += 1
        self._warn(f'ignored: {reason}')

    def _on_reset_odometry(
            self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Move the odometry to its origin."""
        self.odometry.reset()
        response.success = True
        return response
