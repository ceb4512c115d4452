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

"""The files of config/ load into the nodes that they are written for."""

from pathlib import Path

import numpy as np
import pytest
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from sensor_msgs.msg import JointState
from swerve_kinematics.configuration.node import NODE_DECLARATIONS
import yaml

CONFIG = Path(__file__).parents[2] / 'config'
KNOWN = {declaration.name for declaration in NODE_DECLARATIONS}
INTEGER, DOUBLE, STRING, BOOL = (
    Parameter.Type.INTEGER, Parameter.Type.DOUBLE, Parameter.Type.STRING, Parameter.Type.BOOL)

# Of the releases for Jazzy: joy 3.3, teleop_twist_joy 2.6, teleop_twist_keyboard 2.4.
TELEOP_PARAMETERS = {
    'joy_node': {'deadzone': DOUBLE, 'autorepeat_rate': DOUBLE},
    'teleop_twist_joy_node': {
        'require_enable_button': BOOL, 'enable_button': INTEGER, 'enable_turbo_button': INTEGER,
        'inverted_reverse': BOOL, 'publish_stamped_twist': BOOL, 'frame': STRING,
        **{f'axis_linear.{axis}': INTEGER for axis in 'xy'}, 'axis_angular.yaw': INTEGER,
        **{f'scale_linear{turbo}.{axis}': DOUBLE for axis in 'xy' for turbo in ('', '_turbo')},
        **{f'scale_angular{turbo}.yaw': DOUBLE for turbo in ('', '_turbo')}},
    'teleop_twist_keyboard': {
        'speed': DOUBLE, 'turn': DOUBLE, 'stamped': BOOL, 'frame_id': STRING},
}


def parameters_of(base):
    """Return the parameters in a base's file."""
    return yaml.safe_load((CONFIG / f'{base}.yaml').read_text())['/**']['ros__parameters']


def joint_states(base, angle=0.0):
    """Return the JointState of a base whose joints have their default names."""
    modules = parameters_of(base)['module_names']
    return JointState(
        name=[f'{module}_{kind}_joint' for kind in ('drive', 'steering') for module in modules],
        position=[0.0] * len(modules) + [angle] * len(modules))


def begin(client, base):
    """Send joint states until odometry comes back."""
    publisher = client.publisher(JointState, 'joint_states')
    client.repeat_until(lambda: publisher.publish(joint_states(base)), lambda: client.odom,
                        'odometry')


@pytest.mark.parametrize('base', ['four_modules', 'three_modules', 'limited_steering'])
def test_the_node_runs_with_the_parameters_of_each_base(client, start_node, base):
    given = parameters_of(base)
    assert set(given) <= KNOWN
    node = start_node('--params-file', str(CONFIG / f'{base}.yaml'))
    begin(client, base)
    answer = client.call(GetParameters, 'swerve_node/get_parameters',
                         GetParameters.Request(names=list(given)))
    taken = {name: parameter_value_to_python(value)
             for name, value in zip(given, answer.values)}
    assert {name: list(value) if isinstance(given[name], list) else value
            for name, value in taken.items()} == given
    assert 'error:' not in node.output


def test_three_modules_are_commanded_by_their_names_and_radii(client, start_node):
    start_node('--params-file', str(CONFIG / 'three_modules.yaml'))
    commands = client.listen(JointState, 'joint_commands')
    begin(client, 'three_modules')
    states = client.publisher(JointState, 'joint_states')

    rolling = joint_states('three_modules')

    def drives():
        return [command for command in commands if command.velocity]

    def drive_on():
        # The wheels do as they are told: a base that is held is not driven on.
        rolling.velocity = [*(drives()[-1].velocity if drives() else [0.0] * 3), *[0.0] * 3]
        rolling.position = [*np.add(rolling.position, 0.02 * np.array(rolling.velocity))]
        states.publish(rolling)
        client.send_twist(vx=0.5)
    client.repeat_until(drive_on, lambda: drives() and drives()[-1].velocity[1] > 9.999,
                        'the wheels to turn')
    names = joint_states('three_modules').name
    assert drives()[-1].name == names[:3]
    np.testing.assert_allclose(drives()[-1].velocity, [8.0, 10.0, 10.0], atol=0.01)
    assert [command.name for command in commands if command.position][-1] == names[3:]


def test_limited_steering_stays_within_its_limits(client, start_node):
    limit = parameters_of('limited_steering')['steering_upper_limits'][0]
    start_node('--params-file', str(CONFIG / 'limited_steering.yaml'))
    begin(client, 'limited_steering')
    states = client.publisher(JointState, 'joint_states')

    def steer_round(direction):
        # The measured angles follow the commanded ones.
        message = joint_states('limited_steering')
        if client.steering:
            message.position[4:] = client.steering[-1].data
        states.publish(message)
        client.send_twist(vx=0.3 * np.cos(direction), vy=0.3 * np.sin(direction))
    for direction in np.radians([80.0, 100.0, 135.0]):
        client.repeat_until(
            lambda: steer_round(direction),
            lambda: client.steering and abs(np.sin(client.steering[-1].data[0] - direction))
            < 0.01, f'the wheels to point to {direction}')
    angles = np.array([message.data for message in client.steering])
    assert np.abs(angles).max() <= limit
    # 100 degrees are within reach, 135 only with the drive reversed.
    assert angles.max() == pytest.approx(np.radians(100.0), abs=0.02)
    assert angles[-1] == pytest.approx(np.radians(-45.0), abs=0.02)


@pytest.mark.parametrize('file, name', [
    ('teleop_twist_joy', 'joy_node'), ('teleop_twist_joy', 'teleop_twist_joy_node'),
    ('teleop_twist_keyboard', 'teleop_twist_keyboard')])
def test_the_teleop_nodes_get_their_settings(context, namespace, file, name):
    node = Node(name, namespace=namespace, automatically_declare_parameters_from_overrides=True,
                cli_args=['--ros-args', '--params-file', str(CONFIG / f'{file}.yaml')])
    types = {key: parameter.type_ for key, parameter in node.get_parameters_by_prefix('').items()}
    node.destroy_node()
    types.pop('use_sim_time')
    types.pop('start_type_description_service', None)
    assert types == TELEOP_PARAMETERS[name]


def sections_of(tree, name=''):
    """Yield the full name and the parameters of each node in a file."""
    for key, branch in tree.items():
        if key == 'ros__parameters':
            yield name, branch
        else:
            yield from sections_of(branch, f'{name}/{key}')


def flat(tree, prefix=''):
    """Yield the full name and the value of each parameter."""
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from flat(value, f'{prefix}{key}.')
        else:
            yield prefix + key, value


@pytest.mark.parametrize('path, name, given', [
    (path, name, given) for path in (CONFIG / 'ekf.yaml', CONFIG / 'nav2_params.yaml')
    for name, given in sections_of(yaml.safe_load(path.read_text()))])
def test_nav2_and_the_filter_get_their_settings(context, path, name, given):
    namespace, _, name = name.rpartition('/')
    node = Node(name, namespace=namespace, automatically_declare_parameters_from_overrides=True,
                cli_args=['--ros-args', '--params-file', str(path)])
    taken = {key: parameter.value for key, parameter in node.get_parameters_by_prefix('').items()}
    node.destroy_node()
    for key, wanted in flat(given):
        found = taken[key]
        assert (list(found) if isinstance(wanted, list) else found) == wanted
        assert type(found) is type(wanted) or isinstance(wanted, list)


def test_teleop_at_full_speed_is_within_the_limits_of_the_base():
    base = parameters_of('four_modules')
    joy = yaml.safe_load((CONFIG / 'teleop_twist_joy.yaml').read_text())
    joy = joy['/**/teleop_twist_joy_node']['ros__parameters']
    keyboard = yaml.safe_load((CONFIG / 'teleop_twist_keyboard.yaml').read_text())
    keyboard = keyboard['/**/teleop_twist_keyboard']['ros__parameters']
    assert max(*joy['scale_linear_turbo'].values(), keyboard['speed']) <= base['max_linear_speed']
    assert max(joy['scale_angular_turbo']['yaw'], keyboard['turn']) <= base['max_angular_speed']
