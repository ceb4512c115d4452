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

"""A graph of its own for each executor under test, which the test spins by hand."""

import itertools
import time

import rclpy
from rclpy.node import Node
from std_msgs.msg import Int64

PATIENCE = 20.0  # s
NUMBERS = itertools.count()  # so that no graph hears of the one before


class ExecutorGraph:
    """A context of its own with an executor and the node under test."""

    def __init__(self, kind):
        """Start both."""
        self.context = rclpy.Context()
        self.context.init()
        self.namespace, self.nodes = f'/executor_{next(NUMBERS)}', []
        self.executor = kind(context=self.context)
        self.node = self.add('subject')

    def add(self, name):
        """Return a new node that the executor spins."""
        node = Node(name, context=self.context, namespace=self.namespace)
        self.nodes.append(node)
        self.executor.add_node(node)
        return node

    def spin_until(self, condition, what='the condition'):
        """Spin until the condition holds; fail if it never does."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f'waited in vain for {what}'
            self.executor.spin_once(timeout_sec=0.1)

    def close(self):
        """End both."""
        self.executor.shutdown()
        for node in self.nodes:
            node.destroy_node()
        self.context.try_shutdown()


def talk(graph, topic='numbers', qos=10):
    """Return a publisher and the list that its numbers arrive in, connected."""
    heard = []
    graph.node.create_subscription(Int64, topic, lambda message: heard.append(message.data), qos)
    publisher = graph.node.create_publisher(Int64, topic, qos)
    graph.spin_until(lambda: publisher.get_subscription_count() == 1, 'the subscription')
    return publisher, heard
