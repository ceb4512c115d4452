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

"""A stop is a stop whatever the clocks do: real processes, simulated time, frozen processes."""

import signal
import time

import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool

from swerve_kinematics.ros.stamps import set_stamp

S = 1_000_000_000  # ns
OPEN_LOOP = {'open_loop': True}


def drive(client):
    """Drive until the wheels are at full speed."""
    client.repeat_until(lambda: client.send_twist(vx=1.0),
                        lambda: client.drive and client.drive[-1].data[0] > 19.9, 'driving')


def stops_in_each_way(client):
    """Check that silence, a zero command and a lock each stop the wheels."""
    def is_stopped():
        return not any(client.drive[-1].data)

    def lock(data):
        client.call(SetBool, 'swerve_node/lock_wheels', SetBool.Request(data=data))
    drive(client)
    client.wait_until(is_stopped, 'the stop by silence')
    drive(client)
    client.repeat_until(client.send_twist, is_stopped,
                        'the stop by a zero command')
    drive(client)
    lock(True)
    client.repeat_until(lambda: client.send_twist(vx=1.0), is_stopped,
                        'the stop by a lock')
    lock(False)


def test_it_stops_in_simulated_time_without_a_clock(client, start_node, reports):
    start_node(use_sim_time=True, **OPEN_LOOP)
    stops_in_each_way(client)
    client.wait_until(lambda: reports and '/clock is silent' in reports[-1].message,
                      'the warning')


def test_it_stops_when_simulated_time_is_set_while_it_drives(client, start_node):
    start_node(**OPEN_LOOP)
    drive(client)
    value = ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=True)
    client.call(SetParameters, 'swerve_node/set_parameters', SetParameters.Request(
        parameters=[Parameter(name='use_sim_time', value=value)]))
    stops_in_each_way(client)


def test_it_stops_in_simulated_time_that_loops(client, start_node):
    start_node(use_sim_time=True, **OPEN_LOOP)
    publisher, ticks = client.publisher(Clock, '/clock'), [0]

    def tick():
        ticks[0] += 1
        message = Clock()
        set_stamp(message.clock, 100 * S + ticks[0] % 15 * S // 50)
        publisher.publish(message)
    client.node.create_timer(0.02, tick)
    stops_in_each_way(client)


def test_a_base_that_is_left_alone_obeys_the_next_command(client, start_node):
    # At rest the node turns less often than it may miss a command: that is no freeze.
    start_node(open_loop=True, cmd_vel_timeout=0.04)
    obeyed = 0
    for _ in range(6):
        client.wait_for_count(client.drive, 3, 'commands at rest')
        client.send_twist(vx=1.0)
        count = len(client.drive)
        client.wait_for_count(client.drive, 3, 'commands')
        obeyed += any(any(message.data) for message in client.drive[count:])
        client.wait_until(lambda: not any(client.drive[-1].data), 'rest')
    assert obeyed >= 5  # a busy machine may have frozen it once


def test_a_thawed_process_does_not_obey_what_it_finds_waiting(client, start_node):
    node = start_node(open_loop=True, cmd_vel_timeout=0.3, max_linear_acceleration=1.0)
    drive(client)
    node.send(signal.SIGSTOP)
    frozen = time.monotonic()
    client.repeat_until(lambda: client.send_twist(vx=1.0),
                        lambda: time.monotonic() > frozen + 0.5, 'the timeout')
    count = len(client.drive)
    node.send(signal.SIGCONT)
    client.wait_for_count(client.drive, 20, 'commands')
    assert not any(any(message.data) for message in client.drive[count + 1:])


def test_a_thawed_process_begins_its_ramp_anew(client, start_node):
    node = start_node(open_loop=True, cmd_vel_timeout=0.3, max_linear_acceleration=1.0)
    drive(client)
    node.send(signal.SIGSTOP)
    frozen = time.monotonic()
    client.wait_until(lambda: time.monotonic() > frozen + 0.5, 'the timeout')
    count = len(client.drive)
    node.send(signal.SIGCONT)
    client.repeat_until(lambda: client.send_twist(vx=1.0),
                        lambda: len(client.drive) > count + 10 and client.drive[-1].data[0] > 10.0,
                        'driving')
    # What was under way at the freeze comes first.
    drive_again = [message.data[0] for message in client.drive[count + 1:]]
    # 1 m/s^2, and at most two control periods at once: 0.8 rad/s a command, of which a busy
    # machine may lose a few.
    assert drive_again[0] == pytest.approx(0.0, abs=2.0)
    assert max(b - a for a, b in zip(drive_again, drive_again[1:])) < 5.0
