"""The topics and services of the running node are those of the README."""

from pathlib import Path
import re

import pytest

README = (Path(__file__).parents[2] / 'README.md').read_text()
# What every rclpy node has.
COMMON = {'/rosout', '/parameter_events', '/clock'}
# Those that stand in for others, and what turns them on.
VARIANTS = {'imu': {'gyro_source': 'imu'}, 'joint_commands': {'command_interface': 'joint_state'}}


def documented(verb, node_name):
    """Return the full names that the README's table has behind a verb, but for /tf."""
    names = re.findall(rf'^\| {verb} `([^`]+)`', README, re.MULTILINE)
    namespace = node_name.rpartition('/')[0]
    return {name if name.startswith('/') else
            name.replace('~', node_name) if name.startswith('~') else f'{namespace}/{name}'
            for name in names} - {'/tf'}


@pytest.mark.parametrize('variant', [None, *VARIANTS])
def test_the_graph_is_that_of_the_readme(client, namespace, start_node, variant):
    start_node(**VARIANTS.get(variant, {}))
    client.begin_feedback()
    name, node = f'{namespace}/swerve_node', client.node
    others = {f'{namespace}/{other}' for other in VARIANTS if other != variant}
    if variant == 'joint_commands':
        others |= {topic for topic in documented('publishes', name) if 'controller' in topic}

    def names(query):
        return {topic for topic, _ in query('swerve_node', namespace)} - COMMON
    assert names(node.get_publisher_names_and_types_by_node) == (
        documented('publishes', name) - others)
    assert names(node.get_subscriber_names_and_types_by_node) == (
        documented('subscribes', name) - others)
    assert {service for service in names(node.get_service_names_and_types_by_node)
            if 'parameter' not in service and 'type_description' not in service} == (
        documented('service', name))
