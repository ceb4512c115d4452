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

"""Publishers whose messages cannot arrive, and several where one is expected, on a real graph."""

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist, TwistStamped
from graph import DRIVES, STEERINGS
import pytest
from rcl_interfaces.srv import SetParameters
import rclpy
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Float64MultiArray
from swerve_kinematics.ros.peers import Peers


def reported(reports, *words):
    """Tell whether the latest report is a warning, or graver, that has these words."""
    return reports and reports[-1].level >= DiagnosticStatus.WARN and all(
        word in reports[-1].message for word in words)


def test_a_best_effort_publisher_drives_the_base(client, start_node):
    start_node()
    client.begin_feedback()
    commands = client.publisher(Twist, 'cmd_vel', qos_profile_sensor_data)
    command = Twist()
    command.linear.x = 0.5
    client.repeat_until(lambda: (client.send_joints(), commands.publish(command)),
                        lambda: client.drive and client.drive[-1].data[0] == 10.0, 'driving')


@pytest.mark.parametrize('use_stamped_vel, kind', [
    (False, TwistStamped), (True, Twist)])
def test_a_cmd_vel_of_another_type_is_reported_by_its_node(
        client, start_node, reports, use_stamped_vel, kind):
    node = start_node(use_stamped_vel=use_stamped_vel, gyro_source='none')
    # Only a change of level is logged: let nothing else be wrong.
    client.repeat_until(
        client.send_joints, lambda: reports and reports[-1].level == DiagnosticStatus.OK,
        'all well')
    publisher = client.node.create_publisher(kind, 'cmd_vel', 10)
    name = client.node.get_fully_qualified_name()
    client.repeat_until(
        client.send_joints, lambda: reported(reports, f'{name} publishes', kind.__name__),
        'the report')
    assert name in node.output
    client.node.destroy_publisher(publisher)
    client.repeat_until(
        client.send_joints, lambda: not reported(reports, kind.__name__), 'the report to end')


@pytest.mark.parametrize('topic, kind, parameters', [
    ('swerve_node/set_pose', PoseWithCovarianceStamped, {}),
    ('cmd_vel', Twist, {'cmd_vel': 'reliable'}), ('imu', Imu, {'imu': 'reliable'})])
def test_a_publisher_that_does_not_match_in_quality_of_service_is_reported_by_its_node(
        client, start_node, reports, topic, kind, parameters):
    namespace = client.node.get_namespace()
    start_node(gyro_source='imu', **{
        f'qos_overrides.{namespace}/{name}.subscription.reliability': reliability
        for name, reliability in parameters.items()})
    client.node.create_publisher(kind, topic, qos_profile_sensor_data)
    client.wait_until(
        lambda: reported(reports, f'client publishes {namespace}/{topic}', 'quality of service'),
        'the report')


def test_a_topic_that_nobody_publishes_is_reported_with_one_that_may_be_meant(
        client, start_node, reports):
    namespace = client.node.get_namespace()
    start_node(gyro_source='imu')
    client.node.create_publisher(Imu, 'imu/data', 10)
    words = f'nobody publishes {namespace}/imu; there is {namespace}/imu/data'
    client.repeat_until(client.send_joints, lambda: reported(reports, words), 'the report')
    client.node.create_publisher(Imu, 'imu', 10)
    client.repeat_until(client.send_joints, lambda: not reported(reports, words), 'its end')


def test_commands_on_another_topic_are_pointed_out_until_the_first_one_comes(
        client, start_node, reports):
    namespace = client.node.get_namespace()
    start_node(gyro_source='none')
    client.repeat_until(client.send_joints, lambda: reports and reports[-1].message == 'ok',
                        'nothing to be said of a base that nobody commands')
    client.node.create_publisher(Twist, 'cmd_vel_nav', 10)
    words = f'nobody publishes {namespace}/cmd_vel; there is {namespace}/cmd_vel_nav'
    client.repeat_until(client.send_joints, lambda: reports[-1].message == words, 'the hint')
    assert reports[-1].level == DiagnosticStatus.OK
    client.repeat_until(lambda: (client.send_joints(), client.send_twist()),
                        lambda: reports[-1].message == 'ok', 'the end of the hint')


def test_commands_that_pause_again_and_again_are_reported_until_they_do_not(
        client, start_node, reports):
    start_node(gyro_source='none', cmd_vel_timeout=0.05)

    def driving():
        client.send_joints()
        client.send_twist(vx=0.1)
    words = 'cmd_vel pauses for longer than cmd_vel_timeout 0.05 s'
    client.repeat_until(driving, lambda: reported(reports, words), 'the report', period=0.2)
    # These joints do not move as commanded either, which is another finding, and may last.
    client.repeat_until(client.send_joints, lambda: words not in reports[-1].message, 'its end')


@pytest.mark.parametrize('use_stamped_vel, kind', [(False, Twist), (True, TwistStamped)])
def test_two_nodes_that_command_the_base_in_turn_are_named(
        client, start_node, reports, other, use_stamped_vel, kind):
    start_node(use_stamped_vel=use_stamped_vel, gyro_source='none')
    mine, others = (node.create_publisher(kind, 'cmd_vel', 10) for node in (client.node, other))
    go = kind()
    (go.twist if use_stamped_vel else go).linear.x = 0.1

    def both():
        client.send_joints()
        mine.publish(go)
        others.publish(kind())
    words = 'cmd_vel comes in turn from', 'client and', other.get_name()
    client.repeat_until(both, lambda: reported(reports, *words), 'the report')


def test_commands_that_nobody_receives_are_reported_while_the_base_drives(
        client, start_node, reports):
    namespace = client.node.get_namespace()
    start_node(command_interface='joint_state', gyro_source='none')
    client.node.create_subscription(JointState, 'joint_command', lambda _: None, 10)
    client.repeat_until(client.send_joints, lambda: reports and reports[-1].message == 'ok',
                        'nothing to be said of a base that stands')

    def driving():
        client.send_joints()
        client.send_twist(vx=0.1)
    words = f'nobody receives {namespace}/joint_commands; there is {namespace}/joint_command'
    client.repeat_until(driving, lambda: reported(reports, words), 'the report')
    client.listen(JointState, 'joint_commands')
    client.repeat_until(driving, lambda: not reported(reports, words), 'its end')


def test_one_of_the_command_topics_is_not_said_to_stand_for_another(client, other):
    listened, unheard = (client.node.create_publisher(Float64MultiArray, topic, 10) for topic in (
        'drive_velocity_controller/commands', 'steering'))
    client.repeat_until(
        lambda: None, lambda: listened.get_subscription_count() > 0, 'the listener')
    assert list(Peers(other).unheard([listened, unheard])) == [
        f'nobody receives {unheard.topic_name}; '
        f'there is {client.node.get_namespace()}/steering_position_controller/commands']


@pytest.mark.parametrize('interface, topic, kind', [
    ('forward_command', 'drive_velocity_controller/commands', Float64MultiArray),
    ('forward_command', 'steering_position_controller/commands', Float64MultiArray),
    ('joint_state', 'joint_commands', JointState)])
def test_another_node_that_commands_the_joints_is_reported(
        client, start_node, reports, interface, topic, kind):
    start_node(command_interface=interface)
    rival = client.node.create_publisher(kind, topic, 10)
    client.repeat_until(
        client.send_joints, lambda: reported(reports, topic, 'client', 'swerve_node', 'only one'),
        'the report')
    client.node.destroy_publisher(rival)
    client.repeat_until(client.send_joints, lambda: not reported(reports, 'only one'), 'its end')


@pytest.fixture
def other(context, namespace):
    """Return a second node beside the client."""
    node = rclpy.create_node('joint_state_publisher', namespace=namespace)
    yield node
    node.destroy_node()


def test_nodes_of_the_same_name_are_named_once_each(client, context, namespace):
    """Who starts a driver twice is told of both."""
    twins = [rclpy.create_node('driver', namespace=namespace) for _ in range(2)]
    for twin in twins:
        twin.create_publisher(JointState, 'joint_states', 10)
    peers = Peers(client.node)
    client.wait_until(lambda: peers.publishers('joint_states') == [f'{namespace}/driver'] * 2,
                      'both to be named')
    for twin in twins:
        twin.destroy_node()


def test_zeros_of_a_second_publisher_change_nothing_and_both_nodes_are_named(
        client, start_node, reports, other):
    start_node()
    placeholder = other.create_publisher(JointState, 'joint_states', 10)
    zeros = JointState(name=[*STEERINGS, 'arm', *DRIVES], position=[0.0] * 9)
    angles, turns = [0.5] * 4, [100.0]
    client.begin_feedback(angles=angles, turns=turns * 4)
    client.wait_until(lambda: placeholder.get_subscription_count() > 0, 'a listener')
    start = len(client.odom)

    def drive_on():
        turns[0] += 0.2
        client.send_joints(angles=angles, turns=turns * 4)
        client.send_twist(vx=0.5)
        if len(client.odom) % 5 == 0:
            zeros.header.stamp = client.node.get_clock().now().to_msg()
            placeholder.publish(zeros)
    first = client.odom[-1].pose.pose.position
    client.repeat_until(
        drive_on, lambda: len(client.odom) > start + 60 and reported(
            reports, 'same joints', f'{other.get_fully_qualified_name()}',
            f'{client.node.get_fully_qualified_name()}', 'joint states from another publisher'),
        'the report')
    count = len(client.odom)
    client.repeat_until(drive_on, lambda: len(client.odom) > count + 2, 'the last states')
    last = client.odom[-1].pose.pose.position
    driven = 0.05 * (turns[0] - 100.0)
    assert abs(((last.x - first.x) ** 2 + (last.y - first.y) ** 2) ** 0.5 - driven) < 0.05


def test_who_is_left_by_the_drivers_is_not_believed_and_named_alone(
        client, start_node, reports, other):
    start_node(gyro_source='none')
    placeholder = other.create_publisher(JointState, 'joint_states', 10)
    zeros, turns = JointState(name=DRIVES + STEERINGS, position=[0.0] * 8), [100.0]
    client.begin_feedback(turns=turns * 4)
    client.wait_until(lambda: placeholder.get_subscription_count() > 0, 'a listener')

    def stand_in():
        zeros.header.stamp = client.node.get_clock().now().to_msg()
        placeholder.publish(zeros)

    def both():
        turns[0] += 0.1
        client.send_joints(turns=turns * 4)
        stand_in()
    client.repeat_until(both, lambda: reported(reports, 'same joints'), 'the report')
    client.node.destroy_publisher(client.publisher(JointState, 'joint_states'))
    client.repeat_until(stand_in, lambda: reported(
        reports, f'{other.get_fully_qualified_name()} publishes joints', 'wheels stopped'),
        'the other one to be named alone')


def test_a_second_publisher_takes_over_after_the_feedback_timeout_of_now(
        client, start_node, other):
    start_node(feedback_timeout=100.0, gyro_source='none')
    spare = other.create_publisher(JointState, 'joint_states', 10)
    states, turns = JointState(name=DRIVES + STEERINGS), [0.0]
    client.begin_feedback()
    client.wait_until(lambda: spare.get_subscription_count() > 0, 'a listener')

    def spare_moves():
        turns[0] += 0.01
        states.position = [500.0 + turns[0]] * 4 + [0.0] * 4
        states.header.stamp = client.node.get_clock().now().to_msg()
        spare.publish(states)
    count = len(client.odom)
    client.repeat_until(lambda: (client.send_joints(turns=turns * 4), spare_moves()),
                        lambda: len(client.odom) > count + 10, 'odometry')
    client.call(SetParameters, 'swerve_node/set_parameters', SetParameters.Request(
        parameters=[Parameter('feedback_timeout', value=0.1).to_parameter_msg()]))
    count = len(client.odom)
    client.repeat_until(spare_moves, lambda: len(client.odom) > count + 5,
                        'odometry by the other publisher')


def test_drives_and_steering_of_two_publishers_are_no_fault(client, start_node, reports, other):
    start_node(gyro_source='none')
    steerings = other.create_publisher(JointState, 'joint_states', 10)
    drives = client.publisher(JointState, 'joint_states')
    turns = [0.0]

    def drive_on():
        turns[0] += 0.2
        stamp = client.node.get_clock().now().to_msg()
        for publisher, names, value in ((drives, DRIVES, turns[0]), (steerings, STEERINGS, 0.5)):
            message = JointState(name=names, position=[value] * 4)
            message.header.stamp = stamp
            publisher.publish(message)
    client.repeat_until(drive_on, lambda: len(client.odom) > 20 and reports
                        and reports[-1].level == DiagnosticStatus.OK, 'all to be well')
