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

"""Services, parameters and the executed twist over real DDS."""

import math

from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
import numpy as np
import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParametersAtomically
from std_srvs.srv import SetBool, Trigger

RADIUS = 0.05


def number(name, value):
    return Parameter(name=name, value=ParameterValue(
        type=ParameterType.PARAMETER_DOUBLE, double_value=value))


def numbers(name, value):
    return Parameter(name=name, value=ParameterValue(
        type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=value))


def text(name, value):
    return Parameter(name=name, value=ParameterValue(
        type=ParameterType.PARAMETER_STRING, string_value=value))


@pytest.fixture
def change(client):
    """Return a function that changes parameters together and returns the result."""
    return lambda *parameters: client.call(
        SetParametersAtomically, 'swerve_node/set_parameters_atomically',
        SetParametersAtomically.Request(parameters=parameters)).result


@pytest.fixture
def read(client):
    """Return a function that reads a parameter's value."""
    return lambda name: client.call(
        GetParameters, 'swerve_node/get_parameters',
        GetParameters.Request(names=[name])).values[0]


def forms_an_x(client):
    """Tell whether every wheel is told to stand along the line to the middle of the base."""
    lines = [math.atan2(y, x) for x, y in ((6, 5), (6, -5), (-6, 5), (-6, -5))]
    return client.steering and np.allclose(
        np.sin(np.subtract(client.steering[-1].data, lines)), 0.0, atol=1e-6)


def test_a_base_that_locks_when_idle_forms_an_x_once_stopped(client, start_node, start_sim):
    start_sim()
    start_node(idle_mode='lock', cmd_vel_timeout=0.2)
    client.repeat_until(lambda: client.send_twist(vx=0.5),
                        lambda: client.drive and max(client.drive[-1].data) > 9.0, 'driving')
    assert not forms_an_x(client)
    client.wait_until(lambda: forms_an_x(client), 'the X')
    client.repeat_until(lambda: client.send_twist(vx=0.5),
                        lambda: max(np.abs(client.drive[-1].data)) > 9.0, 'driving again')


def test_locked_wheels_form_an_x_and_refuse_to_move_until_unlocked(
        client, start_node, start_sim):
    start_sim()
    start_node()
    client.repeat_until(lambda: client.send_twist(vx=0.5),
                        lambda: client.drive and max(client.drive[-1].data) > 9.0, 'driving')
    assert client.call(SetBool, 'swerve_node/lock_wheels', SetBool.Request(data=True)).success
    client.repeat_until(lambda: client.send_twist(vx=0.5), lambda: forms_an_x(client), 'the X')
    count = len(client.drive)
    client.repeat_until(lambda: client.send_twist(vx=0.5),
                        lambda: len(client.drive) > count + 20, 'further commands')
    assert not any(any(message.data) for message in client.drive[count:])
    client.call(SetBool, 'swerve_node/lock_wheels', SetBool.Request(data=False))
    client.repeat_until(lambda: client.send_twist(vx=0.5),
                        lambda: max(np.abs(client.drive[-1].data)) > 9.0, 'driving again')


def test_the_pose_is_set_and_reset(client, start_node):
    start_node()
    client.begin_feedback()
    message = PoseWithCovarianceStamped()
    message.header.frame_id = 'odom'
    message.pose.pose.position.x = 3.0
    message.pose.pose.orientation.z = message.pose.pose.orientation.w = math.sqrt(0.5)
    message.pose.covariance[0] = 0.25
    publisher = client.publisher(PoseWithCovarianceStamped, 'swerve_node/set_pose')

    def position():
        return client.odom[-1].pose.pose.position.x
    client.repeat_until(lambda: (publisher.publish(message), client.send_joints()),
                        lambda: abs(position() - 3.0) < 1e-9, 'the pose')
    assert client.odom[-1].pose.covariance[0] == pytest.approx(0.25, rel=1e-3)
    for bad in ('map', 'odom'):
        message.header.frame_id = bad
        message.pose.pose.position.x = 9.0 if bad == 'map' else math.nan
        publisher.publish(message)
    assert client.call(Trigger, 'swerve_node/reset_odometry', Trigger.Request()).success
    client.repeat_until(client.send_joints, lambda: position() == 0.0, 'the origin')
    assert max(message.pose.pose.position.x for message in client.odom) < 4.0


def test_the_limited_twist_is_what_the_modules_execute(client, start_node):
    start_node(max_linear_speed=0.5, max_linear_acceleration=0.0)
    limited = client.listen(TwistStamped, 'swerve_node/cmd_vel_limited')
    client.repeat_until(
        lambda: (client.send_joints(), client.send_twist(2.0, 0.0, 1.0)),
        lambda: limited and limited[-1].twist.linear.x > 0.49, 'the limited twist')
    twist = limited[-1].twist
    # One factor for all axes: the curve stays the same curve.
    assert twist.angular.z / math.hypot(twist.linear.x, twist.linear.y) == pytest.approx(
        0.5, rel=0.01)
    assert limited[-1].header.frame_id == 'base_link'


def test_each_command_is_published_once_for_each_cause(client, start_node):
    start_node(control_rate=5.0, cmd_vel_timeout=10.0, feedback_timeout=10.0)
    client.begin_feedback()
    client.wait_for_count(client.drive, 2, 'ticks of the timer')
    before, steering_before = len(client.drive), len(client.steering)
    for _ in range(50):
        # Faster than the timer, which each of them sets back.
        client.send_twist(vx=1.0)
        client.wait_for_count(client.drive, 1, 'the command')
    assert 50 <= len(client.drive) - before <= 52
    client.wait_until(lambda: len(client.steering) - steering_before
                      == len(client.drive) - before, 'as many steering commands')


def test_safe_parameters_change_while_driving(client, start_node, change, read):
    start_node(max_linear_acceleration=0.0, max_steering_rate=0.0)

    def speed_reaches(speed):
        client.repeat_until(
            lambda: (client.send_joints(), client.send_twist(vx=1.0)),
            lambda: client.drive and abs(client.drive[-1].data[0] * RADIUS - speed) < 1e-6,
            f'{speed} m/s')
    speed_reaches(1.0)
    assert change(number('max_linear_speed', 0.25)).successful
    speed_reaches(0.25)
    assert read('max_linear_speed').double_value == 0.25
    # About the front left module, which stands still.
    assert change(numbers('center_of_rotation', [0.3, 0.25]),
                  number('max_linear_speed', 0.0)).successful
    client.repeat_until(
        lambda: (client.send_joints(), client.send_twist(omega=1.0)),
        lambda: abs(client.drive[-1].data[0]) < 1e-6 < abs(client.drive[-1].data[1]),
        'a turn about the front left module')


def test_a_refused_change_names_its_reason_and_leaves_everything(
        client, start_node, change, read):
    start_node()
    refused = [
        ('idle_mode', (text('idle_mode', 'park'),)),
        ('cmd_vel_timeout', (number('cmd_vel_timeout', -1.0),)),
        ('max_linear_speed', (number('max_linear_speed', math.nan),)),
        ('center_of_rotation', (numbers('center_of_rotation', [1.0]),)),
        ('read-only', (number('control_rate', 20.0),)),
        ('read-only', (numbers('wheel_radii', [0.1]),)),
        # One good and one bad: neither.
        ('idle_mode', (number('max_linear_speed', 0.1), text('idle_mode', 'park'))),
    ]
    for name, parameters in refused:
        result = change(*parameters)
        assert not result.successful
        assert name in result.reason
    assert read('max_linear_speed').double_value == 3.0
    assert read('idle_mode').string_value == 'hold'


def test_parameters_describe_themselves(client, start_node):
    start_node()
    request = DescribeParameters.Request(names=['max_linear_speed', 'steering_lower_limits'])
    speed, limits = client.call(
        DescribeParameters, 'swerve_node/describe_parameters', request).descriptors
    assert speed.type == ParameterType.PARAMETER_DOUBLE
    assert '[m/s]' in speed.description and not speed.read_only
    assert speed.floating_point_range[0].from_value == 0.0
    assert limits.type == ParameterType.PARAMETER_DOUBLE_ARRAY
    assert limits.read_only
