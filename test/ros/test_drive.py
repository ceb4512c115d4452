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

"""The main job over real DDS: commands to the modules, and the odometry back."""

import math
import signal

from geometry_msgs.msg import TwistStamped
from graph import DRIVES, same_moments, speeds_over_time, STEERINGS
from nav_msgs.msg import Odometry
import numpy as np
import pytest
from sensor_msgs.msg import JointState

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.ros.stamps import nanoseconds_of

RADIUS = 0.05
KINEMATICS = SwerveKinematics([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
TWIST = (0.5, 0.2, 0.4)


def velocities(wheel_speeds, angles):
    """Return what a command asks of the modules, as velocity vectors (4, 2) [m/s]."""
    speeds = RADIUS * np.asarray(wheel_speeds)
    return np.column_stack((speeds * np.cos(angles), speeds * np.sin(angles)))


def expected_velocities(twist):
    states = KINEMATICS.inverse(twist)
    return velocities(states.speed / RADIUS, states.angle)


def is_driving(client, twist):
    """Tell whether the latest commands move the modules with the twist."""
    if not client.drive or not client.steering:
        return False
    # Commands are shaped for the control period, which turns them by half its rotation.
    return np.allclose(velocities(client.drive[-1].data, client.steering[-1].data),
                       expected_velocities(twist), atol=0.01)


def test_a_twist_moves_the_modules_and_the_odometry_follows_the_truth(
        client, start_node, start_sim):
    start_sim()
    start_node()
    truth = client.listen(Odometry, 'ground_truth')
    # Either may be discovered seconds after the other.
    client.wait_until(lambda: client.odom and truth, 'odometry and truth')
    client.repeat_until(lambda: client.send_twist(*TWIST),
                        lambda: client.odom[-1].pose.pose.position.x > 0.3
                        and is_driving(client, TWIST), 'the base to drive')
    client.repeat_until(client.send_twist,
                        lambda: not any(client.drive[-1].data)
                        and abs(client.odom[-1].twist.twist.linear.x) < 1e-3, 'the base to stop')
    pairs = same_moments(client.odom, truth)
    assert len(pairs) > 50
    first = [(m.pose.pose.position.x, m.pose.pose.position.y) for m, _ in pairs]
    second = [(t.pose.pose.position.x, t.pose.pose.position.y) for _, t in pairs]
    assert np.abs(np.subtract(first, second)).max() < 0.005
    final = client.odom[-1]
    assert (final.header.frame_id, final.child_frame_id) == ('odom', 'base_link')


def test_the_joint_state_interface_drives_the_base_too(client, start_node, start_sim):
    start_sim()
    start_node(command_interface='joint_state')
    commands = client.listen(JointState, 'joint_commands')

    def latest(names):
        return next((command for command in reversed(commands) if command.name == names), None)

    def is_at_speed():
        drive, steering = latest(DRIVES), latest(STEERINGS)
        return drive and steering and np.allclose(
            velocities(drive.velocity, steering.position), expected_velocities(TWIST), atol=0.05)
    client.repeat_until(lambda: client.send_twist(*TWIST),
                        lambda: client.odom and client.odom[-1].pose.pose.position.x > 0.1
                        and is_at_speed(), 'the base to drive')
    drive, steering = latest(DRIVES), latest(STEERINGS)
    # Who obeys every field must find none that means nothing.
    assert not any([*drive.position, *steering.velocity, *drive.effort, *steering.effort])
    assert drive.header.stamp.sec > 0 and steering.header.stamp.sec > 0
    assert not client.drive


def test_a_new_command_leaves_at_once(client, start_node):
    start_node(control_rate=1.0, feedback_timeout=10.0, max_linear_acceleration=0.0)
    client.begin_feedback()
    # The very first message may get lost.
    client.repeat_until(lambda: client.send_twist(vx=0.0), lambda: len(client.drive) > 5,
                        'commands at the pace of cmd_vel')
    # A node that was held up answers those first that it has not taken yet.
    client.send_twist(vx=0.5)
    client.wait_until(lambda: any(client.drive[-1].data), 'all that were sent')
    before = len(client.drive)
    client.send_twist(vx=1.0)
    client.wait_until(lambda: client.drive[-1].data[0] > 0.75 / RADIUS, 'the command')
    # What was under way, and at the most one tick of the slow timer.
    assert len(client.drive) <= before + 3
    np.testing.assert_allclose(client.drive[-1].data, [1.0 / RADIUS] * 4)


def test_a_base_at_rest_repeats_its_command_less_often(client, start_node):
    start_node(control_rate=100.0, cmd_vel_timeout=20.0, feedback_timeout=20.0,
               max_steering_rate=0.1, command_interface='joint_state')
    commands = client.listen(JointState, 'joint_commands')

    def period():  # of the latest commands by their stamps [ns]; a busy machine delays some
        client.wait_for_count(commands, 40, 'commands')
        return np.quantile(np.diff([nanoseconds_of(command.header.stamp)
                                    for command in commands[-40:] if command.velocity]), 0.25)
    without_feedback = period()
    client.begin_feedback()
    at_rest = period()
    # A quarter turn of the steering first, at 0.1 rad/s. The very first message may get lost.
    client.repeat_until(lambda: client.send_twist(vy=1.0),
                        lambda: any(any(command.position) for command in commands[-2:]),
                        'the steering to move')
    turning = period()
    assert not any(any(command.velocity) for command in commands[-2:])
    client.send_twist()
    client.wait_for_count(commands, 5, 'the steering to stop')
    assert 2.0 * turning < min(without_feedback, at_rest, period())


def test_silence_ramps_to_a_stop_and_holds_the_steering(client, start_node, start_sim):
    start_sim()
    start_node(cmd_vel_timeout=0.2, max_linear_deceleration=2.0)
    limited = client.listen(TwistStamped, 'swerve_node/cmd_vel_limited')
    client.wait_until(lambda: client.odom and limited, 'odometry')
    client.repeat_until(lambda: client.send_twist(vy=1.0),
                        lambda: is_driving(client, (0.0, 1.0, 0.0)), 'the base to strafe')
    client.wait_until(lambda: not any(client.drive[-1].data)
                      and limited[-1].twist.linear.y == 0.0, 'the stop')
    # By their stamps: a busy machine loses some.
    times, speeds = speeds_over_time(limited, 'y')
    last_at_speed = np.flatnonzero(speeds > 0.99)[-1]
    times, speeds = times[last_at_speed:], speeds[last_at_speed:]
    # From 1 m/s at 2 m/s^2, each a little slower than the one before.
    assert times[np.flatnonzero(speeds)[-1]] - times[0] > 0.4
    assert np.all(np.diff(speeds) >= -2.0 * (np.diff(times) + 0.01))
    client.wait_for_count(client.drive, 5, 'the stop to be published on')
    assert not any(any(message.data) for message in client.drive[-5:])
    np.testing.assert_allclose(np.abs(client.steering[-1].data), math.pi / 2, atol=0.02)


def stamped(frame, vy, omega):
    """Return a TwistStamped; its stamp of 0 means now."""
    command = TwistStamped()
    command.header.frame_id = frame
    command.twist.linear.y, command.twist.angular.z = vy, omega
    return command


def drives_straight_in_the_field(client, turn, stop, drive):
    """Turn the base by more than 1 rad, then drive; check that it goes along the field's y."""
    def pose():
        return client.odom[-1].pose.pose if client.odom else Odometry().pose.pose
    client.repeat_until(turn, lambda: pose().orientation.z > math.sin(0.5), 'the base to turn')
    # The heading by which a command is turned is a little old: it must not matter here.
    client.repeat_until(stop, lambda: abs(client.odom[-1].twist.twist.angular.z) < 1e-3,
                        'the base to stop')
    start = pose().position
    client.repeat_until(drive, lambda: pose().position.y > start.y + 0.5, 'the base to drive')
    assert abs(pose().position.x - start.x) < 0.05


def test_a_stamped_command_in_the_odom_frame_is_field_centric(client, start_node, start_sim):
    start_sim()
    start_node(use_stamped_vel=True)
    publisher = client.publisher(TwistStamped, 'cmd_vel')
    drives_straight_in_the_field(
        client, lambda: publisher.publish(stamped('base_link', 0.0, 1.0)),
        lambda: publisher.publish(stamped('base_link', 0.0, 0.0)),
        lambda: publisher.publish(stamped('odom', 0.5, 0.0)))


def test_a_plain_command_is_field_centric_by_parameter(client, start_node, start_sim):
    start_sim()
    start_node(field_centric=True)
    drives_straight_in_the_field(client, lambda: client.send_twist(omega=1.0),
                                 client.send_twist, lambda: client.send_twist(vy=0.5))


@pytest.mark.parametrize('by', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_the_wheels_and_ends_cleanly(client, start_node, start_sim, by):
    start_sim()
    node = start_node()
    client.repeat_until(lambda: client.send_twist(vx=1.0),
                        lambda: client.drive and max(client.drive[-1].data) > 5.0,
                        'the base to drive')
    assert node.end(by) == 0
    client.wait_until(lambda: not any(client.drive[-1].data), 'a last command that stops')
    assert len(client.steering[-1].data) == 4
    assert 'Traceback' not in node.output
