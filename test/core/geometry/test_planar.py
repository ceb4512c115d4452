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

"""The controller's complex numbers agree with the functions for arrays."""

import numpy as np
import pytest

from swerve_kinematics import discretize, SwerveKinematics, to_robot_frame
from swerve_kinematics.core.geometry.planar import (
    between, displacing, module_velocities, PlanarTwist, product, rate_between, REST, scaled,
    straightened, turned)

TWIST = PlanarTwist(1.5 - 0.5j, 2.0)
ARRAY = np.array([1.5, -0.5, 2.0])


def as_array(twist):
    return np.array([twist.velocity.real, twist.velocity.imag, twist.omega])


def test_module_velocities_are_those_of_the_kinematics():
    positions = np.array([[0.3, 0.2], [0.3, -0.2], [-0.4, 0.0]])
    states = SwerveKinematics(positions).inverse(ARRAY, (0.1, -0.2))
    velocities = module_velocities(TWIST, [complex(x - 0.1, y + 0.2) for x, y in positions])
    np.testing.assert_allclose(velocities, states.speed * np.exp(1j * states.angle), atol=1e-14)


@pytest.mark.parametrize('dt', [0.0, 1e-9, 0.02, 0.7])
def test_straightened_is_discretize(dt):
    np.testing.assert_allclose(
        as_array(straightened(TWIST, dt)), discretize(ARRAY, dt), atol=1e-14)


def test_straightened_never_skews_by_more_than_half_a_quarter_turn():
    np.testing.assert_allclose(
        as_array(straightened(TWIST, 3.0)), as_array(straightened(TWIST, 0.25 * np.pi)))


def test_displacing_is_the_inverse_of_straightened():
    back = displacing(straightened(TWIST, 0.3), 0.3)
    np.testing.assert_allclose(as_array(back), ARRAY, atol=1e-15)


def test_turned_is_the_rotation_of_a_field_twist():
    np.testing.assert_allclose(as_array(turned(TWIST, -0.7)), to_robot_frame(ARRAY, 0.7))


def test_between_reaches_its_end_exactly():
    assert between(REST, TWIST, 1.0) is TWIST
    assert between(REST, TWIST, 0.5) == scaled(TWIST, 0.5)
    assert rate_between(REST, TWIST, 0.5) == scaled(TWIST, 2.0)


def test_product_of_a_twist_with_itself_is_its_square():
    assert product(TWIST, TWIST) == pytest.approx(ARRAY @ ARRAY)
