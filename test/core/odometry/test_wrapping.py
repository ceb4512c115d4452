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

"""Wrapped drive joints: unwrapped by their period, or found out; others left as they are."""

from hypothesis import given, strategies as st
import numpy as np
import pytest

from swerve_kinematics.core.odometry.wrapping import DriveUnwrapper

PI, RADIUS = np.pi, 0.05
RATES, PERIODS = (100, 50, 20), (PI, 2 * PI, 4 * PI)


def wrapped(position, period):
    """Return what a joint reads that wraps within +- half its period."""
    return (position + 0.5 * period) % period - 0.5 * period


def drive(rate, duration=22.0, speed=1.0, start=0.3):
    """Return stamps, and positions and velocities of a joint that drives there and back."""
    stamp = np.arange(0.0, duration, 1.0 / rate)
    cruise = np.clip(np.minimum(stamp, 0.5 * duration - stamp) / 0.5, 0.0, 1.0)
    back = np.clip(np.minimum(stamp - 0.5 * duration, duration - stamp) / 0.5, 0.0, 1.0)
    velocity = speed / RADIUS * (cruise - 0.5 * back)
    steps = 0.5 * (velocity[1:] + velocity[:-1]) / rate
    return stamp, start + np.concatenate(([0.0], np.cumsum(steps))), velocity


def counted(unwrapper, stamp, readings, velocities):
    """Return what the unwrapper makes of a joint."""
    elapsed = np.diff(stamp, prepend=stamp[0])
    return np.array([unwrapper.counted(*sample)[0] for sample in zip(
        elapsed, readings[:, np.newaxis].tolist(), velocities[:, np.newaxis].tolist())])


def check(period, given, stamp, position, velocities):
    """Check that the wrapped joint goes the way of the counting one; return the unwrapper."""
    unwrapper = DriveUnwrapper([RADIUS], given)
    result = counted(unwrapper, stamp, wrapped(position, period), velocities)
    np.testing.assert_allclose(result - result[0], position - position[0], atol=1e-9)
    return unwrapper


@pytest.mark.parametrize('period', PERIODS)
@pytest.mark.parametrize('rate', RATES)
@pytest.mark.parametrize('with_velocity', [True, False])
@pytest.mark.parametrize('is_given', [True, False])
def test_a_wrapped_joint_goes_the_way_of_one_that_counts(rate, period, with_velocity, is_given):
    stamp, position, velocity = drive(rate)
    velocities = velocity if with_velocity else np.full_like(velocity, np.nan)
    unwrapper = check(period, period if is_given else 0.0, stamp, position, velocities)
    assert unwrapper.period == period
    assert unwrapper.is_found is not is_given


@pytest.mark.parametrize('velocity', [0.0, 9.55, 1e6])
@pytest.mark.parametrize('is_given', [True, False])
def test_velocities_of_no_use_do_no_harm(velocity, is_given):
    stamp, position, true = drive(50)
    check(2 * PI, 2 * PI * is_given, stamp, position, velocity * true)


@pytest.mark.parametrize('with_velocity', [True, False])
def test_a_given_period_that_is_too_long_is_corrected(with_velocity):
    stamp, position, velocity = drive(50)
    unwrapper = check(2 * PI, 4 * PI, stamp, position,
                      velocity if with_velocity else np.full_like(velocity, np.nan))
    assert unwrapper.period == 2 * PI and unwrapper.is_found


@given(st.integers(0, 2 ** 32 - 1), st.sampled_from(RATES), st.sampled_from(PERIODS[1:]),
       st.booleans(), st.booleans())
def test_jittering_stamps_and_lost_messages_do_no_harm(seed, rate, period, given, reported):
    rng = np.random.default_rng(seed)
    stamp, position, velocity = drive(rate, 8.0)
    kept = rng.random(len(stamp)) > 0.1
    stamp = stamp + rng.uniform(-0.3, 0.3, len(stamp)) / rate
    velocity = velocity + rng.normal(0.0, 0.5, len(stamp)) if reported else velocity * np.nan
    check(period, period * given, stamp[kept], position[kept], velocity[kept])


@given(st.integers(0, 2 ** 32 - 1), st.sampled_from((500, 100, 50, 20, 5)))
def test_a_joint_that_counts_is_left_as_it_is(seed, rate):
    rng = np.random.default_rng(seed)
    # As hard as a base on the ground can brake and reverse, and then some noise.
    stamp = np.arange(0.0, 5.0, 1.0 / rate)
    acceleration = rng.choice([-1.0, 0.0, 1.0], 20).repeat(len(stamp) // 20 + 1)[:len(stamp)]
    velocity = np.clip(np.cumsum(acceleration * 5.0 / RADIUS / rate), -60.0, 60.0)
    position = np.cumsum(velocity) / rate + rng.normal(0.0, 1e-3, len(stamp))
    unwrapper = DriveUnwrapper([RADIUS])
    result = counted(unwrapper, stamp, position, velocity * np.nan)
    np.testing.assert_allclose(result, position, atol=1e-9)
    assert not unwrapper.is_found


def test_an_encoder_that_is_reset_has_not_wrapped():
    stamp, position, velocity = drive(50)
    position[300:] -= position[300]
    unwrapper = DriveUnwrapper([RADIUS])
    np.testing.assert_allclose(counted(unwrapper, stamp, position, velocity), position, atol=1e-9)
    assert not unwrapper.is_found


def test_after_an_interruption_the_joints_begin_anew():
    unwrapper = DriveUnwrapper([RADIUS], 2 * PI)
    unwrapper.counted(0.0, [3.0], [np.nan])
    unwrapper.clear()
    assert unwrapper.counted(10.0, [-3.0], [np.nan]) == [-3.0]


@given(st.lists(st.tuples(st.floats(-1e12, 1e12), st.floats()), min_size=2, max_size=9),
       st.sampled_from((0.0, PI, 2 * PI)))
def test_no_velocity_and_no_reading_is_fatal_or_makes_a_position_infinite(samples, period):
    unwrapper = DriveUnwrapper([RADIUS], period)
    for reading, velocity in samples:
        assert np.isfinite(unwrapper.counted(0.02, [reading], [velocity])).all()


@pytest.mark.parametrize('nonsense', [np.inf, -1e308, 1e12, 150.0])
@pytest.mark.parametrize('reported', [0.0, np.nan])
def test_one_velocity_that_is_nonsense_does_not_turn_a_joint_at_rest(nonsense, reported):
    velocities = np.full(50, reported)
    velocities[0] = nonsense
    check(2 * PI, 2 * PI, np.arange(50) / 20, np.full(50, 0.3), velocities)


@pytest.mark.parametrize('rate', RATES)
@pytest.mark.parametrize('speed', [-6.0, -2.0, -1.0, 1.0, 2.0, 3.0, 4.0, 6.0, 9.0])
@pytest.mark.parametrize('gear', [1.0, 6.75])
@pytest.mark.parametrize('with_velocity', [True, False])
def test_a_joint_that_is_met_in_motion_is_not_taken_for_one_that_wraps(
        rate, speed, gear, with_velocity):
    velocity = np.full(40, speed * gear / RADIUS)
    velocity[20:] *= 1.0 - np.linspace(0.0, 1.0, 20) * min(1.0, 120.0 / (rate * abs(speed)))
    stamp = np.arange(40) / rate
    position = np.concatenate(([3.0], 3.0 + np.cumsum(
        0.5 * (velocity[1:] + velocity[:-1]) / rate)))
    unwrapper = DriveUnwrapper([RADIUS / gear])
    for _ in range(2):  # at the start, and after a gap
        result = counted(unwrapper, stamp, position,
                         velocity if with_velocity else np.full(40, np.nan))
        unwrapper.clear()
        assert not unwrapper.is_found
        np.testing.assert_allclose(result, position, atol=1e-9)


@pytest.mark.parametrize('first', [1e-4, 1e-3, 5e-3, 0.06])
@pytest.mark.parametrize('step', [0.05, 0.2, 1.0])
def test_a_first_stamp_that_jitters_does_not_make_a_joint_seem_to_wrap(first, step):
    position = 100.0 + step * np.arange(40)
    stamp = np.concatenate(([0.0], first + 0.02 * np.arange(39)))
    unwrapper = DriveUnwrapper([RADIUS])
    result = counted(unwrapper, stamp, position, np.full(40, np.nan))
    assert not unwrapper.is_found
    np.testing.assert_allclose(result, position, atol=1e-9)


@pytest.mark.parametrize('period', PERIODS)
def test_a_joint_that_is_met_in_motion_is_found_to_wrap_all_the_same(period):
    stamp = np.arange(200) / 50
    position = 2.0 + 1.5 / RADIUS * stamp
    unwrapper = DriveUnwrapper([RADIUS])
    result = counted(unwrapper, stamp, wrapped(position, period), np.full(200, np.nan))
    assert unwrapper.is_found and unwrapper.period == period
    np.testing.assert_allclose(np.diff(result), np.diff(position), atol=1e-9)


@pytest.mark.parametrize('rate', [50, 20, 10])
@pytest.mark.parametrize('gear', [1.0, 5.0, 7.5, 20.0])
@pytest.mark.parametrize('acceleration', [9.0, 14.0, 25.0, 60.0])
@pytest.mark.parametrize('with_velocity', [True, False])
def test_a_joint_of_a_wheel_that_spins_and_locks_does_not_wrap_for_long(
        rate, gear, acceleration, with_velocity):
    stamp = np.arange(0.0, 12.0, 1.0 / rate)
    to_and_fro = np.select([stamp < 1.0, stamp < 2.0, stamp < 3.0, stamp < 4.0, stamp < 10.0],
                           [0.0, 1.0, 0.0, -1.0, 1.0], 0.0)
    velocity, most = np.zeros_like(stamp), acceleration / rate
    for k in range(1, len(stamp)):
        change = 2.0 * to_and_fro[k] - velocity[k - 1]
        velocity[k] = velocity[k - 1] + np.clip(change, -most, most)
    way = np.cumsum(velocity) / rate
    mean = 0.5 * (velocity + np.append(velocity[1:], 0.0))  # of the steps before and after
    unwrapper = DriveUnwrapper([RADIUS / gear])
    result = counted(unwrapper, stamp, way * gear / RADIUS,
                     mean * gear / RADIUS if with_velocity else velocity * np.nan)
    assert not unwrapper.is_found and unwrapper.period == 0.0
    lost = np.abs(np.diff(result) * RADIUS / gear - np.diff(way))
    assert lost[stamp[1:] > 6.0].max() < 1e-9
    assert lost.sum() < 1e-9 if with_velocity else lost.sum() < 0.5
