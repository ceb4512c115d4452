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

"""The delay between wheels and gyro, from the turns that both tell."""

from calibration_drives import Errors, KINEMATICS, NOMINAL_RADIUS, random_errors, straight, varied
import numpy as np
import pytest
from swerve_kinematics.core.calibration.calibration import calibrate_by_poses
from swerve_kinematics.core.calibration.recording import Recording


def with_delay(log, delay):
    """Return the recording of a log whose gyro is stamped late."""
    yaw = np.interp(log.stamp - delay, log.stamp, log.yaw)
    return Recording(log.stamp, NOMINAL_RADIUS * log.wheel_angle, log.steering_angle, yaw)


@pytest.mark.parametrize('rate', [100, 50, 20])
@pytest.mark.parametrize('delay', [-0.02, 0.0, 0.01, 0.06])
def test_a_delay_is_found_within_a_millisecond(rate, delay):
    rng = np.random.default_rng(rate)
    log = varied(random_errors(rng), rng, rate, duration=20.0)
    found = calibrate_by_poses(KINEMATICS, with_delay(log, delay), log.poses).gyro_delay
    assert found.value == pytest.approx(delay, abs=0.001)
    assert abs(found.value - delay) < 2.0 * found.std < 0.01


def test_silences_of_the_gyro_cost_nothing_but_themselves():
    rng = np.random.default_rng(3)
    log = varied(random_errors(rng), rng, duration=20.0)
    recording = with_delay(log, 0.015)
    recording.yaw[(log.stamp > 6.0) & (log.stamp < 9.0)] = np.nan
    found = calibrate_by_poses(KINEMATICS, recording, log.poses).gyro_delay
    assert found.value == pytest.approx(0.015, abs=0.001)


def test_it_is_unknown_where_nothing_turns_or_no_gyro_is_heard():
    rng = np.random.default_rng(4)
    errors = Errors(np.ones(4), np.zeros(4), 1.0)
    line, _ = straight(errors, rng)
    turning = varied(errors, rng, duration=10.0)
    silent = with_delay(turning, 0.0)
    for recording, poses in (
            (with_delay(line, 0.01), line.poses), (silent._replace(yaw=None), turning.poses),
            (silent._replace(yaw=np.nan * silent.yaw), turning.poses),
            (silent._replace(yaw=0.0 * silent.yaw), turning.poses)):
        found = calibrate_by_poses(KINEMATICS, recording, poses).gyro_delay
        assert (found.value, found.std) == (0.0, np.inf)
