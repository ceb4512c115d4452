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

"""Messages against the core, on a real node without a process."""

import itertools
import math
import struct

from geometry_msgs.msg import PoseWithCovariance, Quaternion, Twist
from nav_msgs.msg import Odometry
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import Float64MultiArray

from swerve_kinematics import SwerveKinematics, SwerveOdometry
from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.core.geometry.rotations import yaw_of
from swerve_kinematics.ros.conversions import rotation_of
from swerve_kinematics.ros.messages import (
    OdometryMessages, planar_pose_and_covariance, planar_twist, serialized_planar_twist, set_yaw)
from swerve_kinematics.ros.serialized import SerializedMessage

KINEMATICS = SwerveKinematics([(0.3, 0.2), (-0.3, -0.2)])
LAYOUT = Layout(('a', 'b'), KINEMATICS, np.full(2, 0.05), ('ad', 'bd'), ('as', 'bs'), 'gyro',
                'odom', 'base_link')


class Broadcaster:
    """Keeps what tf2_ros would send, for tf2_ros is not in PyPI."""

    def __init__(self):
        self.transforms = []

    def sendTransform(self, transform):  # noqa: N802 (the name that tf2_ros gave it)
        self.transforms.append(transform)


def test_odometry_and_transform_say_what_the_core_says(client):
    odometry, broadcaster = SwerveOdometry(KINEMATICS, pose=(1.0, 2.0, 4.0)), Broadcaster()
    for step in range(5):
        odometry.update(0.1 * step, [0.1 * step] * 2, [0.3] * 2, yaw=0.05 * step)
    messages = OdometryMessages(client.node, LAYOUT, broadcaster)
    stamp = 1_700_000_000_123_456_789
    client.repeat_until(lambda: messages.publish(stamp, odometry.estimate), lambda: client.odom,
                        'odom')
    message, transform = client.odom[0], broadcaster.transforms[0]
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == divmod(stamp, 10**9)
    pose, covariance = planar_pose_and_covariance(message.pose)
    np.testing.assert_allclose(pose[:2], odometry.pose[:2], rtol=1e-12)
    assert math.cos(pose[2] - odometry.pose[2]) == pytest.approx(1.0)
    np.testing.assert_allclose(covariance, odometry.pose_covariance)
    full = np.array(message.pose.covariance).reshape(6, 6)
    np.testing.assert_array_equal(np.diag(full)[2:5], 1e6)
    _, twist_covariance = planar_pose_and_covariance(
        PoseWithCovariance(covariance=message.twist.covariance))
    np.testing.assert_allclose(twist_covariance, odometry.twist_covariance)
    twist = message.twist.twist
    np.testing.assert_allclose(
        (twist.linear.x, twist.linear.y, twist.angular.z), odometry.twist)
    assert transform.header.stamp == message.header.stamp
    assert (transform.header.frame_id, transform.child_frame_id) == ('odom', 'base_link')
    translation, rotation = transform.transform.translation, transform.transform.rotation
    assert (translation.x, translation.y) == (pose[0], pose[1])
    assert rotation == message.pose.pose.orientation


def test_what_the_odometry_does_not_say_is_as_rclpy_would_send_it(client):
    messages = OdometryMessages(client.node, LAYOUT, None)
    estimate = SwerveOdometry(KINEMATICS).estimate
    client.repeat_until(lambda: messages.publish(2_000_000_001, estimate), lambda: client.odom,
                        'odom')
    expected = Odometry(child_frame_id=LAYOUT.base_frame)
    expected.header.frame_id = LAYOUT.odom_frame
    expected.header.stamp.sec, expected.header.stamp.nanosec = 2, 1
    expected.pose.covariance = np.diag([1e-12, 1e-12, 1e6, 1e6, 1e6, 1e-12]).ravel()
    expected.twist.covariance = np.diag([0.0, 0.0, 1e6, 1e6, 1e6, 0.0]).ravel()
    assert client.odom[0] == expected


def test_a_twist_is_read_in_the_byte_order_of_its_sender():
    message = Twist()
    message.linear.x, message.linear.y, message.angular.z = 1.0, -2.0, 0.25
    message.linear.z = message.angular.x = message.angular.y = 9.0
    assert serialized_planar_twist(serialize_message(message)) == planar_twist(message)
    big_endian = b'\0\0\0\0' + struct.pack('>6d', 1.0, -2.0, 9.0, 9.0, 9.0, 0.25)
    assert serialized_planar_twist(big_endian) == planar_twist(message)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('vector', ['linear', 'angular'])
@pytest.mark.parametrize('axis', 'xyz')
def test_a_twist_with_an_axis_that_is_not_finite_is_no_command(vector, axis, bad):
    message = Twist()
    setattr(getattr(message, vector), axis, bad)
    for twist in (planar_twist(message), serialized_planar_twist(serialize_message(message))):
        assert not np.isfinite(twist).all()


@pytest.mark.parametrize('size', [0, 1, 4, 51])
def test_a_twist_that_is_cut_short_is_no_command(size):
    assert np.isnan(serialized_planar_twist(serialize_message(Twist())[:size])).all()


def test_a_twist_that_is_encapsulated_in_another_way_is_no_command():
    numbers = serialize_message(Twist())[2:]
    marks = itertools.product(range(256), repeat=2)
    assert {mark for mark in marks if np.isfinite(
        serialized_planar_twist(bytes(mark) + numbers)[0])} == {(0, 0), (0, 1)}


def test_numbers_that_are_not_where_they_should_be_are_refused():
    with pytest.raises(RuntimeError, match='Float64MultiArray'):
        SerializedMessage(None, Float64MultiArray(data=[1.0, 2.0, 3.0]), [1.0, 3.0])


@pytest.mark.parametrize('yaw', [0.0, 1.0, -1.0, 3.0, math.pi])
def test_yaw_survives_a_quaternion(yaw):
    quaternion = Quaternion()
    set_yaw(quaternion, yaw)
    assert yaw_of(rotation_of(quaternion)) == pytest.approx(yaw)
