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

"""What swerve_node costs above a node that does nothing: CPU, latency, memory, rate."""

from contextlib import contextmanager
import os
from pathlib import Path
import subprocess
import sys
import time
from typing import NamedTuple

from figures import Figure
from node_client import Client, NANOSECONDS
import numpy as np
import rclpy
from swerve_kinematics.ros.executor_choice import SWITCH
from swerve_kinematics.tools.processes import end

ROUNDS = 7
RATE = 100  # Hz, of joint states and of twists
DURATION = 3.0  # s, of each measurement
SETTLING = 0.5  # s, after the start
RATES = range(1000, 99, -50)  # Hz
RATE_DURATION = 10.0  # s

# Like the floor, the node sends no transform.
NODE = ['-m', 'swerve_kinematics.ros.node', '--ros-args', '-p', 'enable_odom_tf:=false']
FLOOR = [str(Path(__file__).with_name('floor_node.py')), '--ros-args']
BY_RCLPY = {SWITCH: 'rclpy'}


class Program(NamedTuple):
    """A program to be measured: its command line, and what it finds in its environment."""

    command: list
    environment: dict


# The node as it is, the node under rclpy's own executor, and a node that does nothing under it.
PROGRAMS = {'node': Program(NODE, {}), 'node_in_rclpy': Program(NODE, BY_RCLPY),
            'floor': Program(FLOOR, {})}
# What messages cost is measured with few ticks of the control timer between them. One set of
# joint states is then enough for the node to go on driving.
FEW_TICKS = ['-p', 'control_rate:=5.0', '-p', 'feedback_timeout:=60.0']

TARGETS = {
    'CPU per JointState': ('us', 'ratio <= 0.55'),
    'CPU per Twist': ('us', 'ratio <= 0.55'),
    'part of the DDS threads in it, per JointState': ('%', ''),
    'joint_states -> odom, median': ('us', 'ratio <= 0.9'),
    'joint_states -> odom, 99th percentile': ('us', 'ratio <= 1.0'),
    'cmd_vel -> command, median': ('us', 'ratio <= 0.9'),
    'cmd_vel -> command, 99th percentile': ('us', 'ratio <= 1.0'),
    'idle CPU': ('% of a core', 'value <= 1'),
    'resident memory': ('MB', 'difference <= 5'),
    'start to first command': ('s', 'ratio <= 1.1'),
}


class NodeProcess:
    """A node in a process of its own, and what the kernel says that it uses."""

    def __init__(self, name, arguments):
        """Start the node of this name in the namespace of the same name."""
        self.started = time.monotonic_ns()
        program = PROGRAMS[name]
        self._process = subprocess.Popen(
            [sys.executable, *program.command, *arguments, '-r', f'__ns:=/{name}'],
            env={**os.environ, **program.environment})

    def cpu_time(self):
        """Return the CPU time [s] of all its threads, by POSIX's clock of that process."""
        return time.clock_gettime(~self._process.pid << 3 | 2)

    def main_thread_time(self):
        """Return the CPU time [s] of its main thread; all others are those of DDS."""
        stat = Path(f'/proc/{self._process.pid}/task/{self._process.pid}/schedstat')
        return int(stat.read_text().split()[0]) / NANOSECONDS

    def memory(self):
        """Return the resident memory [MB]."""
        pages = int(Path(f'/proc/{self._process.pid}/statm').read_text().split()[1])
        return pages * os.sysconf('SC_PAGE_SIZE') / 1e6

    def end(self):
        """End it, and wait until it has."""
        end(self._process)


@contextmanager
def running(names, arguments):
    """Run nodes while the block runs; yield a client, processes and start-up times [s]."""
    client = Client([f'/{name}' for name in names])
    processes, start_up = [], []
    try:
        for index, name in enumerate(names):
            processes.append(NodeProcess(name, arguments))
            start_up.append(
                (client.wait_for_command(index) - processes[-1].started) / NANOSECONDS)
        client.wait_for_odometry()
        time.sleep(SETTLING)
        yield client, processes, np.array(start_up)
    finally:
        for process in processes:
            process.end()
        client.close()


def at_rest(names):
    """Return the figures of nodes that run together, as people start them, and do nothing."""
    with running(names, []) as (_, processes, start_up):
        _, idle = cpu_time_during(processes, lambda: time.sleep(DURATION))
        return {'idle CPU': 100.0 * idle, 'start to first command': start_up}


def at_work(names):
    """
    Return the figures of nodes that run together and answer messages, by name of the figure.

    The client turns from one node to the next with every message: what else the machine does
    meets all of them alike.
    """
    with running(names, FEW_TICKS) as (client, processes, _):
        before = np.array([process.main_thread_time() for process in processes])
        start = time.monotonic()
        joint_states, joints_cpu = cpu_time_during(
            processes, lambda: client.exchange_joint_states(RATE, DURATION))
        after = np.array([process.main_thread_time() for process in processes])
        main_cpu = (after - before) / (time.monotonic() - start)
        twists, twists_cpu = cpu_time_during(
            processes, lambda: client.exchange_twists(RATE, DURATION))
        feedback, command = latencies(joint_states), latencies(twists)
        return {
            'CPU per JointState': 1e6 * joints_cpu / RATE,
            'CPU per Twist': 1e6 * twists_cpu / RATE,
            'part of the DDS threads in it, per JointState':
                100.0 * (1.0 - main_cpu / joints_cpu),
            'joint_states -> odom, median': feedback[0],
            'joint_states -> odom, 99th percentile': feedback[1],
            'cmd_vel -> command, median': command[0],
            'cmd_vel -> command, 99th percentile': command[1],
            'resident memory': np.array([process.memory() for process in processes]),
        }


def cpu_time_during(processes, action):
    """Return what the action returns, and CPU time per time of each process meanwhile."""
    def clocks():
        return np.array([time.monotonic()] + [process.cpu_time() for process in processes])

    before = clocks()
    result = action()
    elapsed, *cpu_times = clocks() - before
    return result, np.array(cpu_times) / elapsed


def latencies(exchanges):
    """Return median and 99th percentile [us] of the latencies, for each node."""
    return np.array([1e6 * np.percentile(exchange.latencies, (50, 99))
                     for exchange in exchanges]).T


def highest_lossless_rate(name):
    """Return the highest of RATES [Hz] at which no odometry is lost, 0 if there is none."""
    def is_lossless(client, rate):
        time.sleep(SETTLING)
        exchange, = client.exchange_joint_states(rate, RATE_DURATION, to_first_loss=True)
        return not exchange.unanswered

    with running([name], []) as (client, _, _):
        return next((rate for rate in RATES if is_lossless(client, rate)), 0)


def figures():
    """Return the figures of the node, and of the node under rclpy, against the floor."""
    rclpy.init()
    try:
        names = list(PROGRAMS)
        rounds = [measured(names[index % 3:] + names[:index % 3]) for index in range(ROUNDS)]
        lossless = {name: highest_lossless_rate(name) for name in names}
    finally:
        rclpy.try_shutdown()
    result = []
    for name, (unit, target) in TARGETS.items():
        node, in_rclpy, floor = zip(*([values[name][program] for program in names]
                                      for values in rounds))
        result += [Figure(name, unit, node, 'floor', floor, target),
                   Figure(f'the same under rclpy: {name}', unit, in_rclpy, 'floor', floor)]
    node, _, floor = ((lossless[name],) for name in names)
    return result + [Figure('highest lossless rate of joint states', 'Hz', node, 'floor', floor,
                            'ratio >= 1.0')]


def measured(names):
    """Return the figures of one round: for each, the value of each program by its name."""
    values = {**at_work(names), **at_rest(names)}
    return {figure: dict(zip(names, value)) for figure, value in values.items()}
