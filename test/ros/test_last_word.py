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

"""Whatever ends the node, its last word is a stop: real processes, faults and signals."""

import signal

import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool

PATIENT = {'cmd_vel_timeout': 20.0, 'feedback_timeout': 20.0}
ENOUGH = 8  # stops, of which a best-effort listener may lose all but one


def drive(client):
    """Drive until the wheels turn."""
    client.begin_feedback()
    client.repeat_until(lambda: client.send_twist(vx=1.0),
                        lambda: client.drive and any(client.drive[-1].data), 'driving')


def ask(client, kind, name, request):
    """Call a service that will not answer."""
    service = client.node.create_client(kind, name)
    client.wait_until(service.service_is_ready, name)
    service.call_async(request)


def lock(client):
    ask(client, SetBool, 'swerve_node/lock_wheels', SetBool.Request(data=True))


def change_a_parameter(client):
    value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=1.0)
    ask(client, SetParameters, 'swerve_node/set_parameters', SetParameters.Request(
        parameters=[Parameter(name='cmd_vel_timeout', value=value)]))


@pytest.mark.parametrize('method, provoke', [
    ('SwerveNode._control', None), ('SwerveNode._report', None),
    ('SwerveNode._on_cmd_vel', lambda client: client.send_twist(vx=1.0)),
    ('Estimation._on_joint_states', lambda client: client.send_joints()),
    ('SwerveNode._on_lock_wheels', lock), ('SwerveNode._check_parameters', change_a_parameter),
    ('SwerveNode._apply_parameters', change_a_parameter)])
def test_a_fault_in_any_callback_stops_the_wheels_first(
        client, start, monkeypatch, method, provoke):
    monkeypatch.setenv('FAILING_METHOD', method)
    node = start('failing_node', **PATIENT)
    drive(client)
    if provoke:
        client.wait_until(lambda: max(client.drive[-1].data) > 19.0, 'full speed')
        provoke(client)
    client.wait_until(lambda: not node.is_running(), 'the end of the node')
    assert node.wait() == 1
    client.wait_until(lambda: not any(client.drive[-1].data), 'the stop')
    assert 'Traceback' in node.output
    last = node.output.rstrip().splitlines()[-1]
    assert last.startswith('error: ') and 'a fault in the making' in last


def test_a_fault_while_the_node_is_built_stops_the_wheels_too(client, start, monkeypatch):
    monkeypatch.setenv('FAILING_METHOD', 'SwerveNode._create_inputs')
    node = start('failing_node')
    client.wait_until(lambda: client.drive, 'the stop')
    assert not any(any(message.data) for message in client.drive)
    assert node.wait() == 1
    assert node.output.rstrip().splitlines()[-1].startswith('error: ')


@pytest.mark.parametrize('by', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_the_stop_is_repeated_for_a_best_effort_listener(client, start_node, by):
    heard = client.listen(
        Float64MultiArray, 'drive_velocity_controller/commands', qos_profile_sensor_data)
    node = start_node(**PATIENT)
    drive(client)
    client.wait_until(lambda: heard and max(heard[-1].data) > 19.0, 'full speed')
    moving = len(heard)
    node.send(by)
    client.wait_until(lambda: not node.is_running(), 'the end of the node')
    assert node.wait() == 0
    client.wait_until(lambda: sum(not any(message.data) for message in heard[moving:]) >= ENOUGH,
                      'the last stops')
    assert 'Traceback' not in node.output


def test_middleware_that_hangs_keeps_no_node_from_its_end(client, start):
    node = start('hanging_node', **PATIENT)
    drive(client)
    node.send(signal.SIGINT)
    client.wait_until(lambda: not any(client.drive[-1].data), 'the stop')
    node.send(signal.SIGTERM)
    assert node.wait() == -signal.SIGALRM
