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

"""Tests of the filter of velocity, bias, lean and creep."""

import math

from hypothesis import given
from inertial_replay import ALIKE
import numpy as np
import pytest
from strategies import seeds

from swerve_kinematics.core.odometry import inertial, velocity_filter
from swerve_kinematics.core.odometry.inertial import Inertial
from swerve_kinematics.core.odometry.velocity_filter import VelocityFilter


def test_a_rest_tells_what_the_force_is_off_by():
    # Bias and lean are unknown each, their sum is not.
    judge, dt = Inertial(0j), 0.02
    for _ in range(100):
        judge.judge(dt, ALIKE, 0j, 0.3 + 0.1j, 0j, 0.0)
        judge.settle(dt, 0j, 0.0)
    assert judge._filter.force_std < 0.1 < math.sqrt(judge._filter._bias_variance)
    # One that is mounted askew shows more the harder the base accelerates.
    judge.judge(dt, ALIKE, 0j, 10.3 + 0.1j, 0j, 0.0)
    judge.judge(dt, ALIKE, 0j, 10.3 + 0.1j, 0j, 0.0)
    assert judge._filter.force_std > 0.4


@given(seeds)
def test_an_offset_that_bias_and_lean_do_not_explain_teaches_them_no_more(seed):
    rng = np.random.default_rng(seed)
    direction, stds = np.exp(1j * rng.uniform(0.0, 6.28)), rng.uniform(4.0, 100.0)
    told = []
    for factor in (velocity_filter.LARGEST_STDS, stds):
        ours = VelocityFilter()
        ours.restart(1.0 + 0j, 0.01)
        for _ in range(10):
            ours.predict(0.02, np.exp(0.02j), 0.02 + 0j, None)
            ours.coast(0.02)
        std = math.sqrt(ours.wheel_variance + 0.001)
        ours.reconcile(factor * std * direction, 0.001)
        told.append((abs(ours.bias), abs(ours.lean), abs(ours.way_error) / factor))
    (bias, lean, way), (bias_beyond, lean_beyond, way_beyond) = told
    assert 0.0 < bias_beyond <= bias * (1.0 + 1e-9)
    assert 0.0 < lean_beyond <= lean * (1.0 + 1e-9)
    assert way_beyond == pytest.approx(way)


def test_beyond_a_lean_the_wheels_are_believed():
    judge, dt = Inertial(0j), 0.02
    for k in range(400):
        lean = complex(min(k * dt, 4.0))
        judge.judge(dt, ALIKE, 0j, lean, None, 0.0)
        judge.settle(dt, 0j, 0.0)
    assert abs(judge.lean) > 1.0
    assert judge.believed == (abs(judge.lean) <= inertial.LARGEST_LEAN)


@given(seeds)
def test_the_filter_is_the_textbooks(seed):
    rng = np.random.default_rng(seed)
    ours = VelocityFilter()
    ours.restart(complex(*rng.normal(size=2)), 0.1)
    # The way that was coasted, and the four states: velocity, bias, lean, creep.
    state = np.array((0j, ours.velocity, 0j, 0j, 0j))
    covariance = np.diag((0.0, 0.1, velocity_filter.BIAS_STD ** 2, velocity_filter.LEAN_STD ** 2,
                          velocity_filter.CREEP_STD ** 2)).astype(complex)
    for k in range(12):
        h, back = rng.uniform(0.005, 0.1), np.exp(1j * rng.normal(scale=0.3))
        gained = complex(*rng.normal(size=2))
        tilted = complex(*rng.normal(scale=0.01, size=2)) if rng.random() < 0.5 else None
        before = state[1]
        ours.predict(h, back, gained, tilted)
        step = np.array(((back, 0, 0, 0, 0), (0, back, -h, -h * back, 0), (0, 0, 1, 0, 0),
                         (0, 0, 0, back, 0), (0, 0, 0, 0, 1)))
        tilt = tilted or 0.0
        state = step @ state + (0.0, gained - 0.5 * h * tilt, 0.0, tilt, 0.0)
        lean_drift = (velocity_filter.FOLLOWED_DRIFT if tilted is not None
                      else velocity_filter.LEAN_DRIFT * (1.0 + abs(ours.velocity)))
        covariance = step @ covariance @ step.conj().T + h * np.diag(
            (0.0, velocity_filter.VIBRATION ** 2, velocity_filter.BIAS_DRIFT ** 2,
             lean_drift ** 2, velocity_filter.CREEP_DRIFT ** 2 * abs(ours.velocity)))
        acceleration = (state[1] - back * before) / h
        assert ours.acceleration == pytest.approx(acceleration)
        if k % 3:
            ours.coast(h)
            moved = np.eye(5, dtype=complex)
            moved[0, 1] = h
            covariance = moved @ covariance @ moved.T
        if k % 2:
            continue
        measured = np.array((0.0, 1.0, 0.0, 0.0, acceleration))
        innovation, variance = complex(*rng.normal(size=2)), rng.uniform(1e-4, 0.1)
        assert ours.wheel_velocity == pytest.approx(measured @ state)
        ours.correct(innovation, variance)
        with_measured = covariance @ measured.conj()
        total = (measured @ with_measured).real + variance
        state = state + with_measured / total * innovation
        # A time is a number, and no tyre or encoder is off by more than so much.
        state[4] = np.clip(state[4].real, -velocity_filter.LARGEST_CREEP,
                           velocity_filter.LARGEST_CREEP)
        covariance = covariance - np.outer(with_measured, with_measured.conj()) / total
        np.testing.assert_allclose((ours.velocity, ours.bias, ours.lean, ours.creep), state[1:],
                                   atol=1e-9)
        np.testing.assert_allclose(ours.way_error, with_measured[0] / total * innovation,
                                   atol=1e-9)
        ours.way_error = 0j
        assert ours.variance == pytest.approx(covariance[1, 1].real)
