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

"""Tests of what the odometry makes of wheels that change their speed faster than tyres can."""

import numpy as np
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.traction import GRIP, Traction

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
DT = 0.02


@pytest.mark.parametrize('acceleration', [0.5 * GRIP, -0.9 * GRIP])
@pytest.mark.parametrize('rate', [0.0, 2.0])
def test_wheels_that_grip_have_no_excess(acceleration, rate):
    grip = Traction()
    for k in range(100):
        heading = np.exp(-1j * rate * DT * k)
        assert grip.excess(DT, (1.0 + acceleration * DT * k) * heading, rate * DT) < 1e-9


def test_a_jump_wears_off_as_fast_as_the_base_can_follow():
    grip, dt, excesses = Traction(), 0.02, []
    grip.excess(dt, 0j, 0.0)
    for _ in range(100):
        excesses.append(grip.excess(dt, 1.5 + 0j, 0.0))
    assert excesses[0] == pytest.approx(1.5 - GRIP * dt)
    assert np.flatnonzero(excesses)[-1] * dt == pytest.approx(1.5 / GRIP, abs=2.0 * dt)


def test_velocities_after_a_gap_and_of_long_steps_are_taken_over():
    grip = Traction()
    assert grip.excess(DT, 3.0 + 0j, 0.0) == 0.0
    grip.interrupt()
    assert grip.excess(DT, -3.0 + 0j, 0.0) == 0.0
    assert grip.excess(0.2, 3.0 + 0j, 0.0) == 0.0


@pytest.mark.parametrize('yaw', [0.0, None])
@pytest.mark.parametrize('change', ['start', 'stop'])
def test_wheels_that_spin_or_lock_alike_make_the_pose_less_sure(yaw, change):
    # To 2 m/s or from it within 0.1 s: no wheel contradicts another, and the base lags behind.
    stds = []
    for ramp in (0.1, 2.0):
        odo, way = SwerveOdometry(SwerveKinematics(CORNERS)), 0.0
        for k in range(200):
            speed = 2.0 * min(max((k - 50) * DT / ramp, 0.0), 1.0)
            way += DT * (speed if change == 'start' else 2.0 - speed)
            odo.update(k * DT, np.full(4, way), np.zeros(4), yaw)
        stds.append(np.sqrt(odo.pose_covariance[0, 0]))
    assert stds[0] > 0.1
    assert stds[0] > 3.0 * stds[1]
