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

"""Tests of what becomes of encoders' readings that are sent more than once."""

from benchmarks import drives
from inertial_replay import CORNERS, FINE, forces_of
import numpy as np
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.repeats import LONGEST_WAIT, Repeats

FINE_DRIVE = drives.from_rest(
    drives.smooth_motion(CORNERS, FINE, duration=10.0, finest=2000))


def errors(every, held, phases):
    """Return how far off [m] an odometry is that hears readings only once in `held` steps."""
    samples = np.arange(0, len(FINE_DRIVE.stamp), every)
    forces = forces_of(FINE_DRIVE, every, place=(0.0, 0.0))
    odo, off = SwerveOdometry(SwerveKinematics(CORNERS), estimate_gyro_bias=False), []
    for k, sample in enumerate(samples):
        read = samples[np.maximum(k - (k + phases) % held, 0)]
        modules = np.arange(4)
        odo.update(FINE_DRIVE.stamp[sample], FINE_DRIVE.distance[read, modules],
                   FINE_DRIVE.angle[read, modules], FINE_DRIVE.yaw[sample],
                   specific_force=forces[k])
        if not odo.is_waiting:
            off.append(np.hypot(*(odo.pose - FINE_DRIVE.truth[sample])[:2]))
    assert odo.coasting == 0.0 and len(off) >= len(samples) // held
    return np.array(off)


@pytest.mark.parametrize('every, held', [(10, 2), (5, 2), (5, 4)])
def test_a_driver_that_hears_less_than_it_tells_is_no_slip(every, held):
    assert errors(every, held, np.zeros(4, int)).max() < 0.01


@pytest.mark.parametrize('every, held', [(10, 2), (5, 2)])
def test_nor_are_encoders_that_are_heard_one_after_the_other(every, held):
    # Those that are heard a step late are behind by as much, at up to 4 m/s.
    assert errors(every, held, np.array((0, 1, 1, 0))).max() < 0.15


def after(*rolled, dt=0.02):
    """Return the Repeats after steps in which two wheels rolled so far [m], and where they are."""
    repeats, places = Repeats(), np.zeros(2)
    for ways in rolled:
        places, known = places + ways, bool(repeats.expected)
        found = repeats.keep(dt, places.tolist(), list(ways), 0.0)
        assert found == (bool(repeats.expected) and not known)
    return repeats, places.tolist()


FAST, SLOW, STANDING = (0.04, -0.04), (0.0015, -0.0015), (0.04, 0.0)


@pytest.mark.parametrize('rolled, repeated', [
    ((FAST, STANDING, FAST), True),  # a wheel that stood for a moment
    ((FAST, FAST, FAST), False),
    ((FAST, STANDING), False),  # and one that has locked, for ever or longer than a moment
    ((FAST, *[STANDING] * 3, FAST), False),
    ((SLOW, (0.0, 0.0), SLOW), False),  # ticks of a coarse encoder
    ((SLOW, (0.0, 0.0), FAST), False),  # a hard start
    ((FAST, STANDING, FAST, SLOW), False)])  # a wheel that may have stopped since
def test_old_readings_are_known_by_wheels_that_stand_for_a_moment(rolled, repeated):
    repeats, places = after(*rolled)
    assert (repeats.expected and repeats.has(0.02, places, 0.0)) == repeated
    assert not repeats.has(0.02, [place + 0.01 for place in places], 0.0)
    assert not repeats.has(LONGEST_WAIT, places, 0.0)


def test_a_wheel_that_locks_is_waited_for_once():
    repeats, places = after(FAST, STANDING, FAST)
    for elapsed in (0.02, 0.04):
        assert repeats.has(elapsed, places, 0.0)
        repeats.wait(elapsed, 0j, 0j)
    repeats.keep(0.06, places, [0.0, 0.0], 0.0)
    repeats.keep(0.02, [places[0] + 0.04, places[1]], [0.04, 0.0], 0.0)
    assert not repeats.expected


@pytest.mark.parametrize('missing', [None, 'force', 'rates'])
def test_forces_and_rates_of_a_step_are_means_over_all_of_it(missing):
    repeats, _ = after(FAST, STANDING, FAST)
    repeats.wait(0.01, None if missing == 'force' else 1j, 2.0)
    repeats.wait(0.02, 2j, None if missing == 'rates' else 4.0)
    force, rates = repeats.means(0.04, 0.5j, 1.0)
    assert force == (None if missing == 'force' else pytest.approx(1j))
    assert rates == (None if missing == 'rates' else pytest.approx(2.0))
    assert repeats.is_waiting
    repeats.keep(0.04, [2.0, 2.0], [0.2, 0.2], 0.0)
    assert not repeats.is_waiting
    assert repeats.means(0.02, 3j, None) == (3j, None)


@pytest.mark.parametrize('yaw', [0.0, None], ids=['gyro', 'wheels alone'])
@pytest.mark.parametrize('has_imu', [True, False], ids=['accelerometer', 'none'])
@pytest.mark.parametrize('every', [20, 30, 40, 50])
def test_the_twist_does_not_flicker_where_readings_are_sent_again(every, has_imu, yaw):
    # Taken every so many milliseconds and sent every 20 ms, at 1 m/s^2 up to 2 m/s.
    odo, errors, told = SwerveOdometry(SwerveKinematics(CORNERS)), [], 0
    for k in range(500):
        time = 1e-3 * (20 * k // every * every) - 1.0
        way = 0.5 * min(max(time, 0.0), 2.0) ** 2 + 2.0 * max(time - 2.0, 0.0)
        is_starting = 0.0 < 0.02 * k - 1.0 <= 2.0
        odo.update(0.02 * k, [way] * 4, [0.0] * 4, yaw,
                   specific_force=(float(is_starting), 0.0) if has_imu else None)
        told += not odo.is_waiting
        errors.append(odo.twist[0] - min(max(0.02 * k - 1.0, 0.0), 2.0))
    assert np.abs(errors[100:]).max() < 0.2  # 1 to 2 where each sample is a step
    assert odo.pose[0] == pytest.approx(way, abs=0.11)
    assert told >= 0.9 * 450 * 20 / every  # but for those that were sent again


@pytest.mark.parametrize('standing', [4, 10])
def test_old_readings_explain_what_looked_like_stamps_that_scatter(standing):
    # Wheels at 2 m/s, heard in every second step, that lock every half a second.
    odo, way, told, scatter = SwerveOdometry(SwerveKinematics(CORNERS)), 0.0, 0.0, []
    for k in range(300):
        way += 0.04 * (k < 25 or k % 25 >= standing)
        told = told if k % 2 else way
        odo.update(0.02 * k, [told] * 4, [0.0] * 4, 0.0, specific_force=(0.0, 0.0))
        scatter.append(odo.stamp_scatter is not None)
    assert np.mean(scatter) < 0.05


def test_an_accelerometer_that_falls_silent_in_a_wait_spoils_nothing():
    odo, way, k = SwerveOdometry(SwerveKinematics(CORNERS)), 0.0, 0
    while not odo.is_waiting:
        assert k < 50
        way += 0.04 * (k % 2)  # 1 m/s, heard in every second step
        odo.update(0.02 * k, [way] * 4, [0.0] * 4, 0.0, specific_force=(0.0, 0.0))
        k += 1
    for _ in range(20):
        way += 0.04 * (k % 2)
        assert odo.update(0.02 * k, [way] * 4, [0.0] * 4, 0.0) != odo.is_waiting
        k += 1
    np.testing.assert_allclose(odo.twist, (1.0, 0.0, 0.0), atol=0.02)
