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

"""Which poses are taken, and that whatever comes, what is published is finite."""

from geometry_msgs.msg import PoseWithCovarianceStamped
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays
import numpy as np
import pytest

from swerve_kinematics import SwerveKinematics, SwerveOdometry
from swerve_kinematics.ros.set_pose import refusal

NUMBERS = st.floats(allow_nan=True, allow_infinity=True) | st.floats(-1e10, 1e10)
POSE, UNIT = np.array([1.0, -2.0, 3.0]), np.eye(3)


def numbers_of(odometry):
    """Return every number that the node publishes of a nav_msgs/Odometry."""
    pose, twist = odometry.pose, odometry.twist
    position, rotation = pose.pose.position, pose.pose.orientation
    linear, angular = twist.twist.linear, twist.twist.angular
    return [position.x, position.y, rotation.z, rotation.w, linear.x, linear.y, angular.z,
            *pose.covariance, *twist.covariance]


@pytest.mark.parametrize('covariance, word', [
    (1.7e308 * UNIT, 'out of range'), (np.diag([1.0, np.nan, 1.0]), 'finite'),
    (np.diag([1.0, -1.0, 1.0]), 'covariance'),
    (np.array([[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), 'covariance'),
    (np.array([[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), 'covariance')])
def test_a_covariance_that_none_can_be_is_refused(covariance, word):
    assert word in refusal('odom', 'odom', POSE, covariance)


@pytest.mark.parametrize('covariance', [np.zeros((3, 3)), 1e6 * UNIT, np.ones((3, 3))])
def test_certain_unknown_and_fully_correlated_poses_are_taken(covariance):
    assert refusal('', 'odom', POSE, covariance) is None


@given(arrays(float, 3, elements=NUMBERS), arrays(float, 3, elements=NUMBERS))
def test_a_pose_that_is_taken_never_leads_to_a_number_that_is_not_finite(pose, variances):
    covariance = np.diag(variances)
    if refusal('odom', 'odom', pose, covariance) is not None:
        return
    odometry = SwerveOdometry(SwerveKinematics([(1.0, 0.0), (-1.0, 0.0)]))
    odometry.reset(pose, covariance)
    for k in range(4):
        odometry.update(0.1 * k, [0.1 * k] * 2, [0.3] * 2, yaw=0.1 * k)
    assert np.isfinite(np.concatenate([np.ravel(part) for part in odometry.estimate])).all()


def test_a_boundless_covariance_is_ignored_and_counted(client, start_node, reports):
    start_node()
    client.begin_feedback()
    message = PoseWithCovarianceStamped()
    message.pose.pose.position.x = 3.0
    message.pose.pose.orientation.w = 1.0
    message.pose.covariance[0] = message.pose.covariance[35] = 1.7e308
    publisher = client.publisher(PoseWithCovarianceStamped, 'swerve_node/set_pose')
    client.repeat_until(
        lambda: (publisher.publish(message), client.send_joints()),
        lambda: reports and 'set_pose out of range' in reports[-1].message,
        'the report')
    assert np.isfinite([numbers_of(odometry) for odometry in client.odom]).all()
    assert client.odom[-1].pose.pose.position.x == 0.0
