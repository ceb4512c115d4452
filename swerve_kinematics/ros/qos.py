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

"""Publishers and subscriptions: quality of service by parameters, and no events by default."""

from collections.abc import Callable
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.subscription import Subscription

NO_PUBLISHER_EVENTS = PublisherEventCallbacks(use_default_callbacks=False)
NO_SUBSCRIPTION_EVENTS = SubscriptionEventCallbacks(use_default_callbacks=False)
# How many messages wait for whoever reads them late.
DEPTH = 10
# For what comes in over and over: matches reliable publishers and best-effort ones, such as
# those of a micro-ROS board. A message that is lost is followed by the next, or by a timeout.
FROM_ANY_PUBLISHER = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)


class EventlessNode(Node):
    """
    A node whose publishers and subscriptions, rclpy's own among them, have no default events.

    Those log that the two ends of a topic do not match. The other end logs that too, while here
    each event would be waited for, anew, at every wake-up of the node: all of them together cost
    about as much as the odometry.
    """

    def create_publisher(self, *args: Any, event_callbacks: PublisherEventCallbacks | None = None,
                         **options: Any) -> Publisher:
        """Create a publisher; events only where they are given."""
        return super().create_publisher(
            *args, event_callbacks=event_callbacks or NO_PUBLISHER_EVENTS, **options)

    def create_subscription(
            self, msg_type: Any, topic: str, callback: Callable[..., None], *args: Any,
            event_callbacks: SubscriptionEventCallbacks | None = None,
            **options: Any) -> Subscription:
        """Create a subscription; events only where they are given."""
        return super().create_subscription(
            msg_type, topic, callback, *args,
            event_callbacks=event_callbacks or NO_SUBSCRIPTION_EVENTS, **options)


def publisher(node: Node, kind: type, topic: str) -> Publisher:
    """
    Create a reliable publisher with the parameters `qos_overrides.<topic>.publisher.*`.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates it.
    kind : type
        Of the messages.
    topic : str
        Relative name.

    Returns
    -------
    rclpy.publisher.Publisher

    """
    return node.create_publisher(
        kind, topic, DEPTH, qos_overriding_options=QoSOverridingOptions.with_default_policies())


def subscription(node: Node, kind: type, topic: str, callback: Callable[..., Any],
                 qos: int | QoSProfile, raw: bool,
                 group: CallbackGroup | None = None) -> Subscription:
    """
    Create a subscription with the parameters `qos_overrides.<topic>.subscription.*`.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates it.
    kind : type
        Of the messages.
    topic : str
        Relative name.
    callback : callable
        Is handed each message.
    qos : int or rclpy.qos.QoSProfile
        The default: a depth of reliable, volatile messages, or a profile.
    raw : bool
        Whether the messages are handed on as their bytes.
    group : rclpy.callback_groups.CallbackGroup or None
        The node's own if None.

    Returns
    -------
    rclpy.subscription.Subscription

    """
    return node.create_subscription(
        kind, topic, callback, qos, raw=raw, callback_group=group,
        qos_overriding_options=QoSOverridingOptions.with_default_policies())
