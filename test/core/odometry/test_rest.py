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

"""Tests of the detection of rest."""

import numpy as np
import pytest

from swerve_kinematics.core.odometry.rest import RestDetector


def test_rest_needs_time_and_outlasts_an_encoders_last_bit():
    rest = RestDetector()
    flicker = [0.08e-3, 0.0]
    seen = [rest.update(0.02, np.array([1.0, 2.0]) + flicker[k % 2],
                        np.array([0.5, 3.1]) + 1.5e-3 * (k % 2)) for k in range(30)]
    assert not any(seen[:11])
    assert all(seen[12:])


@pytest.mark.parametrize('speed, steering_rate', [(2e-3, 0.0), (0.0, 0.5)])
def test_creeping_or_steering_is_no_rest(speed, steering_rate):
    rest = RestDetector()
    one = np.array([0.0, 1.0])
    assert not any(rest.update(0.02, speed * t * one, steering_rate * t * one)
                   for t in 0.02 * np.arange(100))


def test_missing_modules_are_no_rest():
    rest = RestDetector()
    assert not any(rest.update(0.1, np.array([0.0, np.nan]), np.zeros(2)) for _ in range(10))
