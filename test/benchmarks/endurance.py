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
Find what our executor loses or makes late that rclpy's does not, over a long time.

    python test/benchmarks/endurance.py [minutes]

Two nodes drive side by side, one under each executor, on the same joint states (200 Hz) and
cmd_vel (100 Hz): each message goes to both, first to the one and then to the other in turn. Each
must be answered, and every answer is told from the others: odometry by its stamp, commands by
their speed, which follows the twist at once since no acceleration is limited here. Needs the same
as bench.py.
"""

import math
import os
import struct
import sys
import time

os.environ.update(ROS_DOMAIN_ID='84', ROS_AUTOMATIC_DISCOVERY_RANGE='LOCALHOST')

from geometry_msgs.msg import Twist  # noqa: E402, I100
from nav_msgs.msg import Odometry  # noqa: E402
from node_client import (  # noqa: E402
    COMMANDS, DEEP, Inbox, JOINTS, NANOSECONDS, stamp_of)
from node_cost import NodeProcess  # noqa: E402
import numpy as np  # noqa: E402
import rclpy  # noqa: E402
from sensor_msgs.msg import JointState  # noqa: E402
from std_msgs.msg import Float64MultiArray  # noqa: E402
from swerve_kinematics.ros.serialized import ENCAPSULATION  # noqa: E402

PERIOD = NANOSECONDS // 200  # of joint states; every other time with a twist
NODES = ('node', 'node_in_rclpy')
UNLIMITED = [word for limit in ('linear_acceleration', 'linear_deceleration')
             for word in ('-p', f'max_{limit}:=0.0')]
RADIUS = 0.05  # m
STEP, STEPS = 1e-4, 1000  # m/s between two twists, and how many until they turn back
PATIENCE = 20 * NANOSECONDS
LAST_ANSWERS = NANOSECONDS
LATE = 0.02  # s
ROW = '{:18}{:18}{:>8}{:>7}{:>11}{:>10}{:>10}{:>10}{:>18}'


class Record:
    """What one node was sent on one topic, and how long each answer took [s]."""

    def __init__(self):
        """Start with nothing sent."""
        self._waiting, self.sent, self.latencies = {}, 0, []

    def send(self, mark):
        """Note a message that is sent now, and the mark that its answer will bear."""
        self._waiting[mark] = time.monotonic_ns()
        self.sent += 1

    def hear(self, mark):
        """Note an answer; one to nothing, such as a repeated command, does not count."""
        sent = self._waiting.pop(mark, None)
        if sent is not None:
            self.latencies.append((time.monotonic_ns() - sent) / NANOSECONDS)

    def row(self, node, topics):
        """Return the line of the table."""
        ms = 1e3 * np.array(self.latencies)
        return ROW.format(
            node, topics, self.sent, self.sent - len(ms),
            *(f'{value:.2f} ms' for value in (*np.percentile(ms, (50, 99, 99.9)), ms.max())),
            int((ms > 1e3 * LATE).sum()))


class Driver:
    """Stands for a base that drives straight ahead, now a bit faster and now a bit slower."""

    def __init__(self):
        """Join the graph."""
        self._node = node = rclpy.create_node('endurance')
        self._joints_out, self._twist_out = (
            [node.create_publisher(kind, f'/{name}/{topic}', DEEP) for name in NODES]
            for kind, topic in ((JointState, 'joint_states'), (Twist, 'cmd_vel')))
        self._answers = Inbox(node, [
            (kind, f'/{name}/{topic}') for name in NODES
            for kind, topic in ((Odometry, 'odom'), (Float64MultiArray, COMMANDS))])
        self._joints, self._twist = JointState(name=[*JOINTS, 'gyro_joint']), Twist()
        self._count, self._distance, self._speed = 0, 0.0, 1.0
        # Of each node: to its joint states, and to its twists.
        self.records = [(Record(), Record()) for _ in NODES]

    def close(self):
        """Leave the graph."""
        self._node.destroy_node()

    def drive(self, duration):
        """Send and receive for so long [ns]."""
        start = time.monotonic_ns()
        while (elapsed := time.monotonic_ns() - start) < duration:
            self._send()
            self._receive(start + (elapsed // PERIOD + 1) * PERIOD)
        self._receive(time.monotonic_ns() + LAST_ANSWERS)

    def _send(self):
        """Send a JointState, and every other time a Twist, to both nodes."""
        self._count += 1
        order = range(len(NODES)) if self._count % 4 < 2 else reversed(range(len(NODES)))
        self._distance += self._speed * PERIOD / NANOSECONDS
        stamp = divmod(time.time_ns(), NANOSECONDS)
        self._joints.header.stamp.sec, self._joints.header.stamp.nanosec = stamp
        self._joints.position = [self._distance / RADIUS] * 4 + [0.0] * 5
        self._joints.velocity = [self._speed / RADIUS] * 4 + [0.0] * 5
        has_twist = self._count % 2 == 0
        if has_twist:
            step = self._count // 2 % (2 * STEPS)
            self._speed = self._twist.linear.x = 1.0 + STEP * min(step, 2 * STEPS - step)
        for node in order:
            joints, twists = self.records[node]
            joints.send(stamp)
            self._joints_out[node].publish(self._joints)
            if has_twist:
                twists.send(_mark(self._speed / RADIUS))
                self._twist_out[node].publish(self._twist)

    def _receive(self, until):
        """Take what comes until the monotonic clock [ns] shows `until`."""
        while (received := self._answers.wait(until))[1] is not None:
            topic, message = received
            node, is_command = divmod(topic, 2)
            self.records[node][is_command].hear(
                speed_of(message) if is_command else stamp_of(message))


def speed_of(command):
    """Return the first of the speeds in a serialized Float64MultiArray, as a mark."""
    return _mark(*struct.unpack_from('<d', command, ENCAPSULATION + 16))


def _mark(speed):
    """Return a wheel speed [rad/s] as a whole number that tells two commands apart."""
    return math.floor(speed * RADIUS / STEP + 0.5)


def main(minutes=10.0):
    """Drive both nodes for so long, and print what was lost and how late the rest came."""
    rclpy.init()
    driver = Driver()
    processes = [NodeProcess(name, UNLIMITED)
                 for name in NODES]
    try:
        driver.drive(PATIENCE)  # until all have found each other
        driver.records = [(Record(), Record()) for _ in NODES]
        driver.drive(round(60.0 * minutes * NANOSECONDS))
        print(ROW.format('node', 'answers', 'sent', 'lost', 'median', '99 %', '99.9 %', 'worst',
                         f'later than {1e3 * LATE:.0f} ms'))
        for node, records in zip(('our executor', "rclpy's executor"), driver.records):
            for topics, record in zip(('odom', 'commands'), records):
                print(record.row(node, topics))
    finally:
        for process in processes:
            process.end()
        driver.close()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main(*map(float, sys.argv[1:]))
