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

"""An accelerometer of any rate tells the means of the odometry's steps, or is left out."""

import math

from hypothesis import given, strategies as st
import numpy as np
import pytest
from sensor_msgs.msg import Imu

from swerve_kinematics.core.geometry.rotations import (
    from_roll_pitch_yaw, inverse, product, Rotation)
from swerve_kinematics.ros.accelerometer import AccelerometerFeedback, InertialSample
from swerve_kinematics.ros.conversions import imu_numbers
from swerve_kinematics.ros.mounted_imu import MountedImu
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds

START = 1000 * NANOSECONDS
STEP = 0.02  # s
GRAVITY = 9.81


def sample(x, y, rates=0j, z=GRAVITY):
    """Return what a level sensor along the axes of the base says."""
    return InertialSample(complex(x, y), rates, math.hypot(x, y, z), (x, y))


def lively(k, x=0.3, y=-0.2):
    """Return a sample with noise, as any sensor has it."""
    return sample(x + 0.01 * math.sin(7.0 * k), y + 0.01 * math.cos(5.0 * k))


def left_out_after(make, moving=True, before=100, rate=200.0):
    """Return after how long [s] a fault leaves the sensor out, and how it is reported."""
    feedback, k, period = AccelerometerFeedback(), 0, 1.0 / rate
    for k in range(before):
        feedback.add(START + nanoseconds(k * period), lively(k))
    begin = k * period
    for step in range(1, 200):
        now = begin + step * STEP
        while (k + 1) * period <= now:
            k += 1
            made = make(k)
            if made is not None:
                feedback.add(START + nanoseconds(k * period), made)
        means = feedback.means(START + nanoseconds(now), [now * moving])
        if step > 1 and means.force is None:
            return step * STEP, feedback.fault
    return math.inf, feedback.fault


@pytest.mark.parametrize('make, word', [
    (lambda k: None, 'silent'),
    (lambda k: sample(0.31, -0.2), 'frozen'),
    (lambda k: sample(14.715, 0.1 * math.sin(k)), 'end of its range'),
    (lambda k: sample(19.6, 0.1 * math.sin(k)), 'saturated'),
    (lambda k: sample(math.nan, 0.1 * math.sin(k)), 'not a number'),
    (lambda k: sample(0.1 * math.sin(k), math.nan), 'not a number'),
    (lambda k: sample(math.inf, 1e300), 'not a number')])
def test_a_fault_leaves_it_out_within_a_fifth_of_a_second_and_is_named(make, word):
    time, fault = left_out_after(make)
    assert time <= 0.2
    assert word in fault


@pytest.mark.parametrize('rate', [25.0, 50.0, 200.0])
@pytest.mark.parametrize('wrong', [math.nan, 1e3])
def test_a_fault_that_lasts_is_named_in_every_step_whatever_the_rates(rate, wrong):
    feedback, faults = AccelerometerFeedback(), []
    for stamp, is_step in sorted([(k / rate, False) for k in range(int(rate))]
                                 + [(0.003 + 0.01 * k, True) for k in range(99)]):
        if is_step:
            feedback.means(START + nanoseconds(stamp), [stamp])
            faults.append(feedback.fault)
        else:
            feedback.add(START + nanoseconds(stamp), sample(wrong, 0.1 * math.sin(stamp)))
    assert None not in faults[1:]


@pytest.mark.parametrize('rate, is_used', [(7.0, False), (9.0, False), (20.0, True)])
def test_no_step_of_a_base_rests_on_a_sample_that_speaks_for_too_long(rate, is_used):
    feedback, samples = AccelerometerFeedback(), np.arange(0.0, 2.0, 1.0 / rate)
    steps = 0.003 + 0.02 * np.arange(90)
    for stamp, is_step in sorted([(stamp, False) for stamp in samples]
                                 + [(stamp, True) for stamp in steps]):
        if not is_step:
            feedback.add(START + nanoseconds(stamp), lively(stamp))
        elif feedback.means(START + nanoseconds(stamp), [stamp]).force is not None:
            # Neither does it span a pause, nor is it at the end of one.
            assert is_used or not ((samples > stamp - 0.02) & (samples <= stamp)).any()
            assert stamp - samples[samples <= stamp][-1] <= 0.1
        elif stamp > 0.1:
            assert not is_used


def test_a_sensor_that_works_is_never_left_out():
    assert left_out_after(lively) == (math.inf, None)
    assert left_out_after(lively, moving=False) == (math.inf, None)


@pytest.mark.parametrize('size', [1.0, -1.0, 32.2, -0.7])
def test_what_is_not_gravity_leaves_it_out_after_the_first_rest(size):
    # That a force does not point up does not make it gravity on a sensor that is turned.
    time, fault = left_out_after(lambda k: InertialSample(
        complex(0.001 * math.sin(k)), 0j, size, (0.001 * math.sin(k),)), moving=False)
    assert time <= 1.2
    assert fault == f'{abs(size):g} m/s^2 at rest is not gravity: wrong unit?'


@pytest.mark.parametrize('flicker', [1e-9, 1e-4])
def test_encoders_that_flicker_at_rest_do_not_hide_it(flicker):
    feedback = AccelerometerFeedback()
    for k in range(60):
        now = START + k * nanoseconds(STEP)
        feedback.add(now, sample(0.001 * math.sin(k), 0.001 * math.cos(k), z=1.0))
        feedback.means(now, [2.0 + flicker * (k % 2), 3.0])
    assert 'wrong unit' in feedback.fault
    # To creep is no rest, and shows nothing new.
    for k in range(60, 180):
        now = START + k * nanoseconds(STEP)
        feedback.add(now, sample(0.001 * math.sin(k), 0.001 * math.cos(k)))
        feedback.means(now, [2.0 + 5e-5 * k, 3.0])
    assert 'wrong unit' in feedback.fault


@pytest.mark.parametrize('size, has_gravity', [(GRAVITY, True), (0.05, False)])
def test_the_tilt_counts_only_where_gravity_shows_in_the_force(size, has_gravity):
    feedback = AccelerometerFeedback()
    for k in range(100):
        now = START + k * nanoseconds(STEP)
        feedback.add(now, lively(k)._replace(size=size))
        means = feedback.means(now, [0.01 * max(k - 70, 0)])
    assert means.force is not None
    assert (means.rates is not None) is has_gravity


def test_a_driver_may_take_gravity_off():
    assert left_out_after(lambda k: InertialSample(
        complex(0.01 * math.sin(k)), 0j, 0.05, (0.01 * math.sin(k),)),
        moving=False) == (math.inf, None)


@pytest.mark.parametrize('mounting', [
    (math.pi, 0.0, 0.0), (0.0, math.pi, 0.5), (math.pi / 2, 0.0, 0.0), (0.0, -math.pi / 2, 0.0),
    (math.pi, 0.0, math.pi), (0.6, 0.0, 0.0)], ids=str)
def test_a_mounting_that_nobody_described_leaves_it_out_after_the_first_rest(mounting):
    described = MountedImu((), 'auto')
    back = inverse(from_roll_pitch_yaw(*mounting))

    def made(k):
        x, y, z = 0.01 * np.sin((7.0 * k, 5.0 * k, 3.0 * k))
        there = Rotation(x, y, GRAVITY + z, 0.0)
        message = Imu()
        vector = message.linear_acceleration
        vector.x, vector.y, vector.z = product(product(back, there), inverse(back))[:3]
        return described.inertial(imu_numbers(message))

    time, fault = left_out_after(made, moving=False)
    assert time <= 1.2 and 'imu_orientation' in fault


def test_one_that_changes_not_at_all_at_rest_is_no_fault():
    time, fault = left_out_after(lambda k: sample(0.0, 0.0), moving=False)
    assert time <= 0.2 and fault is None


def test_it_is_back_as_soon_as_it_works_again():
    feedback = AccelerometerFeedback()
    for k in range(200):
        if not 60 <= k < 120:
            feedback.add(START + k * nanoseconds(0.005), lively(k))
        if k % 4 == 0:
            means = feedback.means(START + k * nanoseconds(0.005), [0.001 * k])
    assert means.force is not None and feedback.fault is None


def test_a_sensor_of_another_clock_is_left_out():
    feedback = AccelerometerFeedback()
    for k in range(200):
        feedback.add(2 * START + k * nanoseconds(0.005), lively(k))
        means = feedback.means(START + k * nanoseconds(0.005), [0.001 * k])
        assert means == (None, None)
    assert 'another clock' in feedback.fault


@pytest.mark.parametrize('late, bundle, is_used', [
    (0.0, 1, True), (0.025, 1, True), (0.05, 1, False), (0.0, 8, True), (0.0, 18, False),
    (0.02, 12, False)])
def test_a_sensor_that_is_heard_too_late_is_left_out(late, bundle, is_used):
    """Whether each sample comes late, or many come at once."""
    feedback, sent, used = AccelerometerFeedback(), 0, []
    for step in range(1, 200):
        now = step * STEP
        while (sent + bundle) * 0.005 + late <= now + 1e-9:
            for _ in range(bundle):
                feedback.add(START + nanoseconds(sent * 0.005), lively(sent))
                sent += 1
        means = feedback.means(START + nanoseconds(now), [now])
        used.append(means.force is not None)
    assert all(used[100:]) if is_used else not any(used[100:])
    assert is_used or 'late by' in feedback.fault


def test_what_is_not_measured_is_no_accelerometer():
    feedback = AccelerometerFeedback()
    feedback.add(START, InertialSample(None, 0j, GRAVITY, ()))
    assert feedback.means(START + nanoseconds(STEP), [0.0]) == (None, None)
    assert not feedback.heard and feedback.fault is None


def test_rates_that_are_none_leave_the_force_alone():
    feedback = AccelerometerFeedback()
    for k in range(20):
        feedback.add(START + k * nanoseconds(0.005), lively(k)._replace(rates=None))
        means = feedback.means(START + k * nanoseconds(0.005), [0.001 * k])
    assert means.rates is None and means.force is not None


@given(st.lists(st.floats(0.001, 0.02), min_size=40, max_size=80),
       st.floats(-0.02, 0.02), st.integers(0, 2 ** 32 - 1))
def test_the_means_add_up_to_what_was_measured_whatever_the_rates(periods, late, seed):
    """Steps of the odometry and samples of the sensor need not have anything in common."""
    rng, feedback = np.random.default_rng(seed), AccelerometerFeedback()
    stamps = START + np.round(np.cumsum(periods) * NANOSECONDS).astype(int)
    forces = rng.uniform(0.0, 5.0, len(stamps))
    last = first = told = None
    for stamp, before, force in zip(stamps[1:].tolist(), stamps.tolist(), forces[1:]):
        feedback.add(stamp, sample(force, -force, complex(0.1 * force)))
        now = stamp - nanoseconds(late)
        means = feedback.means(now, [float(now)])
        if means.force is not None:
            if told is None:
                told, first = 0.0, last
            told += means.force[0] * (now - last) / NANOSECONDS
            assert means.force[1] == pytest.approx(-means.force[0], abs=1e-6)
            assert means.rates[0] == pytest.approx(0.1 * means.force[0], abs=1e-6)
        last = now
    step = nanoseconds(1e-4)
    times = np.arange(first, last, step)
    held = forces[np.clip(np.searchsorted(stamps, times), 0, len(stamps) - 1)]
    # What may be missed: the longest period at the largest force, at either end.
    assert told == pytest.approx(held.sum() * step / NANOSECONDS, abs=2 * 0.02 * 5.0 + 0.02)


@pytest.mark.parametrize('rate', [25.0, 50.0, 100.0, 400.0])
def test_a_mean_is_that_of_its_step(rate):
    feedback, period, k = AccelerometerFeedback(), 1.0 / rate, 0
    for step in range(1, 100):
        while k * period <= step * STEP + 1e-9:
            # A sensor that averages forces which grow by 1 m/s^2 in a second.
            force = (k - 0.5) * period
            feedback.add(START + nanoseconds(k * period), sample(force, -force))
            k += 1
        means = feedback.means(START + nanoseconds(step * STEP), [0.1 * step])
    # Where samples are rarer than steps one is carried on, and made good in the next step.
    rare = 0.0 if rate >= 1.0 / STEP else period
    assert means.force[0] == pytest.approx((step - 0.5) * STEP, abs=1e-9 + rare)


@pytest.mark.parametrize('imu_first', [True, False])
@pytest.mark.parametrize('offset', [-0.001, 0.0, 0.001])
def test_a_pause_of_both_senders_leaves_no_force_behind(imu_first, offset):
    feedback, means = AccelerometerFeedback(), []
    for k in [*range(50), *range(250, 300)]:
        now = START + nanoseconds(k * STEP)
        made = sample(0.1 * (-1) ** k, 0.1 * (-1) ** k)
        heard = [lambda: feedback.add(now + nanoseconds(offset), made),
                 lambda: means.append(feedback.means(now, [k * STEP]).force)]
        for hear in heard if imu_first else reversed(heard):
            hear()
    assert means[-1] is not None
    assert all(force is None or abs(force[0]) < 0.4 for force in means)


def means_of(samples):
    """Return how many samples at 200 Hz are out of range, and the means (k, 4) at 50 Hz."""
    feedback, means = AccelerometerFeedback(), []
    for k, made in enumerate(samples):
        now = START + k * nanoseconds(0.005)
        feedback.add(now, made)
        if k % 4 == 0:
            means.append(feedback.means(now, [0.0]))
    assert means[0].force is None  # of no step
    return feedback.out_of_range, np.array([(*force, *rates) for force, rates in means[1:]])


# Walls stop a base at once; the last one gives way, and presses for 12 samples.
@pytest.mark.parametrize('hits', [
    *[{k: -90.0 for k in range(first, first + 5)} for first in range(50, 54)],
    {50 + k: 40.0 * math.sin(math.pi * k / 12.0) for k in range(13)}])
def test_a_collision_is_in_the_means(hits):
    out_of_range, means = means_of([lively(k, hits.get(k, 0.0), 0.0) for k in range(100)])
    assert STEP * means[:, 0].sum() == pytest.approx(0.005 * sum(hits.values()), rel=0.01)
    assert not out_of_range


def test_the_force_before_stands_in_for_a_spike():
    (none, quiet), (one, spoilt) = (
        means_of([sample(spike, -0.2) if k == 22 else lively(k) for k in range(40)])
        for spike in (0.3, 120.0))
    assert (none, one) == (0, 1)
    np.testing.assert_allclose(spoilt, quiet, atol=0.02)


@pytest.mark.parametrize('force, is_hit', [(0.3, False), (400.0, True), (math.nan, True)])
def test_a_hit_that_is_out_of_range_is_told_from_a_force_that_is_not_heard(force, is_hit):
    feedback, hits = AccelerometerFeedback(), []
    for k in range(12):
        now = START + k * nanoseconds(STEP)
        if k < 9:
            feedback.add(now, sample(force, 0.1) if k == 5 else lively(k))
        feedback.means(now, [0.1 * k])
        hits.append(feedback.is_out_of_range)
    assert any(hits[5:7]) == is_hit
    assert not any(hits[:5] + hits[7:])
