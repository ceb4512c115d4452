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

"""Accelerations and steering rates: known numbers, and the derivatives they claim to be."""

from hypothesis import given
import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
import pytest
from strategies import layouts, twists
from swerve_kinematics import SwerveKinematics, to_field_frame

S12 = SwerveKinematics([(12, 12), (12, -12), (-12, 12), (-12, -12)])
BASE = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
TURN = 2.0 * np.pi
STEP = 1e-5


@pytest.mark.parametrize('kinematics, acceleration, omega, size, degrees', [
    (S12, (0, 0, TURN), TURN, (678.403181,) * 4,
     (-144.043061, 125.956939, -54.043061, 35.956939)),
    (BASE, (0.5, -0.2, 1.5), 2.0, (1.141271, 1.123610, 2.015564, 2.005617),
     (-151.189206, 110.854458, -46.005086, 4.289153))])
def test_known_module_accelerations(kinematics, acceleration, omega, size, degrees):
    x, y = kinematics.module_accelerations(acceleration, omega).T
    assert_allclose(np.hypot(x, y), size, atol=1e-6)
    assert_allclose(np.degrees(np.arctan2(y, x)), degrees, atol=1e-6)


def test_a_steady_turn_still_pulls_the_modules_inwards():
    assert_allclose(BASE.module_accelerations([0.0, 0.0, 0.0], 2.0),
                    -4.0 * BASE.module_positions)


def test_a_module_on_the_centre_has_the_acceleration_of_the_centre():
    center = BASE.module_positions[1]
    vectors = BASE.module_accelerations([0.5, -0.2, 1.5], 2.0, center)
    assert_allclose(vectors[1], [0.5, -0.2])


@given(layouts(), twists(count=1), twists(count=1))
def test_module_accelerations_are_the_derivative_of_the_world_velocity(positions, twist, rate):
    twist, rate = twist[0], rate[0]
    vx, vy, omega = twist
    # The inertial acceleration of base_link: the rate of its twist, and omega x v.
    inertial = rate + [-omega * vy, omega * vx, 0.0]

    def world_velocity(time):
        now = twist + rate * time
        heading = omega * time + 0.5 * rate[2] * time ** 2
        x, y = positions.T
        velocity = np.stack((now[0] - now[2] * y, now[1] + now[2] * x, 0.0 * x), axis=-1)
        return to_field_frame(velocity, heading)[:, :2]

    derivative = (world_velocity(STEP) - world_velocity(-STEP)) / (2.0 * STEP)
    vectors = SwerveKinematics(positions).module_accelerations(inertial, omega)
    assert_allclose(vectors, derivative, atol=1e-6)


@given(layouts(), twists(), twists(count=1))
def test_accelerations_about_a_centre_are_those_of_a_body_seen_from_there(positions, rate, other):
    center, omega = other[0, :2], other[0, 2]
    assert_allclose(SwerveKinematics(positions).module_accelerations(rate, omega, center),
                    SwerveKinematics(positions - center).module_accelerations(rate, omega),
                    atol=1e-11)


@given(layouts(), twists())
def test_chassis_acceleration_undoes_module_accelerations(positions, acceleration):
    kinematics = SwerveKinematics(positions)
    omega = np.linspace(-3.0, 3.0, len(acceleration))
    vectors = kinematics.module_accelerations(acceleration, omega)
    expected = np.concatenate((acceleration, omega[:, np.newaxis] ** 2), axis=-1)
    assert_allclose(kinematics.chassis_acceleration(vectors), expected, atol=1e-10)


@given(layouts(), twists())
def test_chassis_acceleration_is_the_least_squares_fit(positions, noise):
    vectors = np.resize(noise, (len(positions), 2))
    matrix = np.concatenate([[(1, 0, -y, -x), (0, 1, x, -y)] for x, y in positions])
    expected = np.linalg.lstsq(matrix, vectors.reshape(-1), rcond=None)[0]
    fit = SwerveKinematics(positions).chassis_acceleration(vectors)
    assert_allclose(fit, expected, atol=1e-9)


def test_chassis_acceleration_refuses_wrong_shapes():
    for wrong in (np.zeros((3, 2)), np.zeros((4, 3)), np.zeros(4)):
        with pytest.raises(ValueError, match='module_accelerations'):
            BASE.chassis_acceleration(wrong)


@given(layouts(), twists(), twists())
def test_steering_rates_are_the_derivative_of_inverse(positions, twist, rate):
    center = (0.1, -0.2)
    kinematics = SwerveKinematics(positions)
    before = kinematics.inverse(twist - STEP * rate, center)
    after = kinematics.inverse(twist + STEP * rate, center)
    moving = kinematics.inverse(twist, center).speed > 0.3
    drive, steering = kinematics.steering_rates(twist, rate, center)
    turned = np.angle(np.exp(1j * (after.angle - before.angle)))
    assert_allclose(steering[moving], turned[moving] / (2 * STEP), rtol=1e-5, atol=1e-4)
    assert_allclose(drive[moving], ((after.speed - before.speed) / (2 * STEP))[moving],
                    rtol=1e-5, atol=1e-4)


def test_a_steady_twist_needs_no_steering():
    drive, steering = BASE.steering_rates([1.0, 0.5, 2.0], [0.0, 0.0, 0.0])
    assert_array_equal(drive, 0.0)
    assert_array_equal(steering, 0.0)


@pytest.mark.parametrize('speed, defined', [(0.0, False), (0.999e-6, False), (1.001e-6, True)])
def test_rates_are_zero_where_a_velocity_has_no_direction(speed, defined):
    drive, steering = BASE.steering_rates([speed, 0.0, 0.0], [1.0, 1.0, 0.0])
    assert_allclose(drive, 1.0 if defined else 0.0)
    assert_allclose(steering, 1.0 / speed if defined else 0.0)
