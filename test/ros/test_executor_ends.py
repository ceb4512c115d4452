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

"""What ends a turn of our executor, or its life, is what ends rclpy's: exceptions, shutdowns."""

import subprocess
import sys
import threading
import time
import weakref

from executor_graph import PATIENCE, talk
import pytest
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.task import Future
from std_msgs.msg import Int64
from std_srvs.srv import Trigger


def test_an_exception_comes_out_once_and_spinning_goes_on(graph):
    publisher, heard = talk(graph)

    def fail():
        timer.cancel()
        raise ZeroDivisionError('as planned')
    timer = graph.node.create_timer(0.01, fail)
    with pytest.raises(ZeroDivisionError, match='as planned'):
        graph.spin_until(lambda: False)
    graph.spin_until(lambda: publisher.publish(Int64(data=1)) or heard, 'a number')


def test_what_a_callback_does_with_something_destroyed_comes_out(graph):
    gone = graph.node.create_publisher(Int64, 'gone', 10)
    gone.destroy()
    graph.node.create_timer(0.01, lambda: gone.publish(Int64()))
    with pytest.raises(_rclpy.InvalidHandle):
        graph.spin_until(lambda: False, 'the exception')


def test_an_exception_in_a_service_comes_out_once(graph):
    def fail(_, response):
        raise ZeroDivisionError('as planned')
    graph.node.create_service(Trigger, 'service', fail)
    client = graph.node.create_client(Trigger, 'service')
    graph.spin_until(client.service_is_ready, 'the service')
    client.call_async(Trigger.Request())
    with pytest.raises(ZeroDivisionError):
        graph.spin_until(lambda: False)
    publisher, heard = talk(graph)
    graph.spin_until(lambda: publisher.publish(Int64(data=1)) or heard, 'a number')


def test_an_exception_loses_no_trigger(graph):
    called = []

    def fail():
        called.append('failure')
        raise ZeroDivisionError('as planned')
    guards = [graph.node.create_guard_condition(callback) for callback in (
        lambda: called.append('first'), fail, lambda: called.append('last'))]
    graph.executor.spin_once(timeout_sec=0.0)
    for guard in guards:
        guard.trigger()
    with pytest.raises(ZeroDivisionError):
        graph.spin_until(lambda: False, 'the exception')
    graph.spin_until(lambda: len(called) == 3, 'the other guard conditions')
    assert set(called) == {'first', 'failure', 'last'}


def test_a_callback_group_that_is_busy_loses_no_trigger(graph):
    group, end, called = MutuallyExclusiveCallbackGroup(), Future(), []

    async def wait():
        called.append('begun')
        await end
    first = graph.node.create_guard_condition(wait, callback_group=group)
    second = graph.node.create_guard_condition(
        lambda: called.append('second'), callback_group=group)
    graph.executor.spin_once(timeout_sec=0.0)
    first.trigger()
    second.trigger()
    graph.spin_until(lambda: 'begun' in called, 'the first')
    end.set_result(None)
    graph.executor.wake()
    graph.spin_until(lambda: 'second' in called, 'the second')


def test_a_cancelled_task_is_forgotten(graph):
    async def wait():
        await Future()
    task = graph.executor.create_task(wait)
    graph.executor.spin_once(timeout_sec=0.0)
    task.cancel()
    is_there = weakref.ref(task)
    del task
    graph.spin_until(lambda: is_there() is None, 'the end of the task')


@pytest.mark.parametrize('from_callback', [True, False])
def test_a_context_that_is_shut_down_ends_it(graph, from_callback):
    if from_callback:
        graph.node.create_timer(0.01, graph.context.shutdown)
    else:
        threading.Timer(0.05, graph.context.shutdown).start()
    try:
        graph.executor.spin()
    except ExternalShutdownException:
        pass
    assert not graph.context.ok()


# A stream of callbacks, and a signal between the twentieth and the next; prints how many come
# after the end of the context.
SIGNALLED = """
import os, signal, threading
import rclpy
from rclpy.executors import ExternalShutdownException
from swerve_kinematics.ros.executor import PersistentExecutor
rclpy.init()
node, calls, late = rclpy.create_node('signalled'), [], []
def tick():
    (calls if rclpy.ok() else late).append(1)
    if len(calls) == 20:
        threading.Timer(0.005, os.kill, (os.getpid(), signal.SIGTERM)).start()
node.create_timer(0.01, tick)
executor = PersistentExecutor()
executor.add_node(node)
try:
    executor.spin()
except ExternalShutdownException:
    pass
print(len(late))
"""


def test_a_signal_that_rclpy_handles_ends_it_before_the_next_callback():
    done = subprocess.run([sys.executable, '-c', SIGNALLED], capture_output=True, text=True,
                          check=True, timeout=PATIENCE)
    assert int(done.stdout) == 0


def test_it_may_be_shut_down_in_a_callback(graph):
    ticks = []

    def end():
        ticks.append(1)
        graph.executor.shutdown(timeout_sec=0.0)
    graph.node.create_timer(0.01, end)
    graph.executor.spin()
    assert ticks == [1]


def test_another_thread_may_shut_it_down_while_it_waits(graph):
    publisher, heard = talk(graph)
    for count in range(1, 11):
        executor = type(graph.executor)(context=graph.context)
        executor.add_node(graph.node)
        thread = threading.Thread(target=executor.spin, daemon=True)
        thread.start()
        publisher.publish(Int64(data=count))
        deadline = time.monotonic() + PATIENCE
        while len(heard) < count:
            assert time.monotonic() < deadline
        executor.shutdown()
        thread.join(PATIENCE)
        assert not thread.is_alive()
