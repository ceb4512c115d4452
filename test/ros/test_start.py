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

"""The start of a program: what it reads is what ROS would give it, and mistakes end it at once."""

from pathlib import Path

import pytest
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from swerve_kinematics.configuration.command_line import parse
from swerve_kinematics.configuration.parameter_file import given_to, read_argument, read_file
from swerve_kinematics.configuration.program import NODE

CONFIG = Path(__file__).parents[2] / 'config'
BY_ROS = {'use_sim_time', 'start_type_description_service'}


def by_ros(arguments):
    """Return the parameters that rclpy gives a node with these arguments."""
    node = Node(NODE.name, cli_args=arguments, start_parameter_services=False,
                automatically_declare_parameters_from_overrides=True)
    values = {name: parameter.value for name, parameter
              in node.get_parameters_by_prefix('').items() if name not in BY_ROS}
    node.destroy_node()
    return values


def by_us(arguments):
    """Return the parameters that our reader gives it."""
    command, sections = parse(NODE, arguments), {}
    for path in command.files:
        read_file(path, sections)
    for argument in command.parameters:
        read_argument(argument, sections)
    return {name: given.value for name, given in given_to(sections, command.node).items()}


@pytest.mark.parametrize('rules', [
    [], ['-r', '__ns:=/r/b'], ['-r', '__node:=x', '-r', '__ns:=/r'],
    ['-r', 'swerve_node:__node:=x', '-r', '__node:=y'], ['-r', 'y:__node:=x']])
def test_each_section_is_for_the_nodes_that_ros_gives_it_to(context, tmp_path, rules):
    sections = ('/**', 'swerve_node', '/swerve_node', '/*/swerve_node', '/**/swerve_node', '/*',
                '/r/b/swerve_node', 'r/x', '/r/*', '/r/**', '/*/*/swerve_node', '/r/**/x', 'y')
    path = tmp_path / 'robot.yaml'
    path.write_text('\n'.join(f'"{section}": {{ros__parameters: {{last: {i}, of{i}: {i}}}}}'
                              for i, section in enumerate(sections)))
    arguments = ['--ros-args', '--params-file', str(path), *rules, '-p', 'last:=99', '-p',
                 'swerve_node:of0:=7', '-p', 'x:of1:=8']
    assert by_us(arguments) == by_ros(arguments)


def test_values_are_those_that_ros_reads(context):
    for file in ('four_modules', 'three_modules', 'limited_steering'):
        arguments = ['--ros-args', '--params-file', str(CONFIG / f'{file}.yaml')]
        assert by_us(arguments) == {
            name: list(value) if hasattr(value, 'typecode') else value
            for name, value in by_ros(arguments).items()}


def test_a_mistake_ends_the_start_with_one_line_that_names_it(start_node, tmp_path):
    wrong = tmp_path / 'wrong.yaml'
    wrong.write_text('/**:\n  ros__parameters:\n    wheel_radius: 0.1\n')
    of_other = tmp_path / 'of_other.yaml'
    of_other.write_text('robot: {ros__parameters: {control_rate: 20}}\n')
    started = [
        (start_node('--params-file', str(wrong)), ('wrong.yaml, line 3', "'wheel_radii'")),
        (start_node('--params-file', str(of_other)), ('of_other.yaml', 'swerve_node')),
        (start_node('--params-file', 'nowhere.yaml'), ('nowhere.yaml',)),
        (start_node('--', 'stray'), ("'stray'", '--ros-args')),
        (start_node('--foo'), ('--foo',)),
        (start_node('-r', '__node:=a-b'), ('a-b',)),
        (start_node(gyro_source='magic'), ("'gyro_source' = 'magic'",)),
        (start_node(wheel_radii='[.nan]'), ("'wheel_radii'",)),
        (start_node(module_x=[300, 300, -300, -300]), ("'module_x'", 'millimetres?'))]
    for node, words in started:
        assert node.wait() == 1
        line, = node.output.splitlines()
        assert line.startswith('error: ') and all(word in line for word in words), line


def test_help_and_check_start_nothing(start_node, start_sim):
    file = str(CONFIG / 'four_modules.yaml')
    helped, checked, simulated = (
        start_node('--', '--help'), start_node('--', '--check', file, '--ros-args'),
        start_sim('--', '--check', file))
    assert helped.wait() == checked.wait() == simulated.wait() == 0
    assert helped.output.startswith('usage: swerve_node')
    for program in (checked, simulated):
        line, = program.output.splitlines()
        assert line.startswith('4 modules') and file in line


def change(client, name, value):
    """Set a parameter of the running node; return the result."""
    return client.call(SetParameters, 'swerve_node/set_parameters', SetParameters.Request(
        parameters=[Parameter(name, value=value).to_parameter_msg()])).results[0]


def test_integers_are_taken_at_the_start_and_while_running(client, start_node, tmp_path):
    path = tmp_path / 'robot.yaml'
    path.write_text('/**:\n  ros__parameters:\n    module_x: [1, 0.5, -1, -1]\n'
                    '    wheel_radii: 0.06\n    use_sim_time: true\n')
    node = start_node('--params-file', str(path), control_rate=20, max_linear_speed=1)
    assert change(client, 'max_linear_speed', 2).successful
    assert change(client, 'center_of_rotation', [0, 1]).successful
    refused = change(client, 'max_linear_sped', 2.0)
    assert not refused.successful and 'undeclared' in refused.reason
    refused = change(client, 'max_linear_speed', 'fast')
    assert not refused.successful and 'Wrong parameter type' in refused.reason
    names = ['module_x', 'wheel_radii', 'control_rate', 'max_linear_speed', 'center_of_rotation',
             'use_sim_time']
    answer = client.call(GetParameters, 'swerve_node/get_parameters',
                         GetParameters.Request(names=names))
    values = [parameter_value_to_python(value) for value in answer.values]
    assert repr([list(value) if hasattr(value, 'typecode') else value for value in values]) == (
        '[[1.0, 0.5, -1.0, -1.0], [0.06], 20.0, 2.0, [0.0, 1.0], True]')
    assert '4 modules over 2 m x 0.5 m, wheel radius 0.06 m' in node.output
    assert str(path) in node.output
