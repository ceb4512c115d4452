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

"""A mend is the parameters' new values: with them nothing is wrong any more."""

import numpy as np
import pytest

from swerve_kinematics.core.checking.changes import Change
from swerve_kinematics.core.checking.mends import mended

PARAMETERS = {
    'module_x': [0.3, 0.3, -0.3, -0.3], 'module_y': [0.25, -0.25, 0.25, -0.25],
    'drive_joint_names': ['a', 'b', 'c', 'd'], 'steering_joint_names': ['e', 'f', 'g', 'h'],
    'drive_directions': [1.0, -1.0, 1.0, -1.0], 'steering_directions': [1.0, 1.0, -1.0, 1.0],
    'drive_ratios': [1.0, 1.0, 1.0, 2.0], 'steering_ratios': [1.0, 1.0, 2.0, 1.0],
    'wheel_radii': [0.05] * 4, 'steering_offsets': [0.0, 0.1, 0.2, 3.0]}


@pytest.mark.parametrize('change, expected', [
    (Change('drive reversed', (1,)), {'drive_directions': [1.0, 1.0, 1.0, -1.0]}),
    (Change('steering reversed', (0, 1, 2, 3)), {'steering_directions': [-1.0, -1.0, 1.0, -1.0]}),
    (Change('wheel radius', (2,), 1.2), {'wheel_radii': [0.05, 0.05, 0.06, 0.05]}),
    # Wheels are not measured that wrongly: the drives have a gear that is not described.
    (Change('wheel radius', (0, 1, 2, 3), 0.2), {'drive_ratios': [5.0, 5.0, 5.0, 10.0]}),
    (Change('wheel radius', (0, 1, 2, 3), 4.0), {'drive_ratios': [0.25, 0.25, 0.25, 0.5]}),
    (Change('steering offset', (1,), 0.2), {'steering_offsets': [0.0, 0.3, 0.2, 3.0]}),
    # Clockwise, two turns of the joint for one of the module.
    (Change('steering offset', (2,), 0.3), {'steering_offsets': [0.0, 0.1, -0.4, 3.0]}),
    (Change('steering offset', (0,), 4.71), {'steering_offsets': [-np.pi / 2, 0.1, 0.2, 3.0]}),
    # A joint with end stops reads no turn less, so that no offset within a turn may.
    (Change('steering offset', (3,), 0.5), {'steering_offsets': [0.0, 0.1, 0.2, 3.5]}),
    # A turn of a geared joint is none of its module.
    (Change('steering offset', (2,), -2.1), {'steering_offsets': [0.0, 0.1, 4.4, 3.0]}),
    (Change('x and y swapped'), {'module_x': PARAMETERS['module_y'],
                                 'module_y': PARAMETERS['module_x']}),
    (Change('y of wrong sign'), {'module_y': [-0.25, 0.25, -0.25, 0.25]}),
    (Change('drive joints swapped', (0, 2)), {'drive_joint_names': ['c', 'b', 'a', 'd']}),
    (Change('gyro in degrees'), {})], ids=str)
def test_each_change_has_its_parameters(change, expected):
    values = mended(PARAMETERS, [change])
    assert values.keys() == expected.keys()
    for name, entries in expected.items():
        assert values[name] == (entries if isinstance(entries[0], str)
                                else pytest.approx(entries))


def test_an_offset_that_the_node_would_refuse_is_a_turn_less():
    far = {**PARAMETERS, 'steering_offsets': [0.0, 6.2, -12.5, 6.0]}
    values = mended(far, [Change('steering offset', (1,), 0.2)])
    values = mended({**far, **values}, [Change('steering offset', (2,), 0.1)])
    assert values == {'steering_offsets': pytest.approx(
        [0.0, 6.4 - 2.0 * np.pi, 4.0 * np.pi - 12.7, 6.0])}


def test_an_offset_leaves_those_of_other_modules_alone():
    far = {**PARAMETERS, 'steering_offsets': [0.0, 0.1, 4.0, -6.0]}
    values = mended(far, [Change('steering offset', (1,), 0.2)])
    assert values == {'steering_offsets': [0.0, pytest.approx(0.3), 4.0, -6.0]}


def test_what_belongs_to_the_joints_goes_with_them():
    values = mended(PARAMETERS, [Change('modules swapped', (0, 1))])
    assert values == {
        'drive_joint_names': ['b', 'a', 'c', 'd'], 'steering_joint_names': ['f', 'e', 'g', 'h'],
        'drive_directions': [-1.0, 1.0, 1.0, -1.0], 'steering_offsets': [0.1, 0.0, 0.2, 3.0]}


def test_changes_build_on_each_other():
    exchanged, turned = Change('modules swapped', (0, 1)), Change('drive reversed', (0,))
    assert mended(PARAMETERS, [exchanged, turned])['drive_directions'] == [1.0, 1.0, 1.0, -1.0]


def test_joints_that_are_commanded_by_index_get_the_right_positions():
    rotated = Change('modules rotated', (0, 1, 2, 3), 1)
    assert rotated.permutation(4) == [1, 2, 3, 0]
    values = mended(PARAMETERS, [rotated], by_index=True)
    # Joint 1 sits where the description has module 0.
    assert values == {'module_x': [-0.3, 0.3, 0.3, -0.3], 'module_y': [-0.25, 0.25, -0.25, 0.25]}


@pytest.mark.parametrize('kind, name', [('drive joints', 'drive_joint_names'),
                                        ('steering joints', 'steering_joint_names')])
def test_names_never_part_the_reading_of_a_joint_from_its_command(kind, name):
    swapped, misnamed = Change(f'{kind} swapped', (0, 1)), Change(f'{kind} misnamed', (0, 1))
    # Commands by index do not follow other names; commands by name do.
    assert mended(PARAMETERS, [swapped], by_index=True) == {}
    assert name in mended(PARAMETERS, [misnamed], by_index=True)
    assert name in mended(PARAMETERS, [swapped])
    assert mended(PARAMETERS, [misnamed]) == {}
