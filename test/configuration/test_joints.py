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

"""Joint space and module space: what each parameter means, and one the inverse of the other."""

from hypothesis import given, strategies as st
import numpy as np
import pytest

from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.joints import (
    JOINT_DECLARATIONS, joints_from, ModuleJoints)

TURN = 2.0 * np.pi
FEW = st.integers(2, 8)


def values(**given):
    """Return the values of all joint parameters."""
    return {**{declaration.name: declaration.default for declaration in JOINT_DECLARATIONS},
            **given}


@st.composite
def described(draw):
    """Draw the joints of a base, with numbers of any kind."""
    count = draw(FEW)

    def numbers(strategy):
        return draw(st.lists(strategy, min_size=count, max_size=count))
    ratio = st.floats(0.05, 20.0)
    return joints_from(values(
        wheel_radii=numbers(st.floats(0.02, 0.3)),
        drive_directions=numbers(st.sampled_from((1.0, -1.0))), drive_ratios=numbers(ratio),
        drive_coupling_ratio=numbers(st.sampled_from((0.0, 1.0, -3.5))),
        steering_directions=numbers(st.sampled_from((1.0, -1.0))),
        steering_ratios=numbers(ratio), steering_offsets=numbers(st.floats(-4.0, 4.0))), count)


@given(described(), st.integers(0, 2 ** 32 - 1))
def test_the_converter_is_its_own_inverse(joints, seed):
    rng = np.random.default_rng(seed)
    drives, steerings = rng.normal(scale=30.0, size=(2, len(joints.wheel_radii))).tolist()
    angles = joints.module_angles(steerings)
    np.testing.assert_allclose(joints.steering_positions(angles), steerings, atol=1e-9)
    np.testing.assert_allclose(
        joints.drives(joints.travel(drives, angles), angles), drives, atol=1e-9)
    rates = joints.module_rates(steerings)
    np.testing.assert_allclose(joints.steering_velocities(rates), steerings, atol=1e-9)


@given(described(), st.integers(0, 2 ** 32 - 1))
def test_velocities_are_the_slopes_of_positions(joints, seed):
    rng = np.random.default_rng(seed)
    count = len(joints.wheel_radii)
    (way, angle), (speed, rate) = rng.normal(scale=3.0, size=(2, 2, count))
    dt = 0.01

    def positions(time):
        angles = (angle + rate * time).tolist()
        return np.array([joints.drives((way + speed * time).tolist(), angles),
                         joints.steering_positions(angles)])
    np.testing.assert_allclose(
        (positions(dt) - positions(0.0)) / dt,
        [joints.drives(speed.tolist(), rate.tolist()), joints.steering_velocities(rate.tolist())],
        atol=1e-8)


@given(described())
def test_offset_and_coupling_mean_what_their_parameters_say(joints):
    count = len(joints.wheel_radii)
    straight = joints.steering_positions([0.0] * count)
    assert straight == joints.steering_offsets
    held_still = np.subtract(joints.drives([1.0] * count, [TURN] * count),
                             joints.drives([1.0] * count, [0.0] * count))
    np.testing.assert_allclose(held_still / TURN, joints.drive_coupling_ratios, atol=1e-9)


def test_directions_and_ratios_mean_what_their_parameters_say():
    joints = joints_from(values(
        wheel_radii=[0.1], drive_directions=[1.0, -1.0], drive_ratios=[6.75],
        steering_directions=[-1.0, 1.0], steering_ratios=[1.0, 12.0]), 2)
    # One turn of the wheel forwards, and one of the module counter-clockwise.
    np.testing.assert_allclose(
        joints.drives([0.1 * TURN] * 2, [0.0] * 2), [6.75 * TURN, -6.75 * TURN])
    np.testing.assert_allclose(joints.steering_positions([TURN] * 2), [-TURN, 12.0 * TURN])


def test_an_unknown_steering_matters_only_where_it_is_coupled():
    joints = ModuleJoints([0.1, 0.1], drive_coupling_ratios=[0.0, 1.0])
    assert joints.travel([1.0, 1.0], [np.nan] * 2) == [0.1, pytest.approx(np.nan, nan_ok=True)]
    assert ModuleJoints([0.1]).travel([1.0], [np.nan]) == [0.1]


@pytest.mark.parametrize('name, bad', [
    ('drive_directions', [0.5]), ('steering_directions', [1.0, -1.0, 0.0]),
    ('drive_ratios', [1.0, 2.0]), ('drive_coupling_ratio', [1.0] * 4),
    ('steering_ratios', [])])
def test_a_description_that_makes_no_sense_is_refused_by_name(name, bad):
    with pytest.raises(ParameterError, match=f"'{name}'"):
        joints_from(values(**{name: bad}), 3)


def test_a_number_for_each_module_is_needed():
    with pytest.raises(ValueError, match='2 numbers'):
        ModuleJoints([0.1, 0.1], drive_ratios=[1.0])
