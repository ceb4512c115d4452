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

"""Our executor does what rclpy's does: whatever is asked of it here is asked of both."""

import os
import subprocess
import sys
import threading
import time

from executor_graph import PATIENCE, talk
import pytest
from rcl_interfaces.srv import SetParameters
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import ClockType
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.task import Future
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Int64
from std_srvs.srv import Trigger

from swerve_kinematics.ros.executor_choice import SWITCH
from swerve_kinematics.ros.wait_set import Unhurried


def test_messages_arrive_in_order_and_none_is_lost(graph):
    publisher, heard = talk(graph, qos=100)
    for number in range(100):
        publisher.publish(Int64(data=number))
    graph.spin_until(lambda: len(heard) == 100, 'all numbers')
    assert heard == list(range(100))


def test_a_subscription_may_be_made_and_destroyed_in_a_callback(graph):
    publisher, heard = talk(graph)
    late = []

    def exchange():
        timer.cancel()
        graph.node.destroy_subscription(next(iter(graph.node.subscriptions)))
        graph.node.create_subscription(
            Int64, 'numbers', lambda message: late.append(message.data), 10)
    timer = graph.node.create_timer(0.01, exchange)
    graph.spin_until(timer.is_canceled, 'the exchange')
    graph.spin_until(lambda: publisher.get_subscription_count() == 1, 'the new subscription')
    graph.spin_until(lambda: publisher.publish(Int64(data=7)) or late, 'a number')
    assert late[0] == 7 and heard == []


def test_a_turn_lasts_until_something_is_called_however_often_it_is_woken(graph):
    ticks = []
    graph.node.create_timer(0.05, lambda: ticks.append(1))
    for count in range(1, 4):
        graph.executor.remove_node(graph.node)  # as rclpy.spin_once does
        graph.executor.add_node(graph.node)
        graph.executor.spin_once(timeout_sec=PATIENCE)
        assert len(ticks) == count


def test_a_turn_lasts_no_longer_than_it_may_and_no_longer_than_a_future(graph):
    begin = time.monotonic()
    waker = threading.Timer(0.02, graph.executor.wake)
    waker.start()
    graph.executor.spin_once(timeout_sec=0.1)
    assert 0.09 < time.monotonic() - begin < PATIENCE
    future = Future()
    setter = threading.Timer(0.02, future.set_result, [7])
    setter.start()
    graph.executor.spin_until_future_complete(future)
    assert future.result() == 7
    for thread in (waker, setter):
        thread.join()


def test_a_node_may_come_and_go(graph):
    publisher, heard = talk(graph)
    other, ticks = graph.add('other'), []
    other.create_timer(0.01, lambda: ticks.append(1))
    graph.spin_until(lambda: len(ticks) > 3, 'the timer of the other node')
    graph.executor.remove_node(other)
    graph.spin_until(lambda: publisher.publish(Int64(data=1)) or len(heard) > 3, 'numbers')
    other.destroy_node()
    count = len(ticks)
    graph.spin_until(lambda: publisher.publish(Int64(data=1)) or len(heard) > 20, 'numbers')
    assert len(ticks) == count


def test_a_timer_may_be_reset_cancelled_and_paced_anew(graph):
    ticks, calls = [], []

    def tick():
        calls.append(1)
        slow.reset()  # never gets round to it
        if len(calls) == 20:
            fast.cancel()
    slow = graph.node.create_timer(0.2, lambda: ticks.append(1))
    fast = graph.node.create_timer(0.02, tick)
    graph.spin_until(fast.is_canceled, 'twenty calls')
    assert ticks == []
    graph.spin_until(lambda: ticks, 'the slow timer')
    assert len(calls) == 20
    slow.timer_period_ns = 1_000_000
    graph.spin_until(lambda: len(ticks) > 20, 'the faster pace')


def test_what_is_unhurried_comes_while_others_stream(graph):
    stream, ticks, heard = [], [], []
    graph.node.create_timer(0.005, lambda: stream.append(1))
    graph.node.create_timer(0.02, lambda: ticks.append(1), callback_group=Unhurried())
    graph.node.create_subscription(Int64, 'numbers', lambda message: heard.append(message.data),
                                   10, callback_group=Unhurried())
    publisher = graph.node.create_publisher(Int64, 'numbers', 10)
    graph.spin_until(lambda: publisher.get_subscription_count() == 1, 'the subscription')
    graph.spin_until(lambda: len(stream) > 20, 'the stream')
    for number in range(4):
        publisher.publish(Int64(data=number))
    del ticks[:]
    graph.spin_until(lambda: len(heard) == 4 and len(ticks) > 3, 'numbers and ticks')
    assert heard == [0, 1, 2, 3]


# rclpy's own takes one message in a turn, so a service may overtake those that have come.
@pytest.mark.parametrize('graph', ['PersistentExecutor'], indirect=True)
def test_a_service_that_is_called_after_unhurried_messages_finds_them_heard(graph):
    stream, heard, before = [], [], []

    def answer(_, response):
        before.append(list(heard))
        return response
    graph.node.create_timer(0.005, lambda: stream.append(1))
    graph.node.create_subscription(Int64, 'numbers', lambda message: heard.append(message.data),
                                   10, callback_group=Unhurried())
    graph.node.create_service(Trigger, 'service', answer)
    publisher = graph.node.create_publisher(Int64, 'numbers', 10)
    client = graph.node.create_client(Trigger, 'service')
    graph.spin_until(lambda: publisher.get_subscription_count() == 1, 'the subscription')
    graph.spin_until(client.service_is_ready, 'the service')
    graph.spin_until(lambda: len(stream) > 20, 'the stream')
    for number in range(8):
        publisher.publish(Int64(data=number))
    future = client.call_async(Trigger.Request())
    graph.spin_until(future.done, 'the answer')
    assert before == [[*range(8)]]


def test_services_clients_and_parameters_answer(graph):
    def answer(_, response):
        response.message = 'done'
        return response
    graph.node.create_service(Trigger, 'service', answer)
    graph.node.declare_parameter('number', 1)
    future = graph.node.create_client(Trigger, 'service').call_async(Trigger.Request())
    graph.spin_until(future.done, 'the answer')
    assert future.result().message == 'done'
    client = graph.node.create_client(SetParameters, f'{graph.namespace}/subject/set_parameters')
    request = SetParameters.Request(parameters=[Parameter('number', value=2).to_parameter_msg()])
    graph.spin_until(client.service_is_ready, 'the parameter service')
    future = client.call_async(request)
    graph.executor.spin_until_future_complete(future, timeout_sec=PATIENCE)
    assert future.result().results[0].successful
    assert graph.node.get_parameter('number').value == 2


def test_a_coroutine_may_wait_for_a_service(graph):
    group = ReentrantCallbackGroup()
    graph.node.create_service(
        Trigger, 'service', lambda _, response: response, callback_group=group)
    client = graph.node.create_client(Trigger, 'service', callback_group=group)
    answers = []

    async def ask():
        timer.cancel()
        answers.append(await client.call_async(Trigger.Request()))
    timer = graph.node.create_timer(0.01, ask, callback_group=group)
    graph.spin_until(lambda: answers, 'the answer in the coroutine')


def test_another_thread_wakes_it(graph):
    done, guarded = [], []
    guard = graph.node.create_guard_condition(lambda: guarded.append(1))
    graph.executor.spin_once(timeout_sec=0.0)

    def disturb():
        graph.executor.create_task(lambda: done.append(1))
        guard.trigger()
    thread = threading.Timer(0.05, disturb)
    thread.start()
    deadline = time.monotonic() + PATIENCE
    while not (done and guarded):
        assert time.monotonic() < deadline
        graph.executor.spin_once()  # without an end of its own
    thread.join()


def test_events_of_publishers_are_handled(graph):
    reports = []
    graph.node.create_publisher(
        Int64, 'reliable', QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT),
        event_callbacks=PublisherEventCallbacks(incompatible_qos=reports.append))
    graph.node.create_subscription(Int64, 'reliable', lambda _: None, 10)
    graph.spin_until(lambda: reports, 'the report of incompatible settings')


def test_simulated_time_may_begin_run_fast_pause_and_jump(graph):
    ticks = []
    clock = graph.node.create_publisher(Clock, '/clock', 10)
    graph.node.create_timer(0.5, lambda: ticks.append(
        graph.node.get_clock().now().nanoseconds))
    graph.node.set_parameters([Parameter('use_sim_time', value=True)])
    graph.spin_until(lambda: clock.get_subscription_count() > 0, 'the clock subscription')

    def pass_to(second):
        message = Clock()
        message.clock.sec = second
        clock.publish(message)
        graph.spin_until(
            lambda: graph.node.get_clock().now().nanoseconds == second * 10 ** 9, 'the time')
    for second in range(1, 11):
        pass_to(second)
    graph.spin_until(lambda: len(ticks) > 3, 'ticks in simulated time')
    graph.executor.spin_once(timeout_sec=0.05)
    count = len(ticks)
    for _ in range(5):
        graph.executor.spin_once(timeout_sec=0.02)
    assert len(ticks) == count  # time stands still
    pass_to(3)
    for second in range(4, 12):
        pass_to(second)
    graph.spin_until(lambda: len(ticks) > count, 'ticks after the jump')
    assert graph.node.get_clock().clock_type == ClockType.ROS_TIME


# What a release of rclpy may lack: a method, something of the bindings, what an executor has.
LACKING = """
from rclpy.executors import Executor
from rclpy.impl.implementation_singleton import rclpy_implementation
make = Executor.__init__
def make_without_tasks(self, **options):
    make(self, **options)
    del self._tasks
del Executor._take_waitable, rclpy_implementation.WaitSet.wait
del rclpy_implementation.get_current_signal_handlers_options
Executor.__init__ = make_without_tasks
"""


@pytest.mark.parametrize('preparation, expected, said', [
    ('', 'PersistentExecutor', ''),
    ('import os; os.environ["SWERVE_KINEMATICS_EXECUTOR"] = "rclpy"',
     'SingleThreadedExecutor', ''),
    (LACKING, 'SingleThreadedExecutor',
     'rclpy has no _take_waitable, get_current_signal_handlers_options, WaitSet.wait, _tasks: '
     'using its own executor')])
def test_which_executor_is_used(preparation, expected, said):
    code = (f'{preparation}\nimport rclpy; rclpy.init()\n'
            'from swerve_kinematics.ros.executor_choice import make_executor\n'
            'print(type(make_executor()).__name__)')
    environment = {name: value for name, value in os.environ.items()
                   if name != SWITCH}
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True,
                          env=environment, check=True)
    assert done.stdout.strip() == expected
    assert done.stderr.strip() == said
