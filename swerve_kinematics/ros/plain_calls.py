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


def call_of_timer(timer: Any) -> Callable[[], None]:
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


def call_of_subscription(subscription: Any) -> Callable[[], None]:
    """Return what calls a subscription with its next message, unless it is taken or destroyed."""
    handle, kind, raw = subscription.handle, subscription.msg_type, subscription.raw
    take = handle.take_message
    message_only = Subscription.CallbackType.MessageOnly

    def call() -> None:
        """Call it if there is a message."""
        try:
            with handle:
                taken = take(kind, raw)
        except _rclpy.InvalidHandle:
            return
        if taken is None:
            return
        if subscription._callback_type is message_only:
            subscription.callback(taken[0])
        else:
            subscription.callback(*taken)
    return call


# What makes the plain call, by the method of rclpy's Executor that takes the entity.
PLAIN = {'_take_timer': call_of_timer, '_take_subscription': call_of_subscription}


def plain_call(entity: Any, take: str) -> Callable[[], None] | None:
    """Return the plain call of an entity; None if it has a coroutine, or is of another kind."""
    make = PLAIN.get(take)
    return None if make is None or iscoroutinefunction(entity.callback) else make(entity)
