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
A single-threaded executor that keeps its wait set.

rclpy makes a new wait set, a stack of context managers, a task and two coroutines for each
callback, which costs a small node more CPU than all else it does. Here the entities to wait for
are gathered once, and anew only when rclpy triggers the executor's guard condition because some
were added or removed. Timers and subscriptions that are ready are taken and called plainly; all
that is rare (services, clients, guard conditions, events, tasks, coroutines) goes through the
handlers that rclpy's executors share. A timer's callback takes no arguments.

It relies on what is under rclpy's public interface, listed in RELIES_ON. Where a release lacks
any of it, or SWERVE_KINEMATICS_EXECUTOR=rclpy is set, `make_executor` returns rclpy's own.
"""

import inspect
import os
import sys
from typing import Any, Callable

from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.subscription import Subscription
from rclpy.utilities import timeout_sec_to_nsec

from swerve_kinematics.ros.plain_calls import PLAIN
from swerve_kinematics.ros.wait_set import KINDS, WaitSet

SWITCH = 'SWERVE_KINEMATICS_EXECUTOR'
RELIES_ON = (
    (Executor, ('can_execute', '_make_handler', '_take_waitable', *(take for *_, take in KINDS))),
    (_rclpy, ('InvalidHandle',)),
    (_rclpy.WaitSet, ('clear_entities', 'wait', 'get_ready_entities',
                      *(f'add_{kind}' for _, kind, _ in KINDS))),
    (_rclpy.Subscription, ('take_message', 'pointer')),
    (_rclpy.Timer, ('is_timer_ready', 'call_timer', 'pointer')), (Subscription, ('CallbackType',)))


def make_executor() -> Executor:
    """Return a PersistentExecutor; rclpy's own where the switch or this rclpy want that."""
    if os.environ.get(SWITCH) == 'rclpy':
        return SingleThreadedExecutor()
    missing = [f'{owner.__name__}.{name}' for owner, names in RELIES_ON for name in names
               if not hasattr(owner, name)]
    if missing:
        print(f"rclpy has no {', '.join(missing)}: using its own executor", file=sys.stderr)
        return SingleThreadedExecutor()
    return PersistentExecutor()


class PersistentExecutor(Executor):
    """Calls what is ready in the thread that spins; makes a wait set only when nodes change."""

    def __init__(self, **options: Any) -> None:
        """Start without nodes; `options` are those of `rclpy.executors.Executor`."""
        super().__init__(**options)
        self._wait_set: WaitSet | None = None

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop, as `rclpy.executors.Executor.shutdown` does."""
        self._forget()
        return super().shutdown(timeout_sec)

    def _forget(self) -> None:
        """Let go of the wait set; the next turn gathers a new one."""
        if self._wait_set is not None:
            self._wait_set.close()
            self._wait_set = None

    def spin_once_until_future_complete(self, future: Any, timeout_sec: Any = None) -> None:
        """Do as `spin_once`, and return when the future is done."""
        future.add_done_callback(lambda _: self.wake())
        # rclpy tells how much of the time is left by a number, or by an object that has it.
        self.spin_once(getattr(timeout_sec, 'timeout', timeout_sec))

    _spin_once_until_future_complete = spin_once_until_future_complete  # as Kilted calls it

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait, at most `timeout_sec` [s] if given, and call all that is ready then."""
        if self._tasks:
            self._run_tasks()
        if self._is_shutdown:
            return
        if self._wait_set is None:
            self._check_context()
            guards = [guard.handle for guard in (self._guard, self._sigint_gc) if guard]
            self._wait_set = WaitSet(
                self.get_nodes(), guards, self._context, self.can_execute, self._call_for)
        wait_set = self._wait_set
        try:
            # All are looked up before the first is called, for a callback may change the nodes.
            ready, triggered = wait_set.wait(timeout_sec_to_nsec(timeout_sec))
        except _rclpy.InvalidHandle:
            self._forget()  # an event's publisher or subscription is gone
            return
        if self._is_shutdown:
            return
        if triggered:
            self._check_context()  # whose end triggers them too
            self._forget()
        for entity, call in ready:
            if self._is_shutdown:
                return
            # Only tasks keep others from being called.
            if not self._tasks or self.can_execute(entity):
                call()

    def _check_context(self) -> None:
        """Raise an exception if the context is shut down."""
        if not self._context.ok():
            raise ExternalShutdownException()

    def _call_for(self, entity: Any, node: Any, take: str) -> Callable[[], None]:
        """Return a plain call for timers and subscriptions, rclpy's handler for all else."""
        plain_call_of = PLAIN.get(take)
        if plain_call_of is None or inspect.iscoroutinefunction(entity.callback):
            return lambda: self._run(self._make_handler(entity, node, getattr(self, take)))
        return plain_call_of(entity)

    def _run_tasks(self) -> None:
        """Go on with the tasks of this executor, and forget those that are done."""
        for task, *_ in list(self._tasks):
            if not task.done():
                self._run(task)
        with self._tasks_lock:
            self._tasks = [entry for entry in self._tasks if not entry[0].done()]

    def _run(self, task: Any) -> None:
        """Run a task up to its end or its next wait; raise what it raises."""
        task()
        if task.done() and task.exception() is not None:
            raise task.exception()
