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

"""Rotations in space, and the yaw in them."""

import math

from hypothesis import given, strategies as st
import numpy as np
import pytest
from strategies import NO_ROTATIONS

from swerve_kinematics.core.geometry.rotations import (
    from_roll_pitch_yaw, IDENTITY, inverse, product, Rotation, up, yaw_of)

angles = st.floats(-math.pi, math.pi)


@given(angles, angles, angles, angles, angles, angles)
def test_rotations_are_a_group(a, b, c, d, e, f):
    first, second = from_roll_pitch_yaw(a, b, c), from_roll_pitch_yaw(d, e, f)
    np.testing.assert_allclose(product(first, inverse(first)), IDENTITY, atol=1e-12)
    np.testing.assert_allclose(
        inverse(product(first, second)), product(inverse(second), inverse(first)), atol=1e-12)
    # A base with its z axis up has its up in z.
    assert up(from_roll_pitch_yaw(0.0, 0.0, a)) == pytest.approx((0.0, 0.0, 1.0))


@given(st.floats(-3.1, 3.1), st.floats(0.1, 10.0))
def test_yaw_does_not_depend_on_the_length_of_a_quaternion(yaw, length):
    rotation = Rotation(*(length * part for part in from_roll_pitch_yaw(0.0, 0.0, yaw)))
    assert yaw_of(rotation) == pytest.approx(yaw)


@pytest.mark.parametrize('numbers', NO_ROTATIONS)
def test_numbers_that_are_no_rotation_have_no_yaw(numbers):
    assert math.isnan(yaw_of(Rotation(*numbers)))
