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

"""Sticks: what full deflection means, and what the dead band leaves."""

import numpy as np
from numpy.testing import assert_allclose
import pytest
from swerve_kinematics import joystick_twist, SwerveKinematics


def test_full_deflection():
    assert_allclose(joystick_twist(1.0, -1.0, 1.0, max_speed=3.0, base_radius=0.5),
                    [3.0, -3.0, 6.0])


def test_full_turn_runs_the_wheels_at_the_maximum_speed():
    kinematics = SwerveKinematics([(0.3, 0.4), (0.3, -0.4), (-0.3, 0.4), (-0.3, -0.4)])
    twist = joystick_twist(0.0, 0.0, -1.0, max_speed=2.0, base_radius=0.5)
    assert_allclose(kinematics.inverse(twist).speed, 2.0)


def test_sticks_beyond_their_range_are_clipped():
    assert_allclose(joystick_twist(1.5, -7.0, np.inf, 2.0, 1.0), [2.0, -2.0, 2.0])


@pytest.mark.parametrize('stick, live', [
    (0.0, 0.0), (0.2, 0.0), (-0.2, 0.0), (0.6, 0.5), (-0.6, -0.5), (1.0, 1.0), (-1.0, -1.0)])
def test_dead_band_starts_at_zero_and_ends_at_full(stick, live):
    assert_allclose(joystick_twist(stick, 0.0, stick, 1.0, 1.0, deadband=0.2), [live, 0.0, live],
                    atol=1e-15)


def test_one_lost_axis_leaves_the_others():
    assert_allclose(joystick_twist(np.nan, 0.5, 1.0, 2.0, 1.0, 0.1), [np.nan, 0.8 / 0.9, 2.0])


@pytest.mark.parametrize('wrong, match', [
    ({'max_speed': -1.0}, 'max_speed'), ({'max_speed': np.nan}, 'max_speed'),
    ({'max_speed': np.inf}, 'max_speed'), ({'base_radius': np.inf}, 'base_radius'),
    ({'base_radius': 0.0}, 'base_radius'), ({'base_radius': np.nan}, 'base_radius'),
    ({'deadband': 1.0}, 'deadband'), ({'deadband': -0.1}, 'deadband')])
def test_limits_that_make_no_sense_are_refused(wrong, match):
    limits = {'max_speed': 1.0, 'base_radius': 1.0, 'deadband': 0.0} | wrong
    with pytest.raises(ValueError, match=match):
        joystick_twist(0.0, 0.0, 0.0, **limits)
