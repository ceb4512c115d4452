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

"""Launch swerve_node together with the simulated base: drive it with any teleop."""

from pathlib import Path
import re
from tempfile import NamedTemporaryFile

from ament_index_python.packages import get_package_prefix, PackageNotFoundError
from launch import LaunchContext, LaunchDescription, Substitution
from launch.actions import DeclareLaunchArgument, GroupAction, OpaqueFunction
from launch.conditions import evaluate_condition_expression, IfCondition
from launch.substitutions import FileContent, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """Describe the arguments, both nodes, and what shows them."""
    share = FindPackageShare('swerve_kinematics')
    namespace = LaunchConfiguration('namespace')
    params_file = LaunchConfiguration('params_file')
    prefixed = {'frame_prefix': ParameterValue(
        LaunchConfiguration('frame_prefix'), value_type=str)}
    return LaunchDescription([
        DeclareLaunchArgument(
            'params_file', description='YAML file with the parameters of the base',
            default_value=PathJoinSubstitution([share, 'config', 'four_modules.yaml'])),
        DeclareLaunchArgument('namespace', default_value='', description='Namespace of the robot'),
        DeclareLaunchArgument('frame_prefix', default_value='',
                              description='Put before the names of the frames, such as robot1/, '
                              'in place of what params_file says'),
        DeclareLaunchArgument('physics', default_value='rolling', choices=['rolling', 'mujoco'],
                              description='How the base moves: on wheels that only roll, or on '
                              'tyres that slip (pip install mujoco)'),
        DeclareLaunchArgument('rviz', default_value='false',
                              description='Show it in RViz (rviz2, robot_state_publisher)'),
        OpaqueFunction(function=refuse_what_is_missing),
        Node(package='swerve_kinematics', executable='swerve_node', output='screen',
             namespace=namespace, parameters=[params_file, prefixed]),
        # Of the parameters it takes those of the layout.
        Node(package='swerve_kinematics', executable='swerve_sim', output='screen',
             namespace=namespace,
             parameters=[params_file, prefixed, {'physics': LaunchConfiguration('physics')}]),
        GroupAction(rviz_nodes(share, namespace, prefixed),
                    condition=IfCondition(LaunchConfiguration('rviz'))),
    ])


def refuse_what_is_missing(context: LaunchContext) -> None:
    """
    End the launch where params_file names no file, or RViz is wanted and not installed.

    launch_ros only warns of such a file, and notices a missing package when the nodes run.
    """
    path = LaunchConfiguration('params_file').perform(context)
    if not Path(path).is_file():
        raise FileNotFoundError(f"params_file '{path}' does not exist")
    if evaluate_condition_expression(context, [LaunchConfiguration('rviz')]):
        for package in ('rviz2', 'robot_state_publisher'):
            try:
                get_package_prefix(package)
            except PackageNotFoundError:
                raise RuntimeError(
                    f'rviz:=true needs {package}, which is not installed: sudo apt install '
                    f"ros-$ROS_DISTRO-{package.replace('_', '-')}") from None


class WithPrefixedFrames(Substitution):
    """
    A copy of a file for RViz, with the prefix before the frames in it.

    Parameters
    ----------
    path : launch.Substitution
        Of the file; without a prefix it is taken itself.

    """

    def __init__(self, path: Substitution) -> None:
        """Keep the path."""
        self._path = path

    def perform(self, context: LaunchContext) -> str:
        """Write the copy and return its path."""
        path = self._path.perform(context)
        prefix = LaunchConfiguration('frame_prefix').perform(context)
        if not prefix:
            return path
        text = re.sub('(?<= )(odom|base_link)(?=:?$)', lambda name: prefix + name[0],
                      Path(path).read_text(), flags=re.MULTILINE)
        with NamedTemporaryFile('w', suffix='.rviz', delete=False) as file:
            # Here RViz adds the slash itself.
            file.write(text.replace('TF Prefix: ""', f'TF Prefix: "{prefix.rstrip("/")}"'))
        return file.name


def rviz_nodes(share: FindPackageShare, namespace: LaunchConfiguration,
               prefixed: dict[str, ParameterValue]) -> list[Node]:
    """Return RViz with the markers of swerve_node, and the model of the four-module base."""
    urdf = FileContent(PathJoinSubstitution([share, 'config', 'four_modules.urdf']))
    # RViz knows the topics by the names that they have without a namespace.
    topics = ('odom', 'robot_description', 'swerve_node/markers', 'swerve_node/set_pose')
    return [
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             namespace=namespace,
             parameters=[{'robot_description': ParameterValue(urdf, value_type=str)}, prefixed]),
        Node(package='rviz2', executable='rviz2', namespace=namespace,
             arguments=['-d', WithPrefixedFrames(
                 PathJoinSubstitution([share, 'config', 'swerve.rviz']))],
             remappings=[(f'/{topic}', topic) for topic in topics]),
    ]
