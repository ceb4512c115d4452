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

"""Tests of the filter of a gyro's bias."""

import numpy as np
import pytest

from swerve_kinematics.core.odometry.gyro import GyroBiasFilter


def test_filter_finds_a_constant_bias():
    rng = np.random.default_rng(1)
    bias_filter = GyroBiasFilter(initial_std=0.02)
    for _ in range(2000):
        bias_filter.predict(0.02)
        bias_filter.correct(0.01 + 0.05 * rng.standard_normal(), 0.05 ** 2)
    assert bias_filter.bias == pytest.approx(0.01, abs=3.0 * np.sqrt(bias_filter.variance))
    assert np.sqrt(bias_filter.variance) < 0.0015


def test_filter_is_the_kalman_filter_of_one_state():
    bias_filter = GyroBiasFilter(initial_std=0.1, drift=0.0)
    assert bias_filter.correct(0.05, 0.01) == pytest.approx(0.5)
    assert bias_filter.bias == pytest.approx(0.025)
    assert bias_filter.variance == pytest.approx(0.005)


def test_variance_grows_with_the_drift():
    bias_filter = GyroBiasFilter(initial_std=0.0, drift=0.002)
    for _ in range(100):
        bias_filter.predict(0.25)
    assert bias_filter.variance == pytest.approx(0.002 ** 2 * 25.0)


def test_wild_innovation_is_clipped_at_three_sigma():
    bias_filter = GyroBiasFilter(initial_std=0.01, drift=0.0)
    gain = bias_filter.correct(100.0, 0.02 ** 2)
    assert bias_filter.bias == pytest.approx(gain * 3.0 * np.hypot(0.01, 0.02))


@pytest.mark.parametrize('rate, variance', [
    (np.nan, 1.0), (np.inf, 1.0), (0.1, np.inf), (0.1, np.nan)])
def test_filter_ignores_what_is_no_measurement(rate, variance):
    bias_filter = GyroBiasFilter(initial_std=0.01)
    assert bias_filter.correct(rate, variance) == 0.0
    assert bias_filter.bias == 0.0
    assert bias_filter.variance == 0.01 ** 2


@pytest.mark.parametrize('arguments', [(-1.0, 0.0), (0.0, -1.0), (np.nan, 0.0), (0.0, np.inf)])
def test_filter_refuses_what_is_no_deviation(arguments):
    with pytest.raises(ValueError):
        GyroBiasFilter(*arguments)
