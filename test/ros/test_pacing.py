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

"""The control loop wakes a period after the latest command, and for nothing else."""

import time

import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from swerve_kinematics.ros.executor import PersistentExecutor
from swerve_kinematics.ros.pacing import Pacer
from swerve_kinematics.ros.stamps import nanoseconds

PERIOD = nanoseconds(0.02)
PATIENCE = 20.0  # s


@pytest.fixture(params=[PersistentExecutor, SingleThreadedExecutor])
def executor(request):
    """Return an executor that spins a node."""
    context = rclpy.Context()
    context.init()
    executor = request.param(context=context)
    node = Node('paced', context=context)
    executor.add_node(node)
    yield executor
    executor.shutdown()
    node.destroy_node()
    context.try_shutdown()


def paced(executor, is_simulated=False):
    """Return a pacer, and the list of the times [ns] at which it wakes the control loop."""
    ticks = []

    def control():
        ticks.append(time.monotonic_ns())
        pacer.commanded(False, is_simulated)
    node, = executor.get_nodes()
    pacer = Pacer(node, PERIOD, control)
    return pacer, ticks


def spin_until_ticks(executor, ticks, count):
    """Spin until the control loop has been woken so many times."""
    deadline = time.monotonic() + PATIENCE
    while len(ticks) < count:
        assert time.monotonic() < deadline, 'waited in vain for the control loop'
        executor.spin_once(timeout_sec=0.1)


def test_a_command_from_elsewhere_wakes_nobody(executor):
    pacer, _ = paced(executor)
    executor.spin_once(timeout_sec=0.01)
    waits = []
    for _ in range(20):
        pacer.restart()
        start = time.monotonic()
        executor.spin_once(timeout_sec=0.01)
        waits.append(time.monotonic() - start)
    assert sorted(waits)[len(waits) // 2] >= 0.009  # to the end, and not for a moment


@pytest.mark.parametrize('is_simulated', [False, True])
def test_the_loop_wakes_a_period_after_the_latest_command(executor, is_simulated):
    pacer, ticks = paced(executor, is_simulated)
    commands = [time.monotonic_ns()]
    for _ in range(40):
        executor.spin_once(timeout_sec=0.005)
        pacer.commanded(False, is_simulated)
        pacer.restart()
        commands.append(time.monotonic_ns())
    spin_until_ticks(executor, ticks, 3)
    for tick in ticks:
        latest = max(command for command in commands if command < tick)
        assert tick - latest > 0.99 * PERIOD


def test_a_pace_that_quickens_counts_at_once(executor):
    pacer, _ = paced(executor)
    node, = executor.get_nodes()
    timer, = node.timers
    pacer.commanded(is_settled=True, is_simulated=False)
    pacer.restart()
    pacer.commanded(is_settled=False, is_simulated=False)
    pacer.restart()
    assert timer.time_until_next_call() <= PERIOD
