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

"""A gyro that is heard more rarely than the wheels, through the parts of the node."""

import math

from benchmarks import drives
from inertial_replay import CORNERS
import numpy as np
from odometry_parts import OdometryParts
import pytest

from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.geometry.rotations import from_roll_pitch_yaw

FINE = 200  # Hz
DRIVE = drives.smooth_motion(CORNERS, FINE, duration=16.0, finest=2000)


@pytest.mark.parametrize('has_yaw', [True, False])
@pytest.mark.parametrize('rate, joints_rate', [(10, 50), (10, 100), (20, 100)])
def test_what_it_makes_up_for_is_not_taken_for_its_bias(has_yaw, rate, joints_rate):
    parts, headings = OdometryParts(
        module_x=CORNERS[:, 0].tolist(), module_y=CORNERS[:, 1].tolist(), wheel_radii=[1.0],
        imu_use='auto' if has_yaw else 'rate'), []
    noise = 0.002 * np.random.default_rng(0).standard_normal(len(DRIVE.stamp))
    for k, stamp in enumerate(1.0 + DRIVE.stamp):
        if k % (FINE // rate) == 0:
            parts.hear_imu(stamp - 0.001, from_roll_pitch_yaw(0.0, 0.0, DRIVE.yaw[k]),
                           (0.0, 0.0, DRIVE.yaw_rate[k] + noise[k]), None)
        if k % (FINE // joints_rate) == 0:
            headings.append(parts.hear_joints(
                stamp, [*DRIVE.distance[k].tolist(), *DRIVE.angle[k].tolist()])[2])
    errors = wrap_angle(headings - DRIVE.truth[::FINE // joints_rate, 2] - headings[0]
                        + DRIVE.truth[0, 2])
    assert np.abs(errors).max() < math.radians(4.0)


@pytest.mark.parametrize('rate, spin', [(10, 6.0), (20, 8.0), (50, 8.0), (50, 20.0), (100, 12.0)])
@pytest.mark.parametrize('reset', [0.0, 1.0])
def test_an_orientation_without_a_rate_is_followed_however_fast_the_base_spins(
        rate, spin, reset):
    """The wheels roll too far by 5 %, so that only the gyro knows the turn."""
    time = np.arange(6 * FINE) / FINE
    yaw = np.cumsum(np.minimum(5.0 * time, spin)) / FINE
    parts = OdometryParts(
        module_x=CORNERS[:, 0].tolist(), module_y=CORNERS[:, 1].tolist(), wheel_radii=[1.0],
        imu_use='orientation', estimate_gyro_bias=False)
    angles = np.arctan2(CORNERS[:, 0], -CORNERS[:, 1]).tolist()
    rolled = 1.05 * np.outer(yaw, np.hypot(*CORNERS.T))
    for k, stamp in enumerate(1.0 + time):
        if k % (FINE // rate) == 0:
            anew = reset if time[k] > 5.0 else 0.0
            parts.hear_imu(stamp - 0.003, from_roll_pitch_yaw(
                0.0, 0.0, np.interp(time[k] - 0.003, time, yaw) + anew), (0.0, 0.0, 0.0), None)
        if k % (FINE // 100) == 0:
            heading = parts.hear_joints(stamp, [*rolled[k].tolist(), *angles])[2]
    # What was turned while the yaw was set anew is not known.
    assert abs(heading - yaw[k - 1]) < 0.02 + (2.0 * spin / rate if reset else 0.0)
    assert bool(parts.odometry.yaw_jumps) == bool(reset)
