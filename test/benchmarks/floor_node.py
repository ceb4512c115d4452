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

"""
The least that a node in rclpy costs: the messages of swerve_node without any maths.

It subscribes to what swerve_node subscribes to, answers each JointState with an Odometry and
each Twist with two arrays, has the same control timer, and reuses its messages. It has none of
the services and other parameters, no diagnostics, and reads nothing of a message but its stamp.
Nothing of it is this package's.
"""

from array import array

from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from nav_msgs.msg import Odometry
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray


class FloorNode(Node):
    """Answers each message with messages made in advance."""

    def __init__(self):
        """Create the messages, then join the graph."""
        super().__init__('swerve_node')
        self._odometry = Odometry(child_frame_id='base_link')
        self._odometry.header.frame_id = 'odom'
        self._array = Float64MultiArray(data=array('d', [0.0] * 4))
        self._odom_out = self.create_publisher(Odometry, 'odom', 10)
        self._drive_out = self.create_publisher(
            Float64MultiArray, 'drive_velocity_controller/commands', 10)
        self._steering_out = self.create_publisher(
            Float64MultiArray, 'steering_position_controller/commands', 10)
        self.create_subscription(Twist, 'cmd_vel', self._on_cmd_vel, 10)
        self.create_subscription(
            JointState, 'joint_states', self._on_joint_states, qos_profile_sensor_data)
        self.create_subscription(
            PoseWithCovarianceStamped, '~/set_pose', lambda _: None, 10)
        rate = self.declare_parameter('control_rate', 50.0).value
        self._timer = self.create_timer(1.0 / rate, self._command)

    def _on_cmd_vel(self, _):
        """Publish a command at once."""
        self._command()
        self._timer.reset()

    def _command(self):
        """Publish a command."""
        self._steering_out.publish(self._array)
        self._drive_out.publish(self._array)

    def _on_joint_states(self, message):
        """Publish an odometry with the stamp of the feedback."""
        self._odometry.header.stamp = message.header.stamp
        self._odom_out.publish(self._odometry)


def main():
    """Run the node until a signal ends it."""
    rclpy.init()
    node = FloorNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        node.destroy_node()


if __name__ == '__main__':
    main()
