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

"""swerve_sim as a process: what it takes, what it ignores, how it ends."""

import math
import signal
import time

from graph import same_moments
from nav_msgs.msg import Odometry
import numpy as np
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from swerve_kinematics.ros.messages import planar_twist
from swerve_kinematics.ros.stamps import nanoseconds_of


def test_setpoints_move_it_and_damaged_ones_do_not(client, start_sim):
    start_sim()
    states, truth = client.listen(JointState, 'joint_states'), client.listen(
        Odometry, 'ground_truth')
    drive = client.publisher(Float64MultiArray, 'drive_velocity_controller/commands')
    steer = client.publisher(Float64MultiArray, 'steering_position_controller/commands')

    def send(speeds, angles):
        drive.publish(Float64MultiArray(data=speeds))
        steer.publish(Float64MultiArray(data=angles))
    client.repeat_until(lambda: send([10.0] * 4, [math.pi / 2] * 4),
                        lambda: truth and truth[-1].twist.twist.linear.y > 0.499, 'strafing')
    for bad in ([math.nan] * 4, [1.0], []):
        send(bad, bad)
    # A real drive keeps its last setpoint when commands stop.
    client.wait_for_count(truth, 30, 'further truth')
    assert truth[-1].twist.twist.linear.y == pytest.approx(0.5, abs=1e-3)
    np.testing.assert_allclose(states[-1].position[4:8], math.pi / 2, atol=1e-3)
    assert np.isfinite(states[-1].position).all()


def test_joint_states_come_at_the_rate_that_was_set(client, start_sim):
    start_sim(publish_rate=50.0)
    states = client.listen(JointState, 'joint_states')
    client.wait_until(lambda: len(states) > 40, 'joint states')
    stamps = np.array([nanoseconds_of(message.header.stamp) for message in states])
    assert np.median(np.diff(stamps)) == pytest.approx(20e6, rel=0.1)
    assert states[-1].name[-1] == 'gyro_joint'


@pytest.mark.parametrize('by', [signal.SIGINT, signal.SIGTERM])
def test_it_ends_cleanly_by_a_signal(client, start_sim, by):
    sim = start_sim()
    states = client.listen(JointState, 'joint_states')
    client.wait_until(lambda: states, 'joint states')
    assert '4 modules over 0.6 m x 0.5 m' in sim.output
    assert sim.end(by) == 0
    assert 'Traceback' not in sim.output


def test_a_bad_parameter_ends_the_start_with_one_line(start_sim):
    sim = start_sim(slipping_wheel=4)
    assert sim.wait() == 1
    assert 'slipping_wheel' in sim.output and len(sim.output.strip().splitlines()) == 1


def test_a_simulator_that_was_held_up_catches_up_bit_by_bit(client, start_sim):
    sim = start_sim(publish_rate=100.0)
    truth = client.listen(Odometry, 'ground_truth')
    drive = client.publisher(Float64MultiArray, 'drive_velocity_controller/commands')
    client.repeat_until(lambda: drive.publish(Float64MultiArray(data=[10.0] * 4)),
                        lambda: truth and truth[-1].twist.twist.linear.x > 0.499, 'motion')
    sim.send(signal.SIGSTOP)
    held_at = time.time_ns()
    client.wait_until(lambda: time.time_ns() > held_at + 10 ** 9, 'the end of a second')
    sim.send(signal.SIGCONT)
    client.wait_until(lambda: time.time_ns() - nanoseconds_of(truth[-1].header.stamp) < 10 ** 8
                      and nanoseconds_of(truth[-1].header.stamp) > held_at, 'the present')
    stamps = np.array([nanoseconds_of(message.header.stamp) for message in truth])
    way = np.array([message.pose.pose.position.x for message in truth])
    # A message may get lost.
    assert np.diff(stamps).max() < 0.5e9
    # It has moved for as long as the stamps say.
    since = np.searchsorted(stamps, held_at)
    assert way[-1] - way[since] == pytest.approx(
        0.5e-9 * (stamps[-1] - stamps[since]), rel=1e-3)


def test_the_node_drives_the_base_in_rigid_body_physics_for_ten_seconds(
        client, start_sim, start_node):
    start_sim(physics='mujoco', **{'mujoco.friction': 0.8})
    start_node()
    truth = client.listen(Odometry, 'ground_truth')
    for twist in ((0.5, 0.0, 0.3), (0.0, 0.5, -0.6), (-0.4, -0.3, 0.0), (0.0, 0.0, 0.0)):
        client.wait_until(lambda: truth, 'motion')
        begun = nanoseconds_of(truth[-1].header.stamp)
        client.repeat_until(
            lambda: client.send_twist(*twist),
            lambda: nanoseconds_of(truth[-1].header.stamp) > begun + 2.5e9 and planar_twist(
                truth[-1].twist.twist) == pytest.approx(twist, abs=0.03), f'2.5 s and {twist}')
    estimate, true = same_moments(client.odom, truth)[-1]
    estimated, real = estimate.pose.pose.position, true.pose.pose.position
    # Tyres creep: a per cent or so.
    assert math.hypot(estimated.x - real.x, estimated.y - real.y) < 0.05
