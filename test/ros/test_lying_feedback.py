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

"""Feedback that lies, over real DDS: the odometry does not believe it, and the node says so."""

from graph import DRIVES, STEERINGS
import numpy as np
import pytest
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu, JointState

from swerve_kinematics.ros.messages import set_yaw
from swerve_kinematics.ros.stamps import set_stamp

MS = 1_000_000  # ns


class Player:
    """Sends feedback at stamps of its own, as fast as the odometry takes it."""

    def __init__(self, client, reports):
        self._client, self._reports = client, reports
        client.begin_feedback()
        self._time = client.node.get_clock().now().nanoseconds + 20 * MS

    def play(self, steps, joints, imu=None):
        """Send joints(k) -> (wheel turns, velocity) and imu(k) -> (yaw, rate) every 20 ms."""
        for k in range(steps):
            self._time += 20 * MS
            if imu:
                message = Imu()
                set_stamp(message.header.stamp, self._time)
                set_yaw(message.orientation, imu(k)[0])
                message.angular_velocity.z = imu(k)[1]
                self._client.publisher(Imu, 'imu', qos_profile_sensor_data).publish(message)
            turns, velocity = joints(k)
            message = JointState(name=DRIVES + STEERINGS, position=[turns] * 4 + [0.0] * 4,
                                 velocity=[velocity] * 4 + [0.0] * 4)
            set_stamp(message.header.stamp, self._time)
            self._client.publisher(JointState, 'joint_states').publish(message)
            count = len(self._client.odom)
            self._client.wait_until(lambda: len(self._client.odom) > count, 'odometry')

    def wait_for(self, words):
        """Wait until a report has these words."""
        self._client.wait_until(
            lambda: any(words in report.message for report in self._reports),
            f'a report of {words}')


@pytest.fixture
def player(client, reports, start_node):
    """Return a function that starts the node with parameters and returns a player for it."""
    def started(**parameters):
        start_node(feedback_timeout=5.0, **parameters)
        return Player(client, reports)
    return started


@pytest.mark.parametrize('turning, velocity, words', [
    (0.0, 5.0, 'position does not change'), (0.2, 10.0 * 60.0 / (2.0 * np.pi), 'rpm')])
def test_velocities_that_lie_do_not_move_the_twist(client, player, turning, velocity, words):
    base = player(gyro_source='none')
    base.play(60, lambda k: (turning * k, velocity))
    assert client.odom[-1].twist.twist.linear.x == pytest.approx(0.05 * turning / 0.02, abs=1e-5)
    base.wait_for(words)


def test_an_orientation_set_anew_does_not_turn_the_base(client, player):
    base = player(gyro_source='imu')
    base.play(30, lambda k: (0.0, 0.0), lambda k: (0.0 if k < 15 else 0.5, 0.0))
    assert abs(client.odom[-1].pose.pose.orientation.z) < 1e-3
    base.wait_for('jumps of the yaw')


def test_an_orientation_that_stands_still_leaves_the_turn_to_the_rate(client, player):
    base = player(gyro_source='imu', estimate_gyro_bias=False)

    def heading():
        return 2.0 * np.arcsin(client.odom[-1].pose.pose.orientation.z)

    def turn(steps):
        base.play(steps, lambda k: (0.0, 0.0), lambda k: (0.0, 1.0))
    # The first messages of a publisher may be lost.
    client.repeat_until(lambda: turn(1), lambda: heading() > 0.1, 'the IMU to be heard')
    before = heading()
    turn(50)
    assert heading() - before == pytest.approx(1.0, abs=0.05)
    base.wait_for('stands still')
