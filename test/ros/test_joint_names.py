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

"""Joints are looked up by name once, and those that are missing are named with what is there."""

import pytest

from swerve_kinematics.ros.joint_names import JointNames

WANTED = ('rear_left_steering_joint', 'rear_right_steering_joint')


@pytest.mark.parametrize('seen, expected', [
    (WANTED, None), ((), None),
    (('rear_left_steering_joint', 'rear_rght_steering_joint'),
     'joint_states lack rear_right_steering_joint; there is rear_rght_steering_joint'),
    (('rear_left_steering_joint', 'm2', 'm4'),
     'joint_states lack rear_right_steering_joint; there is m2, m4'),
    (('rear_left_steering_joint',), 'joint_states lack rear_right_steering_joint')])
def test_missing_joints_are_named_with_the_nearest_that_is_there(seen, expected):
    names = JointNames(WANTED, None)
    for name in seen:
        names.slots((name,))
    assert names.missing == expected


def test_a_joint_that_is_listed_twice_is_named():
    names = JointNames(WANTED, None)
    names.slots((WANTED[0], WANTED[0], 'arm'))
    assert names.missing == (
        'joint_states lack rear_right_steering_joint; there is arm; '
        'joint_states list rear_left_steering_joint twice')
    names.slots(WANTED)  # of another publisher, say
    assert names.missing is None


def test_ever_new_name_lists_do_not_fill_the_memory():
    names = JointNames(WANTED, None)
    for k in range(1000):
        names.slots((f'joint_{k}',))
    assert len(names._slots_by_names) < 100
