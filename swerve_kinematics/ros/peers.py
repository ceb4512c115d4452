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

"""Who else publishes on the topics of the node, as the graph tells, and what is wrong with it."""

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import qos_check_compatible, QoSCompatibility, QoSProfile
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from swerve_kinematics.ros.qos import DEPTH, subscription


class Peers:
    """
    Looks up the publishers on the node's inputs; meant for about once a second.

    A publisher that does not match in type or quality of service is silent: the middleware
    delivers nothing and the node cannot know that there was something to deliver.

    Parameters
    ----------
    node : rclpy.node.Node
        Subscribes, and asks the graph.

    """

    def __init__(self, node: Node) -> None:
        """Start without an input."""
        self._node = node
        self._inputs: list[Subscription] = []

    def subscribe(self, kind: type, topic: str, callback: Callable[..., Any],
                  qos: int | QoSProfile = DEPTH, raw: bool = False,
                  group: CallbackGroup | None = None) -> None:
        """Add an input, as `subscription` takes it."""
        self._inputs.append(subscription(self._node, kind, topic, callback, qos, raw, group))

    def count(self, topic: str) -> int:
        """Return how many publishers a topic has."""
        return self._node.count_publishers(self._node.resolve_topic_name(topic))

    def publishers(self, topic: str) -> list[str]:
        """Return the full name of the node of each publisher on a topic, in order."""
        return sorted(map(_node_name, self._infos(topic)))

    def absences(self, topics: Iterable[str]) -> Iterator[str]:
        """Yield which of the topics nobody publishes, with others of the same type."""
        names = {self._node.resolve_topic_name(topic) for topic in topics}
        for own in self._inputs:
            if own.topic_name in names and (
                    told := absence(self._node, own.topic_name, own.msg_type)):
                yield told

    def elsewhere(self, topic: str) -> Iterator[str]:
        """Yield, where nobody publishes a topic, which others of the same type there are."""
        name = self._node.resolve_topic_name(topic)
        for own in self._inputs:
            if own.topic_name == name and not self._node.count_publishers(name) and (
                    others := _others(self._node, own.msg_type, self._infos)):
                yield _nobody(name, others)

    def mismatches(self) -> Iterator[str]:
        """Yield what there is to say of each publisher whose messages cannot arrive."""
        for own in self._inputs:
            # To count is cheap, to ask for each publisher is not.
            if own.handle.get_publisher_count() == self._node.count_publishers(own.topic_name):
                continue
            taken = _type_name(own.msg_type)
            for info in self._infos(own.topic_name):
                who = f'{_node_name(info)} publishes {own.topic_name}'
                if info.topic_type != taken:
                    yield f'{who} as {info.topic_type}, but the node expects {taken}'
                    continue
                verdict, reason = qos_check_compatible(
                    info.qos_profile, own.qos_profile)
                if verdict == QoSCompatibility.ERROR:
                    yield (f'{who} with a quality of service that does not match: '
                           f'{reason.removeprefix("ERROR: ").rstrip(" ;")}')

    def rivals(self, publishers: Collection[Publisher]) -> Iterator[str]:
        """Yield what there is to say of each of the node's own topics that others publish too."""
        for topic in [own.topic_name for own in publishers]:
            if self._node.count_publishers(topic) > 1:
                names = ' and '.join(self.publishers(topic))
                yield f'{topic} is published by {names}: only one may command joints'

    def unheard(self, publishers: Collection[Publisher]) -> Iterator[str]:
        """Yield which of the node's own messages nobody receives, with what others listen to."""
        taken = {own.topic_name for own in publishers}
        for own in publishers:
            if not own.get_subscription_count():
                others = _others(
                    self._node, own.msg_type, self._node.get_subscriptions_info_by_topic)
                meant = [topic for topic in others if topic not in taken]
                yield f'nobody receives {own.topic_name}{_hint(meant)}'

    def _infos(self, topic: str) -> list[TopicEndpointInfo]:
        """Return what the graph knows of the publishers on a topic."""
        return self._node.get_publishers_info_by_topic(topic)


def absence(node: Node, topic: str, kind: Any) -> str | None:
    """
    Return that nobody publishes a topic, None if somebody does.

    Parameters
    ----------
    node : rclpy.node.Node
        Asks the graph.
    topic : str
        Its full name.
    kind : type
        Of its messages: other nodes may publish them by another name.

    """
    if node.count_publishers(topic):
        return None
    return _nobody(topic, _others(node, kind, node.get_publishers_info_by_topic))


def _others(node: Node, kind: Any,
            infos: Callable[[str], list[TopicEndpointInfo]]) -> list[str]:
    """Return the topics of a type that other nodes have, and not this one, by their `infos`."""
    own, type_name = node.get_fully_qualified_name(), _type_name(kind)
    return [topic for topic, types in node.get_topic_names_and_types()
            if type_name in types and (names := {*map(_node_name, infos(topic))})
            and own not in names]


def _nobody(topic: str, others: list[str]) -> str:
    """Return in words that nobody publishes a topic, with the others that may be meant."""
    return f'nobody publishes {topic}{_hint(others)}'


def _hint(others: list[str]) -> str:
    """Return in words the topics that may be meant, nothing if there are none."""
    return f'; there is {", ".join(others)}' if others else ''


def _node_name(info: TopicEndpointInfo) -> str:
    """Return the full name of the node that an endpoint belongs to."""
    return f'{info.node_namespace.rstrip("/")}/{info.node_name}'


def _type_name(kind: Any) -> str:
    """Return the name of a message type as the graph has it, such as std_msgs/msg/Empty."""
    package, folder, *_ = kind.__module__.split('.')
    return f'{package}/{folder}/{kind.__name__}'
