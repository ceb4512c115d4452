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

"""What goes out of a command, in messages that are built once: for the joints, and the twist."""

from array import array

from geometry_msgs.msg import TwistStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.ros.qos import publisher
from swerve_kinematics.ros.serialized import SerializedMessage

# How long a process that ends waits for a listener that does not answer. One that does is asked
# by Fast DDS only some 0.6 s after the last message.
DELIVERY_TIMEOUT = Duration(seconds=1.0)
# To count listeners takes almost as long as to publish to one: it is done once in so many calls.
LOOK_EVERY = 8


class ForwardCommands:
    """
    Commands for two ros2_control forward controllers: a pair of Float64MultiArray.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publishers.
    layout : Layout
        Tells how many modules there are.

    """

    def __init__(self, node: Node, layout: Layout) -> None:
        """Create publishers and messages."""
        count = len(layout.drive_joints)
        self._drive = _numbers(node, 'drive_velocity_controller/commands', count)
        self._steering = _numbers(node, 'steering_position_controller/commands', count)

    def publish(self, stamp: int, wheel_speeds: list[float],
                steering_angles: list[float] | None) -> None:
        """
        Publish one command.

        Parameters
        ----------
        stamp : int
            Time [ns].
        wheel_speeds : list of float (n,)
            Drive joint velocities [rad/s].
        steering_angles : list of float (n,) or None
            Steering joint positions [rad]; None leaves the steering alone.

        """
        if steering_angles is not None:
            self._steering.numbers[:] = array('d', steering_angles)
            self._steering.publish()
        self._drive.numbers[:] = array('d', wheel_speeds)
        self._drive.publish()

    @property
    def publishers(self) -> list[Publisher]:
        """Return what the commands go out of."""
        return [self._drive.publisher, self._steering.publisher]

    def wait_for_delivery(self) -> None:
        """Wait until the listeners have the commands: the end of a process drops the latest."""
        for message in (self._drive, self._steering):
            message.publisher.wait_for_all_acked(DELIVERY_TIMEOUT)


def _numbers(node: Node, topic: str, count: int) -> SerializedMessage:
    """Return a Float64MultiArray of so many numbers, still to be set, for a topic."""
    numbers = _placeholders(count)
    return SerializedMessage(
        publisher(node, Float64MultiArray, topic), Float64MultiArray(data=numbers), numbers)


def _placeholders(count: int) -> 'array[float]':
    """Return numbers by which a block of so many is recognized in a serialized message."""
    return array('d', [0.1 + index for index in range(count)])


class JointCommands:
    """
    Commands in two stamped JointStates, for Isaac Sim or a driver that takes them.

    One has the steering joints and their positions, one the drive joints and their velocities:
    who obeys every field there is finds none that means nothing.
    """

    def __init__(self, node: Node, layout: Layout) -> None:
        """Create the publisher and the messages."""
        self._publisher = publisher(node, JointState, 'joint_commands')
        numbers = _placeholders(len(layout.drive_joints))
        self._drive = SerializedMessage(
            self._publisher, JointState(name=layout.drive_joints, velocity=numbers), numbers)
        self._steering = SerializedMessage(
            self._publisher, JointState(name=layout.steering_joints, position=numbers), numbers)

    def publish(self, stamp: int, wheel_speeds: list[float],
                steering_angles: list[float] | None) -> None:
        """Publish one command, as `ForwardCommands.publish` does."""
        if steering_angles is not None:
            self._steering.publish_at(stamp, steering_angles)
        self._drive.publish_at(stamp, wheel_speeds)

    @property
    def publishers(self) -> list[Publisher]:
        """Return what the commands go out of."""
        return [self._publisher]

    def wait_for_delivery(self) -> None:
        """Wait as `ForwardCommands.wait_for_delivery` does."""
        self._publisher.wait_for_all_acked(DELIVERY_TIMEOUT)


Commands = ForwardCommands | JointCommands
# What `command_interface` chooses from.
COMMANDS: dict[str, type[Commands]] = {
    'forward_command': ForwardCommands, 'joint_state': JointCommands}


class LimitedTwist:
    """
    The twist that is really being executed, in the base frame.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publisher.
    layout : Layout
        Gives the name of the base frame.

    """

    def __init__(self, node: Node, layout: Layout) -> None:
        """Create the publisher and the message."""
        self._publisher = publisher(node, TwistStamped, '~/cmd_vel_limited')
        message, numbers = TwistStamped(), _placeholders(6)
        message.header.frame_id = layout.base_frame
        for vector, values in ((message.twist.linear, numbers[:3]),
                               (message.twist.angular, numbers[3:])):
            vector.x, vector.y, vector.z = values
        self._message = SerializedMessage(self._publisher, message, numbers)
        # What `Publisher.get_subscription_count` ends up in.
        self._count_listeners = self._publisher.handle.get_subscription_count
        self._calls, self._is_heard = 0, False

    def publish(self, stamp: int, twist: tuple[float, float, float]) -> None:
        """Publish `twist` (3,) [m/s, m/s, rad/s] at `stamp` [ns], if anyone listens."""
        if self._calls % LOOK_EVERY == 0:
            self._is_heard = self._count_listeners() > 0
        self._calls += 1
        if self._is_heard:
            vx, vy, omega = twist
            self._message.publish_at(stamp, (vx, vy, 0.0, 0.0, 0.0, omega))
