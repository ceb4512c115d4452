"""Publishers whose messages cannot arrive, and several where one is expected, on a real graph."""

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist, TwistStamped
import pytest
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu


def reported(reports, *words):
    """Tell whether the latest report is a warning, or graver, that has these words."""
    return reports and reports[-1].status[0].level >= DiagnosticStatus.WARN and all(
        word in reports[-1].status[0].message for word in words)


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
    node = start_node(use_stamped_vel=use_stamped_vel)
    publisher = client.node.create_publisher(kind, 'cmd_vel', 10)
    name = client.node.get_fully_qualified_name()
    client.repeat_until(
        client.send_joints, lambda: reported(reports, f'{name} publishes', kind.__name__),
        'the report')
    assert name in node.output
    client.node.destroy_publisher(publisher)
    client.repeat_until(
        client.send_joints,
        lambda: reports[-1].status[0].level == DiagnosticStatus.OK
        or not reported(reports, kind.__name__), 'the report to end')


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
