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

"""Joints and gyro that are not heard alike: stalls in one of them, and rates that differ."""

import math

from graph import DRIVES, STEERINGS
import numpy as np
from odometry_parts import values
import pytest
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu, JointState

from swerve_kinematics import SwerveOdometry
from swerve_kinematics.configuration.node import NODE_DECLARATIONS, parameters_from
from swerve_kinematics.ros.feedback import JointFeedback
from swerve_kinematics.ros.gyro_feedback import GyroFeedback
from swerve_kinematics.ros.messages import planar_pose, set_yaw
from swerve_kinematics.ros.stamps import nanoseconds, set_stamp

MS = 1_000_000  # ns
LAYOUT = parameters_from(values(NODE_DECLARATIONS, {})).layout
KIN = LAYOUT.kinematics
NAMES = [*LAYOUT.drive_joints, *LAYOUT.steering_joints]


def after_a_stall(yaw=lambda k: 0.01 * k, rate=lambda k: 1.0, heard=lambda k: True):
    """Return the sample after joint states stall from 0.1 s to 1.1 s; the gyro tells of k cs."""
    joints, sample = JointFeedback(LAYOUT, None, 500 * MS, 200 * MS), None
    for k in range(111):
        if heard(k):
            joints.read_gyro(10 * k * MS, yaw(k), rate(k))
        if k <= 10 or k == 110:
            sample = joints.read(10 * k * MS, NAMES, [0.0] * 8, [])
    assert not sample.continuous
    return sample


def nothing(_):
    """Return what a source says that is not there."""
    return np.nan


@pytest.mark.parametrize('gyro', [
    {}, {'yaw': nothing}, {'rate': nothing}, {'heard': lambda k: k % 20 == 10},
    {'yaw': lambda k: np.remainder(0.06 * k, 6.283), 'rate': lambda k: 6.0}])
def test_a_gyro_that_is_heard_all_the_time_has_gone_on(gyro):
    assert after_a_stall(**gyro).gyro_went_on


@pytest.mark.parametrize('gyro', [
    {'heard': lambda k: not 40 < k < 65},  # silent for a while
    {'yaw': lambda k: 0.01 * k - 0.4 * (k > 50)}, {'yaw': lambda k: 2.0 * (k > 50),
                                                   'rate': nothing},  # set anew
    {'yaw': lambda k: np.nan if 40 < k < 45 else 0.01 * k},  # it came back, from who knows where
    {'rate': lambda k: np.nan if 40 < k < 45 else 1.0}])
def test_a_gyro_that_was_silent_or_set_anew_has_not_gone_on(gyro):
    assert not after_a_stall(**gyro).gyro_went_on


def test_a_gyro_whose_clock_was_set_has_not_gone_on():
    joints = JointFeedback(LAYOUT, None, 500 * MS, 200 * MS)
    for stamp, gyro_stamp in ((5000, 5000), (5100, 5100), (None, 4000), (None, 4100),
                              (None, 5950), (6000, 6000)):
        joints.read_gyro(gyro_stamp * MS, 0.0, 0.0)
        if stamp:
            sample = joints.read(stamp * MS, NAMES, [0.0] * 8, [])
    assert not sample.gyro_went_on


@pytest.mark.parametrize('stall', [0.1, 0.19, 0.25, 0.45])
@pytest.mark.parametrize('joints_stall', [True, False])
@pytest.mark.parametrize('late', [0.0, 0.003, 0.008, -0.002])  # how much newer the gyro is [s]
@pytest.mark.parametrize('gyro_period', [0.005, 0.02])
def test_a_gyro_of_rates_that_stalls_loses_no_turn(stall, joints_stall, late, gyro_period):
    # Its timeout is 0.2 s, that of the joints 0.5 s.
    joints, odometry = JointFeedback(LAYOUT, None, 500 * MS, 200 * MS), SwerveOdometry(
        KIN, estimate_gyro_bias=False)
    wheels = KIN.inverse((0.0, 0.0, 1.0))
    rolled, steered = wheels.speed / LAYOUT.joints.distance_per_drive, wheels.angle.tolist()
    heard = 0.0
    for k in range(100):
        time = 0.02 * k
        is_stalled = 0.7 < time < 0.7 + stall
        while heard <= time + late + 1e-9:
            if not 0.7 < heard < 0.7 + stall:
                joints.read_gyro(nanoseconds(10.0 + heard), math.nan, 1.0)
            heard += gyro_period
        if is_stalled and joints_stall:
            continue
        sample = joints.read(nanoseconds(10.0 + time), NAMES,
                             [*(rolled * time).tolist(), *steered], [])
        assert sample.continuous or k == 0
        odometry.update(time, sample.distances, sample.angles, sample.yaw, sample.yaw_rate,
                        rate_integral=sample.rate_integral)
    assert odometry.pose[2] == pytest.approx(time, abs=1e-3)


def test_the_node_keeps_the_turn_of_a_stall_and_goes_on_from_the_last_position(
        client, start_node):
    start_node(gyro_source='imu', feedback_timeout=0.3, gyro_timeout=2.0)
    imu = client.publisher(Imu, 'imu', qos_profile_sensor_data)
    joints = client.publisher(JointState, 'joint_states')
    time, turned, rolled = [client.node.get_clock().now().nanoseconds], [0.0], [0.0]

    def turn():
        time[0] += 20 * MS
        turned[0] += 0.04
        message = Imu()
        set_stamp(message.header.stamp, time[0])
        set_yaw(message.orientation, turned[0])
        message.angular_velocity.z = 2.0
        imu.publish(message)

    def drive():
        turn()
        rolled[0] += 0.2
        message = JointState(name=DRIVES + STEERINGS, position=[rolled[0]] * 4 + [0.0] * 4)
        set_stamp(message.header.stamp, time[0])
        joints.publish(message)

    client.repeat_until(drive, lambda: len(client.odom) > 20, 'odometry')
    before, count, at_stall = planar_pose(client.odom[-1].pose.pose), len(client.odom), time[0]
    odom_at = client.odom[-1].header.stamp
    client.repeat_until(turn, lambda: time[0] > at_stall + 600 * MS, 'the stall')
    rolled[0] += 500.0
    client.repeat_until(drive, lambda: len(client.odom) > count + 5, 'odometry after the stall')
    after = client.odom[-1]
    elapsed = (after.header.stamp.sec - odom_at.sec
               + 1e-9 * (after.header.stamp.nanosec - odom_at.nanosec))
    pose = planar_pose(after.pose.pose)
    assert np.remainder(pose[2] - before[2] - 2.0 * elapsed + 1.0, 2.0 * np.pi) - 1.0 == (
        pytest.approx(0.0, abs=0.02))
    assert np.hypot(*np.subtract(pose[:2], before[:2])) < 0.5


@pytest.mark.parametrize('gyro_period', [0.02, 0.05, 0.1])
@pytest.mark.parametrize('has_rate', [True, False])
def test_a_gyro_that_is_heard_rarely_does_not_make_the_yaw_rate_leap(has_rate, gyro_period):
    gyro, odometry = GyroFeedback(200 * MS), SwerveOdometry(KIN, estimate_gyro_bias=False)
    turned, heard, worst = 0.0, 0.0, 0.0
    for k in range(800):
        time = 0.005 * k
        omega = 1.5 * math.sin(2.0 * time)
        turned = 0.75 * (1.0 - math.cos(2.0 * time))
        if time >= heard:
            heard += gyro_period
            gyro.add(nanoseconds(1000.0 + time), turned, omega if has_rate else math.nan)
        reading = gyro.at(nanoseconds(1000.0 + time))
        wheels = KIN.inverse((0.0, 0.0, 1.0))
        odometry.update(time, wheels.speed * turned, wheels.angle, reading.yaw, reading.rate,
                        rate_integral=reading.integral)
        if k > 50:
            worst = max(worst, abs(odometry.twist[2] - omega))
    assert worst < 0.6
    assert odometry.pose[2] == pytest.approx(turned, abs=0.02)
