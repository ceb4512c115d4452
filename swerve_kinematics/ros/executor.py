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

It relies on what is under rclpy's public interface. `executor_choice` lists that, and takes
rclpy's own where a release lacks any of it, or SWERVE_KINEMATICS_EXECUTOR=rclpy is set.
"""

from time import monotonic_ns
from typing import Any, Callable

from rclpy.executors import Executor, ExternalShutdownException
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.utilities import timeout_sec_to_nsec

from swerve_kinematics.ros.plain_calls import plain_call
from swerve_kinematics.ros.wait_set import Entry, WaitSet


class PersistentExecutor(Executor):
    """Calls what is ready in the thread that spins; makes a wait set only when nodes change."""

    def __init__(self, **options: Any) -> None:
        """Start without nodes; `options` are those of `rclpy.executors.Executor`."""
        super().__init__(**options)
        self._wait_set: WaitSet | None = None
        self._is_waiting = self._signals_end_context = False

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop, as `rclpy.executors.Executor.shutdown` does, from any thread."""
        is_done = super().shutdown(timeout_sec)
        if not self._is_waiting:  # or else it is still in use, and forgotten as soon as it is not
            self._forget()
        return is_done

    def _forget(self) -> None:
        """Let go of the wait set; the next turn gathers a new one."""
        wait_set, self._wait_set = self._wait_set, None
        if wait_set is not None:
            wait_set.close()

    def spin_once_until_future_complete(self, future: Any, timeout_sec: Any = None) -> None:
        """Do as `spin_once`, and return when the future is done."""
        future.add_done_callback(lambda _: self.wake())
        # rclpy tells how much of the time is left by a number, or by an object that has it.
        self.spin_once(getattr(timeout_sec, 'timeout', timeout_sec), future.done)

    _spin_once_until_future_complete = spin_once_until_future_complete  # as Kilted calls it

    def spin_once(self, timeout_sec: float | None = None,
                  is_over: Callable[[], bool] = lambda: False) -> None:
        """Wait, at most `timeout_sec` [s] if given, until something can be called; call it all."""
        left = timeout_sec_to_nsec(timeout_sec)
        end = monotonic_ns() + left
        if self._tasks:
            self._run_tasks()
        while not (self._turn(left) or self._tasks or self._is_shutdown or is_over()):
            if left >= 0 and (left := end - monotonic_ns()) <= 0:
                break
        if self._tasks and not self._is_shutdown:  # what one waits for may just have happened
            self._run_tasks()

    def _turn(self, timeout: int) -> bool:
        """Wait once, at most `timeout` [ns] unless negative; tell whether anything was ready."""
        ready, triggered = list[Entry](), True
        self._is_waiting = True
        try:
            if not self._is_shutdown:
                # All are looked up before the first is called: a callback may change the nodes.
                ready, triggered = (self._wait_set or self._gathered()).wait(timeout)
        except _rclpy.InvalidHandle:
            pass  # an event's publisher or subscription is gone
        finally:
            self._is_waiting = False
        if triggered or self._is_shutdown:
            self._forget()
        if (triggered or self._signals_end_context) and not self._is_shutdown:
            self._check_context()  # whose end triggers a guard condition too, but not at once
        for entity, call in ready:
            if self._is_shutdown:
                break
            # Only tasks keep others from being called.
            if not self._tasks or self.can_execute(entity):
                call()
        return bool(ready)

    def _gathered(self) -> WaitSet:
        """Return a wait set of all that the nodes have now."""
        self._check_context()
        self._signals_end_context = (
            _rclpy.get_current_signal_handlers_options() != _rclpy.SignalHandlerOptions.NO)
        guards = [guard.handle for guard in (self._guard, self._sigint_gc) if guard]
        self._wait_set = WaitSet(
            self.get_nodes(), guards, self._context, self.can_execute, self._call_for)
        return self._wait_set

    def _check_context(self) -> None:
        """Raise an exception if the context is shut down."""
        if not self._context.ok():
            raise ExternalShutdownException()

    def _call_for(self, entity: Any, node: Any, name: str, take: str) -> Callable[[], object]:
        """Return a plain call for timers and subscriptions, rclpy's handler for all else."""
        def call() -> None:
            """Call it, unless another callback has destroyed, cancelled or reset it."""
            if entity in getattr(node, name) and (name != 'timers' or entity.is_ready()):
                self._run(self._make_handler(entity, node, getattr(self, take)))
        return plain_call(entity, take) or call

    def _run_tasks(self) -> None:
        """Forget the tasks of this executor that are done or cancelled; go on with the others."""
        with self._tasks_lock:
            self._tasks = [entry for entry in self._tasks
                           if not (entry[0].done() or entry[0].cancelled())]
        for task, *_ in list(self._tasks):
            self._run(task)

    def _run(self, task: Any) -> None:
        """Run a task up to its end or its next wait; raise what it raises."""
        task()
        if task.done():
            self.wake()  # what waits for it goes on in the next turn
            if task.exception() is not None:
                raise task.exception()
