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

"""Tests of the twist: all of it is that of the stamp."""

from benchmarks import drives
import numpy as np
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.twist import Extrapolation

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])


@pytest.mark.parametrize('rate', [20, 50])
@pytest.mark.parametrize('gyro', [True, False])
def test_the_twist_belongs_to_the_stamp(rate, gyro):
    fine = drives.smooth_motion(CORNERS, 1000, duration=10.0, finest=2000)
    velocity = np.gradient(fine.truth[:, 0] + 1j * fine.truth[:, 1], fine.stamp)
    velocity *= np.exp(-1j * fine.truth[:, 2])
    picked = slice(None, None, 1000 // rate)
    drive, velocity = fine.at(picked), velocity[picked]
    odometry = SwerveOdometry(SwerveKinematics(CORNERS), drive.truth[0], False)
    off, late, nees = [], [], []
    for k, stamp in enumerate(drive.stamp):
        odometry.update(stamp, drive.distance[k], drive.angle[k],
                        drive.yaw[k] if gyro else None)
        vx, vy, omega = odometry.twist
        if k > 5:
            error = vx - velocity[k].real, vy - velocity[k].imag, omega - drive.yaw_rate[k]
            nees.append(error @ np.linalg.solve(odometry.twist_covariance, error))
            off.append((abs(complex(vx, vy) - velocity[k]), abs(omega - drive.yaw_rate[k])))
            middle = 0.5 * (velocity[k] + velocity[k - 1])
            late.append((abs(middle - velocity[k]),
                         0.5 * abs(drive.yaw_rate[k] - drive.yaw_rate[k - 1])))
    assert (np.max(off, axis=0) < 0.25 * np.max(late, axis=0)).all()
    assert np.mean(nees) < 3.0


def test_a_steady_slope_is_carried_on_exactly():
    means, rng = Extrapolation(), np.random.default_rng(1)
    start = 0.0
    for _ in range(60):
        dt = rng.uniform(0.01, 0.05)
        middle = start + 0.5 * dt
        velocity, yaw_rate = means.at_end(dt, 3.0 * middle + 1.0j, -2.0 * middle)
        start += dt
    assert abs(velocity - (3.0 * start + 1.0j)) < 1e-6 and abs(yaw_rate + 2.0 * start) < 1e-6


def test_a_gap_leaves_no_slope():
    means = Extrapolation()
    for mean in (0.0, 1.0):
        means.at_end(0.1, complex(mean), mean)
    means.interrupt()
    assert means.at_end(0.1, 5.0 + 0j, 4.0) == (5.0, 4.0)
    assert means.acceleration == means.turning == 0.0


@pytest.mark.parametrize('gyro', [True, False])
@pytest.mark.parametrize('speed', [0.0, 0.1, 1.0])
def test_a_step_too_short_to_tell_does_not_disturb_the_twist(gyro, speed):
    rng = np.random.default_rng(1)
    odometry, stamp, way, resolution = SwerveOdometry(SwerveKinematics(CORNERS)), 0.0, 0.0, 5e-4
    for k in range(600):
        dt = 0.02 * rng.uniform(0.8, 1.2)
        way += speed * dt
        if k % 15 == 14:  # a clock was set back by up to 0.4 s: what came meanwhile was dropped
            way, dt = way + speed * rng.uniform(0.0, 0.4), 10.0 ** rng.uniform(-6.0, -2.5)
        stamp += dt
        counts = np.round((way + rng.normal(0.0, 2e-4, 4)) / resolution)
        odometry.update(stamp, counts * resolution, np.zeros(4),
                        rng.normal(0.0, 1e-4) if gyro else None)
        if k > 10:
            vx, vy, omega = odometry.twist
            assert abs(complex(vx - speed, vy)) < 0.1 and abs(omega) < 0.2


@pytest.mark.parametrize('gap', [0.15, 0.5, 10.0])
@pytest.mark.parametrize('before', [0, 50])
@pytest.mark.parametrize('dt', [0.01, 0.02, 0.05])
def test_steps_after_a_long_one_are_not_too_short_to_tell(dt, before, gap):
    odometry, way = SwerveOdometry(SwerveKinematics(CORNERS)), 0.0
    stamps = np.cumsum([0.0, *[dt] * before, gap, dt])
    for stamp in stamps:
        way += dt * (stamp == stamps[-1])
        odometry.update(stamp, np.full(4, way), np.zeros(4), 0.0)
    assert odometry.twist[0] > 0.5


@pytest.mark.parametrize('factor', [0.3, 0.5, 2.0, 3.5])
@pytest.mark.parametrize('gyro', [True, False])
def test_a_leap_that_one_step_tells_of_is_doubted_and_one_of_two_is_true(gyro, factor):
    odometry, stamp, way = SwerveOdometry(SwerveKinematics(CORNERS)), 0.0, 0.0
    for k in range(40):
        stamp += 0.02 / factor if k == 20 else 0.02
        way += 0.1 if k >= 30 else 0.03
        known = odometry.twist_covariance[0, 0]
        odometry.update(stamp, np.full(4, way), np.zeros(4), 0.0 if gyro else None)
        if 0 < k < 31:
            assert odometry.twist[0] == pytest.approx(1.5, abs=0.7 if k == 20 else 0.2)
        if (k == 30 or k == 20 and factor > 1.0) and odometry.twist[0] == 1.5:
            # It may be either. (A clock that was set forward is known as such.)
            assert odometry.twist_covariance[0, 0] > known + 0.5
    assert odometry.twist[0] == pytest.approx(5.0, abs=0.2)


@pytest.mark.parametrize('rate', [50, 100, 200])
@pytest.mark.parametrize('rolling', [0.0, 1.0])
def test_a_base_that_is_pushed_around_turns_although_its_wheels_do_not(rolling, rate):
    odometry, yaw = SwerveOdometry(SwerveKinematics(CORNERS)), 0.0
    for k in range(2 * rate):
        turning = min(60.0 * max(k / rate - 1.0, 0.0), 4.0)
        yaw += turning / rate
        odometry.update(k / rate, np.full(4, rolling * k / rate), np.zeros(4), yaw)
        if k > 1.1 * rate:
            assert odometry.twist[2] > 3.5
    assert odometry.twist[2] == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize('gyro', [True, False])
@pytest.mark.parametrize(('dt', 'jitter'), [(0.002, 0.001), (0.02, 0.008)])
def test_velocities_that_are_measured_are_told_whatever_the_stamps(gyro, dt, jitter):
    rng, odometry = np.random.default_rng(1), SwerveOdometry(SwerveKinematics(CORNERS))
    for k in range(300):
        speed = 2.0 + np.sin(dt * k)
        odometry.update(dt * k + rng.uniform(-jitter, jitter), np.full(
            4, 2.0 * dt * k - np.cos(dt * k)), np.zeros(4), 0.0 if gyro else None,
            velocities=np.full(4, speed))
        if k > 10:
            is_told = odometry.twist[0] == pytest.approx(speed)
            # A step much shorter than usual tells nothing.
            assert is_told or odometry.twist[0] == pytest.approx(speed, abs=2.0 * dt)
            assert np.sqrt(odometry.twist_covariance[0, 0]) < 4.0
