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

"""The ros2_control example fits the node's defaults: names, order, geometry, interfaces."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from swerve_kinematics.configuration.layout import default_layout
import yaml

CONFIG = Path(__file__).parents[2] / 'config'
URDF = ElementTree.parse(CONFIG / 'four_modules.urdf').getroot()
CONTROLLERS = yaml.safe_load((CONFIG / 'ros2_control_controllers.yaml').read_text())
LAYOUT = default_layout()
JOINTS = {joint.get('name'): joint for joint in URDF.findall('joint')}
HARDWARE_JOINTS = {joint.get('name'): joint for joint in URDF.findall('ros2_control/joint')}


def vector(element, attribute):
    """Return the numbers of an attribute."""
    return [float(number) for number in element.get(attribute).split()]


def interfaces(joint, kind):
    """Return the names of a joint's command or state interfaces."""
    return [interface.get('name') for interface in joint.findall(f'{kind}_interface')]


@pytest.mark.parametrize('controller, interface, joints', [
    ('drive_velocity_controller', 'velocity', LAYOUT.drive_joints),
    ('steering_position_controller', 'position', LAYOUT.steering_joints)])
def test_the_controllers_take_the_nodes_commands_in_its_order(controller, interface, joints):
    parameters = CONTROLLERS[controller]['ros__parameters']
    # A group velocity controller knows its interface.
    named = {} if interface == 'velocity' else {'interface_name': interface}
    assert parameters == {**named, 'joints': list(joints)}
    for joint in joints:
        assert interfaces(HARDWARE_JOINTS[joint], 'command') == [interface]


def test_the_controller_manager_knows_every_controller():
    manager = dict(CONTROLLERS['controller_manager']['ros__parameters'])
    assert manager.pop('update_rate') >= 50
    forward = {'type': 'forward_command_controller/ForwardCommandController'}
    # A forward controller that is deactivated leaves the wheels turning; this one stops them.
    velocity = {'type': 'velocity_controllers/JointGroupVelocityController'}
    assert manager == {
        'joint_state_broadcaster': {'type': 'joint_state_broadcaster/JointStateBroadcaster'},
        'drive_velocity_controller': velocity, 'steering_position_controller': forward}


def test_the_hardware_measures_what_the_node_reads():
    assert set(HARDWARE_JOINTS) == {*LAYOUT.drive_joints, *LAYOUT.steering_joints}
    for joint in HARDWARE_JOINTS.values():
        assert interfaces(joint, 'state') == ['position', 'velocity']
        # Without it the mock's first position is NaN, which the node does not take.
        assert joint.find("state_interface[@name='position']/param").get('name') == 'initial_value'


def test_the_modules_are_where_the_node_has_them():
    for name, position in zip(LAYOUT.steering_joints, LAYOUT.kinematics.module_positions):
        joint = JOINTS[name]
        assert joint.find('parent').get('link') == 'base_link' == LAYOUT.base_frame
        assert vector(joint.find('axis'), 'xyz') == [0.0, 0.0, 1.0]
        np.testing.assert_array_equal(vector(joint.find('origin'), 'xyz')[:2], position)
        # swerve_node's steering is continuous unless limits are given.
        assert joint.get('type') == 'continuous'


def test_each_wheel_rolls_forward_in_its_fork_and_touches_the_ground():
    links = {link.get('name'): link for link in URDF.findall('link')}
    for drive, steering, radius in zip(
            LAYOUT.drive_joints, LAYOUT.steering_joints, LAYOUT.joints.wheel_radii):
        joint = JOINTS[drive]
        assert joint.find('parent').get('link') == JOINTS[steering].find('child').get('link')
        assert vector(joint.find('axis'), 'xyz') == [0.0, 1.0, 0.0]
        assert joint.find('origin') is None and joint.get('type') == 'continuous'
        wheel = links[joint.find('child').get('link')].find('visual/geometry/cylinder')
        assert float(wheel.get('radius')) == radius
        assert vector(JOINTS[steering].find('origin'), 'xyz')[2] == radius


def test_the_model_is_one_tree():
    children = [joint.find('child').get('link') for joint in JOINTS.values()]
    links = [link.get('name') for link in URDF.findall('link')]
    assert len(set(links)) == len(links) and len(set(children)) == len(children)
    assert set(links) - set(children) == {'base_link'}


def test_the_page_says_who_stops_the_drives_when_the_node_is_gone():
    page = (CONFIG.parent / 'docs' / 'your_robot.md').read_text()
    recipe = page.split('### Who watches over the commands')[1].split('\n## ')[0]
    for word in ('SIGKILL', 'set_controller_state', 'drive_velocity_controller', 'inactive'):
        assert word in recipe
