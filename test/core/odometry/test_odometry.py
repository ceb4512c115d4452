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

"""Tests of the odometry: its geometry, its fault handling and its covariances."""

from benchmarks import drives
from hypothesis import given, strategies as st
import numpy as np
import pytest
from strategies import layouts, seeds

from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.geometry.se2 import se2_compose, se2_exp
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.chord import chords, fit
from swerve_kinematics.core.odometry.group import Layout
from swerve_kinematics.core.odometry.module_paths import ModulePaths
from swerve_kinematics.core.odometry.odometry import OdometryNoise, SwerveOdometry

CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
KIN = SwerveKinematics(CORNERS)
TWIST = np.array([1.2, -0.4, 0.8])
PERIOD = 0.02
# Modules far from base_link may move faster than any real one does.
ANY_SPEED = OdometryNoise(max_module_speed=np.inf)


def constant_drive(kin, twist, steps=50, period=PERIOD, start=(0.0, 0.0, 0.0)):
    """Return the Drive of a base that moves with one twist from `start`."""
    t = period * np.arange(steps + 1)
    states = kin.inverse(twist)
    truth = se2_compose(start, se2_exp(np.multiply.outer(t, twist)))
    return drives.Drive(kin.module_positions, t, np.multiply.outer(t, states.speed),
                        np.tile(states.angle, (steps + 1, 1)), 0.3 + truth[:, 2],
                        np.full(steps + 1, twist[2]), truth)


def after_rest(drive, steps):
    """Return the drive with so many steps of rest before it."""
    series = [np.concatenate((np.repeat(values[:1], steps, axis=0), values))
              for values in drive[2:]]
    stamps = (drive.stamp[1] - drive.stamp[0]) * np.arange(steps + len(drive.stamp))
    return drives.Drive(drive.modules, stamps, *series)


def odometry(kin=KIN, **settings_):
    """Return an odometry that trusts its gyro, which most of these drives have without bias."""
    return SwerveOdometry(kin, **{'estimate_gyro_bias': False, **settings_})


def feed(odo, drive, **gyro):
    """Run a drive and return the last pose."""
    return drives.replay(odo, drive, **gyro)[-1]


# Geometry

@given(layouts(), seeds)
def test_constant_twist_is_exact_with_each_kind_of_gyro(positions, seed):
    kin = SwerveKinematics(positions)
    drive = constant_drive(kin, np.random.default_rng(seed).normal(scale=2.0, size=3))
    for gyro in ({'yaw': True}, {'yaw': False, 'yaw_rate': True}, {'yaw_rate': True}):
        odo = odometry(kin, noise=ANY_SPEED)
        np.testing.assert_allclose(feed(odo, drive, **gyro), drive.truth[-1], atol=1e-9)
        assert not odo.slipping.any()


@given(layouts(), seeds)
def test_wheels_alone_follow_a_constant_twist(positions, seed):
    kin = SwerveKinematics(positions)
    drive = constant_drive(kin, np.random.default_rng(seed).normal(scale=1.0, size=3))
    pose = feed(odometry(kin, noise=ANY_SPEED), drive, yaw=False)
    np.testing.assert_allclose(pose, drive.truth[-1], atol=2e-5)


@given(layouts(), st.floats(-3.0, 3.0), st.floats(0.1, 3.0))
def test_constant_steering_rate_is_exact(positions, steering_rate, speed):
    kin = SwerveKinematics(positions)
    t = 0.1 * np.arange(40)
    angle = steering_rate * t
    for yaw in (0.0, None):
        odo = odometry(kin)
        for k, stamp in enumerate(t):
            modules = np.ones(kin.module_count)
            odo.update(stamp, speed * stamp * modules, angle[k] * modules, yaw)
        # The integral of speed exp(i angle): the arc of a circle, base_link never turns.
        arc = speed * t[-1] * np.sinc(angle[-1] / (2.0 * np.pi)) * np.exp(0.5j * angle[-1])
        np.testing.assert_allclose(odo.pose, (arc.real, arc.imag, 0.0), atol=1e-9)


def test_smooth_motion_is_a_hundred_times_closer_than_by_end_angles():
    drive = drives.smooth_motion(CORNERS, 50, finest=1000)
    error = drives.position_error(drives.replay(odometry(), drive), drive)
    assert error < 0.01 * 4.0 * drives.position_error(drives.end_angle_poses(drive), drive)


@given(layouts(counts=(2, 3, 6)), seeds)
def test_pose_is_where_it_was_set(positions, seed):
    rng = np.random.default_rng(seed)
    kin, start = SwerveKinematics(positions), rng.normal(scale=5.0, size=3)
    drive = constant_drive(kin, rng.normal(size=3), start=start)
    pose = feed(odometry(kin, pose=start, noise=ANY_SPEED), drive)
    np.testing.assert_allclose(pose, drive.truth[-1], atol=1e-9)


@pytest.mark.parametrize('gyro', [{'yaw': True}, {'yaw': False}])
def test_twist_is_that_of_the_base(gyro):
    odo = odometry()
    feed(odo, constant_drive(KIN, TWIST), **gyro)
    np.testing.assert_allclose(odo.twist, TWIST, atol=1e-5)


@pytest.mark.parametrize('yaws', [(0.0, 0.0), (None, None)])
def test_measured_velocities_make_the_twist(yaws):
    odo, states = odometry(), KIN.inverse((1.0, 0.5, 0.0))
    for k, yaw in enumerate(yaws):
        odo.update(0.1 * k, np.zeros(4), states.angle, yaw, velocities=states.speed)
    np.testing.assert_allclose(odo.twist, (1.0, 0.5, 0.0), atol=1e-12)
    np.testing.assert_allclose(odo.pose, 0.0, atol=1e-12)


def test_wheels_tell_the_yaw_rate_by_their_velocities():
    odo, states = odometry(), KIN.inverse(TWIST)
    for k in range(2):
        odo.update(0.1 * k, np.zeros(4), states.angle, velocities=states.speed)
    np.testing.assert_allclose(odo.twist, TWIST, atol=1e-12)


def test_velocity_that_is_missing_is_made_from_distances():
    odo, drive = odometry(), constant_drive(KIN, TWIST)
    for k in range(3):
        odo.update(drive.stamp[k], drive.distance[k], drive.angle[k], drive.yaw[k],
                   velocities=[np.nan, 9.0, 9.0, 9.0])
    np.testing.assert_allclose(odo.twist, TWIST, atol=1e-9)


def test_wrapped_sensors_tell_the_same():
    drive = drives.smooth_motion(CORNERS, 50, finest=1000)
    turned = drive._replace(angle=drive.angle + 6.0, yaw=drive.yaw + 3.0)
    wrapped = drive._replace(angle=wrap_angle(turned.angle), yaw=wrap_angle(turned.yaw))
    np.testing.assert_allclose(feed(odometry(), wrapped), feed(odometry(), turned), atol=1e-9)


def test_yaw_counts_whole_turns():
    assert feed(odometry(), constant_drive(KIN, (0.0, 0.0, 3.0), steps=500))[2] == (
        pytest.approx(30.0))


# Time, gaps and faults

def test_first_call_primes():
    odo = odometry(pose=(1.0, 2.0, 3.0))
    assert not odo.update(5.0, [7.0] * 4, [0.0] * 4, 0.4)
    np.testing.assert_array_equal(odo.pose, (1.0, 2.0, 3.0))
    assert odo.update(5.1, [7.1] * 4, [0.0] * 4, 0.4)


@pytest.mark.parametrize('stamp', [1.0, 0.5, -3.0, np.nan, np.inf, -np.inf])
def test_repeated_or_older_stamp_is_dropped(stamp):
    odo = odometry()
    odo.update(0.9, np.zeros(4), np.zeros(4))
    odo.update(1.0, np.full(4, 0.1), np.zeros(4))
    pose, covariance = odo.pose, odo.pose_covariance
    assert not odo.update(stamp, np.full(4, 0.2), np.zeros(4))
    np.testing.assert_array_equal(odo.pose, pose)
    np.testing.assert_array_equal(odo.pose_covariance, covariance)
    assert odo.update(1.1, np.full(4, 0.3), np.zeros(4))
    assert odo.pose[0] == pytest.approx(0.3)


def test_dropped_samples_are_bridged():
    drive = constant_drive(KIN, TWIST, steps=100)
    kept = np.random.default_rng(3).random(101) > 0.3
    kept[[0, -1]] = True
    np.testing.assert_allclose(feed(odometry(), drive.at(kept)), drive.truth[-1], atol=1e-9)


@pytest.mark.parametrize('stamp', [30.0, 0.99])
def test_reprime_keeps_the_pose_and_grows_the_covariance(stamp):
    odo, drive = odometry(), constant_drive(KIN, TWIST)
    feed(odo, drive)
    pose, variances = odo.pose, np.diag(odo.pose_covariance)
    odo.reprime()
    assert not odo.update(stamp, np.full(4, -50.0), np.zeros(4), -2.0)
    np.testing.assert_array_equal(odo.pose, pose)
    assert (np.diag(odo.pose_covariance) > variances + 0.5).all()
    assert odo.update(stamp + 0.1, np.full(4, -50.0), np.zeros(4), -2.0)
    np.testing.assert_allclose(odo.pose, pose, atol=1e-12)


def test_longer_gap_loses_more():
    variances = []
    for gap in (0.5, 5.0):
        odo = odometry()
        feed(odo, constant_drive(KIN, TWIST))
        odo.reprime()
        odo.update(1.0 + gap, np.zeros(4), np.zeros(4))
        variances.append(np.diag(odo.pose_covariance))
    assert (variances[1] > 10.0 * variances[0]).all()


@pytest.mark.parametrize('gyro', [{'yaw': True}, {'yaw': False}])
@pytest.mark.parametrize('faulty_readings', ['reset', 'missing', 'missing angle'])
def test_module_that_resets_or_goes_missing_is_left_out(gyro, faulty_readings):
    drive = constant_drive(KIN, TWIST)
    distance, angle = drive.distance + 8.0, drive.angle.copy()
    if faulty_readings == 'reset':
        distance[25:, 2] -= 9.0
    elif faulty_readings == 'missing':
        distance[20:30, 2] = np.nan
    else:
        angle[20:30, 2] = np.inf
    odo = odometry()
    np.testing.assert_allclose(feed(odo, drive._replace(distance=distance, angle=angle), **gyro),
                               drive.truth[-1], atol=1e-6)


def test_encoder_reset_is_reported_for_its_step():
    odo = odometry()
    readings = ([8.0] * 4, [8.01] * 4, [8.02, 8.02, 0.0, 8.02], [8.03, 8.03, 0.01, 8.03])
    reported = []
    for k, distances in enumerate(readings):
        odo.update(PERIOD * k, distances, np.zeros(4), 0.0)
        reported.append(odo.slipping.tolist())
    assert reported == [[False] * 4, [False] * 4, [False, False, True, False], [False] * 4]
    np.testing.assert_allclose(odo.pose, (0.03, 0.0, 0.0), atol=1e-12)


def test_too_few_modules_prime_instead_of_guessing():
    odo = odometry()
    for k in range(3):
        odo.update(PERIOD * k, np.full(4, 0.01 * k), np.zeros(4))
    pose, variance = odo.pose, odo.pose_covariance[0, 0]
    assert not odo.update(0.06, [0.03, np.nan, np.nan, np.nan], np.zeros(4))
    assert not odo.update(0.08, np.full(4, np.nan), np.zeros(4))
    np.testing.assert_array_equal(odo.pose, pose)
    assert odo.pose_covariance[0, 0] > variance


def test_one_module_and_a_gyro_are_enough():
    drive = constant_drive(KIN, TWIST)
    drive.distance[:, :3] = np.nan
    np.testing.assert_allclose(feed(odometry(), drive), drive.truth[-1], atol=1e-9)


def test_gyro_lost_and_back_leaves_no_jump():
    drive = constant_drive(KIN, TWIST, steps=90)
    drive.yaw[30:60] = np.nan
    drive.yaw[60:] += 2.0
    poses = drives.replay(odometry(), drive)
    np.testing.assert_allclose(poses, drive.truth, atol=1e-5)


@pytest.mark.parametrize('gyro', [{'yaw': True}, {'yaw': False}])
def test_slipping_wheel_is_left_out_and_reported(gyro):
    drive = constant_drive(KIN, TWIST)
    drive.distance[10:, 3] += np.linspace(0.0, 0.4, 41)
    odo = odometry()
    np.testing.assert_allclose(feed(odo, drive, **gyro), drive.truth[-1], atol=1e-4)
    assert odo.slipping.tolist() == [False, False, False, True]


def test_no_wheel_is_left_out_when_two_disagree_with_two():
    odo = odometry()
    odo.update(0.0, np.zeros(4), np.zeros(4), 0.0)
    odo.update(0.1, [0.1, 0.1, 0.2, 0.2], np.zeros(4), 0.0)
    assert not odo.slipping.any()
    assert odo.residual == pytest.approx(0.5)
    assert odo.pose[0] == pytest.approx(0.15)


@given(st.lists(st.tuples(*[st.floats() for _ in range(4)]), min_size=2, max_size=6), st.floats(),
       st.booleans())
def test_no_reading_makes_the_state_non_finite(samples, velocity, estimate):
    odo = SwerveOdometry(KIN, estimate_gyro_bias=estimate)
    for k, (distance, angle, yaw, rate) in enumerate(samples):
        odo.update(0.1 * k, [distance, 0.0, 0.0, 0.0], [0.0, angle, 0.0, 0.0], yaw, rate,
                   [velocity] * 4)
    for state in (odo.pose, odo.twist, odo.pose_covariance, odo.twist_covariance,
                  odo.gyro_bias, odo.residual):
        assert np.isfinite(state).all()


@pytest.mark.parametrize('gap', [1e-9, 1e6])
def test_extreme_steps_stay_finite(gap):
    odo = SwerveOdometry(KIN)
    for k, stamp in enumerate((0.0, 0.02, 0.02 + gap, 0.04 + gap)):
        odo.update(stamp, np.full(4, 0.01 * k), np.full(4, 0.1 * k), 0.1 * k, 3.0)
    assert np.isfinite(odo.pose_covariance).all()
    assert np.isfinite(odo.pose).all()


# The gyro's bias

@pytest.mark.parametrize('gyro', [{}, {'yaw': False, 'yaw_rate': True}])
def test_bias_is_learned_at_rest_and_taken_off(gyro):
    drive = after_rest(constant_drive(KIN, TWIST, steps=1000), 100)
    drive.yaw_rate[:100] = 0.0
    bias = np.radians(0.5)
    drive = drive._replace(yaw=drive.yaw + bias * drive.stamp, yaw_rate=drive.yaw_rate + bias)
    odo = SwerveOdometry(KIN)
    pose = feed(odo, drive, **gyro)
    assert odo.gyro_bias == pytest.approx(bias, rel=0.02)
    assert abs(pose[2] - drive.truth[-1, 2]) < 0.1 * bias * drive.stamp[-1]


def test_bias_is_learned_while_driving():
    drive = constant_drive(KIN, TWIST, steps=3000)
    bias = np.radians(0.5)
    odo = SwerveOdometry(KIN)
    feed(odo, drive._replace(yaw=drive.yaw + bias * drive.stamp))
    assert odo.gyro_bias == pytest.approx(bias, rel=0.1)


def creeping(odo, speed, steering=0.0, seconds=1.0):
    """Feed 12-bit encoders of a base that a slope drags along, with a bias of 0.5 deg/s."""
    tick, phases = 2.0 * np.pi * 0.05 / 4096, np.array((0.0, 0.3, 0.6, 0.9))
    for time in np.arange(0.0, seconds, 0.02):
        ticks = np.floor(speed * time / tick + phases)
        # Wheels that are steered on the spot drag the base to and fro.
        yaw = np.radians(0.5) * time + 1e-3 * np.sin(steering * time)
        odo.update(time, ticks * tick, np.full(4, steering * time), yaw)
    return np.degrees(odo.gyro_bias)


@pytest.mark.parametrize('speed', [0.002, 0.01, -0.025])
def test_bias_is_learned_by_a_base_that_creeps_down_a_slope(speed):
    assert creeping(SwerveOdometry(KIN), speed) == pytest.approx(0.5, abs=0.02)


def test_steering_on_the_spot_teaches_no_more_than_driving():
    steady, steering = SwerveOdometry(KIN), SwerveOdometry(KIN)
    creeping(steady, 0.002)
    creeping(steering, 0.002, steering=2.0)
    assert steering._bias.variance > 4.0 * steady._bias.variance


def test_slipping_wheels_do_not_feed_the_bias():
    drive = constant_drive(KIN, TWIST, steps=500)
    drive.distance[:, ::2] += 0.5 * drive.stamp[:, np.newaxis]
    odo = SwerveOdometry(KIN)
    feed(odo, drive)
    assert odo.gyro_bias == 0.0


def test_bias_is_left_alone_when_not_asked_for():
    drive = constant_drive(KIN, np.zeros(3), steps=100)
    odo = odometry()
    feed(odo, drive._replace(yaw=0.01 * drive.stamp))
    assert odo.gyro_bias == 0.0
    assert odo.pose[2] == pytest.approx(0.02)


# Covariances

def noisy(drive, rng, noise, bias):
    """Return the drive with the noise that `OdometryNoise` describes, and 12-bit encoders."""
    dt = drive.stamp[1] - drive.stamp[0]
    scale = np.sqrt(2.0 * noise.correlation_time / dt)
    moved = np.diff(drive.distance, axis=0, prepend=0.0)
    moved *= 1.0 + scale * noise.distance_noise * rng.standard_normal(moved.shape)
    angle = drive.angle + scale * noise.steering_noise * rng.standard_normal(moved.shape)
    walk = noise.gyro_noise * np.sqrt(dt) * np.cumsum(rng.standard_normal(len(drive.stamp)))
    rounded = np.round(np.cumsum(moved, axis=0) / noise.distance_resolution)
    return drive._replace(
        distance=rounded * noise.distance_resolution,
        angle=np.round(angle / drives.ENCODER_STEP) * drives.ENCODER_STEP,
        yaw=drive.yaw + walk + bias * drive.stamp)


def mean_nees(level, yaw, runs=300, rate=5, bias=None):
    """
    Return the mean normalised estimation error squared of 40 s drives, for the 3 states.

    With `level` times the noise that the odometry expects of the wheels, at `rate` [Hz]. With
    a bias [rad/s] the drives start with 2 s of rest, and the odometry estimates it.
    """
    expected = OdometryNoise()
    true = OdometryNoise(distance_noise=level * expected.distance_noise,
                         steering_noise=level * expected.steering_noise)
    total = 0.0
    for run in range(runs):
        rng = np.random.default_rng(run)
        twist = rng.uniform((-1.5, -1.5, -1.0), (1.5, 1.5, 1.0))
        drive = constant_drive(KIN, twist, 40 * rate, 1.0 / rate)
        if bias is not None:
            drive = after_rest(drive, 2 * rate)
        drive = noisy(drive, rng, true, bias or 0.0)
        odo = SwerveOdometry(KIN, estimate_gyro_bias=bias is not None, noise=expected)
        for k, stamp in enumerate(drive.stamp):
            odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k] if yaw else None)
        error = odo.pose - drive.truth[-1]
        total += error @ np.linalg.solve(odo.pose_covariance, error)
    return total / runs


@pytest.mark.parametrize('yaw', [True, False])
def test_covariance_tells_the_truth(yaw):
    assert 2.5 < mean_nees(1.0, yaw) < 3.5


@pytest.mark.parametrize('yaw', [True, False])
def test_covariance_follows_modules_that_are_worse_than_expected(yaw):
    assert 1.5 < mean_nees(4.0, yaw, runs=60, rate=10) < 6.0


def test_covariance_tells_the_truth_about_a_bias():
    assert 2.0 < mean_nees(1.0, True, runs=60, bias=np.radians(0.5)) < 4.0


@pytest.mark.parametrize('gyro', [{'yaw': True}, {'yaw': False}])
def test_covariance_does_not_depend_on_the_rate(gyro):
    covariances = []
    for rate in (10, 200):
        odo = odometry(noise=OdometryNoise(slip_speed=1.0))
        feed(odo, constant_drive(KIN, TWIST, 10 * rate, 1.0 / rate), **gyro)
        covariances.append(odo.pose_covariance)
    np.testing.assert_allclose(covariances[0], covariances[1], rtol=0.03, atol=1e-6)


def test_slip_makes_the_pose_less_sure():
    drive = constant_drive(KIN, TWIST)
    gripping, slipping = odometry(), odometry()
    feed(gripping, drive)
    drive.distance[10:, 3] += np.linspace(0.0, 0.4, 41)
    feed(slipping, drive)
    growth = slipping.pose_covariance - gripping.pose_covariance
    assert (np.linalg.eigvalsh(growth[:2, :2]) > 0.0).all()


def test_covariance_is_that_of_base_link_wherever_it_is():
    # The same drive seen from a point 2 m beside the wheels: its position is as unsure as a
    # lever of 2 m on the yaw makes it.
    offset = 2.0
    rolling = (1.0, 0.0, 0.0)
    near, far = odometry(), odometry(SwerveKinematics(CORNERS + (0.0, offset)))
    feed(near, constant_drive(KIN, rolling))
    feed(far, constant_drive(SwerveKinematics(CORNERS + (0.0, offset)), rolling))
    lever = np.array([(1.0, 0.0, offset), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)])
    np.testing.assert_allclose(far.pose_covariance, lever @ near.pose_covariance @ lever.T,
                               atol=1e-12)
    np.testing.assert_allclose(far.twist_covariance, lever @ near.twist_covariance @ lever.T,
                               atol=1e-12)


def test_covariances_are_symmetric_and_positive():
    odo = SwerveOdometry(KIN)
    feed(odo, drives.smooth_motion(CORNERS, 20, finest=400))
    for covariance in (odo.pose_covariance, odo.twist_covariance):
        np.testing.assert_array_equal(covariance, covariance.T)
        assert (np.linalg.eigvalsh(covariance) > 0.0).all()


# Setting and reading the state

def test_reset_sets_pose_and_covariance_and_drives_on():
    odo, drive = odometry(), constant_drive(KIN, TWIST)
    feed(odo, drive.at(slice(0, 26)))
    covariance = np.diag((0.1, 0.2, 0.3))
    odo.reset((5.0, 6.0, 7.0), covariance)
    np.testing.assert_array_equal(odo.pose, (5.0, 6.0, 7.0))
    np.testing.assert_array_equal(odo.pose_covariance, covariance)
    expected = se2_compose((5.0, 6.0, 7.0), se2_exp(25 * PERIOD * TWIST))
    np.testing.assert_allclose(feed(odo, drive.at(slice(26, None))), expected, atol=1e-9)
    odo.reset()
    np.testing.assert_array_equal(odo.pose_covariance, np.zeros((3, 3)))


def test_what_is_read_is_a_copy():
    odo = odometry()
    feed(odo, constant_drive(KIN, TWIST))
    for name in ('pose', 'twist', 'pose_covariance', 'twist_covariance', 'slipping'):
        getattr(odo, name)[...] = 0
        if name != 'slipping':
            assert np.any(getattr(odo, name)), name


@pytest.mark.parametrize('arguments', [
    (np.zeros(3), np.zeros(4)), (np.zeros(4), np.zeros((1, 4))), (np.zeros((2, 4)), np.zeros(4)),
    (0.0, np.zeros(4)), (np.zeros((4, 1)), np.zeros(4)), ([[0.0]] * 4, np.zeros(4))])
def test_wrong_shapes_are_refused(arguments):
    with pytest.raises(ValueError):
        odometry().update(0.0, *arguments)


def test_wrong_velocities_are_refused():
    with pytest.raises(ValueError, match='velocities'):
        odometry().update(0.0, np.zeros(4), np.zeros(4), velocities=np.zeros(3))


@pytest.mark.parametrize('arguments', [
    ((0.0, 0.0),), ((0.0, 0.0, np.nan),), ((0.0, 0.0, 0.0), np.zeros((2, 2))),
    ((0.0, 0.0, 0.0), np.full((3, 3), np.inf))])
def test_impossible_pose_is_refused_and_changes_nothing(arguments):
    odo = odometry(pose=(1.0, 2.0, 3.0))
    with pytest.raises(ValueError):
        odo.reset(*arguments)
    np.testing.assert_array_equal(odo.pose, (1.0, 2.0, 3.0))


@pytest.mark.parametrize('setting', [
    {'distance_noise': -1.0}, {'gyro_noise': np.nan}, {'slip_speed': np.inf}])
def test_impossible_noise_is_refused(setting):
    with pytest.raises(ValueError, match=next(iter(setting))):
        OdometryNoise(**setting)


@given(distance=st.floats(-1.0, 1.0), angle=st.floats(-3.0, 3.0), steering=st.floats(-1.0, 1.0),
       turn=st.floats(-1.0, 1.0))
def test_a_step_and_the_arrays_of_many_steps_take_the_same_chord(distance, angle, steering, turn):
    # A single module on base_link: its chord is the displacement.
    paths, steering = ModulePaths(1), angle + steering - angle
    paths.update(0.1, [0.0], [angle])
    paths.update(0.1, [distance], [angle + steering])
    step = fit(paths, Layout(np.zeros((1, 2))).group((0,)), turn)
    direction = np.exp(1j * np.array([angle + 0.5 * steering]))
    many = chords(np.array([distance]), np.array([steering]), direction, turn)
    assert abs(step.displacement - many[0]) < 1e-15
