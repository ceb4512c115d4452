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

from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.subscription import Subscription


def call_timer(timer: Any, handle: Any) -> None:
    """Call a timer, unless another callback has cancelled, reset or destroyed it."""
    try:
        with handle:
            if not handle.is_timer_ready():
                return
            handle.call_timer()
    except _rclpy.InvalidHandle:
        return
    timer.callback()


def call_subscription(subscription: Any, handle: Any) -> None:
    """Call a subscription with its next message, unless that is taken or it is destroyed."""
    try:
        with handle:
            taken = handle.take_message(subscription.msg_type, subscription.raw)
    except _rclpy.InvalidHandle:
        return
    if taken is None:
        return
    if subscription._callback_type is Subscription.CallbackType.MessageOnly:
        subscription.callback(taken[0])
    else:
        subscription.callback(*taken)


# By the method of rclpy's Executor that takes the entity.
PLAIN = {'_take_timer': call_timer, '_take_subscription': call_subscription}
