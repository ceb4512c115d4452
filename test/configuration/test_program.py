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

"""What a program is started with: the whole way from its command line to its configuration."""

from pathlib import Path

import numpy as np
import pytest
from swerve_kinematics.configuration.command_line import parse
from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.program import (
    NODE, read_parameters, read_settings, SIMULATOR)

CONFIG = Path(__file__).parents[2] / 'config'


def settings_of(*arguments, program=NODE):
    """Return the settings of a program that is called with arguments."""
    command = parse(program, [str(argument) for argument in arguments])
    return read_settings(program, command.node, command.files, command.parameters)


def file(tmp_path, text, name='robot.yaml'):
    """Write a parameter file."""
    path = tmp_path / name
    path.write_text(text)
    return path


def test_a_file_with_integers_and_scalars_is_taken(tmp_path):
    path = file(tmp_path, """
/**:
  ros__parameters:
    module_x: [1, 0.5, -1, -0.5]
    wheel_radii: 0.06
    max_linear_speed: 2
    odometry: {slip_ratio: 4}
""")
    settings = settings_of('--ros-args', '--params-file', path, '-p', 'control_rate:=20')
    parameters = settings.parameters
    np.testing.assert_array_equal(
        parameters.layout.kinematics.module_positions[:, 0], [1.0, 0.5, -1.0, -0.5])
    np.testing.assert_array_equal(parameters.layout.joints.wheel_radii, [0.06] * 4)
    assert (parameters.limits.max_linear_speed, parameters.noise.slip_ratio) == (2.0, 4.0)
    assert repr(parameters.control_rate) == '20.0'


@pytest.mark.parametrize('text, complaint', [
    ('/**:\n  ros__parameters:\n    wheel_radius: [0.1]\n',
     "line 3: unknown parameter 'wheel_radius'; the nearest known name is 'wheel_radii'"),
    ('/**:\n  ros__parameters:\n    miswired.dead_drive: [a]\n',
     "the nearest known name is 'miswired.dead_drives'"),
    ('swerve_node:\n  ros__parameters:\n    seed: 1\n', "line 3: unknown parameter 'seed'"),
    ('/**:\n  ros__parameters:\n    control_rate: -1\n', "line 3: parameter 'control_rate' = -1"),
    ('/**:\n  ros__parameters:\n    control_rate:\n', "line 3: parameter 'control_rate'"),
    ('/**:\n  ros__parameters:\n    imu_delay: 10\n', 'more than 0.2 s: milliseconds?'),
    ('/**:\n  ros__parameters:\n    drive_directions: 0.5\n', 'must be 1 or -1'),
    ('/**:\n  ros__parameters:\n    steering_directions: [1, 1, 1, -2]\n', 'must be 1 or -1'),
    ('/**:\n  ros__parameters:\n    use_sim_time: 1\n', "line 3: parameter 'use_sim_time' = 1"),
    ('/**:\n  ros__parameters:\n    module_names: [a, b]\n',
     "robot.yaml: parameter 'module_x' is not given, and its default is "
     '[0.3, 0.3, -0.3, -0.3]: must have 2 entries'),
    ('/**:\n  ros__parameters:\n    module_x: [0.1, -0.1]\n',
     'one for each of module_names = [front_left, front_right, rear_left, rear_right]'),
    ('/**:\n  ros__parameters:\n    steering_offsets: [9.0]\n',
     'wrong steering_ratios, or degrees?'),
    ('swerve_nod:\n  ros__parameters:\n    seed: 1\n',
     'robot.yaml: none of its sections (/swerve_nod) is for /swerve_node'),
    ('/robot_1/swerve_node: {ros__parameters: {control_rate: 1}}',
     'robot.yaml: none of its sections (/robot_1/swerve_node) is for /swerve_node'),
    ('/**: {ros__parameters: {}}', 'robot.yaml: there is no parameter in /**')])
def test_a_mistake_is_told_with_its_place(tmp_path, text, complaint):
    with pytest.raises(ParameterError) as refusal:
        settings_of('--ros-args', '--params-file', file(tmp_path, text))
    assert complaint in str(refusal.value)
    assert str(tmp_path) in str(refusal.value) and '\n' not in str(refusal.value)


def test_every_file_has_something_for_the_node(tmp_path):
    good = file(tmp_path, '/**: {ros__parameters: {control_rate: 20}}', 'good.yaml')
    bad = file(tmp_path, 'other: {ros__parameters: {control_rate: 20}}', 'bad.yaml')
    with pytest.raises(ParameterError, match='bad.yaml'):
        settings_of('--ros-args', '--params-file', good, '--params-file', bad)


def test_a_section_for_all_nodes_may_have_parameters_of_the_other_program(tmp_path):
    path = file(tmp_path, '/**: {ros__parameters: {control_rate: 20, seed: 5}}')
    assert settings_of('--ros-args', '--params-file', path).values['control_rate'] == 20.0
    simulator = settings_of('--ros-args', '--params-file', path, program=SIMULATOR)
    assert simulator.parameters.seed == 5
    with pytest.raises(ParameterError, match="unknown parameter 'seed'"):
        settings_of('--ros-args', '-p', 'seed:=5')


def test_what_is_for_rclpy_is_handed_on(tmp_path):
    path = file(tmp_path, '/**: {ros__parameters: {use_sim_time: true, '
                'qos_overrides: {/odom: {publisher: {depth: 3}}}}}')
    assert settings_of('--ros-args', '--params-file', path).of_rclpy == {
        'use_sim_time': True, 'qos_overrides./odom.publisher.depth': 3}


@pytest.mark.parametrize('override, complaint', [
    ('/cmd_vel.subscription.reliabilty:=reliable', "the nearest policy is 'reliability'"),
    ('/cmd_vel.subscriber.depth:=1', 'TOPIC.publisher|subscription.POLICY'),
    ('/cmd_vel.subscription.reliability:=relable', 'must be one of reliable, best_effort'),
    ('/cmd_vel.subscription.reliability:=true', 'must be one of reliable, best_effort'),
    ('/cmd_vel.subscription.depth:=1.5', 'must be an integer'),
    ('/cmd_vel.subscription.depth:=-1', 'must be an integer, 0 or more'),
    ('/cmd_vel.subscription.depth:=99999999999', 'must be an integer')])
def test_an_override_of_quality_that_rclpy_does_not_take_is_refused(override, complaint):
    with pytest.raises(ParameterError) as refusal:
        settings_of('--ros-args', '-p', f'qos_overrides.{override}')
    assert complaint in str(refusal.value) and 'qos_overrides./cmd_vel' in str(refusal.value)


@pytest.mark.parametrize('rules, node', [
    ([], '/swerve_node'), (['__ns:=/a/b'], '/a/b/swerve_node'), (['__ns:=a'], '/a/swerve_node'),
    (['__ns:=/'], '/swerve_node'), (['__node:=x', '__node:=y'], '/x'), (['__name:=x'], '/x'),
    (['swerve_node:__node:=x', '__ns:=/a'], '/a/x'), (['other:__node:=x'], '/swerve_node'),
    (['odom:=__node:=x'], '/swerve_node')])
def test_the_node_has_the_name_that_remapping_gives_it(rules, node):
    arguments = [word for rule in rules for word in ('-r', rule)]
    assert parse(NODE, ['--ros-args', *arguments]).node == node


def test_what_is_left_is_for_ros():
    command = parse(NODE, [
        '--ros-args', '-p', 'a:=1', '--remap', 'x:=y', '--param', 'b:=2', '--params-file', 'f',
        '--', '--ros-args', '--log-level', 'debug'])
    assert command.ros_arguments == ('--ros-args', '--remap', 'x:=y', '--log-level', 'debug')
    assert command.parameters == ('a:=1', 'b:=2')
    assert command.files == (Path('f'),)


@pytest.mark.parametrize('arguments, word', [
    (['--params-file', 'x.yaml'], '--params-file'), (['x.yaml'], 'x.yaml'), (['-p', 'a:=1'], '-p'),
    (['--ros-args', '-p', 'a:=1', '--', 'x'], "'x'"), (['--ros-args', '-p'], '-p'),
    (['--ros-args', '--params-file'], '--params-file'),
    (['--ros-args', '-r', 'cmd_vel=x'], '-r cmd_vel=x: must be from:=to'),
    (['--check'], '--check'), (['--chec', 'x.yaml'], '--chec')])
def test_arguments_of_no_use_are_refused(arguments, word):
    with pytest.raises(ParameterError, match=word) as refusal:
        parse(NODE, arguments)
    assert '\n' not in str(refusal.value)


@pytest.mark.parametrize('base, understood', [
    ('four_modules', ('4 modules over 0.6 m x 0.5 m', 'radius 0.05 m', 'gyro: joint gyro_joint',
                      'forward_command', 'max_linear_jerk')),
    ('three_modules', ('3 modules', 'radius 0.05 to 0.0625 m', 'gyro: imu', 'joint_state')),
    ('limited_steering', ('steering -110 to 110 degrees; gyro: none',
                          'limits turned off: max_linear_jerk'))])
def test_a_line_says_what_was_understood(base, understood):
    path = CONFIG / f'{base}.yaml'
    summary = settings_of('--check', path).summary
    for part in (*understood, str(path)):
        assert part in summary
    assert '\n' not in summary
    assert str(path) in settings_of('--check', path, program=SIMULATOR).summary


def test_the_line_tells_how_joints_and_imu_are_mounted(tmp_path):
    path = file(tmp_path, """
/**:
  ros__parameters:
    drive_ratios: [5.08]
    drive_directions: [1, -1, 1, -1]
    steering_ratios: [1, 1, 1, 12.5]
    steering_directions: [1, 1, 1, -1]
    drive_coupling_ratio: [0.25]
    max_steering_rate: 8.0
    gyro_source: imu
    imu_position: [-0.25, 0.0]
    imu_orientation: [3.1416, 0.0, 0.0]
    imu_delay: 0.01
""")
    summary = settings_of('--check', path).summary
    assert ('wheel radius 0.05 m, drive ratio 5.08, reversed drive: front_right, rear_right, '
            'steering ratio 1 to 12.5, reversed steering: rear_right, coupling ratio 0.25; '
            'gyro: imu at (-0.25, 0) m, turned by (3.1416, 0, 0) rad, 0.01 s late; ') in summary


@pytest.mark.parametrize('name, value, remark', [
    ('max_linear_acceleration', 2000.0, '2000 m/s^2 (CHECK: limits nothing; in mm/s^2?)'),
    ('max_grip_acceleration', 1500.0, '1500 m/s^2 (CHECK: limits nothing; in mm/s^2?)'),
    ('max_angular_acceleration', 340.0, '340 rad/s^2 (CHECK: limits nothing; in deg/s^2?)'),
    ('max_linear_acceleration', 20.0, ''), ('max_linear_acceleration', 0.0, '')])
def test_a_limit_that_no_base_can_reach_is_remarked(name, value, remark):
    summary = settings_of('--ros-args', '-p', f'{name}:={value}').summary
    assert ('CHECK' in summary) == bool(remark)
    assert not remark or f'; {name}: {remark}' in summary


@pytest.mark.parametrize('name', ['cmd_vel_timeout', 'feedback_timeout'])
@pytest.mark.parametrize('seconds, speed, remark', [
    (4.0, 1.5, '4 s (CHECK: drives on for so long in silence, up to 6 m)'),
    (4.0, 0.0, '4 s (CHECK: drives on for so long in silence)'), (1.0, 1.5, '')])
def test_a_timeout_that_lets_the_base_drive_on_is_remarked(name, seconds, speed, remark):
    summary = settings_of('--ros-args', '-p', f'{name}:={seconds}', '-p',
                          f'max_linear_speed:={speed}').summary
    assert ('CHECK' in summary) == bool(remark)
    assert not remark or f'; {name}: {remark}' in summary


def test_check_says_where_the_mounting_of_an_imu_comes_from():
    summary = settings_of('--ros-args', '-p', 'gyro_source:=imu').summary
    assert 'gyro: imu at (0, 0) m, turned as /tf_static tells, if at all, 0 s late; ' in summary


@pytest.mark.parametrize('source, remark', [
    ('imu', ''), ('none', 'gyro: none (CHECK: imu_orientation, imu_delay without effect; '),
    ('joint', 'gyro: joint gyro_joint (CHECK: imu_orientation, imu_delay without effect; '
              'gyro_source: imu?)')])
def test_an_imu_that_is_described_but_not_used_is_remarked(source, remark):
    summary = settings_of('--ros-args', '-p', f'gyro_source:={source}', '-p', 'imu_delay:=0.01',
                          '-p', 'imu_orientation:=[0.0, 0.0, 0.0]').summary
    assert remark in summary
    assert ('CHECK' in summary) is bool(remark)


@pytest.mark.parametrize('kind', ['drive', 'steering'])
@pytest.mark.parametrize('ratios, remark', [
    ([0.148], 'ratio 0.148 (CHECK: below 1; the wrong way round?)'),
    ([6.75, 6.75, 0.148, 6.75], 'ratio 0.148 to 6.75 (CHECK'), ([6.75], ''), ([1.0], '')])
def test_a_gear_that_makes_the_joint_the_slower_one_is_remarked(kind, ratios, remark):
    summary = settings_of('--ros-args', '-p', f'{kind}_ratios:={ratios}').summary
    assert f'{kind} {remark}' in summary or not remark
    assert ('CHECK' in summary) is bool(remark)


@pytest.mark.parametrize('x, radius, is_odd', [
    ([11.8, 11.8, -11.8, -11.8], 0.05, True), ([0.3, 0.3, -0.3, -0.3], 0.002, True),
    ([5.0, 5.0, -5.0, -5.0], 0.2, False), ([0.15, 0.15, -0.15, -0.15], 0.05, False)])
def test_a_base_that_is_huge_for_its_wheels_is_remarked(x, radius, is_odd):
    summary = settings_of(
        '--ros-args', '-p', f'module_x:={x}', '-p', f'wheel_radii:=[{radius}]').summary
    assert ('(CHECK: small for the base; one of them in inches' in summary) is is_odd
    assert ('CHECK' in summary) is is_odd


@pytest.mark.parametrize('period, remark', [
    (360, ', drive joints wrap after 360 rad (CHECK: not a multiple of pi; in degrees'),
    (1, ' 1 rad (CHECK'), (6.28319, ', drive joints wrap after 6.28319 rad;'), (0, ''),
    (12.57, ''), (31.9186, '')])
def test_a_period_of_drive_joints_that_is_not_in_radians_is_remarked(period, remark):
    summary = settings_of('--ros-args', '-p', f'drive_joint_period:={period}').summary
    assert remark in summary
    assert ('wrap' in summary) is bool(period)
    assert ('CHECK' in summary) is ('CHECK' in remark)


@pytest.mark.parametrize('parameters, words', [
    ({}, ''), ({'use_stamped_vel': 'true'}, ', cmd_vel: TwistStamped'),
    ({'field_centric': 'true'}, ', field-centric'),
    ({'field_centric': 'true', 'gyro_source': 'none'},
     ', field-centric (CHECK: without a gyro?)'),
    ({'field_centric': 'true', 'use_stamped_vel': 'true'},
     ", cmd_vel: TwistStamped, field-centric (CHECK: no effect: a TwistStamped's frame decides)"),
    ({'center_of_rotation': '[0.3, 0.0]'}, ', turning about (0.3, 0) m'),
    ({'center_of_rotation': '[0.0, -3]'}, ', turning about (0, -3) m, outside of the modules'),
    ({'open_loop': 'true'}, ', open loop: silent joint_states do not stop it'),
    ({'idle_mode': 'lock'}, ', wheels in an X when stopped')])
def test_the_line_tells_what_is_out_of_the_ordinary_about_commands(parameters, words):
    given = [part for name, value in parameters.items() for part in ('-p', f'{name}:={value}')]
    summary = settings_of('--ros-args', *given).summary
    assert f'commands: forward_command{words}; limits' in summary
    assert ('CHECK' in summary) is ('CHECK' in words)


@pytest.mark.parametrize('text, end', [
    ('frame_prefix: robot1/, module_x: [1, 1, -1, -1]',
     '; frames: robot1/odom, robot1/base_link (FILE; by default: module_y, wheel_radii)'),
    ('module_x: [1, 1, -1, -1], module_y: [1, -1, 1, -1], wheel_radii: 0.1',
     'max_grip_acceleration (FILE)')])
def test_the_line_tells_which_frames_there_are_and_what_was_not_measured(tmp_path, text, end):
    path = file(tmp_path, f'/**: {{ros__parameters: {{{text}}}}}')
    assert settings_of('--check', path).summary.endswith(end.replace('FILE', str(path)))


@pytest.mark.parametrize('x, y, remark', [
    ([0.25, -0.25, 0.25, -0.25], [0.3, 0.3, -0.3, -0.3], 'front_right is not ahead of rear_left'),
    ([0.3, 0.3, -0.3, -0.3], [-0.2, 0.2, -0.2, 0.2], 'front_left is not left of rear_right'),
    ([0.3, 0.2, -0.3, -0.1], [0.2, -0.1, 0.3, -0.3], '')])
def test_names_that_contradict_the_places_of_the_modules_are_remarked(x, y, remark):
    summary = settings_of('--ros-args', '-p', f'module_x:={x}', '-p', f'module_y:={y}').summary
    assert remark in summary
    assert ('CHECK' in summary) is bool(remark)


@pytest.mark.parametrize('modules, kind, joints, remark', [
    (['fl', 'fr', 'rl', 'rr'], 'drive', ['fr_wheel', 'fl_wheel', 'rl_wheel', 'rr_wheel'],
     'drive joint of fl is fr_wheel; drive_joint_names in another order than module_names?'),
    (['fl', 'fr', 'rl', 'rr'], 'steering', ['turn_fl', 'turn_rl', 'turn_rr', 'turn_fr'],
     'steering joint of fr is turn_rl'),
    (['front', 'front_left', 'rear'], 'drive', ['front_left_a', 'front_a', 'rear_a'],
     'drive joint of front is front_left_a'),
    (['front', 'left', 'front_left'], 'drive', ['front_a', 'left_a', 'front_left_a'], ''),
    (['fl', 'fr', 'rl', 'rr'], 'drive', ['motor_4', 'motor_3', 'motor_2', 'motor_1'], ''),
    (['a', 'b', 'c', 'd'], 'drive', ['drive_0', 'drive_1', 'drive_2', 'drive_3'], ''),
    (['0', '1', '2', '3'], 'steering', ['steer_1', 'steer_2', 'steer_3', 'steer_4'], '')])
def test_joints_that_are_in_another_order_than_the_modules_by_their_names_are_remarked(
        tmp_path, modules, kind, joints, remark):
    # No place contradicts these names of the modules.
    lists = ', '.join(f'{name}: {values}' for name, values in (
        ('module_names', modules), (f'{kind}_joint_names', joints),
        ('module_x', [0.3, 0.2, -0.3, -0.2][:len(modules)]),
        ('module_y', [0.2, 0.1, -0.1, -0.2][:len(modules)])))
    summary = settings_of('--check', file(
        tmp_path, f'/**: {{ros__parameters: {{{lists}}}}}')).summary
    assert remark in summary
    assert ('CHECK' in summary) is bool(remark)


@pytest.mark.parametrize('section', [
    '/**', 'swerve_node', '/robot_1/swerve_node', '/*/swerve_node', '/**/swerve_node'])
def test_tools_read_the_file_of_a_node_in_any_namespace(tmp_path, section):
    path = file(tmp_path, f'"{section}": {{ros__parameters: {{wheel_radii: 0.07}}}}')
    assert read_parameters(path).layout.joints.wheel_radii == [0.07] * 4


def sections(**radii):
    """Return a file with a section for each name, with a radius of the wheels in each."""
    return '\n'.join(f'"{name}": {{ros__parameters: {{wheel_radii: {radius}}}}}'
                     for name, radius in radii.items())


@pytest.mark.parametrize('radii', [
    {'/*/swerve_node': 0.05, '/robot1/swerve_node': 0.07},
    {'/robot1/swerve_node': 0.07, '/robot1/swerve_sim': 0.08}])
def test_tools_read_all_that_the_file_of_one_robot_says(tmp_path, radii):
    path = file(tmp_path, sections(**radii))
    assert read_parameters(path).layout.joints.wheel_radii == [0.07] * 4


def test_tools_do_not_choose_between_robots(tmp_path):
    path = file(tmp_path, sections(**{'robot1/swerve_node': 0.05, '/robot2/swerve_node': 0.1}))
    with pytest.raises(ParameterError, match='robots.*/robot1/swerve_node, /robot2/swerve_node'):
        read_parameters(path)
