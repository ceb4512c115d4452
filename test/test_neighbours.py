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

"""The files for Nav2, robot_localization, RViz and Foxglove fit the node and its four modules."""

from collections.abc import Iterator
import json
from pathlib import Path
import re
from typing import Any

import numpy as np
import pytest
import yaml

ROOT = Path(__file__).parents[1]
# Diagonal of robot_localization's state: x y z, roll pitch yaw, their rates, ax ay az.
STATES = 15
PLANAR = [0, 1, 5]
# What others publish or take that these files show.
FROM_OTHERS = {'/robot_description'}


def parameters(file: str, node: str) -> Any:
    """Return the parameters of a node in a file of config/."""
    sections = yaml.safe_load((ROOT / 'config' / file).read_text())
    return sections[node]['ros__parameters']


def nav2(node: str) -> Any:
    """Return the parameters of a node of Nav2."""
    return parameters('nav2_params.yaml', node)


def costmap(name: str) -> Any:
    """Return the parameters of a costmap of Nav2, which is a node within the node of its name."""
    sections = yaml.safe_load((ROOT / 'config' / 'nav2_params.yaml').read_text())
    return sections[name][name]['ros__parameters']


def corners(text: str) -> Any:
    """Return the corners of a polygon, (k, 2), as Nav2 writes them."""
    return np.array(json.loads(text))


BASE = parameters('four_modules.yaml', '/**')
LIMITS = [BASE['max_linear_speed']] * 2 + [BASE['max_angular_speed']]
ACCELERATIONS = [BASE['max_linear_acceleration']] * 2 + [BASE['max_angular_acceleration']]
DECELERATIONS = [BASE['max_linear_deceleration']] * 2 + [BASE['max_angular_acceleration']]


def test_nav2_commands_every_axis_within_the_limits_of_the_base() -> None:
    smoother = nav2('velocity_smoother')
    for name, bound, sign in (('max_velocity', LIMITS, 1), ('min_velocity', LIMITS, -1),
                              ('max_accel', ACCELERATIONS, 1), ('max_decel', DECELERATIONS, -1)):
        # Nav2 refuses limits that are not three, or of the wrong sign, and an entry of 0 keeps
        # that axis at rest. It limits x and y each alone, the node their vector.
        signed = np.multiply(smoother[name], sign)
        assert signed.shape == (3,) and (signed > 0.0).all(), name
        assert np.hypot(*signed[:2]) <= bound[0] and signed[2] <= bound[2], name


def test_nav2s_controller_plans_what_the_base_can_do() -> None:
    controller = nav2('controller_server')
    assert all(controller[f'min_{axis}_velocity_threshold'] <= 0.01
               for axis in ('x', 'y', 'theta'))
    plan = controller['FollowPath']
    assert plan['motion_model'] == 'Omni'
    assert plan['model_dt'] == pytest.approx(1.0 / controller['controller_frequency'])
    assert all(0.0 < plan[f'{axis}_std'] < plan[f'{axis}_max'] for axis in ('vx', 'vy', 'wz'))
    assert plan['vy_max'] == plan['vx_max'] == -plan['vx_min'] > 0.0
    fastest = np.hypot(plan['vx_max'], plan['vy_max'])
    outermost = np.hypot(BASE['module_x'], BASE['module_y']).max()
    assert fastest <= BASE['max_linear_speed'] and plan['wz_max'] <= BASE['max_angular_speed']
    assert fastest + plan['wz_max'] * outermost <= BASE['max_module_speed']
    assert np.hypot(plan['ax_max'], plan['ay_max']) <= BASE['max_linear_acceleration']
    assert plan['ax_min'] < 0.0 and plan['ay_min'] < 0.0
    assert np.hypot(plan['ax_min'], plan['ay_min']) <= BASE['max_linear_deceleration']
    assert plan['az_max'] <= BASE['max_angular_acceleration']
    assert not {'PreferForwardCritic', 'PathAngleCritic'} & set(plan['critics'])
    assert nav2('behavior_server')['max_rotational_vel'] <= BASE['max_angular_speed']
    # What lies beyond the path it is given, or beyond the costmap, it does not plan for.
    horizon = plan['time_steps'] * plan['model_dt'] * fastest
    assert horizon <= plan['prune_distance'] <= 0.5 * costmap('local_costmap')['width']
    assert costmap('local_costmap')['height'] == costmap('local_costmap')['width']
    assert isinstance(costmap('local_costmap')['width'], int)  # Nav2 takes no 8.0


def test_nav2s_commands_reach_the_node_as_twists_and_in_time() -> None:
    monitor, smoother = nav2('collision_monitor'), nav2('velocity_smoother')
    assert monitor['cmd_vel_in_topic'] == 'cmd_vel_smoothed'
    assert monitor['cmd_vel_out_topic'] == 'cmd_vel'
    for node in 'controller_server', 'velocity_smoother', 'collision_monitor', 'behavior_server':
        assert nav2(node)['enable_stamped_cmd_vel'] is False
    assert 1.0 / smoother['smoothing_frequency'] < 0.25 * BASE['cmd_vel_timeout']
    assert smoother['velocity_timeout'] < BASE['cmd_vel_timeout']


def test_nav2_watches_all_around_the_base_for_as_long_as_it_brakes() -> None:
    monitor = nav2('collision_monitor')
    modules = np.column_stack((BASE['module_x'], BASE['module_y']))
    outline = corners(monitor[monitor['polygons'][0]]['points'])
    assert (np.abs(modules).max(axis=0) < outline.max(axis=0)).all()
    np.testing.assert_allclose(outline.max(axis=0), -outline.min(axis=0))
    # One outline everywhere, or the planner leads the base to where the monitor stops it.
    for text in (*(monitor[name]['points'] for name in monitor['polygons']),
                 costmap('local_costmap')['footprint'], costmap('global_costmap')['footprint']):
        np.testing.assert_array_equal(corners(text), outline)
    assert nav2('controller_server')['FollowPath']['CostCritic']['consider_footprint'] is True
    braking = BASE['max_linear_speed'] / BASE['max_linear_deceleration']
    assert monitor['Approach']['time_before_collision'] > braking + 0.1
    assert monitor['source_timeout'] <= BASE['feedback_timeout']


def test_nav2_and_the_filter_name_the_frames_and_topics_of_the_node() -> None:
    for node, names in (('amcl', ('base_frame_id', 'odom_frame_id')),
                        ('bt_navigator', ('robot_base_frame', 'odom_topic')),
                        ('collision_monitor', ('base_frame_id', 'odom_frame_id')),
                        ('behavior_server', ('robot_base_frame', 'local_frame'))):
        assert {nav2(node)[name] for name in names} == {'base_link', 'odom'}
    ekf = parameters('ekf.yaml', 'ekf_filter_node')
    assert (ekf['odom_frame'], ekf['world_frame'], ekf['base_link_frame']) == (
        'odom', 'odom', 'base_link')
    assert ekf['odom0'] == 'odom'


def test_the_filter_is_planar_and_takes_odom_once() -> None:
    ekf = parameters('ekf.yaml', 'ekf_filter_node')
    assert ekf['two_d_mode'] is True
    for source in 'odom0', 'odom1':
        assert np.flatnonzero(ekf[f'{source}_config']).tolist() == PLANAR
        assert len(ekf[f'{source}_config']) == STATES
        assert ekf[f'{source}_differential'] is True


def test_the_filter_lets_the_base_accelerate() -> None:
    noise = np.array(parameters('ekf.yaml', 'ekf_filter_node')['process_noise_covariance'])
    assert noise.shape == (STATES,) and (noise > 0.0).all()
    # Within a second of its largest acceleration the base may do what the filter calls 1.5 sigma.
    assert (noise[[6, 7, 11]] >= (np.array(DECELERATIONS) / 1.5) ** 2).all()


def strings(tree: Any) -> Iterator[str]:
    """Yield every string in a tree of lists and dictionaries, keys included."""
    if isinstance(tree, dict):
        yield from (key for key in tree if isinstance(key, str))
        tree = list(tree.values())
    if isinstance(tree, list):
        for entry in tree:
            yield from strings(entry)
    elif isinstance(tree, str):
        yield tree


def shown_topics() -> dict[str, set[str]]:
    """Return the topics that each of the files names."""
    trees = {'swerve.rviz': yaml.safe_load((ROOT / 'config/swerve.rviz').read_text())[
        'Visualization Manager'],
        'foxglove.json': json.loads((ROOT / 'config/foxglove.json').read_text())}
    return {file: {match[0] for text in strings(tree)
                   if (match := re.match(r'/[a-z][a-z_/]+', text))}
            for file, tree in trees.items()}


def topics_of_the_node() -> set[str]:
    """Return the topics of swerve_node in the table of the page on its interface."""
    page = (ROOT / 'docs' / 'interface.md').read_text()
    rows = re.findall(r'\| (?:subscribes|publishes) `([^`]+)`', page)
    return {'/' + topic.replace('~', 'swerve_node').lstrip('/') for topic in rows}


@pytest.mark.parametrize('file', ['swerve.rviz', 'foxglove.json'])
def test_what_is_shown_is_there(file: str) -> None:
    topics = shown_topics()[file]
    assert {'/odom', '/swerve_node/markers', '/swerve_node/set_pose'} <= topics
    assert topics <= topics_of_the_node() | FROM_OTHERS


def test_every_panel_of_foxglove_has_its_place() -> None:
    layout = json.loads((ROOT / 'config/foxglove.json').read_text())
    panels = sorted(text for text in strings(layout['layout']) if '!' in text)
    assert panels == sorted(layout['configById'])


def test_foxglove_drives_within_the_limits() -> None:
    panels = json.loads((ROOT / 'config/foxglove.json').read_text())['configById']
    teleop, = (panel for name, panel in panels.items() if name.startswith('Teleop!'))
    assert teleop['publishRate'] > 2.0 / BASE['cmd_vel_timeout']
    assert all(abs(button['value']) <= BASE['max_linear_speed']
               for name, button in teleop.items() if name.endswith('Button'))
