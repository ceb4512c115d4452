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

"""An IMU mounted in any way tells the turn and the acceleration of the base."""

from collections import Counter
import math
from types import SimpleNamespace

from geometry_msgs.msg import TransformStamped
from graph import same_moments
from nav_msgs.msg import Odometry
import numpy as np
import pytest
from sensor_msgs.msg import Imu
from strategies import NO_ROTATIONS

from swerve_kinematics.core.geometry.rotations import (
    from_roll_pitch_yaw, inverse, product, Rotation, up)
from swerve_kinematics.ros.conversions import imu_numbers
from swerve_kinematics.ros.mounted_imu import MountedImu
from swerve_kinematics.ros.static_mounting import SelfMountingImu

RIGHT = 0.5 * math.pi
MOUNTINGS = {
    'straight': (0.0, 0.0, 0.0), 'upside down': (math.pi, 0.0, 0.0),
    'upside down, the other way': (0.0, math.pi, 0.0), 'on its side': (RIGHT, 0.0, 0.0),
    'on its nose': (0.0, RIGHT, 0.0), 'turned by 90 degrees': (0.0, 0.0, RIGHT),
    'askew': (0.4, -0.9, 2.0)}


def measured(mounting, yaw, rate):
    """Return the Imu of a level base, from its sensor's frame."""
    sensor = from_roll_pitch_yaw(*mounting)
    in_world = product(from_roll_pitch_yaw(0.0, 0.0, yaw), sensor)
    imu = Imu()
    o, v = imu.orientation, imu.angular_velocity
    o.x, o.y, o.z, o.w = in_world
    v.x, v.y, v.z = (rate * share for share in up(sensor))
    return imu


@pytest.mark.parametrize('mounting', MOUNTINGS.values(), ids=MOUNTINGS)
@pytest.mark.parametrize('use', ['orientation', 'rate', 'auto'])
def test_every_mounting_is_right_in_every_use(mounting, use):
    imu = MountedImu(mounting, use)
    for yaw in np.linspace(-3.0, 3.0, 7):
        told = imu.yaw_and_rate(imu_numbers(measured(mounting, yaw, 0.7)))
        expected = (math.nan if use == 'rate' else yaw, math.nan if use == 'orientation' else 0.7)
        np.testing.assert_allclose(told, expected, atol=1e-9)


def test_a_covariance_that_begins_with_minus_one_means_absent():
    imu, message = MountedImu((), 'auto'), measured((0.0, 0.0, 0.0), 0.3, 0.5)
    assert imu.yaw_and_rate(imu_numbers(message)) == pytest.approx((0.3, 0.5))
    message.orientation_covariance[0] = -1.0
    assert imu.yaw_and_rate(imu_numbers(message)) == pytest.approx((math.nan, 0.5), nan_ok=True)
    message.angular_velocity_covariance[0] = -1.0
    assert imu.yaw_and_rate(imu_numbers(message)) == pytest.approx(
        (math.nan, math.nan), nan_ok=True)


def test_axes_that_the_yaw_rate_does_not_need_may_be_missing():
    message = Imu()
    message.angular_velocity.x = message.angular_velocity.y = math.nan
    message.angular_velocity.z = -0.5
    upside_down = MountedImu((math.pi, 0.0, 0.0), 'rate')
    assert upside_down.yaw_and_rate(imu_numbers(message))[1] == pytest.approx(0.5)


@pytest.mark.parametrize('mounting', MOUNTINGS.values(), ids=MOUNTINGS)
def test_force_and_rates_come_in_the_axes_of_the_base(mounting):
    message = Imu()
    for vector, there in ((message.linear_acceleration, (0.5, -0.7, 9.81)),
                          (message.angular_velocity, (0.02, 0.03, 0.4))):
        # The axes of the sensor, as the base sees them, are those of its mounting.
        back = inverse(from_roll_pitch_yaw(*mounting))
        turned = product(product(back, Rotation(*there, 0.0)), inverse(back))
        vector.x, vector.y, vector.z = turned[:3]
    sample = MountedImu(mounting, 'auto').inertial(imu_numbers(message))
    assert sample.force == pytest.approx(0.5 - 0.7j)
    assert sample.rates == pytest.approx(0.02 + 0.03j)
    assert sample.size == pytest.approx(math.hypot(0.5, 0.7, 9.81))
    assert len(sample.axes) == (3 if mounting == MOUNTINGS['askew'] else 2)
    message.linear_acceleration_covariance[0] = -1.0
    message.angular_velocity_covariance[0] = -1.0
    nothing = MountedImu(mounting, 'auto').inertial(imu_numbers(message))
    assert nothing.force is None and nothing.rates is None


def transform(parent, child, mounting):
    """Return the TransformStamped of a frame on another one."""
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    q = message.transform.rotation
    q.x, q.y, q.z, q.w = from_roll_pitch_yaw(*mounting)
    return message


@pytest.mark.parametrize('mounting', MOUNTINGS.values(), ids=MOUNTINGS)
def test_static_transforms_tell_how_the_sensor_is_mounted(mounting):
    imu = SelfMountingImu(
        SimpleNamespace(create_subscription=lambda *_: None), 'base', 'auto', Counter())
    # A chain up to a frame that carries both, told in two messages.
    imu.take(SimpleNamespace(transforms=[
        transform('root', 'base', (0.0, 0.0, 1.0)), transform('plate', 'imu', mounting)]))
    message = measured(mounting, 0.4, 0.7)
    message.header.frame_id = 'imu'
    imu.yaw_and_rate(imu_numbers(message))
    imu.take(SimpleNamespace(transforms=[transform('root', 'plate', (0.0, 0.0, 1.0))]))
    assert imu.yaw_and_rate(imu_numbers(message)) == pytest.approx((0.4, 0.7))
    message.header.frame_id = 'elsewhere'  # of which nothing is known: changes nothing
    assert imu.yaw_and_rate(imu_numbers(message)) == pytest.approx((0.4, 0.7))


@pytest.mark.parametrize('rotation', NO_ROTATIONS)
def test_a_static_transform_that_is_no_rotation_is_ignored_and_counted(rotation):
    ignored = Counter()
    imu = SelfMountingImu(
        SimpleNamespace(create_subscription=lambda *_: None), 'base', 'auto', ignored)
    message = measured((math.pi, 0.0, 0.0), 0.4, 0.7)
    message.header.frame_id = 'imu'
    imu.take(SimpleNamespace(transforms=[transform('base', 'imu', (math.pi, 0.0, 0.0))]))
    damaged = transform('base', 'imu', (0.0, 0.0, 0.0))
    q = damaged.transform.rotation
    q.x, q.y, q.z, q.w = rotation
    imu.take(SimpleNamespace(transforms=[damaged]))
    assert imu.yaw_and_rate(imu_numbers(message)) == pytest.approx((0.4, 0.7))
    assert ignored.total() == 1


def test_the_node_takes_the_upside_down_imu_of_the_simulated_base(
        client, start_node, start_sim, reports):
    mounting = [math.pi, 0.0, 0.3]
    start_sim(imu_orientation=mounting, imu_position=[0.1, 0.0])
    start_node(gyro_source='imu', imu_orientation=mounting, imu_position=[0.1, 0.0])
    truth = client.listen(Odometry, 'ground_truth')
    client.repeat_until(lambda: client.send_twist(omega=1.0), lambda: truth and client.odom and
                        client.odom[-1].pose.pose.orientation.z > 0.3, 'the base to turn')
    client.wait_for_count(truth, 5, 'the truth about it')
    odom, true = same_moments(client.odom, truth)[-1]
    assert odom.pose.pose.orientation.z == pytest.approx(
        true.pose.pose.orientation.z, abs=0.01)
    # And its accelerometer has a say about the wheels.
    client.repeat_until(
        lambda: client.send_twist(omega=1.0), lambda: reports and 'trusted' == {
            value.key: value.value for value in reports[-1].values}['accelerometer'],
        'the accelerometer to be trusted')
    assert 'accelerometer' not in reports[-1].message
