"""Launch swerve_node together with the simulated base: drive it with any teleop."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import FileContent, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """Describe the arguments, both nodes, and what shows them."""
    share = FindPackageShare('swerve_kinematics')
    namespace = LaunchConfiguration('namespace')
    params_file = LaunchConfiguration('params_file')
    prefix = LaunchConfiguration('frame_prefix')
    prefixed = {'frame_prefix': ParameterValue(prefix, value_type=str)}
    return LaunchDescription([
        DeclareLaunchArgument(
            'params_file', description='YAML with the parameters of the base',
            default_value=PathJoinSubstitution([share, 'config', 'four_modules.yaml'])),
        DeclareLaunchArgument('namespace', default_value='', description='Namespace of the robot'),
        DeclareLaunchArgument('frame_prefix', default_value='',
                              description='Before the names of the frames: robot1/, say'),
        DeclareLaunchArgument('rviz', default_value='false',
                              description='Show it in RViz (rviz2, robot_state_publisher)'),
        # It refuses a params_file that does not exist, and comes first.
        IncludeLaunchDescription(
            PathJoinSubstitution([share, 'launch', 'swerve.launch.py']),
            launch_arguments={'params_file': params_file, 'namespace': namespace,
                              'frame_prefix': prefix}.items()),
        # Of the parameters it takes those of the layout.
        Node(package='swerve_kinematics', executable='swerve_sim', output='screen',
             namespace=namespace, parameters=[params_file, prefixed]),
        GroupAction(rviz_nodes(share, namespace, prefixed),
                    condition=IfCondition(LaunchConfiguration('rviz'))),
    ])


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
             arguments=['-d', PathJoinSubstitution([share, 'config', 'swerve.rviz'])],
             remappings=[(f'/{topic}', topic) for topic in topics]),
    ]
