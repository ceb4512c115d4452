"""Several robots on one graph, simulated time, and both kinds of publisher."""

from graph import Client
from nav_msgs.msg import Odometry
import pytest
from rclpy.qos import qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState

from swerve_kinematics.ros.conversions import planar_pose
from swerve_kinematics.ros.stamps import set_stamp

S = 1_000_000_000  # ns


def test_two_robots_on_one_graph_do_not_disturb_each_other(
        client, namespace, start_node, start_sim):
    other = Client(f'{namespace}/other')
    for name in (namespace, f'{namespace}/other'):
        prefix = name.rpartition('/')[2] + '/'
        start_sim(namespace=name, seed=1, frame_prefix=prefix)
        start_node(namespace=name, frame_prefix=prefix)
    other.wait_until(lambda: other.odom, 'odometry of the other robot')
    client.repeat_until(
        lambda: client.send_twist(vx=0.5),
        lambda: client.odom and client.odom[-1].pose.pose.position.x > 0.3, 'one robot to drive')
    stamp = client.odom[-1].header.stamp
    other.wait_until(lambda: other.odom[-1].header.stamp.sec > stamp.sec, 'later odometry')
    assert max(abs(message.pose.pose.position.x) for message in other.odom) == 0.0
    assert {message.header.frame_id for message in other.odom} == {'other/odom'}
    assert {message.child_frame_id for message in other.odom} == {'other/base_link'}
    own = namespace.strip('/')
    assert {message.header.frame_id for message in client.odom} == {f'{own}/odom'}
    assert {message.child_frame_id for message in client.odom} == {f'{own}/base_link'}
    other.node.destroy_node()


def test_frame_names_are_those_of_the_parameters(client, start_node):
    start_node(odom_frame_id='robot/odom', base_frame_id='robot/base')
    client.begin_feedback()
    assert client.odom[-1].header.frame_id == 'robot/odom'
    assert client.odom[-1].child_frame_id == 'robot/base'


@pytest.mark.parametrize('qos', [10, qos_profile_sensor_data], ids=['reliable', 'best effort'])
def test_both_kinds_of_publisher_are_heard(client, start_node, qos):
    start_node()
    client.publisher(JointState, 'joint_states', qos)
    client.begin_feedback()


def test_quality_of_service_can_be_overridden(client, namespace, start_node):
    override = f'qos_overrides.{namespace}/odom.publisher.reliability'
    elsewhere = 'qos_overrides./odom.publisher.depth'  # without the namespace
    node = start_node(**{override: 'best_effort', elsewhere: 5})
    heard = client.listen(Odometry, 'odom', qos_profile_sensor_data)
    client.repeat_until(client.send_joints, lambda: heard, 'odometry')
    assert f"'{elsewhere}' fits no topic" in node.output
    # The client's reliable subscription does not match a best-effort publisher.
    assert not client.odom


def test_an_imu_takes_the_place_of_the_gyro_joint(client, start_node):
    start_node(gyro_source='imu', estimate_gyro_bias=False)
    publisher = client.publisher(Imu, 'imu', qos_profile_sensor_data)
    client.publisher(JointState, 'joint_states')
    turned = [0.0]

    def send():
        turned[0] += 0.01
        message = Imu()
        message.orientation_covariance[0] = -1.0  # it has no orientation
        message.angular_velocity.z = 0.5
        message.header.stamp = client.node.get_clock().now().to_msg()
        publisher.publish(message)
        client.send_joints(stamp=message.header.stamp)
    client.repeat_until(send, lambda: len(client.odom) > 50, 'odometry')
    first, last = client.odom[10], client.odom[-1]
    elapsed = (last.header.stamp.sec - first.header.stamp.sec
               + 1e-9 * (last.header.stamp.nanosec - first.header.stamp.nanosec))
    yaw = planar_pose(last.pose.pose)[2] - planar_pose(first.pose.pose)[2]
    assert yaw == pytest.approx(0.5 * elapsed, rel=0.05)


class SimulatedTime:
    """A /clock that the test moves, and feedback at its times."""

    def __init__(self, client):
        self._client = client
        self._publisher = client.publisher(Clock, '/clock')
        self.now = 100 * S

    def advance(self, step):
        """Move the clock by `step` [ns], tell it, and send joints at its time."""
        self.now += step
        message = Clock()
        set_stamp(message.clock, self.now)
        self._publisher.publish(message)
        self._client.send_joints(stamp=message.clock)


def test_simulated_time_may_run_fast_pause_and_jump_back(client, start_node):
    # A busy machine may hand the node many steps of the clock at once.
    start_node(use_sim_time=True, cmd_vel_timeout=5.0, feedback_timeout=5.0,
               max_linear_acceleration=0.0, max_linear_deceleration=0.0)
    clock = SimulatedTime(client)

    def is_driving():
        return client.drive and client.drive[-1].data[0] > 19.9
    # 60 ms of simulated time every 20 ms: three times as fast.
    client.repeat_until(lambda: (clock.advance(60_000_000), client.send_twist(vx=1.0)),
                        lambda: is_driving() and client.odom, 'driving in fast time')
    stamp = client.odom[-1].header.stamp
    assert 100 <= stamp.sec < 200
    # Paused: nothing times out, and nothing but a command makes a command.
    count = len(client.drive)
    client.repeat_until(lambda: client.send_twist(vx=1.0),
                        lambda: len(client.drive) > count + 10, 'commands in paused time')
    assert is_driving()
    # Set back: the command is forgotten with the time it was given in.
    clock.now = 10 * S
    client.repeat_until(lambda: clock.advance(60_000_000),
                        lambda: not any(client.drive[-1].data), 'the stop in the past')
    client.repeat_until(lambda: (clock.advance(60_000_000), client.send_twist(vx=1.0)),
                        lambda: is_driving() and client.odom[-1].header.stamp.sec < 60,
                        'driving again')
