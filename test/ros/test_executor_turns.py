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

"""What a callback does to others that are due in the same turn, and what waits for it."""

import time

from executor_graph import PATIENCE
import pytest
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.task import Future
from std_msgs.msg import Int64


@pytest.mark.parametrize('stop', ['cancel', 'reset', 'destroy'])
def test_a_coroutine_of_a_timer_that_another_one_has_stopped_is_not_called(graph, stop):
    called = []

    def stop_second():
        called.append('first')
        if stop == 'destroy':
            graph.node.destroy_timer(second)
        else:
            getattr(second, stop)()

    async def call():
        called.append('second')
    graph.node.create_timer(0.01, stop_second)
    second = graph.node.create_timer(0.05, call)
    while not second.is_ready():
        time.sleep(0.001)
    graph.spin_until(lambda: called.count('first') > 2, 'the first timer')
    assert 'second' not in called


def test_a_guard_condition_that_another_one_has_destroyed_is_not_called(graph):
    called, guards = [], []

    def destroy_all():
        called.append(1)
        while guards:
            graph.node.destroy_guard_condition(guards.pop())
    guards += [graph.node.create_guard_condition(destroy_all) for _ in range(3)]
    graph.executor.spin_once(timeout_sec=0.0)
    for guard in guards:
        guard.trigger()
    graph.spin_until(lambda: called, 'the first')
    graph.executor.spin_once(timeout_sec=0.05)
    assert called == [1]


def test_an_event_of_a_publisher_that_another_event_has_destroyed_is_not_handled(graph):
    handled, publishers = [], []

    def destroy_all(_):
        handled.append(1)
        while publishers:
            graph.node.destroy_publisher(publishers.pop())
    events = PublisherEventCallbacks(matched=destroy_all, use_default_callbacks=False)
    for topic in 'abc':
        publishers.append(
            graph.node.create_publisher(Int64, topic, 10, event_callbacks=events))
        graph.node.create_subscription(Int64, topic, lambda _: None, 10)
    while not all(publisher.get_subscription_count() for publisher in publishers):
        time.sleep(0.001)
    graph.spin_until(lambda: handled, 'the first event')
    graph.executor.spin_once(timeout_sec=0.05)
    assert handled == [1]


def spin_in_turns_until(graph, done):
    """Spin until a list has an entry, in turns that have to end by themselves."""
    begin = time.monotonic()
    while not done:
        graph.executor.spin_once(timeout_sec=PATIENCE)
    assert time.monotonic() - begin < PATIENCE


@pytest.mark.parametrize('fails', [False, True])
def test_a_turn_ends_when_a_coroutine_has_got_what_it_waits_for(graph, fails):
    future, done = Future(), []

    async def wait():
        done.append(await future)

    def set_result():
        timer.cancel()
        future.set_result(7)
        if fails:
            raise ZeroDivisionError('as planned')
    graph.executor.create_task(wait)
    # Slower than what is a stream of messages, with which a turn is short.
    timer = graph.node.create_timer(0.05, set_result)
    if fails:
        with pytest.raises(ZeroDivisionError):
            graph.spin_until(lambda: False, 'the exception')
    spin_in_turns_until(graph, done)
    assert done == [7]


# Kilted's own waits for something else to come.
@pytest.mark.parametrize('graph', ['PersistentExecutor'], indirect=True)
def test_a_turn_ends_when_a_task_has_got_what_it_waits_for_from_others(graph):
    done = []

    async def count(number):
        return 1 + await graph.executor.create_task(count, number - 1) if number else 0

    async def wait():
        done.append(await graph.executor.create_task(count, 20))
    graph.executor.create_task(wait)
    spin_in_turns_until(graph, done)
    assert done == [20]
