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

"""Small motions on the floor that swerve_node executes, along one axis at a time."""

from functools import partial
import math
from typing import Any, NamedTuple

from geometry_msgs.msg import Twist, TwistStamped
import numpy as np
from rclpy.node import Node

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.ros.command_output import DELIVERY_TIMEOUT
from swerve_kinematics.ros.last_word import repeat_stop
from swerve_kinematics.ros.messages import set_planar_twist
from swerve_kinematics.tools.check.questions import HARDLY, progress, Questions
from swerve_kinematics.tools.check.robot import Robot, robot
from swerve_kinematics.tools.recordings.collector import Collector

Twists = tuple[float, float, float]
STOP: Twists = 0.0, 0.0, 0.0
# No motion is faster [m/s, rad/s], and no rim may be [m/s]: something runs away then.
SPEED, TURN = 0.2, 0.5
FASTEST_RIM = 0.8
# Nor does any wheel turn the base faster than this [m/s]: on a large one it would seem to run
# away, and a small one that is described in inches would spin.
TURNING_RIM = 0.4


class Step(NamedTuple):
    """A motion: shares of the speeds, for how many steps' time, and what to ask after it."""

    name: str
    twist: Twists
    duration: float = 1.0
    question: str = ''


# Every axis for itself, then together.
STEPS = (
    Step('forward', (1.0, 0.0, 0.0), question='Did the base move forward?'),
    Step('backward', (-1.0, 0.0, 0.0)),
    Step('to the left', (0.0, 1.0, 0.0), question='Did it move to the left?'),
    Step('to the right', (0.0, -1.0, 0.0)),
    Step('turning left', (0.0, 0.0, 1.0), 1.2, 'Did it turn to the left?'),
    Step('turning right', (0.0, 0.0, -1.0), 1.2),
    *(Step('in curves', twist, 0.6) for twist in (
        (0.7, 0.0, 0.8), (0.0, 0.7, -0.8), (-0.7, 0.3, 0.8), (-0.3, -0.7, -0.8),
        (0.4, -0.5, 1.0), (0.4, 0.6, -1.0))))


class TwistCommands:
    """
    Commands for swerve_node.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publisher.
    parameters : NodeParameters
        Tell which type the commands have, and the frame.

    """

    def __init__(self, node: Node, parameters: NodeParameters) -> None:
        """Create the publisher."""
        self._node, self._is_stamped = node, parameters.use_stamped_vel
        self._kind: Any = TwistStamped if self._is_stamped else Twist
        self._frame = parameters.layout.base_frame
        self._publisher = node.create_publisher(self._kind, 'cmd_vel', 10)

    def has_listener(self) -> bool:
        """Tell whether anybody hears the commands."""
        return bool(self._publisher.get_subscription_count())

    def publish(self, twist: Twists) -> None:
        """Publish a twist [m/s, m/s, rad/s]."""
        message = self._kind()
        if self._is_stamped:
            message.header.stamp = self._node.get_clock().now().to_msg()
            message.header.frame_id = self._frame
        set_planar_twist(message.twist if self._is_stamped else message, twist)
        self._publisher.publish(message)

    def wait_for_delivery(self) -> None:
        """Wait until the listeners have the commands."""
        self._publisher.wait_for_all_acked(DELIVERY_TIMEOUT)


class Floor:
    """
    Moves a base by small steps and watches it.

    Parameters
    ----------
    seen : Robot
        With joint states coming in.
    commands : TwistCommands
        With a listener.
    questions : Questions
        For what no sensor knows.
    step_time : float
        [s].
    turn : float
        Yaw rate [rad/s], as from `turning_speed`.

    Attributes
    ----------
    answers : list of bool
        Whether the base went forward, to the left, and turned left; empty if nobody was asked.

    """

    def __init__(self, seen: Robot, commands: TwistCommands, questions: Questions,
                 step_time: float, turn: float) -> None:
        """Start with nothing moved."""
        self._seen, self._commands, self._questions = seen, commands, questions
        self._step_time, self._turn = step_time, turn
        self.answers: list[bool] = []

    def run(self) -> None:
        """Move; whatever happens, leave the base stopped."""
        try:
            self._seen.wait_until_still(self._stop)
            for step in STEPS:
                self._drive(step)
                # One that cannot stop shows after the first step, before it is driven any further.
                if step is STEPS[0] or step is STEPS[-1] or self._asks(step):
                    self._seen.wait_until_still(self._stop)
                if self._asks(step):
                    self.answers.append(self._is_so(step.question))
        finally:
            repeat_stop(self._stop, self._commands.wait_for_delivery)

    def _asks(self, step: Step) -> bool:
        """Tell whether there is a question after a step."""
        return bool(step.question) and not self._questions.asks_nothing

    def _is_so(self, question: str) -> bool:
        """Return the answer to a question; ValueError if the base was not seen to move."""
        answer = self._questions.choice(
            question, ('y', 'n', HARDLY), self._seen.keeping(self._stop))
        if answer == HARDLY:
            raise ValueError(
                'the base hardly moves although its joints say so: does the driver report and '
                'take rad, not degrees or turns? Or do the wheels spin? Check on blocks')
        return answer == 'y'

    def _stop(self) -> None:
        """Command the base to stop."""
        self._commands.publish(STOP)

    def _drive(self, step: Step) -> None:
        """Drive one step; ValueError if a wheel runs away or the joint states fall silent."""
        x, y, turn = step.twist
        command = partial(self._commands.publish, (SPEED * x, SPEED * y, self._turn * turn))
        seconds = step.duration * self._step_time
        for time in self._seen.moving(seconds, command, FASTEST_RIM):
            progress(f'{step.name}: {seconds - time:.0f} s left')


def turning_speed(parameters: NodeParameters) -> float:
    """Return at which yaw rate [rad/s] a base turns that no wheel moves too fast."""
    from_center = parameters.layout.kinematics.module_positions - parameters.center_of_rotation
    return min(TURN, TURNING_RIM / float(np.hypot(*from_center.T).max()))


def driven_on_the_floor(parameters: NodeParameters, questions: Questions, step_time: float,
                        ros_arguments: list[str]) -> tuple[Collector, list[bool]]:
    """
    Return what a robot does that we move along one axis at a time, and what was answered.

    swerve_node drives it, so that its limits and its stop hold too.

    Raises
    ------
    ValueError
        If nobody listens, the joint states fall silent, or a joint moves when it should not.

    """
    with robot(parameters, ros_arguments) as seen:
        seen.wait_for_joints()
        commands = TwistCommands(seen.node, parameters)
        seen.wait_until(
            commands.has_listener,
            lambda: 'nobody listens to cmd_vel: start swerve_node first, with the same parameters')
        # A wrong description may make it faster than SPEED: as fast as is not yet running away.
        space = math.ceil(FASTEST_RIM * step_time)
        if not questions.is_so(f'The base will move. Are {space} m clear on every side, and is a '
                               'hand on the emergency stop?', seen.keeping()):
            raise ValueError('cancelled: nothing was moved')
        floor = Floor(seen, commands, questions, step_time, turning_speed(parameters))
        floor.run()
        return seen.collector, floor.answers
