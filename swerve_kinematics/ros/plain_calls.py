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
Timers and subscriptions called plainly, where rclpy makes a task and a coroutine for each call.

An entity may have been destroyed since it was found ready; what its callback raises comes out.
"""

from collections.abc import Callable
from inspect import iscoroutinefunction
from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.subscription import Subscription

from swerve_kinematics.ros.wait_set import Unhurried

# So many messages are handed over in a row: senders that never cease must not hold up the rest.
BACKLOG = 20


def call_of_timer(timer: Any) -> Callable[[], object]:
    """Return what calls a timer, unless another callback has cancelled, reset or destroyed it."""
    handle = timer.handle

    def call() -> None:
        """Call it if it is ready."""
        try:
            with handle:
                if not handle.is_timer_ready():
                    return
                handle.call_timer()
        except _rclpy.InvalidHandle:
            return
        timer.callback()
    return call


def call_of_subscription(subscription: Any) -> Callable[[], object]:
    """
    Return what calls a subscription with its next message, unless it is taken or destroyed.

    One that is Unhurried is called with all that have come: they are older than the call of a
    service that is looked at together with them.
    """
    handle, kind, raw = subscription.handle, subscription.msg_type, subscription.raw
    take = handle.take_message
    message_only = Subscription.CallbackType.MessageOnly

    def call() -> bool:
        """Call it if there is a message, and tell whether there was."""
        try:
            with handle:
                taken = take(kind, raw)
        except _rclpy.InvalidHandle:
            return False
        if taken is None:
            return False
        if subscription._callback_type is message_only:
            subscription.callback(taken[0])
        else:
            subscription.callback(*taken)
        return True
    if isinstance(subscription.callback_group, Unhurried):
        return lambda: all(call() for _ in range(BACKLOG))
    return call


# What makes the plain call, by the method of rclpy's Executor that takes the entity.
PLAIN = {'_take_timer': call_of_timer, '_take_subscription': call_of_subscription}


def plain_call(entity: Any, take: str) -> Callable[[], object] | None:
    """Return the plain call of an entity; None if it has a coroutine, or is of another kind."""
    make = PLAIN.get(take)
    return None if make is None or iscoroutinefunction(entity.callback) else make(entity)
