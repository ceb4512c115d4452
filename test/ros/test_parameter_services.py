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

"""What `ros2 param` does, over the node's own services: list, dump, load, describe."""

from typing import Any

from graph import Client
import pytest
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import GetParameters, ListParameters
from rclpy.parameter import parameter_value_to_python
from swerve_kinematics.configuration.declarations import DOUBLES, ListOf, STRINGS
from swerve_kinematics.configuration.node import NODE_DECLARATIONS
from swerve_kinematics.configuration.simulator import SIMULATOR_DECLARATIONS
import yaml

LISTS = {STRINGS: ParameterType.PARAMETER_STRING_ARRAY,
         DOUBLES: ParameterType.PARAMETER_DOUBLE_ARRAY}


def values_of(client: Client, name: str) -> dict[str, Any]:
    """Return all parameters of a node as the services give them, ParameterValue by name."""
    names = sorted(client.call(ListParameters, f'{name}/list_parameters',
                               ListParameters.Request()).result.names)
    values = client.call(GetParameters, f'{name}/get_parameters',
                         GetParameters.Request(names=names)).values
    assert len(values) == len(names), 'one parameter without a value silences all others'
    return dict(zip(names, values))


def dumped(client: Client, name: str) -> dict[str, Any]:
    """Return what `ros2 param dump` writes of a node, as plain values in nested namespaces."""
    tree: dict[str, Any] = {}
    for full_name, value in values_of(client, name).items():
        *namespaces, leaf = full_name.split('.')
        branch = tree
        for namespace in namespaces:
            branch = branch.setdefault(namespace, {})
        branch[leaf] = parameter_value_to_python(value)
    return {f'{client.node.get_namespace()}/{name}': {'ros__parameters': tree}}


@pytest.mark.parametrize('name, declarations', [
    ('swerve_node', NODE_DECLARATIONS), ('swerve_sim', SIMULATOR_DECLARATIONS)])
def test_every_parameter_has_a_value_of_its_type(
        client, start_node, start_sim, name, declarations):
    {'swerve_node': start_node, 'swerve_sim': start_sim}[name]()
    values = values_of(client, name)
    assert {declaration.name for declaration in declarations} <= set(values)
    for declaration in declarations:
        if isinstance(declaration.default, ListOf):
            assert values[declaration.name].type == LISTS[declaration.default], declaration.name
    assert ParameterType.PARAMETER_NOT_SET not in {value.type for value in values.values()}


def test_a_node_started_from_its_edited_dump_is_the_same_but_for_the_edit(
        client, start_node, tmp_path):
    given = {'wheel_radii': [0.07], 'idle_mode': 'lock', 'drive_joint_names': [],
             'steering_offsets': [0.1, -0.1, 0.2, 0.0], 'odometry.distance_noise': 0.004}
    first = start_node(**given)
    dump = dumped(client, 'swerve_node')
    assert first.end() == 0
    client.wait_until(lambda: not client.node.count_publishers('odom'), 'the node to be gone')
    parameters, = dump.values()
    assert parameters['ros__parameters']['steering_lower_limits'] == []
    assert parameters['ros__parameters']['odometry']['distance_noise'] == 0.004
    parameters['ros__parameters']['max_linear_speed'] = 0.25
    file = tmp_path / 'dump.yaml'
    file.write_text(yaml.dump(dump, default_flow_style=False))
    start_node('--params-file', str(file))
    assert dumped(client, 'swerve_node') == dump
