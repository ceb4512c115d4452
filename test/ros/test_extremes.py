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

"""Numbers and stamps at the ends of what a message can hold, over real DDS."""

import itertools

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from graph import DRIVES, ignored, STEERINGS
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState

from swerve_kinematics.ros.serialized_reading import (
    JointStateReader, read_imu, read_twist_stamped)
from swerve_kinematics.ros.stamps import is_valid, nanoseconds_of

LAST, FIRST = 2147483647, -2147483648  # s
STAMPS = [Time(sec=sec, nanosec=nanosec) for sec, nanosec in itertools.product(
    (LAST, FIRST, -1, 0, 1), (0, 999_999_999, 1_000_000_000, 4_294_967_295))]
NUMBERS = (1.7e308, -1.7e308, 5e-324, 1e200, -1e155, 0.0, 1e15, np.inf, np.nan)


def joint_states():
    """Yield joint states with every extreme in every place."""
    names = DRIVES + STEERINGS + ['gyro_joint']
    for stamp in STAMPS:
        yield stamp, JointState(name=names, position=[0.1] * 9, velocity=[0.1] * 9)
    for number, place in itertools.product(NUMBERS, range(9)):
        values = [0.1] * 9
        values[place] = number
        yield None, JointState(name=names, position=values, velocity=[0.1] * 9)
        yield None, JointState(name=names, position=[0.1] * 9, velocity=values)
        yield None, JointState(name=names, velocity=values)


def others():
    """Yield all other input with every extreme, each with the topic it goes to."""
    for stamp in STAMPS:
        for kind, topic in ((Imu, 'imu'), (TwistStamped, 'cmd_vel'),
                            (PoseWithCovarianceStamped, 'swerve_node/set_pose')):
            message = kind()
            message.header.stamp = stamp
            yield topic, message
    for number in NUMBERS:
        imu, command, pose = Imu(), TwistStamped(), PoseWithCovarianceStamped()
        imu.orientation.z = imu.orientation.w = imu.angular_velocity.z = number
        command.twist.linear.x = command.twist.angular.z = number
        pose.pose.pose.position.x = pose.pose.pose.orientation.w = number
        yield from (('imu', imu), ('cmd_vel', command), ('swerve_node/set_pose', pose))


@pytest.mark.parametrize('gyro_source', ['joint', 'imu'])
def test_no_number_and_no_stamp_ends_the_node(client, start_node, reports, gyro_source):
    node = start_node(use_stamped_vel=True, gyro_source=gyro_source, drive_joint_period=6.28319)
    client.begin_feedback()
    publisher = client.publisher(JointState, 'joint_states')
    messages = itertools.cycle(joint_states())

    def send():
        stamp, message = next(messages)
        message.header.stamp = stamp or client.node.get_clock().now().to_msg()
        publisher.publish(message)
    client.repeat_until(
        send, lambda: ignored(reports, 'joint states with an impossible stamp') > 10
        and ignored(reports, 'unusable joint values') > 50, 'the counts', period=0.005)
    for topic, message in others():
        if gyro_source == 'imu' or topic != 'imu':
            client.publisher(type(message), topic).publish(message)
            client.send_joints()
    count = len(client.odom)
    client.repeat_until(client.send_joints, lambda: len(client.odom) > count + 5, 'odometry')
    assert node.is_running()
    assert np.isfinite([message.data for message in client.drive + client.steering]).all()


@pytest.mark.parametrize('nanosec', [1_000_000_000, 4_294_967_295])
def test_nanoseconds_that_overflow_are_no_time(nanosec):
    stamp = Time(sec=5, nanosec=nanosec)
    assert not is_valid(nanoseconds_of(stamp))
    imu, command, joints = Imu(), TwistStamped(), JointState(name=['wheel'], position=[1.0])
    for message in (imu, command, joints):
        message.header.stamp = stamp
    assert not is_valid(read_imu(serialize_message(imu)).stamp)
    assert not is_valid(read_twist_stamped(serialize_message(command)).stamp)
    reader = JointStateReader()
    for _ in range(2):  # the second time the message is laid out like the last one
        assert not is_valid(reader.read(serialize_message(joints)).stamp)
    joints.header.stamp.nanosec = 999_999_999
    assert reader.read(serialize_message(joints)).stamp == 5_999_999_999


def test_an_impossible_time_on_the_clock_is_ignored_and_counted(
        client, start_node, start_sim, reports):
    programs = start_node(use_sim_time=True), start_sim(use_sim_time=True)
    publisher = client.publisher(Clock, '/clock')
    client.wait_until(lambda: publisher.get_subscription_count() == 2, 'both to listen')
    stamps = itertools.cycle(STAMPS)
    client.repeat_until(lambda: (publisher.publish(Clock(clock=next(stamps))),
                                 client.send_joints()),
                        lambda: ignored(reports, 'impossible times on /clock') > 2 * len(STAMPS)
                        and client.odom, 'the counts')
    assert all(program.is_running() for program in programs)
