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

"""Several robots on one graph, simulated time, and both kinds of publisher."""

import time

from geometry_msgs.msg import Twist
from graph import same_moments
from nav_msgs.msg import Odometry
import numpy as np
import pytest
from rclpy.qos import qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState

from swerve_kinematics.configuration.node import NODE_DECLARATIONS
from swerve_kinematics.configuration.simulator import SIMULATOR_DECLARATIONS
from swerve_kinematics.core.geometry.se2 import to_robot_frame
from swerve_kinematics.ros.conversions import planar_pose
from swerve_kinematics.ros.messages import set_planar_twist
from swerve_kinematics.ros.stamps import set_stamp
from swerve_kinematics.tools.demo.figure_eight import FigureEight, plan

S = 1_000_000_000  # ns

FIGURE = FigureEight(length=1.6, width=0.8, turns=1, duration=6.0, ramp=1.0)
# Mirrored, clockwise, geared and coupled; and three modules, other radii, an IMU on its side.
BASES = {
    'first': {'drive_directions': [1.0, -1.0, 1.0, -1.0], 'steering_directions': [-1.0],
              'steering_offsets': [0.3, 2.8, -1.0, 3.0], 'drive_ratios': [6.75],
              'steering_ratios': [12.8], 'drive_coupling_ratio': [3.0, -3.0, 3.0, -3.0]},
    'second': {'module_names': ['front', 'left', 'right'], 'module_x': [0.35, -0.2, -0.2],
               'module_y': [0.0, 0.3, -0.3], 'wheel_radii': [0.05, 0.06, 0.07],
               'drive_joint_period': 12.566371, 'steering_directions': [-1.0, 1.0, -1.0],
               'gyro_source': 'imu', 'imu_orientation': [0.0, 1.570796, 0.0]}}


class Robot:
    """One of several robots: a node, a base, and someone who drives it."""

    def __init__(self, client, name, start_node, start_sim):
        """Start both programs in a namespace of their own."""
        namespace, self._client = f'{client.node.get_namespace()}/{name}', client
        described = {**BASES[name], 'frame_prefix': f'{name}/', 'seed': 1}
        start_node(namespace=namespace, **chosen(described, NODE_DECLARATIONS))
        start_sim(namespace=namespace, **chosen(described, SIMULATOR_DECLARATIONS))
        self.odom, self.truth = (
            client.listen(Odometry, f'{namespace}/{topic}') for topic in ('odom', 'ground_truth'))
        self.imu, self.imu_frame = client.listen(Imu, f'{namespace}/imu'), f'{name}/imu_link'
        self._topic = f'{namespace}/cmd_vel'

    def drive(self, time):
        """Command the motion along the figure at a time [s]."""
        target, velocity = plan(FIGURE, time)
        message = Twist()
        set_planar_twist(message, to_robot_frame(velocity, target[2]).tolist())
        self._client.publisher(Twist, self._topic).publish(message)

    def stands(self):
        """Tell whether the base is at rest."""
        twist = self.odom[-1].twist.twist
        return np.hypot(twist.linear.x, twist.linear.y) + abs(twist.angular.z) < 0.01

    def errors(self):
        """Return by how much odometry and truth differ (k, 3), at the same stamps."""
        return np.array([planar_pose(odom.pose.pose) - planar_pose(true.pose.pose)
                         for odom, true in same_moments(self.odom, self.truth)])


def chosen(described, declarations):
    """Return those of the parameters that are declared."""
    return {declaration.name: described[declaration.name] for declaration in declarations
            if declaration.name in described}


def test_two_robots_of_two_kinds_on_one_graph_know_where_they_are(client, start_node, start_sim):
    robots = {name: Robot(client, name, start_node, start_sim) for name in BASES}
    client.wait_until(lambda: all(robot.odom and robot.truth for robot in robots.values()),
                      'odometry of both')
    begun = time.monotonic()
    # The second one starts later: neither obeys the other's commands.
    delays = dict(zip(robots, (0.0, 0.5)))

    def drive():
        for name, robot in robots.items():
            robot.drive(time.monotonic() - begun - delays[name])
    client.repeat_until(drive, lambda: time.monotonic() > begun + FIGURE.duration + 0.5 and all(
        robot.stands() for robot in robots.values()), 'the end of the figures')
    for name, robot in robots.items():
        assert {message.header.frame_id for message in robot.imu} == {robot.imu_frame}
        way = np.array([planar_pose(message.pose.pose)[:2] for message in robot.truth])
        length = np.hypot(*np.diff(way, axis=0).T).sum()
        errors = robot.errors()
        assert length > 3.0 and len(errors) > 100
        # How exact the odometry of such bases is, test_descriptions tells. A busy machine loses
        # readings; a robot that heard the other's joints or IMU would be metres off.
        assert np.hypot(*errors[:, :2].T).max() < 0.02 * length
        assert np.abs(np.angle(np.exp(1j * errors[:, 2]))).max() < 0.05
        # Nobody closes the loop: the figure is round, but not where it was planned.
        assert np.ptp(way, axis=0).min() > 0.5 * FIGURE.width
        assert {(message.header.frame_id, message.child_frame_id) for message in robot.odom} == {
            (f'{name}/odom', f'{name}/base_link')}


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
    assert f"'{elsewhere}' matches no topic" in node.output
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
