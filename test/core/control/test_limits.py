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

"""Limits of speed: one factor for the whole twist, so that the curve is kept."""

import math

import numpy as np
import pytest

from swerve_kinematics import discretize, SwerveKinematics
from swerve_kinematics.core.control.limits import ControllerLimits, saturated, speed_scale
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.geometry.planar import PlanarTwist

DT = 0.02
POSITIONS = [(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)]
OFFSETS = Offsets(complex(x, y) for x, y in POSITIONS)


@pytest.mark.parametrize('value', [0.0, -1.0, 1e-300, math.nan])
def test_a_limit_that_is_not_positive_is_named(value):
    with pytest.raises(ValueError, match='max_linear_jerk must be positive'):
        ControllerLimits(max_linear_jerk=value)


def test_limits_are_plain_numbers():
    assert type(ControllerLimits(max_linear_speed=np.float64(2.0)).max_linear_speed) is float


@pytest.mark.parametrize('limits, scale', [
    ({}, 1.0), ({'max_linear_speed': 1.0}, 0.5), ({'max_angular_speed': 1.0}, 0.25),
    ({'max_module_speed': 1.0}, 1.0 / math.hypot(2.0 + 4 * 0.2, 4 * 0.3)),
    ({'max_linear_speed': 1.0, 'max_angular_speed': 1.0}, 0.25)])
def test_one_factor_brings_a_twist_within_all_speed_limits(limits, scale):
    twist = PlanarTwist(2.0 + 0j, 4.0)
    assert speed_scale(twist, OFFSETS, ControllerLimits(**limits)) == pytest.approx(scale)


def test_saturated_scales_before_it_discretizes():
    twist, dt = PlanarTwist(3.0 + 1.0j, 6.0), 0.05
    straight, scale = saturated(twist, OFFSETS, 1.2, dt)
    states = SwerveKinematics(POSITIONS).inverse(discretize(scale * np.array([3.0, 1.0, 6.0]), dt))
    assert states.speed.max() == pytest.approx(1.2, abs=1e-6)
    expected = discretize(scale * np.array([3.0, 1.0, 6.0]), dt)
    np.testing.assert_allclose(
        [straight.velocity.real, straight.velocity.imag, straight.omega], expected, rtol=1e-6)


def test_saturated_leaves_a_slow_twist_alone():
    assert saturated(PlanarTwist(1.0 + 0j, 0.0), OFFSETS, 1.2, DT) == ((1.0 + 0j, 0.0), 1.0)
