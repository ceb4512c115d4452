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

"""The robot as a check sees it: its joints, its gyro, its commands, and who else is there."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
import math
import signal
from time import monotonic
from typing import Any, NamedTuple

import rclpy
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data, QoSProfile
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Float64MultiArray

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.ros.command_output import COMMANDS, Commands
from swerve_kinematics.ros.executor_choice import make_executor
from swerve_kinematics.ros.joint_sources import JointSources, turns_of_joints
from swerve_kinematics.ros.peers import absence, Peers
from swerve_kinematics.ros.process import initialize, leaving
from swerve_kinematics.ros.sample import Sample
from swerve_kinematics.ros.signals import collected_signals, ENDING_SIGNALS
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds
from swerve_kinematics.tools.recordings.collector import Collector
from swerve_kinematics.tools.recordings.messages import (
    take_drive_commands, take_imu, take_joint_commands, take_joints, take_steering_commands,
    Taker)

# Joint states that are older [s] are silence, and a first one must come within this.
SILENCE, PATIENCE = 0.5, 5.0
PERIOD = 0.02  # s between commands
LOOK = 0.1  # s, over which the speed of a joint is taken
# Joints that are to stand do so within this [s]: for so long [s], to this [m/s], [rad/s].
STOPPING, STANDING_TIME, STANDING, STEERING_STANDING = 2.0, 0.3, 0.02, 0.1
# Who else commands the joints is known so long [s] after joining the graph.
DISCOVERY = 1.5


def nothing() -> None:
    """Do nothing but listen."""


class Moved(NamedTuple):
    """What each joint did [m, rad]; drives without what their modules' turn adds."""

    drives: list[float]
    steerings: list[float]


class Robot:
    """
    Listens to a robot, and tells it what to do while watching it.

    Parameters
    ----------
    node : rclpy.node.Node
        Ours.
    executor : rclpy.executors.Executor
        Spins it.
    parameters : NodeParameters
        The description.
    signals : list of int
        To which those to end are appended.

    Attributes
    ----------
    collector : Collector
        All that came.
    steering_ranges : list of (float, float)
        Lowest and highest angle of each module [rad].

    """

    def __init__(self, node: Node, executor: Executor, parameters: NodeParameters,
                 signals: list[int]) -> None:
        """Subscribe."""
        self._executor, self._signals = executor, signals
        self.node, self.layout, self._parameters = node, parameters.layout, parameters
        self.steering_ranges: list[tuple[float, float]] = list(zip(
            parameters.steering_lower_limits.tolist(), parameters.steering_upper_limits.tolist()))
        self.collector = Collector(parameters, ('joint',))
        self._joined, self._silence = monotonic(), 0.0
        self._peers = Peers(node)
        self._sources = JointSources(
            turns_of_joints(self.layout), nanoseconds(parameters.feedback_timeout),
            partial(self._peers.count, 'joint_states'), nothing)
        on_joints: Callable[..., None] = self._on_joints  # rclpy's own types know no info
        node.create_subscription(JointState, 'joint_states', on_joints, qos_profile_sensor_data)
        if parameters.gyro_source == 'imu':
            self._listen_to(Imu, 'imu', take_imu, qos_profile_sensor_data)
        self._listen_to(
            Float64MultiArray, 'drive_velocity_controller/commands', take_drive_commands)
        self._listen_to(
            Float64MultiArray, 'steering_position_controller/commands', take_steering_commands)
        self._listen_to(JointState, 'joint_commands', take_joint_commands)

    def _listen_to(self, kind: type, topic: str, take: Taker, qos: int | QoSProfile = 10) -> None:
        """Subscribe to a topic for the collector."""
        self.node.create_subscription(kind, topic, partial(self._on_message, take), qos)

    def _on_joints(self, message: Any, info: dict[str, Any]) -> None:
        """Take joint states; `_listen` complains of others that publish the same."""
        if self._sources.believes(message.name, message.position, info):
            self._on_message(take_joints, message)

    def _on_message(self, take: Taker, message: Any) -> None:
        """Take a message; joint states that are not complete, or not new, are silence."""
        before = self.collector.latest
        take(self.collector, message, self.node.get_clock().now().nanoseconds)
        if self.collector.latest is not before:
            self._silence = 0.0

    def sample(self) -> Sample:
        """Return the latest sample; ValueError if the joint states have fallen silent."""
        latest = self.collector.latest
        if latest is None or self._silence > SILENCE:
            raise ValueError('joint_states fell silent: stopped')
        return latest

    def _since(self, before: Sample) -> tuple[Sample, float]:
        """Return the latest sample, and how much later [s] than another; ValueError if earlier."""
        now = self.sample()
        elapsed = (now.stamp - before.stamp) / NANOSECONDS
        if elapsed < 0.0:
            raise ValueError('the stamps of joint_states jump back: stopped')
        return now, elapsed

    def _listen(self, seconds: float) -> None:
        """
        Take the messages that have come, or the next if it comes in time.

        Raises
        ------
        KeyboardInterrupt
            After a signal to end.
        ValueError
            If several publish the same joints: who is right cannot be known.

        """
        begun = monotonic()
        self._executor.spin_once(timeout_sec=seconds)
        # On a busy machine this process may be late: what came meanwhile still waits to be taken.
        self._silence += min(monotonic() - begun, PERIOD)
        # Not in the signal's handler: what is raised amid rclpy may come out as anything.
        if self._signals:
            raise KeyboardInterrupt
        # By then the graph knows the names of all.
        if self._sources.ignored and monotonic() > self._joined + DISCOVERY:
            names = self._peers.publishers('joint_states')
            # One that was restarted was refused as well, but is alone.
            if len(names) > 1:
                raise ValueError(
                    f'the same joints are published by {" and ".join(names)}: stop one of them')

    def wait_until(self, condition: Callable[[], bool], complaint: Callable[[], str]) -> None:
        """Listen until a condition holds; ValueError with a complaint if it does not soon."""
        deadline = monotonic() + PATIENCE
        while not condition():
            if monotonic() > deadline:
                raise ValueError(complaint())
            self._listen(PERIOD)

    def wait_for_joints(self) -> None:
        """Wait for complete joint states; ValueError if none come."""
        topic = self.node.resolve_topic_name('joint_states')
        self.wait_until(lambda: self.collector.latest is not None, lambda: absence(
            self.node, topic, JointState) or self.collector.lack())

    def during(self, seconds: float, act: Callable[[], object] = nothing) -> Iterator[float]:
        """Do something every period and yield the time [s] each time, for so long."""
        begun = due = monotonic()
        while (now := monotonic()) - begun < seconds:
            if now >= due:
                due = now + PERIOD
                act()
                yield now - begun
            self._listen(max(0.0, due - monotonic()))

    def moving(self, seconds: float, act: Callable[[], object], rim: float,
               steering: float = math.inf) -> Iterator[float]:
        """Do as `during`; ValueError if a joint is faster than it may be [m/s, rad/s]."""
        before = self.sample()
        for time in self.during(seconds, act):
            yield time
            now, elapsed = self._since(before)
            if elapsed >= LOOK:
                fast = self._farther(before, now, rim * elapsed, steering * elapsed)
                if fast:
                    raise ValueError(f'{fast[0]} runs away: stopped (or does its driver not '
                                     'report rad, or take commands in another order?)')
                before = now

    def keeping(self, act: Callable[[], object] = nothing) -> Callable[[], object]:
        """Return what does something for a period each time; it raises what `sample` does."""
        moments = self.during(math.inf, act)

        def keep() -> None:
            next(moments)
            self.sample()
        return keep

    def wait_until_still(self, act: Callable[[], object]) -> None:
        """Do something until no joint moves; ValueError if one does not stop."""
        before, moving = self.sample(), list[str]()
        for _ in self.during(STOPPING, act):
            now, elapsed = self._since(before)
            if elapsed < STANDING_TIME:
                continue
            moving = self._farther(
                before, now, STANDING * elapsed, STEERING_STANDING * elapsed)
            if not moving:
                return
            before = now
        raise ValueError(
            f'{moving[0]} does not stand still when nothing is commanded: stopped' if moving else
            f'the stamps of joint_states advance by less than {STANDING_TIME:g} s in '
            f'{STOPPING:g} s: stopped')

    def _farther(self, before: Sample, now: Sample, rim: float, steering: float) -> list[str]:
        """Return the names of joints that moved farther than [m] and [rad] between two samples."""
        drives, steerings = self.moved(before, now)
        # One of the two stands where a drive is coupled to its steering: the joint, or the wheel.
        ways = [min(abs(way), abs(new - old)) for way, old, new in zip(
            drives, before.distances, now.distances)]
        return [name for names, moves, limit in (
            (self.layout.steering_joints, steerings, steering),
            (self.layout.drive_joints, ways, rim))
            for name, move in zip(names, moves) if abs(move) > limit]

    def moved(self, before: Sample, now: Sample) -> Moved:
        """Return what the joints did between two samples."""
        turned = [new - old for old, new in zip(before.angles, now.angles)]
        given = self.layout.joints.travel([0.0] * len(turned), turned)
        return Moved([new - old - way for old, new, way in zip(
            before.distances, now.distances, given)], turned)

    def joint_commands(self) -> Commands:
        """Return what commands the joints; ValueError if another node does so already."""
        for _ in self.during(self._joined + DISCOVERY - monotonic()):
            pass
        commands = COMMANDS[self._parameters.command_interface](self.node, self.layout)
        self.refuse_rivals(commands)
        return commands

    def refuse_rivals(self, commands: Commands) -> None:
        """Raise ValueError if others than our own publishers command the joints."""
        for topic in [own.topic_name for own in commands.publishers]:
            if self.node.count_publishers(topic) > 1:
                raise ValueError('another node, such as swerve_node, commands the joints on '
                                 f'{topic}: stop it first')


@contextmanager
def robot(parameters: NodeParameters, ros_arguments: list[str]) -> Iterator[Robot]:
    """Join the graph while the block runs; signals to end are exceptions, so that all can stop."""
    initialize(ros_arguments)
    heeded = {number: signal.getsignal(number) for number in ENDING_SIGNALS}
    node, executor = rclpy.create_node('swerve_check'), make_executor()
    executor.add_node(node)
    try:
        yield Robot(node, executor, parameters, collected_signals())
    finally:
        with leaving():
            executor.shutdown()
            node.destroy_node()
            rclpy.try_shutdown()
        for number, handler in heeded.items():
            signal.signal(number, handler)
