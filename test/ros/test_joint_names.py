"""A joint that is missing is named, with the name that may be meant."""

import pytest

from swerve_kinematics.ros.joint_names import missing_joints

WANTED = ('rear_left_steering_joint', 'rear_right_steering_joint')


@pytest.mark.parametrize('seen, expected', [
    (WANTED, None), ((), None),
    (('rear_left_steering_joint', 'rear_rght_steering_joint'),
     'joint_states lacks rear_right_steering_joint; there is rear_rght_steering_joint'),
    (('rear_left_steering_joint', 'arm'), 'joint_states lacks rear_right_steering_joint')])
def test_missing_joints_are_named_with_the_nearest_that_is_there(seen, expected):
    assert missing_joints(WANTED, seen) == expected
