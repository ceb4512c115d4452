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
Which executor spins a process: ours, or rclpy's own.

Ours relies on what is under rclpy's public interface, which a release may change.
"""

from operator import attrgetter
import os
import sys
from typing import Any

from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.subscription import Subscription

from swerve_kinematics.ros.executor import PersistentExecutor
from swerve_kinematics.ros.wait_set import KINDS

SWITCH = 'SWERVE_KINEMATICS_EXECUTOR'
HANDLES = ('Timer', 'Subscription', 'GuardCondition', 'Client', 'Service')
RELIES_ON = (
    (Executor, ('can_execute', '_make_handler', '_take_waitable', *(take for *_, take in KINDS))),
    (_rclpy, ('get_current_signal_handlers_options', 'SignalHandlerOptions.NO',
              'InvalidHandle', 'WaitSet.clear_entities', 'WaitSet.wait',
              'WaitSet.get_ready_entities', *(f'WaitSet.add_{kind}' for _, kind, _ in KINDS),
              'Timer.is_timer_ready', 'Timer.call_timer', 'Subscription.take_message',
              *(f'{handle}.pointer' for handle in HANDLES))),
    (Subscription, ('CallbackType.MessageOnly',)))
# What only an executor has that was made, not its class.
OF_AN_EXECUTOR = ('_context', '_guard._executor_triggered', '_is_shutdown', '_sigint_gc',
                  '_tasks', '_tasks_lock')


def make_executor() -> Executor:
    """Return a PersistentExecutor; rclpy's own where the switch or this rclpy want that."""
    if os.environ.get(SWITCH) == 'rclpy':
        return SingleThreadedExecutor()
    executor = PersistentExecutor()
    if not (missing := _missing_under(executor)):
        return executor
    print(f"rclpy has no {', '.join(missing)}: using its own executor", file=sys.stderr)
    executor.shutdown()
    return SingleThreadedExecutor()


def _missing_under(executor: Executor) -> list[str]:
    """Return the names of what this rclpy lacks, an executor of which is given."""
    return [name for owner, names in (*RELIES_ON, (executor, OF_AN_EXECUTOR))
            for name in names if not _has(owner, name)]


def _has(owner: object, name: str) -> bool:
    """Tell whether an object has an attribute; a name with dots leads to one of another."""
    find: Any = attrgetter(name)
    try:
        find(owner)
    except AttributeError:
        return False
    return True
