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

"""Tests of how long the wheels took for a step, by stamps that may scatter about the readings."""

import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from swerve_kinematics.core.odometry.wheel_time import WheelTime

PERIODS = [0.005, 0.02, 0.05]
seeds = st.integers(0, 10_000)


def durations(read, stamps, ways, gyro=None, asked=None):
    """Return how long steps took for the wheels, and, where asked, for a gyro's yaws [rad]."""
    time, usual, lasted, turned = WheelTime(1), 0.0, [], []
    for k, dt in enumerate(np.diff(stamps)):
        usual += 0.3 * (min(dt, 0.1) - usual) if k else dt
        lasted.append(time.duration(dt, abs(ways[k + 1] - ways[k]), usual))
        if gyro is not None:
            turned.append(time.turn_duration(gyro[k + 1] - gyro[k]) if asked[k] else math.nan)
    return np.array(lasted), np.array(turned)


def driven(read, seed=0):
    """Return how far a wheel has rolled at these times [m]: 0.5 to 3 m/s, up to 3 m/s^2."""
    start = np.random.default_rng(seed).uniform(0.0, 6.0)
    return 1.75 * read - 0.5 * np.cos(2.4 * read + start)


def off(told, true):
    """Return the root mean square error of durations [s], after two seconds of driving."""
    late = np.cumsum(true) > 2.0
    return math.sqrt(np.nanmean((told - true)[late] ** 2))


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(PERIODS), st.floats(0.03, 0.2), st.sampled_from(['normal', 'exponential']),
       seeds)
def test_even_readings_took_even_steps_whatever_their_stamps(period, part, kind, seed):
    rng = np.random.default_rng(seed)
    read = period * np.arange(round(8.0 / period))
    stamps = read + part * period * getattr(rng, f'standard_{kind}')(len(read))
    lasted, _ = durations(read, stamps, driven(read, seed))
    assert off(lasted, np.diff(read)) < 0.3 * off(np.diff(stamps), np.diff(read))


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(PERIODS), st.floats(0.001, 0.9), seeds)
def test_steps_between_uneven_readings_last_as_their_stamps_say(period, part, seed):
    rng = np.random.default_rng(seed)
    read = np.cumsum(period * (1.0 + part * rng.uniform(-1.0, 1.0, round(8.0 / period))))
    lasted, _ = durations(read, read, driven(read, seed))
    np.testing.assert_allclose(lasted, np.diff(read), rtol=0.1 * part + 5e-4)


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(PERIODS), seeds)
def test_wheels_that_slip_do_not_refute_stamps(period, seed):
    rng = np.random.default_rng(seed)
    read = np.cumsum(period * rng.uniform(0.5, 1.5, round(12.0 / period)))
    turns = np.arange(0.0, read[-1] + 0.25, 0.25)
    speeds = np.interp(read, turns, rng.uniform(0.0, 6.0, len(turns)))
    ways = np.cumsum(speeds * np.diff(read, prepend=0.0))
    lasted, _ = durations(read, read, ways)
    assert off(lasted, np.diff(read)) < 0.15 * period


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(PERIODS[:2]), st.floats(0.05, 0.1), seeds)
def test_a_step_over_lost_readings_lasts_as_many_periods(period, part, seed):
    rng = np.random.default_rng(seed)
    read = period * np.arange(round(20.0 / period))
    stamps, kept = read + part * period * rng.standard_normal(len(read)), rng.random(len(read))
    read, stamps = read[kept > 0.1], stamps[kept > 0.1]
    lasted, _ = durations(read, stamps, driven(read, seed))
    assert off(lasted, np.diff(read)) < 0.8 * off(np.diff(stamps), np.diff(read))
    wrong = np.abs(lasted - np.diff(read))[read[1:] > 4.0]
    assert wrong.max() < 0.5 * period  # none is miscounted


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(PERIODS), st.integers(2, 5), seeds)
def test_readings_that_are_held_up_took_no_longer(period, most, seed):
    rng = np.random.default_rng(seed)
    read = period * np.arange(round(10.0 / period))
    stamps, k = read.copy(), 0
    while k < len(read) - most:
        held = rng.integers(1, most, endpoint=True) if rng.random() < 0.1 else 1
        stamps[k:k + held] = read[k + held - 1] + 1e-5 * np.arange(held)
        k += held
    lasted, _ = durations(read, stamps, driven(read, seed))
    assert off(lasted, np.diff(read)) < 0.2 * off(np.diff(stamps), np.diff(read))


@pytest.mark.parametrize('factor', [0.5, 0.8, 1.3, 2.0])
def test_a_driver_that_changes_its_rate_is_followed(factor):
    rng, even = np.random.default_rng(3), np.full(500, 0.02)
    read = np.cumsum(np.concatenate((even, factor * even)))
    stamps = read + 1e-3 * rng.standard_normal(len(read))
    lasted, _ = durations(read, stamps, driven(read))
    assert off(lasted[-300:], np.diff(read)[-300:]) < 0.2 * off(
        np.diff(stamps)[-300:], np.diff(read)[-300:])


def at_another_rate(factor, part):
    """Return how far off [s] wheels and stamps are in steps that last longer by this factor."""
    rng, period = np.random.default_rng(3), 0.02 * np.repeat((1.0, factor), 500)
    read = np.cumsum(period)
    stamps = read + part * period * rng.standard_normal(len(read))
    told, _ = durations(read, stamps, driven(read))
    return tuple(np.abs(steps - np.diff(read))[500:] for steps in (told, np.diff(stamps)))


@pytest.mark.parametrize('factor', [0.25, 0.4, 0.5])
def test_it_is_noticed_at_once_that_there_are_more_readings(factor):
    by_wheels, _ = at_another_rate(factor, 0.1)
    assert np.sum(by_wheels > 0.01 * factor) <= 8  # half of a step


@pytest.mark.parametrize('part', [0.1, 0.15, 0.2])
def test_fewer_readings_are_not_taken_for_lost_ones_for_long(part):
    by_wheels, by_stamps = at_another_rate(4.0, part)
    assert np.sum(by_wheels[:40] ** 2) < np.sum(by_stamps[:40] ** 2)


def test_a_base_that_creeps_tells_nothing_of_stamps():
    read = 0.02 * np.arange(500)
    stamps = read + 2e-3 * np.random.default_rng(4).standard_normal(len(read))
    lasted, _ = durations(read, stamps, 0.08 * read)
    np.testing.assert_array_equal(lasted, np.diff(stamps))


def test_a_gap_and_a_way_that_is_unknown_spoil_nothing():
    rng, time, previous, told = np.random.default_rng(5), WheelTime(1), 0.0, []
    for k in range(600):
        stamp = 0.02 * k + 1e-3 * rng.standard_normal()
        if k % 200 == 199:
            time.interrupt()
        way = math.nan if k % 50 == 49 else 0.03
        told.append(time.duration(stamp - previous, way, 0.02))
        previous = stamp
    # Without a step before it, one lasts as its stamps say.
    even = [k for k in range(200, 599) if k % 50 not in (0, 49)]
    np.testing.assert_allclose(np.array(told)[even], 0.02, atol=0.5e-3)


@pytest.mark.parametrize('own', [True, False])
@pytest.mark.parametrize('part', [1.0, 0.6])
def test_a_gyro_goes_by_stamps_of_its_own_or_by_those_of_the_wheels(own, part):
    # Nobody asks for its time in steps that are too short for a twist.
    read, rng = 0.02 * np.arange(500), np.random.default_rng(7)
    stamps = read + 2e-3 * rng.standard_normal(len(read))
    yaws = 1.5 * driven(stamps if own else read, 1)
    lasted, turned = durations(read, stamps, driven(read), yaws, rng.random(len(read)) < part)
    true, other = (np.diff(stamps), np.diff(read))[::1 if own else -1]
    assert off(turned, true) < 0.25 * off(other, true)
    assert off(lasted, np.diff(read)) < 0.3e-3
