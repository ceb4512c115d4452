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

"""Whatever comes in, what goes out is a number: the odometry at the edges of the floats."""

from dataclasses import fields
import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest
from strategies import layouts, seeds

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.gyro import MAX_YAW_RATE
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
ODD_NUMBERS = (math.nan, math.inf, -math.inf, 0.0, -0.0, 5e-324, 1e-160, 1e160, -1.7e308)


def any_magnitude(rng, shape, largest=12.0):
    """Return random numbers of either sign, from 1e-12 to 10 to the power of `largest`."""
    return rng.choice((-1.0, 1.0), shape) * 10.0 ** rng.uniform(-12.0, largest, shape)


def odd_noise(rng):
    """Return a noise of magnitudes that nobody would choose."""
    names = [field.name for field in fields(OdometryNoise)]
    chosen = rng.choice(names, rng.integers(len(names) + 1), replace=False)
    values = np.abs(any_magnitude(rng, len(chosen)))
    values[rng.random(len(chosen)) < 0.2] = 0.0
    return OdometryNoise(**dict(zip(chosen.tolist(), values.tolist())))


def odd_pair(rng):
    """Return what an accelerometer might say: ordinary, of any magnitude, odd, or nothing."""
    kind = rng.integers(4)
    return (rng.normal(size=2), any_magnitude(rng, 2), rng.choice(ODD_NUMBERS, 2), None)[kind]


def odd_run(rng, count):
    """Yield (stamp, arguments) of a long run whose quantities change their magnitude."""
    stamp = float(any_magnitude(rng, ()))
    size = 10.0 ** rng.uniform(-6.0, 12.0)
    distances, angles, yaw = np.zeros(count), np.zeros(count), 0.0
    for _ in range(60):
        stamp += 10.0 ** rng.uniform(-6.0, 0.0)
        if rng.random() < 0.2:
            size = 10.0 ** rng.uniform(-6.0, 12.0)
        distances = distances + size * rng.normal(size=count)
        angles = angles + min(size, 10.0 ** rng.uniform(-6.0, 3.0)) * rng.normal(size=count)
        yaw += size * rng.normal()
        samples = {
            'distances': distances.copy(), 'angles': angles.copy(),
            'yaw': yaw if rng.random() < 0.6 else None,
            'yaw_rate': float(any_magnitude(rng, ())) if rng.random() < 0.6 else None,
            'velocities': any_magnitude(rng, count) if rng.random() < 0.6 else None,
            'specific_force': odd_pair(rng), 'tilt_rates': odd_pair(rng)}
        if rng.random() < 0.1:
            name = rng.choice(['distances', 'angles'])
            samples[name][rng.integers(count)] = rng.choice(ODD_NUMBERS)
        yield stamp, samples


def assert_sane(odo):
    """Check the invariants: finite always, variances not negative, a turn a base can make."""
    estimate = odo.estimate
    for part in (*estimate, (odo.gyro_bias, odo.residual)):
        assert np.isfinite(part).all(), estimate
    assert min(estimate.pose_covariance[::4]) >= 0.0
    assert min(estimate.twist_covariance[::4]) >= 0.0
    assert abs(estimate.twist[2]) <= MAX_YAW_RATE


@settings(max_examples=150)
@given(layouts(), seeds)
def test_odd_runs_keep_every_number_sane(positions, seed):
    rng = np.random.default_rng(seed)
    scale = 10.0 ** rng.uniform(-3.0, 9.0) if rng.random() < 0.5 else 1.0
    odo = SwerveOdometry(SwerveKinematics(scale * positions), noise=odd_noise(rng),
                         estimate_gyro_bias=rng.random() < 0.5)
    for stamp, samples in odd_run(rng, len(positions)):
        if rng.random() < 0.03:
            odo.reprime()
        odo.update(stamp, **samples)
        assert_sane(odo)


@given(st.lists(st.tuples(*[st.floats() for _ in range(4)]), min_size=2, max_size=6), st.floats(),
       st.booleans())
def test_no_reading_makes_the_state_non_finite(samples, velocity, estimate):
    odo = SwerveOdometry(SwerveKinematics(CORNERS), estimate_gyro_bias=estimate)
    for k, (distance, angle, yaw, rate) in enumerate(samples):
        odo.update(0.1 * k, [distance, 0.0, 0.0, 0.0], [0.0, angle, 0.0, 0.0], yaw, rate,
                   [velocity] * 4)
        assert_sane(odo)


@pytest.mark.parametrize('name', ['yaw', 'yaw_rate', 'rate_integral'])
def test_readings_of_a_gyro_whose_difference_is_no_number_are_absent(name):
    odo = SwerveOdometry(SwerveKinematics(CORNERS))
    for k, reading in enumerate((1.7e308, -1.7e308, 1.7e308)):
        odo.update(0.1 * k, np.zeros(4), np.zeros(4), **{'yaw_rate': 0.0, name: reading})
        assert_sane(odo)
    assert odo.pose[2] == 0.0


@given(st.lists(st.tuples(st.floats(), st.floats(), st.floats()), min_size=2, max_size=6))
def test_any_stamp_and_any_pose_stay_numbers(samples):
    odo = SwerveOdometry(SwerveKinematics(CORNERS), pose=(1e308, -1e308, 1e308))
    for stamp, yaw, rate in samples:
        odo.update(stamp, np.zeros(4), np.zeros(4), yaw, rate, np.full(4, rate))
        assert_sane(odo)


@pytest.mark.parametrize('gap', [1e-9, 1e6])
def test_extreme_steps_stay_finite(gap):
    odo = SwerveOdometry(SwerveKinematics(CORNERS))
    for k, stamp in enumerate((0.0, 0.02, 0.02 + gap, 0.04 + gap)):
        odo.update(stamp, np.full(4, 0.01 * k), np.full(4, 0.1 * k), 0.1 * k, 3.0)
        assert_sane(odo)


@pytest.mark.parametrize('seed', range(5))
def test_pauses_of_any_length_leave_an_accelerometer_sane(seed):
    rng = np.random.default_rng(seed)
    odo, stamp, way = SwerveOdometry(SwerveKinematics(CORNERS)), 0.0, 0.0
    for _ in range(300):
        stamp += 10.0 ** rng.uniform(1.0, 9.0) if rng.random() < 0.3 else 0.02
        way += 0.02 * rng.normal()
        odo.update(stamp, np.full(4, way), rng.normal(0.0, 0.1, 4), yaw_rate=rng.normal(),
                   specific_force=rng.normal(0.0, 3.0, 2))
        assert_sane(odo)


@pytest.mark.parametrize('variance', [1.7e308, 1e200, 1e25])
def test_a_huge_covariance_stays_a_covariance(variance):
    odo = SwerveOdometry(SwerveKinematics(CORNERS))
    odo.reset((0.0, 0.0, 0.0), variance * np.array([(1, 0.5, 0), (0.5, 1, 0), (0, 0, 1)]))
    for k in range(50):
        odo.update(0.02 * k, np.full(4, 0.1 * k), np.full(4, 0.3), 0.1 * k)
        assert_sane(odo)
        assert (np.linalg.eigvalsh(odo.pose_covariance) > 0.0).all()


def test_an_instant_leaves_the_twist_as_it_was():
    odo = SwerveOdometry(SwerveKinematics(CORNERS))
    for stamp, way in ((0.0, 0.0), (0.1, 0.1), (0.1 + 1e-6, 0.101)):
        odo.update(stamp, np.full(4, way), np.zeros(4), 0.0)
    np.testing.assert_allclose(odo.twist, (1.0, 0.0, 0.0), atol=1e-9)
    assert odo.pose[0] == pytest.approx(0.101)
