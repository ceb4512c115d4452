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

"""Launch swerve_node with a parameter file, in a namespace if wanted."""

from pathlib import Path

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

TOPICS = ('cmd_vel', 'joint_states', 'imu', 'odom')


def generate_launch_description() -> LaunchDescription:
    """Describe the arguments and the node."""
    return LaunchDescription([
        DeclareLaunchArgument(
            'params_file', description='YAML file with the parameters of the base',
            default_value=PathJoinSubstitution(
                [FindPackageShare('swerve_kinematics'), 'config', 'four_modules.yaml'])),
        DeclareLaunchArgument('namespace', default_value='', description='Namespace of the robot'),
        DeclareLaunchArgument('frame_prefix', default_value='',
                              description='Put before the names of the frames, such as robot1/; '
                              'if not given, as in params_file'),
        DeclareLaunchArgument('use_sim_time', default_value='',
                              description='Take the time from /clock; if not given, as in '
                              'params_file'),
        *(DeclareLaunchArgument(f'{topic}_topic', default_value=topic,
                                description=f'Name of {topic} on this robot')
          for topic in TOPICS),
        OpaqueFunction(function=node),
    ])


def node(context: LaunchContext) -> list[Node]:
    """
    Return the node; end the launch where params_file names no file.

    launch_ros only warns of a file that is not there, and starts a node with defaults.
    """
    path = LaunchConfiguration('params_file').perform(context)
    if not Path(path).is_file():
        raise FileNotFoundError(f"params_file '{path}' does not exist")
    arguments = {
        name: ParameterValue(LaunchConfiguration(name), value_type=kind)
        for name, kind in (('frame_prefix', str), ('use_sim_time', bool))
        if LaunchConfiguration(name).perform(context)}
    return [Node(
        package='swerve_kinematics', executable='swerve_node', output='screen',
        namespace=LaunchConfiguration('namespace'), parameters=[path, arguments],
        remappings=[(topic, LaunchConfiguration(f'{topic}_topic')) for topic in TOPICS])]
