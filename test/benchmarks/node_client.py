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
The other side of the nodes under test: sends joint states and twists, and times the answers.

It is light enough for 1000 messages a second, for it has no executor and converts no answer:
those cost more than the nodes under test.
"""

from collections import deque
import math
import struct
import time

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
import rclpy
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from swerve_kinematics.ros.serialized import ENCAPSULATION

MODULES = ('front_left', 'front_right', 'rear_left', 'rear_right')
JOINTS = [f'{name}_{kind}_joint' for kind in ('drive', 'steering') for name in MODULES]
COMMANDS = 'drive_velocity_controller/commands'
DEEP = QoSProfile(depth=1000)  # so that nothing is lost on this side
NANOSECONDS = 1_000_000_000
PATIENCE = 20 * NANOSECONDS
LAST_ANSWERS = NANOSECONDS // 5  # how long to wait for them


class Inbox:
    """Receives the messages of some topics, given as pairs of type and name, serialized."""

    def __init__(self, node, topics):
        """Subscribe."""
        self._context, self._kinds = node.context.handle, [kind for kind, _ in topics]
        self._handles = [node.create_subscription(kind, topic, lambda _: None, DEEP).handle
                         for kind, topic in topics]

    def wait(self, until):
        """
        Return the next message and the index of its topic.

        Or None and None once the monotonic clock [ns] has reached `until`.
        """
        index, message = self._take()
        left = until - time.monotonic_ns()
        if message is None and left > 0:
            waiting = rclpy_implementation.WaitSet(
                len(self._handles), 0, 0, 0, 0, 0, self._context)
            waiting.clear_entities()
            for handle in self._handles:
                waiting.add_subscription(handle)
            waiting.wait(left)
            index, message = self._take()
        return index, message

    def _take(self):
        """Return what is there now, as `wait` does."""
        for index, (kind, handle) in enumerate(zip(self._kinds, self._handles)):
            taken = handle.take_message(kind, True)
            if taken is not None:
                return index, taken[0]
        return None, None


class Exchange:
    """
    What was sent to one node, and how long its answers took.

    Attributes
    ----------
    latencies : list of float
        [s] of each answer, in order.
    lost : int
        Messages that a later one overtook.

    """

    def __init__(self):
        """Start with nothing sent."""
        self._waiting = deque()
        self.latencies = []
        self.lost = 0

    @property
    def unanswered(self):
        """Return how many messages have had no answer so far."""
        return self.lost + len(self._waiting)

    def sent(self, mark, time):
        """Note a message sent at a time [ns], and the mark that its answer will bear."""
        self._waiting.append((mark, time))

    def answered(self, mark, time):
        """Note an answer."""
        while self._waiting:
            expected, sent = self._waiting.popleft()
            if mark == expected:
                self.latencies.append((time - sent) / NANOSECONDS)
                break
            self.lost += 1


class Client:
    """
    Stands for bases on a bending curve, each driven by a node of its own.

    Encoders, their velocities and the gyro agree with one another and with the stamps: what
    contradicts itself costs a node more.

    Parameters
    ----------
    namespaces : list of str
        Of the nodes.

    """

    def __init__(self, namespaces):
        """Join the graph."""
        self._node = node = rclpy.create_node('bench_client')
        self._joints_out = [node.create_publisher(JointState, f'{name}/joint_states', DEEP)
                            for name in namespaces]
        self._twist_out = [node.create_publisher(Twist, f'{name}/cmd_vel', DEEP)
                           for name in namespaces]
        self._odom = Inbox(node, [(Odometry, f'{name}/odom') for name in namespaces])
        self._commands = Inbox(node, [(Float64MultiArray, f'{name}/{COMMANDS}')
                                      for name in namespaces])
        self._count = len(namespaces)
        self._joints = JointState(name=JOINTS + ['gyro_joint'])
        self._twist = Twist()
        self._start = time.time_ns()

    def close(self):
        """Leave the graph."""
        self._node.destroy_node()

    def wait_for_command(self, index):
        """Return the time [monotonic ns] at which a node's next command arrives."""
        deadline = time.monotonic_ns() + PATIENCE
        while True:
            sender, message = self._commands.wait(deadline)
            if message is None:
                raise TimeoutError('a node sends no command')
            if sender == index:
                return time.monotonic_ns()

    def wait_for_odometry(self):
        """Send joint states until odometry comes back from every node."""
        deadline = time.monotonic_ns() + PATIENCE
        silent = set(range(self._count))
        while silent:
            for index in silent:
                self._send_joints(index)
            sender, _ = self._odom.wait(time.monotonic_ns() + PATIENCE // 100)
            silent.discard(sender)
            if time.monotonic_ns() > deadline:
                raise TimeoutError('a node sends no odometry')

    def exchange_joint_states(self, rate, duration, to_first_loss=False):
        """
        Send joint states at a steady rate to each node, in turn, and receive odometry.

        Parameters
        ----------
        rate : int
            For each node [Hz].
        duration : float
            [s].
        to_first_loss : bool
            Whether to end as soon as an answer is missing.

        Returns
        -------
        list of Exchange
            One for each node.

        """
        return self._exchange(rate, duration, self._send_joints, self._odom, stamp_of,
                              to_first_loss)

    def exchange_twists(self, rate, duration):
        """Send twists and receive drive commands, as `exchange_joint_states`."""
        return self._exchange(rate, duration, self._send_twist, self._commands,
                              lambda command: None, False)

    def _exchange(self, rate, duration, send, inbox, mark_of, to_first_loss):
        """Send, receive, and match each answer by its mark; the marks of twists are None."""
        while inbox.wait(0)[1] is not None:
            pass  # answers to what was sent before
        exchanges = [Exchange() for _ in range(self._count)]
        count = round(rate * duration) * self._count
        period = NANOSECONDS // (rate * self._count)
        start = time.monotonic_ns()
        for index in range(count):
            receiver = index % self._count
            now = time.monotonic_ns()
            exchanges[receiver].sent(send(receiver), now)
            until = start + (index + 1) * period + (LAST_ANSWERS if index + 1 == count else 0)
            while (received := inbox.wait(until))[1] is not None:
                sender, answer = received
                exchanges[sender].answered(mark_of(answer), time.monotonic_ns())
            if to_first_loss and any(exchange.lost for exchange in exchanges):
                break
        return exchanges

    def _send_joints(self, index):
        """Publish joint states of a base that drives and steers; return their stamp."""
        now = time.time_ns()
        elapsed, stamp = (now - self._start) / NANOSECONDS, divmod(now, NANOSECONDS)
        swing, swinging = 0.2 * math.sin(elapsed), 0.2 * math.cos(elapsed)
        self._joints.header.stamp.sec, self._joints.header.stamp.nanosec = stamp
        self._joints.position = [20.0 * elapsed] * 4 + [swing] * 4 + [0.0]
        self._joints.velocity = [20.0] * 4 + [swinging] * 4 + [0.0]
        self._joints_out[index].publish(self._joints)
        return stamp

    def _send_twist(self, index):
        """Publish a velocity on a curve; nothing in its answer would tell which it was."""
        elapsed = (time.time_ns() - self._start) / NANOSECONDS
        self._twist.linear.x = 1.0 + 0.2 * math.cos(elapsed)
        self._twist.linear.y = 0.2 * math.sin(elapsed)
        self._twist.angular.z = 0.5 * math.sin(0.7 * elapsed)
        self._twist_out[index].publish(self._twist)


def stamp_of(odometry):
    """Return (sec, nanosec) of a serialized Odometry: they come first."""
    return struct.unpack_from('<iI', odometry, ENCAPSULATION)
