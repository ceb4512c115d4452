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

"""The fault table over real DDS: what goes wrong stays harmless."""

import math

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Twist, TwistStamped
from graph import DRIVES, ignored, speeds_over_time, STEERINGS
import numpy as np
import pytest
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

NO_RAMPS = {'max_linear_acceleration': 0.0, 'max_steering_rate': 0.0}


def warned_of(reports, reason):
    """Tell whether a report had the level of a warning, or a graver one, and said why."""
    return any(report.level >= DiagnosticStatus.WARN
               and reason in report.message for report in reports)


@pytest.mark.parametrize('vector, axis, bad', [
    ('linear', 'x', math.nan), ('linear', 'z', math.inf), ('angular', 'y', -math.inf)])
def test_a_command_that_is_not_finite_changes_nothing(
        client, start_node, reports, vector, axis, bad):
    command = Twist()
    command.linear.x = 1.0
    setattr(getattr(command, vector), axis, bad)
    start_node(**NO_RAMPS)
    client.begin_feedback()
    client.repeat_until(lambda: (client.send_joints(), client.send_twist(vx=1.0)),
                        lambda: client.drive and client.drive[-1].data[0] == 20.0, 'driving')
    client.repeat_until(lambda: (client.send_joints(),
                                 client.publisher(Twist, 'cmd_vel').publish(command)),
                        lambda: not any(client.drive[-1].data),
                        'the last good command to time out')
    assert np.isfinite([message.data for message in client.drive]).all()
    assert np.isfinite([message.data for message in client.steering]).all()
    client.wait_until(lambda: ignored(reports, 'cmd_vel not finite') > 0, 'the count of it')
    assert warned_of(reports, 'cmd_vel not finite')


def test_wheels_that_are_held_do_not_lurch_when_released(client, start_node, reports):
    start_node()
    limited = client.listen(TwistStamped, 'swerve_node/cmd_vel_limited')
    client.begin_feedback()
    turned, told = [0.0] * 4, []

    def drive(are_held):
        speeds = [0.0] * 4 if are_held else list(client.drive[-1].data)
        turned[:] = [turn + 0.02 * speed for turn, speed in zip(turned, speeds)]
        client.send_joints(turns=turned)
        client.send_twist(vx=1.0)
        told.append(client.drive[-1].data[0] if client.drive else 0.0)

    client.repeat_until(lambda: drive(True), lambda: max(told, default=0.0) > 5.0
                        and told[-1] < 2.5, 'the ramp to come back')
    client.repeat_until(lambda: drive(True), lambda: warned_of(reports, 'does not follow'),
                        'the warning')
    assert told[-1] < 2.5
    released = len(limited)
    client.repeat_until(lambda: drive(False), lambda: told[-1] > 19.9
                        and limited[-1].twist.linear.x > 0.99, 'the base to drive')
    times, speeds = speeds_over_time(limited[released:], 'x')
    assert np.all(np.diff(speeds) <= 2.0 * (np.diff(times) + 0.01))


def test_without_feedback_the_wheels_stand_and_the_steering_is_left_alone(client, start_node):
    start_node()
    client.repeat_until(lambda: client.send_twist(vx=1.0), lambda: len(client.drive) > 20,
                        'commands')
    assert not any(any(message.data) for message in client.drive)
    assert not client.steering


def test_open_loop_drives_without_feedback(client, start_node):
    start_node(open_loop=True)
    client.repeat_until(lambda: client.send_twist(vx=1.0),
                        lambda: client.drive and client.drive[-1].data[0] > 19.9, 'driving')


def test_lost_feedback_stops_the_wheels_and_its_return_resumes_without_a_jump(
        client, start_node, reports):
    start_node(feedback_timeout=0.3, **NO_RAMPS)
    turns = [0.0]

    def drive():
        turns[0] += 0.4
        client.send_joints(turns=[turns[0]] * 4, angles=[0.5] * 4)
        client.send_twist(math.cos(0.5), math.sin(0.5))
    client.repeat_until(drive, lambda: client.drive and client.drive[-1].data[0] > 19.0
                        and len(client.odom) > 10, 'driving')
    silent = client.odom[-1].pose.pose.position
    client.repeat_until(lambda: client.send_twist(math.cos(0.5), math.sin(0.5)),
                        lambda: not any(client.drive[-1].data), 'the stop')
    np.testing.assert_allclose(client.steering[-1].data, [0.5] * 4, atol=0.02)
    client.wait_until(
        lambda: reports and reports[-1].level == DiagnosticStatus.ERROR, 'an error')
    count = len(client.odom)
    turns[0] += 1000.0
    client.repeat_until(drive, lambda: len(client.odom) > count + 5
                        and client.drive[-1].data[0] > 19.0, 'driving again')
    here = client.odom[count].pose.pose.position
    assert math.dist((silent.x, silent.y), (here.x, here.y)) < 0.2
    assert client.odom[count].pose.covariance[0] > client.odom[count - 1].pose.covariance[0]


@pytest.mark.parametrize('lost', [STEERINGS, STEERINGS[2:3]])
@pytest.mark.parametrize('is_silent', [False, True])
@pytest.mark.parametrize('is_trusted', [False, True])
def test_wheels_stop_where_steering_encoders_restart_until_they_are_right_or_trusted(
        client, start_node, reports, lost, is_silent, is_trusted):
    start_node(feedback_timeout=0.3, gyro_source='none', **NO_RAMPS)
    turns, angles = [0.0], [0.8] * 4

    def drive():
        turns[0] += 0.2
        client.send_joints(turns=[turns[0]] * 4, angles=angles)
        client.send_twist(math.cos(0.8), math.sin(0.8))

    def drives():
        return client.drive and client.drive[-1].data[0] > 19.0

    client.repeat_until(drive, drives, 'driving')
    if is_silent:
        client.repeat_until(lambda: client.send_twist(math.cos(0.8), math.sin(0.8)),
                            lambda: not any(client.drive[-1].data), 'the stop')
    angles = [0.0 if name in lost else 0.8 for name in STEERINGS]
    client.repeat_until(drive, lambda: warned_of(reports, 'did not turn'), 'an error')
    assert reports[-1].level == DiagnosticStatus.ERROR
    assert all((name[:-len('_steering_joint')] in reports[-1].message) == (name in lost)
               for name in STEERINGS)
    count = len(client.drive)
    client.repeat_until(drive, lambda: len(client.drive) > count + 50, 'more commands')
    assert not any(any(command.data) for command in client.drive[count:])
    if is_trusted:
        assert client.call(Trigger, 'swerve_node/trust_steering', Trigger.Request()).success
    else:
        angles = [0.8] * 4
    client.repeat_until(drive, lambda: any(client.drive[-1].data), 'driving again')
    assert not client.call(Trigger, 'swerve_node/trust_steering', Trigger.Request()).success


def test_foreign_split_short_and_damaged_joint_states_are_harmless(client, start_node, reports):
    node = start_node()
    publisher = client.publisher(JointState, 'joint_states')
    names = DRIVES + STEERINGS
    bad = [
        JointState(),
        JointState(name=['arm', 'camera'], position=[1.0, 2.0]),
        JointState(name=names, position=[9.0]),
        JointState(name=names),
        JointState(name=names, position=[math.nan] * 8, velocity=[math.inf] * 8),
        JointState(name=names[:2] * 4, position=[9.0] * 8),
        JointState(name=names, position=[0.0] * 7 + [math.inf]),
        JointState(position=[1.0] * 50),
    ]
    client.begin_feedback(turns=[1.0] * 4)
    client.wait_until(lambda: reports, 'diagnostics')
    count = len(client.odom)

    def send_all():
        for message in bad:
            message.header.stamp = client.node.get_clock().now().to_msg()
            publisher.publish(message)
    client.repeat_until(send_all, lambda: ignored(reports, 'unusable joint values') > 0,
                        'the count')
    assert len(client.odom) == count
    # Split in two, in another order, among foreign joints: one step when both have come.
    stamp = client.node.get_clock().now().to_msg()
    for part in (['arm', *DRIVES[::-1]], [*STEERINGS, 'camera']):
        message = JointState(name=part, position=[1.0] * len(part))
        message.header.stamp = stamp
        publisher.publish(message)
    client.wait_until(lambda: len(client.odom) > count, 'the split set')
    assert len(client.odom) == count + 1
    assert client.odom[-1].header.stamp == stamp
    assert math.hypot(client.odom[-1].pose.pose.position.x,
                      client.odom[-1].pose.pose.position.y) < 1e-6
    assert node.is_running()


def test_an_arm_on_the_same_topic_is_no_reason_to_warn(client, start_node, reports):
    start_node(gyro_source='none')
    client.begin_feedback()
    arm = JointState(name=['shoulder', 'elbow'], position=[1.0, 2.0])

    def foreign():
        """Return how many messages the latest report has found to be of other joints."""
        return next((int(value.value) for value in (reports[-1].values if reports else [])
                     if value.key == 'joint_states of other joints only'), 0)

    def send_both():
        client.send_joints()
        client.publisher(JointState, 'joint_states').publish(arm)
    client.repeat_until(send_both, lambda: foreign() > 0, 'the count')
    begun = len(reports), foreign()
    client.repeat_until(send_both, lambda: len(reports) > begun[0] + 1, 'two more reports')
    assert foreign() > begun[1]
    assert {report.message for report in reports[begun[0]:]} == {'ok'}


def test_repeated_and_older_stamps_are_dropped(client, start_node, reports):
    start_node()
    client.begin_feedback()
    client.wait_until(lambda: reports, 'diagnostics')
    count, stamp = len(client.odom), client.odom[-1].header.stamp
    client.repeat_until(lambda: client.send_joints(turns=[9.0] * 4, stamp=stamp),
                        lambda: ignored(reports, 'repeated or old joint states') > 2, 'the count')
    assert len(client.odom) == count
    assert warned_of(reports, 'repeated or old joint states')


def test_a_clock_set_back_keeps_the_pose(client, start_node):
    node = start_node()
    turns = [0.0]

    def forward():
        turns[0] += 0.2
        client.send_joints(turns=[turns[0]] * 4)
    client.repeat_until(forward, lambda: len(client.odom) > 20, 'odometry')
    before = client.odom[-1].pose.pose.position.x
    assert before > 0.1
    stamp = client.odom[-1].header.stamp
    stamp.sec -= 1000
    count = len(client.odom)
    client.send_joints(turns=[0.0] * 4, stamp=stamp)
    client.wait_until(lambda: client.odom[-1].header.stamp == stamp, 'odometry in the past')
    assert client.odom[-1].pose.pose.position.x == pytest.approx(
        client.odom[count - 1].pose.pose.position.x, abs=0.011)
    client.wait_until(lambda: 'clock jumped' in node.output, 'one warning')


@pytest.mark.parametrize('seconds', [-1000, 2])
def test_a_base_that_drives_is_not_braked_by_a_clock_that_is_set(client, start_node, seconds):
    start_node()
    client.begin_feedback()
    stamp, turned = [client.node.get_clock().now().nanoseconds], [0.0] * 4

    def drive():
        stamp[0] += 20_000_000
        turned[:] = [turn + 0.02 * speed for turn, speed in zip(turned, client.drive[-1].data)]
        client.send_joints(turns=turned, stamp=Time(nanoseconds=stamp[0]).to_msg())
        client.send_twist(vx=1.0)

    client.wait_until(lambda: client.drive, 'commands')
    client.repeat_until(drive, lambda: client.drive[-1].data[0] > 19.999, 'the base to drive')
    stamp[0] += seconds * 1_000_000_000
    count = len(client.drive)
    client.repeat_until(drive, lambda: len(client.drive) > count + 20, 'commands')
    assert min(message.data[0] for message in client.drive[count:]) > 19.99


def test_an_encoder_that_jumps_is_left_out_and_reported(client, start_node, reports):
    start_node()
    turns = np.zeros(4)

    def forward():
        turns[:] += 0.2
        client.send_joints(turns=turns)
    client.repeat_until(forward, lambda: len(client.odom) > 20, 'odometry')
    turns[1] -= 1e4
    count = len(client.odom)
    client.repeat_until(forward, lambda: len(client.odom) > count + 20, 'odometry after the jump')
    steps = np.diff([message.pose.pose.position.x for message in client.odom])
    # The jump was 500 m; a busy machine may lose a few samples of 10 mm.
    assert steps.max() < 1.0 and steps.min() > -1e-6

    def jump():
        turns[1] += 1e4
        forward()
    client.repeat_until(jump, lambda: reports and any(
        'slipping: front_right' in report.message for report in reports), 'a report')


@pytest.mark.parametrize('age, frame, reason', [
    (1000, 'base_link', 'cmd_vel too old'), (-1000, 'base_link', 'cmd_vel from the future'),
    (0, 'map', 'cmd_vel in an unknown frame, neither base_link nor odom')])
def test_a_stale_or_foreign_stamped_command_is_ignored_and_counted(
        client, start_node, reports, age, frame, reason):
    start_node(use_stamped_vel=True)
    publisher = client.publisher(TwistStamped, 'cmd_vel')
    command = TwistStamped()
    command.header.frame_id = frame
    command.twist.linear.x = 1.0

    def send():
        client.send_joints()
        command.header.stamp = client.node.get_clock().now().to_msg()
        command.header.stamp.sec -= age
        publisher.publish(command)
    client.repeat_until(send, lambda: ignored(reports, reason) > 0, 'the count of it')
    assert warned_of(reports, reason)
    assert not any(any(message.data) for message in client.drive)
