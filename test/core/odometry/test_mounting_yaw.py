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

"""Tests of how the yaw at which an accelerometer is mounted shows in a drive."""

import math

from hypothesis import given, settings, strategies as st
from inertial_replay import DRIVE, FORCES, replay, spinning
import numpy as np
import pytest
from strategies import seeds
from swerve_kinematics.core.odometry.mounting_yaw import MountingYaw


def turned(forces, angle):
    """Return forces as a sensor shows them that is mounted further clockwise by an angle."""
    rotated = (forces[:, 0] + 1j * forces[:, 1]) * np.exp(1j * angle)
    return np.column_stack((rotated.real, rotated.imag))


@settings(max_examples=8, deadline=None)
@given(st.floats(math.radians(32.0), math.radians(328.0)), seeds)
def test_an_accelerometer_that_is_turned_is_found_and_not_used(angle, seed):
    noise = np.random.default_rng(seed).normal(0.1, 0.3, FORCES.shape)
    odo, _, coasted = replay(forces=turned(FORCES, angle) + noise)
    assert math.remainder(odo.imu_yaw_error + angle, math.tau) == pytest.approx(0.0, abs=0.1)
    assert not odo.accelerometer_believed
    assert not coasted[len(coasted) // 2:].any()


@settings(max_examples=8, deadline=None)
@given(st.floats(math.radians(50.0), math.radians(310.0)), seeds)
def test_what_it_spoils_before_it_is_distrusted_is_made_up_for(angle, seed):
    noise = np.random.default_rng(seed).normal(0.1, 0.3, FORCES.shape)
    _, poses, _ = replay(forces=turned(FORCES, angle) + noise)
    assert np.hypot(*(poses - DRIVE.truth)[:, :2].T).max() < 0.8  # 2 to 7 m, if it was believed


@pytest.mark.parametrize('agree', [True, False])
def test_only_wheels_that_agree_say_at_once_that_a_sensor_is_turned(agree):
    mounting = MountingYaw()
    assert any(mounting.add(0.02, 1.0, 0.02, 0.02j, agree) for _ in range(100)) == agree
    assert not mounting.proof.is_given


def test_a_sensor_that_has_felt_what_the_wheels_do_is_not_suspected():
    mounting = MountingYaw()
    assert not any(mounting.add(0.02, 1.0, 0.02, force, True)
                   for force in (0.02, 0.02j) for _ in range(100))
    assert mounting.proof.is_given


@settings(max_examples=12, deadline=None)
@given(st.floats(-0.3, 0.3), st.floats(0.0, 0.6), st.floats(-math.pi, math.pi),
       st.sampled_from([0.0, 0.5, 1.8]), seeds)
def test_neither_slip_nor_floor_nor_bias_look_like_a_turned_accelerometer(
        angle, size, way, factor, seed):
    lean = size * np.exp(1j * (way - DRIVE.yaw))
    noise = np.random.default_rng(seed).normal(0.1, 0.3, FORCES.shape)
    forces = turned(FORCES, angle) + noise + np.column_stack((lean.real, lean.imag))
    start = 16.0 * np.random.default_rng(seed).random()
    odo, _, _ = replay(spinning(DRIVE, start, start + 2.0, factor), forces)
    assert odo.imu_yaw_error == 0.0


def test_a_sensor_that_stops_being_turned_is_used_again():
    early = len(FORCES) // 4
    forces = np.concatenate((turned(FORCES[:early], 0.5 * math.pi), FORCES[early:]))
    assert replay(DRIVE.at(slice(early)), forces)[0].imu_yaw_error
    odo, _, _ = replay(forces=forces)
    assert odo.imu_yaw_error == 0.0
    assert odo.accelerometer_believed
