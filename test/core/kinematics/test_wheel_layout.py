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

"""Kinematics as values: equal, hashed and pickled by where the wheels are."""

import copy
import pickle

from hypothesis import given
import numpy as np
from numpy.testing import assert_array_equal
import pytest
from strategies import layouts
from swerve_kinematics import MecanumKinematics, SwerveKinematics

CORNERS = np.array([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])


@given(layouts())
def test_one_layout_makes_equal_kinematics(positions):
    first, second = SwerveKinematics(positions), SwerveKinematics(positions.tolist())
    assert first == second
    assert hash(first) == hash(second)
    assert first != SwerveKinematics(positions + 1.0)
    assert first != SwerveKinematics(np.vstack((positions, [9.0, 9.0])))


def test_zeros_of_both_signs_are_one_place():
    first, second = (SwerveKinematics([(1.0, 0.0), (zero, 1.0)]) for zero in (0.0, -0.0))
    assert first == second
    assert hash(first) == hash(second)


def test_the_kind_of_wheels_tells_equal_layouts_apart():
    assert SwerveKinematics(CORNERS) != MecanumKinematics(CORNERS)
    assert SwerveKinematics(CORNERS) != CORNERS.tolist()
    assert len({SwerveKinematics(CORNERS), SwerveKinematics(CORNERS),
                MecanumKinematics(CORNERS), MecanumKinematics(CORNERS)}) == 2


@pytest.mark.parametrize('kind', [SwerveKinematics, MecanumKinematics])
@pytest.mark.parametrize('copied', [
    copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
def test_a_copy_is_equal_and_as_constant(kind, copied):
    original = kind(CORNERS)
    twin = copied(original)
    assert twin == original
    assert_array_equal(twin.inverse([1.0, 2.0, 3.0]), original.inverse([1.0, 2.0, 3.0]))
    positions = twin.module_positions if kind is SwerveKinematics else twin.wheel_positions
    with pytest.raises(ValueError, match='read-only'):
        positions[0, 0] = 1.0
