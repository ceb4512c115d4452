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

from benchmarks import drives
import numpy as np
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.traction import (
    BEST_GRIP, ICY_GRIP, POOR_GRIP, SLACK, Traction)

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
DT = 0.02


def excesses(traction, speeds, grip=BEST_GRIP, rate=0.0):
    """Return what a traction says of these speeds, driven ahead while turning at a rate."""
    return np.array([
        traction.excess(DT, speed * np.exp(-1j * rate * DT * k), rate * DT, grip)
        for k, speed in enumerate(speeds)])


@pytest.mark.parametrize('grip', [BEST_GRIP, POOR_GRIP, ICY_GRIP])
@pytest.mark.parametrize('share', [0.999, -0.999])
@pytest.mark.parametrize('rate', [0.0, 2.0])
def test_wheels_that_grip_have_no_excess(grip, share, rate):
    speeds = 1.0 + share * grip * DT * np.arange(100)
    assert excesses(Traction(), speeds, grip, rate).max() < 1e-9


@pytest.mark.parametrize('grip', [POOR_GRIP, ICY_GRIP])
def test_wheels_that_are_contradicted_may_all_slip_on_a_poor_floor(grip):
    speeds = 2.0 * grip * DT * np.arange(50)
    assert excesses(Traction(), speeds).max() == 0.0
    slipping = excesses(Traction(), speeds, grip)
    np.testing.assert_allclose(np.diff(slipping[1:]), grip * DT)


def test_a_contradiction_is_remembered_until_the_base_has_caught_up():
    traction, speeds = Traction(), 2.0 * POOR_GRIP * DT * np.arange(50)
    excesses(traction, speeds[:25], POOR_GRIP)
    slipping = excesses(traction, speeds[25:])
    assert (slipping > 0.0).all()
    at_last = excesses(traction, np.full(100, speeds[-1]))
    assert np.flatnonzero(at_last)[-1] * DT == pytest.approx(
        slipping[-1] / POOR_GRIP, abs=2.0 * DT)
    assert excesses(traction, speeds[-1] + speeds).max() == 0.0


def test_a_jump_wears_off_as_fast_as_a_poor_floor_lets_the_base_follow():
    slipping = excesses(Traction(), [0.0] + 100 * [1.5])
    assert slipping[1] == pytest.approx(1.5 - POOR_GRIP * DT)
    assert np.flatnonzero(slipping)[-1] * DT == pytest.approx(1.5 / POOR_GRIP, abs=2.0 * DT)


def test_what_encoders_and_stamps_do_to_the_speed_is_no_slip():
    rng = np.random.default_rng(0)
    noise = rng.uniform(-0.5 * SLACK, 0.5 * SLACK, 500)
    assert excesses(Traction(), 0.9 * BEST_GRIP * DT * np.arange(500) + noise).max() == 0.0


def test_velocities_after_a_gap_and_of_long_steps_are_taken_over():
    traction = Traction()
    assert excesses(traction, [3.0]) == 0.0
    traction.interrupt()
    assert excesses(traction, [-3.0]) == 0.0
    assert traction.excess(0.2, 3.0 + 0j, 1.0, POOR_GRIP) == 0.0
    assert traction.excess(DT, 3.0 + 0j, 0.0, BEST_GRIP) == 0.0


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


@pytest.mark.parametrize('yaw', [True, False])
def test_good_tyres_are_trusted(yaw):
    # Up to 2.5 m/s and 3 rad/s, with 11 m/s^2 where both meet: 90 m in 40 s.
    drive = drives.from_rest(drives.smooth_motion(CORNERS, 50, finest=1000))
    odo = SwerveOdometry(SwerveKinematics(CORNERS), drive.truth[0])
    drives.replay(odo, drive, yaw=yaw)
    assert np.sqrt(odo.pose_covariance[0, 0]) < (0.1 if yaw else 0.5)
