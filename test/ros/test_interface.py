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

"""The topics and services of the running node are those of the page on its interface."""

from pathlib import Path
import re

import pytest

PAGE = (Path(__file__).parents[2] / 'docs' / 'interface.md').read_text()
# What every rclpy node has, beside its parameters and type descriptions; and what is there only
# where tf2 is installed.
COMMON = {'/rosout', '/clock', '/tf', '/tf_static'}
# Those that stand in for others, and what turns them on.
VARIANTS = {'imu': {'gyro_source': 'imu'}, 'joint_commands': {'command_interface': 'joint_state'}}


def documented(verb, node_name):
    """Return the full names that the page's table has behind a verb, but for those of tf2."""
    names = re.findall(rf'^\| {verb} `([^`]+)`', PAGE, re.MULTILINE)
    namespace = node_name.rpartition('/')[0]
    return {name if name.startswith('/') else
            name.replace('~', node_name) if name.startswith('~') else f'{namespace}/{name}'
            for name in names} - COMMON


@pytest.mark.parametrize('variant', [None, *VARIANTS])
def test_the_graph_is_that_of_the_page(client, namespace, start_node, variant):
    start_node(**VARIANTS.get(variant, {}))
    name, node = f'{namespace}/swerve_node', client.node
    client.wait_until(
        lambda: ('swerve_node', namespace) in node.get_node_names_and_namespaces(), 'the node')
    others = {f'{namespace}/{other}' for other in VARIANTS if other != variant}
    if variant == 'joint_commands':
        others |= {topic for topic in documented('publishes', name) if 'controller' in topic}

    def names(query):
        return {name for name, _ in query('swerve_node', namespace)
                if 'parameter' not in name and 'type_description' not in name} - COMMON
    expected = {
        node.get_publisher_names_and_types_by_node: documented('publishes', name) - others,
        node.get_subscriber_names_and_types_by_node: documented('subscribes', name) - others,
        node.get_service_names_and_types_by_node: documented('service', name)}
    for query, documented_names in expected.items():
        client.wait_until(lambda: names(query) == documented_names, sorted(documented_names))
