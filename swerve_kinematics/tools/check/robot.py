"""The robot as a check sees it: its joints, its gyro, its commands, and who else is there."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
import sys
from time import monotonic
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Float64MultiArray

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.ros.feedback import Sample
from swerve_kinematics.ros.messages import ForwardCommands, JointCommands
from swerve_kinematics.ros.stamps import nanoseconds_of
from swerve_kinematics.tools.recordings.collector import Collector

# Joint states that are older [s] are silence, and a first one must come within this.
SILENCE, PATIENCE = 0.5, 5.0
PERIOD = 0.02  # s between commands
# Who else commands the joints is known after this [s].
DISCOVERY = 1.5


class Robot:
    """
    Listens to a robot, and tells it what to do while watching it.

    Parameters
    ----------
    node : rclpy.node.Node
        Ours.
    parameters : NodeParameters
        The description.

    Attributes
    ----------
    collector : Collector
        All that came.

    """

    def __init__(self, node: Node, parameters: NodeParameters) -> None:
        """Subscribe."""
        self.node, self.layout, self._parameters = node, parameters.layout, parameters
        self.collector = Collector(parameters, ('joint',))
        self._heard = -float('inf')
        node.create_subscription(JointState, 'joint_states', self._on_joints,
                                 qos_profile_sensor_data)
        if parameters.gyro_source == 'imu':
            node.create_subscription(Imu, 'imu', self._on_imu, qos_profile_sensor_data)
        node.create_subscription(
            Float64MultiArray, 'drive_velocity_controller/commands',
            self._on_drive_commands, 10)
        node.create_subscription(
            Float64MultiArray, 'steering_position_controller/commands',
            self._on_steering_commands, 10)
        node.create_subscription(JointState, 'joint_commands', self._on_joint_commands, 10)

    def _on_joints(self, message: JointState) -> None:
        """Take joint states."""
        self._heard = monotonic()
        self.collector.add_joints(
            nanoseconds_of(message.header.stamp) or self.node.get_clock().now().nanoseconds,
            message.name, message.position, message.velocity)

    def _on_imu(self, message: Imu) -> None:
        """Take a sample of the gyro."""
        self.collector.add_imu(
            nanoseconds_of(message.header.stamp) or self.node.get_clock().now().nanoseconds,
            message)

    def _on_drive_commands(self, message: Float64MultiArray) -> None:
        """Take what the drives are told."""
        self.collector.add_drive_commands(message.data.tolist())

    def _on_steering_commands(self, message: Float64MultiArray) -> None:
        """Take what the steering is told."""
        self.collector.add_steering_commands(message.data.tolist())

    def _on_joint_commands(self, message: JointState) -> None:
        """Take what drives or steering are told by name."""
        self.collector.add_joint_commands(message.name, message.velocity, message.position)

    def sample(self) -> Sample:
        """Return the latest sample; ValueError if the joint states have fallen silent."""
        latest = self.collector.latest
        if latest is None or monotonic() - self._heard > SILENCE:
            raise ValueError('joint_states fell silent: stopped')
        return latest

    def wait_for_joints(self) -> None:
        """Wait for complete joint states; ValueError if none come."""
        deadline = monotonic() + PATIENCE
        while self.collector.latest is None:
            if monotonic() > deadline:
                raise ValueError(f'no complete joint_states within {PATIENCE:g} s')
            rclpy.spin_once(self.node, timeout_sec=0.05)

    def during(self, seconds: float, act: Callable[[], None]) -> Iterator[float]:
        """Do something every period and yield the time [s] each time, for so long."""
        begun = due = monotonic()
        while (now := monotonic()) - begun < seconds:
            if now >= due:
                due += PERIOD
                act()
                yield now - begun
            rclpy.spin_once(self.node, timeout_sec=max(0.0, due - monotonic()))

    def joint_commands(self) -> ForwardCommands | JointCommands:
        """Return what commands the joints; ValueError if another node does so already."""
        for _ in self.during(DISCOVERY, lambda: None):
            pass
        self.refuse_rivals(ours=0)
        is_pair = self._parameters.command_interface == 'forward_command'
        return (ForwardCommands if is_pair else JointCommands)(self.node, self.layout)

    def refuse_rivals(self, ours: int = 1) -> None:
        """Raise ValueError if others than our own publishers command the joints."""
        topic = ('drive_velocity_controller/commands'
                 if self._parameters.command_interface == 'forward_command' else 'joint_commands')
        if self.node.count_publishers(topic) > ours:
            raise ValueError(f'another node commands the joints on {topic}: stop it first')

    def twist_commands(self) -> Callable[[tuple[float, float, float]], None]:
        """Return what commands a twist to swerve_node; ValueError if none listens."""
        kind: Any = TwistStamped if self._parameters.use_stamped_vel else Twist
        publisher = self.node.create_publisher(kind, 'cmd_vel', 10)
        deadline = monotonic() + PATIENCE
        while not publisher.get_subscription_count():
            if monotonic() > deadline:
                raise ValueError('nobody listens to cmd_vel: start swerve_node first')
            rclpy.spin_once(self.node, timeout_sec=0.05)

        def command(twist: tuple[float, float, float]) -> None:
            message = kind()
            if kind is TwistStamped:
                message.header.stamp = self.node.get_clock().now().to_msg()
                message.header.frame_id = self.layout.base_frame
            target = message.twist if kind is TwistStamped else message
            target.linear.x, target.linear.y, target.angular.z = twist
            publisher.publish(message)
        return command


@contextmanager
def robot(parameters: NodeParameters, ros_arguments: list[str]) -> Iterator[Robot]:
    """Join the graph while the block runs; Ctrl-C stays an exception, so that all can stop."""
    rclpy.init(args=ros_arguments, signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node('swerve_check')
    try:
        yield Robot(node, parameters)
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def progress(text: str) -> None:
    """Show where a check is, on one line."""
    if sys.stderr.isatty():
        print(f'\r{text:<76}', end='', file=sys.stderr, flush=True)


def said(text: str) -> None:
    """Write a line, below the progress."""
    progress('')
    if sys.stderr.isatty():
        print('\r', end='', file=sys.stderr)
    print(text, flush=True)


def answered(question: str, asks_nothing: bool) -> bool:
    """Return the answer to a question that no sensor can give; yes where nothing is asked."""
    return choice(question, ('y', 'n'), asks_nothing) == 'y'


def choice(question: str, options: Sequence[str], asks_nothing: bool) -> str:
    """Return which of some answers is given; the first one where nothing is asked."""
    if asks_nothing:
        return options[0]
    progress('')
    while True:
        answer = input(f'\r{question} [{"/".join(options)}] ').strip()
        if answer in options:
            return answer
