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

"""Tests of the estimate of how far stamps are off."""

import math

import numpy as np
import pytest

from swerve_kinematics.core.odometry.stamp_jitter import LEAST_SPEED, StampJitter

DT = 0.02


def learnt(errors, speed, turn=0.0, dt=DT):
    """Return the standard deviation of a stamp [s] after steps with these errors [m/s]."""
    stamps, back = StampJitter(), np.exp(-1j * turn)
    for error in errors:
        stamps.std(dt, back, complex(error), speed, 0.0)
    return math.sqrt(stamps.variance)


@pytest.mark.parametrize('speed', [0.3, 3.0])
@pytest.mark.parametrize('std', [0.3e-3, 4e-3])
def test_stamps_that_scatter_are_told_at_any_speed(speed, std):
    rng, found = np.random.default_rng(4), []
    for _ in range(40):
        late = std * rng.standard_normal(200)
        found.append(learnt(speed * np.diff(late) / DT, speed) ** 2)
    assert math.sqrt(np.mean(found)) == pytest.approx(std, rel=0.25)


def test_errors_are_compared_along_the_same_direction():
    late, turn = 1e-3 * (-1.0) ** np.arange(200), 0.3
    errors = np.diff(late) / DT
    turned = errors * np.exp(-1j * turn * np.arange(len(errors)))
    assert learnt(turned, 1.0, turn) == pytest.approx(learnt(errors, 1.0))


@pytest.mark.parametrize('errors', [
    np.full(200, 0.8),  # slip that stays
    np.linspace(0.0, 3.0, 200),  # or grows
    np.where(np.arange(200) > 190, 1.5, 0.0),  # or begins at once
    np.sin(0.3 * np.arange(200)),  # or comes and goes
])
def test_slip_is_no_jitter(errors):
    assert learnt(errors, 1.0) < 1e-5


@pytest.mark.parametrize('speed', [0.0, 1.0])
@pytest.mark.parametrize('dt', [0.01, 0.02, 0.3])
def test_encoders_that_are_set_anew_are_no_jitter(speed, dt):
    for seed in range(10):
        rng, stamps = np.random.default_rng(seed), StampJitter()
        for step in range(60):
            error = (1e-4 * rng.standard_normal() - 2.0 * (step == 50)) / dt
            stamps.std(dt, 1.0, complex(error), abs(speed + error), 0.0)
            assert not stamps.are_useless


def test_steps_of_any_length_tell_the_same():
    rng, found = np.random.default_rng(6), []
    for _ in range(40):
        steps = DT * rng.choice((1.0, 2.0, 3.0), 200, p=(0.7, 0.2, 0.1))
        stamps, late = StampJitter(), 2e-3 * rng.standard_normal(201)
        for dt, error in zip(steps, 1.5 * np.diff(late) / steps):
            stamps.std(dt, 1.0, complex(error), 1.5, 0.0)
        found.append(stamps.variance)
        stamps, error = StampJitter(), 0.0
        for dt in steps:
            error += 0.5 * dt  # slip that grows
            stamps.std(dt, 1.0, complex(error), 1.5, 0.0)
        assert stamps.variance == 0.0
    assert math.sqrt(np.mean(found)) == pytest.approx(2e-3, rel=0.25)


def test_what_stamps_make_of_a_velocity():
    stamps, rng = StampJitter(), np.random.default_rng(5)
    late = 1e-3 * rng.standard_normal(3000)
    told = [stamps.std(DT, 1.0, complex(error), 2.0, 0.0) for error in 2.0 * np.diff(late) / DT]
    assert np.mean(told[100:]) == pytest.approx(2.0 * math.sqrt(2.0) * 1e-3 / DT, rel=0.2)
    standing = [stamps.std(DT, 1.0, 0j, 0.0, 0.0) for _ in range(2)]
    assert standing[1] == 0.0


def test_stamps_that_come_in_bunches_tell_the_same():
    # At 200 Hz a driver that is held up stamps the next reading right after the last one.
    rng, found = np.random.default_rng(7), []
    for _ in range(20):
        due = 0.005 * np.arange(800)
        late = np.maximum.accumulate(due + rng.exponential(1e-3, len(due))) + 1e-5 * due - due
        steps = 0.005 + np.diff(late)
        stamps = StampJitter()
        for dt in steps:
            # A steady 1.5 m/s, as such stamps show it.
            stamps.std(dt, 1.0, 1.5 * (0.005 / dt - 1.0) + 0j, 1.5 * 0.005 / dt, 0.0)
        found.append(stamps.variance)
    assert math.sqrt(np.mean(found)) == pytest.approx(np.std(late), rel=0.25)


def test_the_last_bit_of_encoders_is_no_scatter_of_stamps():
    stamps, bit, rng = StampJitter(), 5e-3, np.random.default_rng(9)
    for error in np.diff(bit * rng.uniform(-0.5, 0.5, 400)) / DT:
        stamps.std(DT, 1.0, complex(error), 0.2, bit)
    assert stamps.variance == 0.0


@pytest.mark.parametrize('dt', [0.005, 0.02, 0.05])
@pytest.mark.parametrize('part, useless', [(0.0, False), (0.18, False), (0.35, True)])
def test_stamps_are_useless_where_they_scatter_by_a_good_part_of_a_period(dt, part, useless):
    stamps, rng = StampJitter(), np.random.default_rng(8)
    for error in np.diff(part * rng.standard_normal(round(8.0 / dt))):
        stamps.std(dt, 1.0, complex(error), 1.0, 0.0)
    assert stamps.are_useless == useless


def test_a_base_at_rest_tells_nothing_and_a_gap_interrupts():
    rounding = 0.5e-4 * (-1.0) ** np.arange(100)
    assert learnt(np.diff(rounding) / DT, 0.0) <= 1e-4 / LEAST_SPEED
    stamps = StampJitter()
    for error in (0.0, 1.0, 0.0):
        stamps.std(DT, 1.0, complex(error), 1.0, 0.0)
        stamps.interrupt()
    assert stamps.variance == 0.0
