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

"""A client on a real graph, and the programs it talks to."""

import multiprocessing
import os
import runpy
import signal
import sys
import time

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
import numpy as np
import rclpy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from swerve_kinematics.ros.executor_choice import make_executor
from swerve_kinematics.ros.stamps import nanoseconds_of

PATIENCE = 20.0  # s, for what takes far less on an idle machine
MODULES = ('front_left', 'front_right', 'rear_left', 'rear_right')
DRIVES = [f'{name}_drive_joint' for name in MODULES]
STEERINGS = [f'{name}_steering_joint' for name in MODULES]
# Importing is most of a start: a process that has done it is forked for each program.
FORKS = multiprocessing.get_context('forkserver')
FORKS.set_forkserver_preload(['rosidl_generator_py', *(
    f'swerve_kinematics.{module}' for module in (
        'ros.node', 'sim.node', 'tools.check.main', 'tools.check.blocks', 'tools.check.floor'))])


def same_moments(messages, others):
    """Return the pairs of messages, such as odometry and truth, that have the same stamp."""
    by_stamp = {nanoseconds_of(other.header.stamp): other for other in others}
    return [(message, by_stamp[stamp]) for message in messages
            if (stamp := nanoseconds_of(message.header.stamp)) in by_stamp]


def speeds_over_time(commands, axis):
    """Return the stamps [s] of TwistStamped messages, and their speeds along an axis [m/s]."""
    return np.transpose([(1e-9 * nanoseconds_of(command.header.stamp),
                          getattr(command.twist.linear, axis)) for command in commands])


def ignored(reports, reason):
    """Return how often the latest of a node's reports says that it ignored input for a reason."""
    counts = {value.key: int(value.value) for value in (reports[-1].values if reports else [])
              if value.key.startswith('ignored: ')}
    return counts.get(f'ignored: {reason}', 0)


class Program:
    """A ROS program of this package in a process of its own."""

    def __init__(self, module, namespace, ros_arguments, parameters, log, options=(),
                 typed=os.devnull):
        """
        Start `python -m module` with options, and with parameters in a namespace.

        Its output goes to a file, and what is typed comes from one.
        """
        arguments = [*options, '--ros-args', '-r', f'__ns:={namespace}', *ros_arguments]
        for name, value in parameters.items():
            arguments += ['-p', f'{name}:={_yaml(value)}']
        self._name, self._log = f'{module} in {namespace}', log
        log.touch()
        self._process = FORKS.Process(
            target=_run, args=(module, arguments, log, typed, dict(os.environ)))
        self._process.start()

    @property
    def output(self):
        """Return what the program has printed."""
        return self._log.read_text()

    def is_running(self):
        """Tell whether the process lives."""
        return self._process.is_alive()

    def wait(self):
        """Return the exit code of a program that ends by itself."""
        self._process.join(PATIENCE)
        assert not self.is_running(), f'waited in vain for the end of {self._name}: {self.output}'
        return self._process.exitcode

    def send(self, by):
        """Send a signal unless the program has ended."""
        if self.is_running():
            os.kill(self._process.pid, by)

    def end(self, by=signal.SIGINT):
        """Send a signal unless the program has ended; return the exit code."""
        self.send(by)
        try:
            return self.wait()
        finally:
            self._process.kill()  # one that waited in vain leaves no program behind


def _run(module, arguments, log, typed, environment):
    """Do in a forked process what `python -m module` does in a new one."""
    with open(log, 'w') as output:
        for stream in 1, 2:
            os.dup2(output.fileno(), stream)
    sys.stdin = open(typed)
    os.environ.update(environment)
    sys.argv = [module, *arguments]
    sys.modules.pop(module, None)  # it begins anew, as the main module
    runpy.run_module(module, run_name='__main__', alter_sys=True)


def _yaml(value):
    """Return a value as the ROS command line takes it."""
    return str(value).lower() if isinstance(value, bool) else str(value).replace("'", '"')


class Client:
    """Publishes to the programs under test and keeps all they publish."""

    def __init__(self, namespace):
        """Create the client's node in a namespace."""
        self.node = rclpy.create_node('client', namespace=namespace)
        self._executor = make_executor()
        self._executor.add_node(self.node)
        self.drive = self.listen(Float64MultiArray, 'drive_velocity_controller/commands')
        self.steering = self.listen(Float64MultiArray, 'steering_position_controller/commands')
        self.odom = self.listen(Odometry, 'odom')
        self._publishers = {}

    def close(self):
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()

    def listen(self, kind, topic, qos=10):
        """Subscribe to a topic; return the list that its messages will be appended to."""
        messages = []
        self.node.create_subscription(kind, topic, messages.append, qos)
        return messages

    def wait_until(self, condition, what):
        """Handle messages until the condition holds; fail, naming it, if it never does."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f'waited in vain for {what}'
            self._executor.spin_once(timeout_sec=0.02)

    def wait_for_count(self, messages, count, what):
        """Wait until `count` more messages have arrived."""
        target = len(messages) + count
        self.wait_until(lambda: len(messages) >= target, what)

    def repeat_until(self, action, condition, what, period=0.02):
        """Do something every `period` seconds until the condition holds."""
        last = [0.0]

        def acted():
            if time.monotonic() - last[0] >= period:
                last[0] = time.monotonic()
                action()
            return condition()
        self.wait_until(acted, what)

    def publisher(self, kind, topic, qos=10):
        """Return a publisher on a topic that someone listens to, made when first asked for."""
        publisher = self._publishers.get(topic)
        if publisher is None:
            publisher = self._publishers[topic] = self.node.create_publisher(kind, topic, qos)
        self.wait_until(lambda: publisher.get_subscription_count() > 0,
                        f'a subscriber of {topic}')
        return publisher

    def send_twist(self, vx=0.0, vy=0.0, omega=0.0):
        """Publish a velocity command."""
        message = Twist()
        message.linear.x, message.linear.y, message.angular.z = vx, vy, omega
        self.publisher(Twist, 'cmd_vel').publish(message)

    def send_joints(self, angles=(0.0,) * 4, turns=(0.0,) * 4, stamp=None, **extra):
        """Publish the joints of the four modules: steering angles and wheel rotations [rad]."""
        message = JointState(name=DRIVES + STEERINGS, position=[*turns, *angles])
        for name, position in extra.items():
            message.name.append(name)
            message.position.append(position)
        message.header.stamp = stamp or self.node.get_clock().now().to_msg()
        self.publisher(JointState, 'joint_states').publish(message)

    def begin_feedback(self, **joints):
        """Send joints until odometry comes back: from then on each message gets through."""
        self.repeat_until(lambda: self.send_joints(**joints), lambda: self.odom, 'odometry')

    def call(self, kind, name, request):
        """Call a service and return its response."""
        service = self.node.create_client(kind, name)
        self.wait_until(service.service_is_ready, f'the service {name}')
        future = service.call_async(request)
        self.wait_until(future.done, f'the answer of {name}')
        return future.result()
