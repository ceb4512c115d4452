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

"""Orientations that never change, and those that only do so rarely."""

import numpy as np
import pytest

from swerve_kinematics.core.odometry.still_yaw import StillYaw


def test_an_orientation_that_never_changes_is_believed_only_at_rest():
    yaw = StillYaw()
    assert all(yaw.follows(0.02, 0.0, 0.01) for _ in range(1000))
    assert not any(yaw.follows(0.02, 0.0, 0.5) for _ in range(20))
    assert yaw.stands
    assert not yaw.follows(0.02, 0.0, 0.0)
    assert yaw.follows(0.02, 0.1, 0.0)
    assert not yaw.stands


@pytest.mark.parametrize('hold', [5, 10])
def test_an_orientation_slower_or_coarser_than_its_rate_is_believed_once_it_moves(hold):
    yaw = StillYaw()
    believed = [yaw.follows(0.01, k // hold * hold * 0.01, 1.0) for k in range(100)]
    assert all(believed[hold:])


def test_vibration_does_not_make_a_yaw_stand_still():
    yaw = StillYaw()
    assert all(yaw.follows(0.005, 0.0, 0.08 * np.sin(k)) for k in range(400))
    moved = StillYaw()
    moved.follows(0.005, 1.0, 0.0)
    assert all(moved.follows(0.005, 0.0, 2.0 * np.sin(k)) for k in range(400))


def test_a_sensor_that_repeats_yaw_and_rate_is_frozen_until_one_of_them_changes():
    yaw = StillYaw()
    for _ in range(2):
        for k in range(10):
            yaw.follows(0.01, 0.01 * k, 1.0)
        assert not yaw.is_frozen
        for _ in range(25):
            yaw.follows(0.01, 0.1, 1.0)
        assert yaw.is_frozen
    yaw.follows(0.01, 0.1, 0.0)
    assert yaw.stands and not yaw.is_frozen


def test_a_sensor_without_an_orientation_or_with_a_lively_rate_is_not_frozen():
    without, lively = StillYaw(), StillYaw()
    lively.follows(0.01, 1.0, 1.0)
    for k in range(100):
        without.follows(0.01, 0.0, 1.0)
        lively.follows(0.01, 0.0, 1.0 + 1e-6 * (k % 2))
    assert without.stands and not without.is_frozen
    assert lively.stands and not lively.is_frozen
