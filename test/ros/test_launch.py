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

"""The launch files, launched: nodes in their namespace, with their parameters and topics."""

import os
from pathlib import Path
import signal
import subprocess
import sys

from graph import PATIENCE
import pytest

pytest.importorskip('launch_ros')  # not in PyPI: these tests run where ROS is installed

from launch import LaunchContext  # noqa: E402, I100
from launch.launch_description_sources import (  # noqa: E402
    get_launch_description_from_python_launch_file as description_of)
from rcl_interfaces.srv import GetParameters  # noqa: E402
from sensor_msgs.msg import JointState  # noqa: E402
import yaml  # noqa: E402

REPOSITORY = Path(__file__).parents[2]
# What `ros2 launch FILE NAME:=VALUE...` does, without ros2cli.
LAUNCH = """
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
import sys
path, *arguments = sys.argv[1:]
service = LaunchService()
service.include_launch_description(LaunchDescription([IncludeLaunchDescription(
    path, launch_arguments=[tuple(argument.split(':=')) for argument in arguments])]))
sys.exit(service.run())
"""


@pytest.fixture
def installed(tmp_path):
    """Return the environment of a shell in which this repository is an installed package."""
    name = 'swerve_kinematics'
    marker = tmp_path / 'share/ament_index/resource_index/packages' / name
    share, executables = tmp_path / 'share' / name, tmp_path / 'lib' / name
    for folder in (marker.parent, share, executables):
        folder.mkdir(parents=True)
    marker.touch()
    for folder in ('config', 'launch'):
        (share / folder).symlink_to(REPOSITORY / folder)
    for module in ('ros', 'sim'):
        program = executables / {'ros': 'swerve_node', 'sim': 'swerve_sim'}[module]
        program.write_text(f'#!/bin/sh\nexec {sys.executable} -m {name}.{module}.node "$@"\n')
        program.chmod(0o755)
    paths = {variable: os.pathsep.join(filter(None, (str(path), os.environ.get(variable))))
             for variable, path in (('AMENT_PREFIX_PATH', tmp_path), ('PYTHONPATH', REPOSITORY))}
    return {**os.environ, **paths, 'ROS_LOG_DIR': str(tmp_path / 'log')}


@pytest.fixture
def launch(installed, namespace, tmp_path):
    """Return a function that launches a file in the test's namespace; it is ended with it."""
    processes = []

    def launch_file(file, **arguments):
        words = [f'{name}:={value}' for name, value in arguments.items()]
        with open(tmp_path / f'{file}.log', 'w') as log:
            processes.append(subprocess.Popen(
                [sys.executable, '-c', LAUNCH, REPOSITORY / 'launch' / file,
                 f'namespace:={namespace}', *words],
                env=installed, stdout=log, stderr=subprocess.STDOUT, start_new_session=True))
        return processes[-1]

    yield launch_file
    for process in processes:
        interrupt(process)
    for log in tmp_path.glob('*.log'):
        print(log.read_text())  # pytest shows it if the test failed


def interrupt(process):
    """Do what Ctrl-C does: signal the launcher and all it has started; return its exit code."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
    return process.wait(PATIENCE)


def arguments_of(file):
    """Return the arguments that --show-args lists, each with its description."""
    description = description_of(str(REPOSITORY / 'launch' / file))
    return {action.name: action.description for action in description.get_launch_arguments()}


def test_the_demo_drives(client, launch):
    process = launch('demo.launch.py')
    client.repeat_until(lambda: client.send_twist(vx=0.5),
                        lambda: client.odom and client.odom[-1].pose.pose.position.x > 0.1,
                        'the base to drive')
    assert interrupt(process) == 0


def test_the_demo_takes_another_base(client, launch):
    launch('demo.launch.py', params_file=REPOSITORY / 'config/three_modules.yaml')
    states = client.listen(JointState, 'joint_states')
    client.wait_until(lambda: client.odom and states, 'odometry')
    assert {'front_drive_joint', 'rear_left_steering_joint'} <= set(states[-1].name)


def test_what_is_not_given_is_as_in_the_file(client, launch, tmp_path):
    params = tmp_path / 'robot.yaml'
    params.write_text(yaml.safe_dump({'/**': {'ros__parameters': {
        'use_sim_time': True, 'frame_prefix': 'robot1/'}}}))
    launch('swerve.launch.py', params_file=params)
    answer = client.call(GetParameters, 'swerve_node/get_parameters',
                         GetParameters.Request(names=['frame_prefix', 'use_sim_time']))
    assert answer.values[0].string_value == 'robot1/' and answer.values[1].bool_value


def test_the_node_takes_its_parameters_and_topics(client, launch, tmp_path):
    params = tmp_path / 'robot.yaml'
    params.write_text(yaml.safe_dump({'/**': {'ros__parameters': {'idle_mode': 'lock'}}}))
    launch('swerve.launch.py', params_file=params, use_sim_time='true',
           cmd_vel_topic='nav/cmd_vel', joint_states_topic='drives/joint_states',
           imu_topic='imu/data', odom_topic='wheels/odom')
    answer = client.call(GetParameters, 'swerve_node/get_parameters',
                         GetParameters.Request(names=['idle_mode', 'use_sim_time']))
    assert answer.values[0].string_value == 'lock'
    assert answer.values[1].bool_value

    def endpoints():
        node, namespace = client.node, client.node.get_namespace()
        if ('swerve_node', namespace) not in node.get_node_names_and_namespaces():
            return set()
        listed = (node.get_subscriber_names_and_types_by_node('swerve_node', namespace)
                  + node.get_publisher_names_and_types_by_node('swerve_node', namespace))
        return {name.removeprefix(namespace + '/') for name, _ in listed}
    wanted = {'nav/cmd_vel', 'drives/joint_states', 'wheels/odom'}
    client.wait_until(lambda: wanted <= endpoints(), 'the remapped topics')
    assert not {'cmd_vel', 'joint_states', 'odom'} & endpoints()


@pytest.mark.parametrize('file', ['swerve.launch.py', 'demo.launch.py'])
def test_a_params_file_that_does_not_exist_starts_nothing(client, launch, tmp_path, file):
    missing = tmp_path / 'my_robt.yaml'
    assert launch(file, params_file=missing).wait(PATIENCE) != 0
    log = (tmp_path / f'{file}.log').read_text()
    assert f"params_file '{missing}' does not exist" in log
    assert 'process started' not in log


@pytest.mark.parametrize('present, missing', [
    ([], 'rviz2'), (['rviz2'], 'robot_state_publisher')])
def test_rviz_that_is_not_installed_starts_nothing(
        client, launch, installed, tmp_path, present, missing):
    for package in present:
        (tmp_path / 'share/ament_index/resource_index/packages' / package).touch()
    assert launch('demo.launch.py', rviz='true').wait(PATIENCE) != 0
    log = (tmp_path / 'demo.launch.py.log').read_text()
    assert f'rviz:=true needs {missing}, which is not installed' in log
    assert 'process started' not in log


@pytest.mark.parametrize('prefix', ['', 'robot1/'])
def test_rviz_shows_the_frames_that_there_are(client, launch, tmp_path, prefix):
    shown = tmp_path / 'shown.rviz'
    for package, does in (('rviz2', f'cp "$2" {shown}.new && mv {shown}.new {shown}'),
                          ('robot_state_publisher', 'sleep 60')):
        (tmp_path / 'share/ament_index/resource_index/packages' / package).touch()
        program = tmp_path / 'lib' / package / package
        program.parent.mkdir()
        program.write_text(f'#!/bin/sh\n{does}\n')
        program.chmod(0o755)
    launch('demo.launch.py', rviz='true', **({'frame_prefix': prefix} if prefix else {}))
    client.wait_until(shown.exists, 'what RViz is to show')
    manager = yaml.safe_load(shown.read_text())['Visualization Manager']
    displays = {display['Name']: display for display in manager['Displays']}
    odom, base = f'{prefix}odom', f'{prefix}base_link'
    assert manager['Global Options']['Fixed Frame'] == odom
    assert displays['Grid']['Reference Frame'] == odom
    assert {odom, base} < set(displays['TF']['Frames'])
    assert manager['Views']['Current']['Target Frame'] == base
    # RViz joins the two by a slash, robot_state_publisher by nothing.
    assert displays['Robot']['TF Prefix'] == prefix.rstrip('/')


def test_the_demo_drives_on_tyres(client, launch):
    launch('demo.launch.py', physics='mujoco')
    client.repeat_until(lambda: client.send_twist(vx=0.5),
                        lambda: client.odom and client.odom[-1].pose.pose.position.x > 0.1,
                        'the base to drive')
    answer = client.call(GetParameters, 'swerve_sim/get_parameters',
                         GetParameters.Request(names=['physics']))
    assert answer.values[0].string_value == 'mujoco'


@pytest.mark.parametrize('file, names', [
    ('swerve.launch.py', {
        'params_file', 'namespace', 'frame_prefix', 'use_sim_time', 'cmd_vel_topic',
        'joint_states_topic', 'imu_topic', 'odom_topic'}),
    ('demo.launch.py', {'params_file', 'namespace', 'frame_prefix', 'physics', 'rviz'})])
def test_every_argument_is_listed_and_described(file, names):
    arguments = arguments_of(file)
    assert set(arguments) == names
    assert all(arguments.values())


@pytest.mark.parametrize('rviz, shown', [('true', True), ('false', False)])
def test_rviz_comes_when_it_is_wanted(rviz, shown):
    group = description_of(str(REPOSITORY / 'launch' / 'demo.launch.py')).entities[-1]
    context = LaunchContext()
    context.launch_configurations['rviz'] = rviz
    assert group.condition.evaluate(context) == shown
    packages = {action.node_package for action in group.get_sub_entities()
                if hasattr(action, 'node_package')}
    assert packages == {'rviz2', 'robot_state_publisher'}
