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

"""Calibration finds radii, offsets and gyro scale, and knows how well."""

from functools import cache

from calibration_drives import (
    driven, Errors, forced, KINEMATICS, NOMINAL_RADIUS, random_errors, straight, varied)
import numpy as np
import pytest
from swerve_kinematics.core.calibration.calibration import calibrate_by_poses
from swerve_kinematics.core.calibration.line import calibrate_by_distance
from swerve_kinematics.core.calibration.recording import heading_by_gyro, Recording
from swerve_kinematics.core.calibration.slip import slipping
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

DEGREE = np.radians(1.0)
ERRORS = Errors(np.array([1.02, 0.98, 1.0, 1.01]), DEGREE * np.array([1.0, -1.0, 0.5, 0.0]), 1.01)


def recording_of(log, yaw=True):
    """Return a log as a robot with nominal radii and no offsets sees it."""
    return Recording(log.stamp, NOMINAL_RADIUS * log.wheel_angle, log.steering_angle,
                     log.yaw if yaw else None)


def by_poses(log):
    return calibrate_by_poses(KINEMATICS, recording_of(log), log.poses)


def share_within_two_sigma(errors, deviations):
    return np.mean(np.abs(errors) < 2.0 * np.array(deviations))


@pytest.mark.parametrize('rate', [100, 50, 20])
def test_recovers_2_percent_and_1_degree_with_12_bit_encoders(rate):
    found = by_poses(varied(ERRORS, np.random.default_rng(1), rate))
    np.testing.assert_allclose(found.radius_scale, ERRORS.radius_scale, atol=0.0005)
    np.testing.assert_allclose(found.steering_offset, ERRORS.steering_offset, atol=0.09 * DEGREE)
    assert found.gyro_scale == pytest.approx(ERRORS.gyro_scale, abs=0.0003)
    assert found.common_offset_known


def test_a_clock_that_is_set_by_years_amid_a_drive_costs_little():
    log = varied(ERRORS, np.random.default_rng(1), 50)
    leap = np.where(np.arange(len(log.stamp)) < 700, 0.0, 1.8e9)
    found = by_poses(log._replace(stamp=log.stamp + leap))
    np.testing.assert_allclose(found.radius_scale, ERRORS.radius_scale, atol=0.0005)
    np.testing.assert_allclose(found.steering_offset, ERRORS.steering_offset, atol=0.09 * DEGREE)


def test_recovers_errors_of_any_size():
    errors = Errors(np.array([0.5, 1.5, 1.0, 2.0]), np.array([np.pi - 0.1, -2.0, 1.0, 0.0]), 1.0)
    found = by_poses(varied(errors, np.random.default_rng(2)))
    np.testing.assert_allclose(found.radius_scale, errors.radius_scale, rtol=0.001)
    np.testing.assert_allclose(found.steering_offset, errors.steering_offset, atol=0.1 * DEGREE)


@pytest.mark.parametrize('truth_noise, allowed', [(0.0, 1.0), (0.002, 1.5)])
def test_the_uncertainty_covers_the_truth_and_is_not_much_larger(truth_noise, allowed):
    radius, offset, gyro = [], [], []
    for seed in range(50):
        rng = np.random.default_rng(seed)
        errors = random_errors(rng)
        log = varied(errors, rng, rate=(100, 50, 20)[seed % 3])
        log = log._replace(poses=log.poses + truth_noise * rng.standard_normal(log.poses.shape))
        found = by_poses(log)
        radius.append((found.radius_scale - errors.radius_scale, found.radius_scale_std))
        offset.append((found.steering_offset - errors.steering_offset, found.steering_offset_std))
        gyro.append((found.gyro_scale - errors.gyro_scale, found.gyro_scale_std))
    for name, largest, pairs in (('radius', 0.001, radius), ('offset', 0.1 * DEGREE, offset),
                                 ('gyro', 0.001, gyro)):
        error, deviation = np.moveaxis(np.array(pairs), 1, 0)
        assert np.abs(error).max() < allowed * largest, name
        assert share_within_two_sigma(error, deviation) >= 0.9, name
        assert np.sqrt(np.mean((error / deviation) ** 2)) > 0.4, name


def test_wheels_that_fight_each_other_are_told_as_far_as_the_motion_tells():
    radius, offset, deviations, patterns = [], [], [], []
    for seed in range(8):
        rng = np.random.default_rng(seed)
        errors = random_errors(rng)
        found = by_poses(driven(errors, rng))
        radius.append(found.radius_scale - errors.radius_scale)
        offset.append(found.steering_offset - errors.steering_offset)
        deviations.append((found.radius_scale_std, found.steering_offset_std))
        # What moves the base: the mean, and differences between front and rear, left and right.
        for pattern in ([1, 1, 1, 1], [1, 1, -1, -1], [1, -1, 1, -1]):
            patterns.append(np.array([radius[-1], offset[-1]]) @ pattern / 4.0)
    patterns = np.abs(patterns).max(axis=0)
    assert patterns[0] < 0.001
    assert patterns[1] < 0.1 * DEGREE
    radius_std, offset_std = np.moveaxis(np.array(deviations), 1, 0)
    # The modules of a drive are wrong together: one drive of the eight may be beyond.
    assert share_within_two_sigma(radius, radius_std) >= 0.8
    assert share_within_two_sigma(offset, offset_std) >= 0.8


def test_what_driven_wheels_hide_shows_in_the_uncertainty_whenever_they_are_driven():
    still_wrong = Errors(np.ones(4), np.array([0.02, -0.03, 0.0, 0.05]), 1.0)
    for seed in range(2):
        found = by_poses(driven(still_wrong, np.random.default_rng(seed), duration=12.0))
        still_wrong = Errors(still_wrong.radius_scale / found.radius_scale,
                             still_wrong.steering_offset - found.steering_offset, 1.0)
        assert found.driven
        # Nothing shows the pattern that moves no base, and it is as large as ever.
        left = still_wrong.steering_offset @ (1, -1, -1, 1) / 4.0
        assert left == pytest.approx(0.025, abs=0.002)
        assert (np.abs(still_wrong.steering_offset) < 2.0 * found.steering_offset_std).all()
        assert np.abs(still_wrong.steering_offset.mean()) < 0.1 * DEGREE


@pytest.mark.parametrize('errors', [
    Errors(np.ones(4), np.zeros(4), 1.0), ERRORS._replace(steering_offset=np.zeros(4)),
    ERRORS._replace(radius_scale=np.ones(4)), ERRORS],
    ids=['nothing', 'radii', 'offsets', 'both'])
def test_wheels_that_rolled_freely_are_known_whatever_is_wrong_with_them(errors):
    for seed in range(3):
        found = by_poses(varied(errors, np.random.default_rng(seed)))
        assert not found.driven
        np.testing.assert_allclose(found.radius_scale, errors.radius_scale, atol=1e-4)
        np.testing.assert_allclose(
            found.steering_offset, errors.steering_offset, atol=0.1 * DEGREE)


def test_motors_that_give_way_show_the_radii_but_not_what_the_steering_hides():
    # As in a physics simulation: the frame turns the wheels, but not the modules.
    for seed in range(5):
        rng = np.random.default_rng(seed)
        errors = random_errors(rng)
        log = forced(KINEMATICS, errors, np.ones(4), rng, give_way=True)
        found = by_poses(log)
        assert found.driven
        radius, offset = (found.radius_scale - errors.radius_scale,
                          found.steering_offset - errors.steering_offset)
        assert np.abs(radius).max() < 0.012
        assert found.radius_scale_std.max() < 0.004
        # They are not moved far to explain noise.
        assert np.abs(offset).max() < DEGREE
        assert found.steering_offset_std.min() > 0.9 * DEGREE


@pytest.mark.parametrize('positions', [
    [(0.3, 0.05), (-0.35, -0.1)], [(0.45, 0.0), (-0.25, 0.28), (-0.25, -0.28)],
    [(0.55, 0.2), (0.35, -0.35), (-0.1, 0.3), (-0.3, -0.15)],
    [(0.9, 0.3), (0.9, -0.3), (0.5, 0.35), (0.2, 0.3), (0.2, -0.3)]],
    ids=['2', '3', 'askew', '5'])
@pytest.mark.parametrize('grip', [0.0, 0.4], ids=['even grip', 'uneven grip'])
def test_driven_wheels_are_within_the_uncertainty_on_any_layout_twice(positions, grip):
    kinematics, count, deviations = SwerveKinematics(positions), len(positions), []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        left = Errors(1.0 + 0.01 * rng.standard_normal(count),
                      0.02 * rng.standard_normal(count), 1.0)
        weights = rng.uniform(1.0 - grip, 1.0 + grip, count)
        for _ in range(2):
            log = forced(kinematics, left, weights, rng)
            found = calibrate_by_poses(kinematics, recording_of(log), log.poses)
            left = Errors(left.radius_scale / found.radius_scale,
                          left.steering_offset - found.steering_offset, 1.0)
            deviations.append(((left.radius_scale - 1.0) / found.radius_scale_std,
                               left.steering_offset / found.steering_offset_std))
    assert np.mean(np.abs(deviations) < 2.0) >= 0.9
    assert np.abs(deviations).max() < 4.0


def test_wheels_known_to_roll_freely_need_not_show_it():
    log = driven(Errors(np.ones(4), np.zeros(4), 1.0), np.random.default_rng(7), duration=12.0)
    assert by_poses(log).driven
    pushed = calibrate_by_poses(KINEMATICS, recording_of(log), log.poses, pushed=True)
    assert not pushed.driven
    assert pushed.steering_offset_std.max() < 0.5 * DEGREE
    assert by_poses(log).steering_offset_std.min() > DEGREE


@pytest.mark.parametrize('slow', [0.3, 1.5], ids=['locked', 'spinning'])
def test_spans_in_which_wheels_slip_are_left_out_and_named(slow):
    log = varied(ERRORS, np.random.default_rng(8))
    steps = np.diff(log.wheel_angle, axis=0)
    for start, end, modules in ((4.0, 6.0, [1]), (12.0, 15.0, [0, 1, 2, 3])):
        steps[np.ix_((log.stamp[1:] > start) & (log.stamp[1:] <= end), modules)] *= slow
    slipped = log._replace(wheel_angle=np.concatenate(
        (log.wheel_angle[:1], log.wheel_angle[0] + np.cumsum(steps, axis=0))))
    found = by_poses(slipped)
    np.testing.assert_allclose(found.radius_scale, ERRORS.radius_scale, atol=0.002)
    np.testing.assert_allclose(found.steering_offset, ERRORS.steering_offset, atol=0.1 * DEGREE)
    for span in found.left_out:
        assert any(start - 0.5 <= span.start and span.end <= end + 0.5 and set(
            span.modules) <= set(modules)
            for start, end, modules in ((4.0, 6.0, [1]), (12.0, 15.0, [0, 1, 2, 3])))
    assert {1} in [set(span.modules) for span in found.left_out]
    assert sum(span.end - span.start for span in found.left_out) > 3.0
    assert by_poses(log).left_out == ()


@pytest.mark.parametrize('yaw', [True, False], ids=['gyro', 'no gyro'])
def test_a_line_of_known_length(yaw):
    radius, offset, deviations = [], [], []
    for seed in range(50):
        rng = np.random.default_rng(seed)
        errors = random_errors(rng)
        log, length = straight(errors, rng, direction=rng.uniform(-3.0, 3.0))
        found = calibrate_by_distance(
            KINEMATICS, recording_of(log, yaw), length + 0.002 * rng.standard_normal())
        radius.append(found.radius_scale - errors.radius_scale)
        relative = errors.steering_offset - errors.steering_offset.mean()
        offset.append(found.steering_offset - relative)
        deviations.append((found.radius_scale_std, found.steering_offset_std))
        assert not found.common_offset_known
        assert found.gyro_scale_std == np.inf
    radius_std, offset_std = np.moveaxis(np.array(deviations), 1, 0)
    assert share_within_two_sigma(radius, radius_std) >= 0.9
    assert share_within_two_sigma(offset, offset_std) >= 0.9
    assert np.median(radius_std) < 0.001
    assert np.abs(offset).max() < 0.1 * DEGREE


@cache
def driven_ahead(seed):
    """Return random errors, and the log of a line that a base with them was driven along."""
    def ahead(time):
        return np.array((0.55 * np.clip(min(time - 1.0, 11.0 - time), 0.0, 1.0), 0.0, 0.0))

    rng = np.random.default_rng(seed)
    errors = random_errors(rng)
    return errors, driven(errors, rng, duration=12.0, twist_at=ahead)


@pytest.mark.parametrize('yaw', [True, False], ids=['gyro', 'no gyro'])
def test_a_line_that_was_driven_is_not_trusted_with_more_than_it_shows(yaw):
    for seed in range(8):
        errors, log = driven_ahead(seed)
        found = calibrate_by_distance(KINEMATICS, recording_of(log, yaw), np.hypot(
            *(log.poses[-1, :2] - log.poses[0, :2])))
        # The encoders that hold the modules all round, by the same all the way.
        assert found.driven
        relative = errors.steering_offset - errors.steering_offset.mean()
        assert (np.abs(found.radius_scale - errors.radius_scale)
                < 2.0 * found.radius_scale_std).all()
        assert (np.abs(found.steering_offset - relative) < 2.0 * found.steering_offset_std).all()
        assert found.radius_scale.mean() == pytest.approx(errors.radius_scale.mean(), abs=0.001)


def test_a_line_tells_offsets_only_of_a_base_that_was_pushed():
    log, length = straight(ERRORS, np.random.default_rng(1))
    found, pushed = (calibrate_by_distance(KINEMATICS, recording_of(log), length, pushed=pushed)
                     for pushed in (False, True))
    assert found.steering_offset_std.min() > 2.0 * DEGREE
    assert pushed.steering_offset_std.max() < 0.1 * DEGREE
    np.testing.assert_allclose(found.radius_scale_std, pushed.radius_scale_std, rtol=0.5)


def test_a_gyro_that_is_heard_late_tells_the_heading_of_a_line_all_the_same():
    log, _ = straight(ERRORS, np.random.default_rng(1))
    recording = recording_of(log)
    late = np.where(log.stamp < 0.4, np.nan, log.yaw)
    np.testing.assert_allclose(heading_by_gyro(recording._replace(yaw=late)),
                               heading_by_gyro(recording), atol=1e-3)
    assert np.ptp(heading_by_gyro(recording)) > 5e-3


def test_a_module_that_does_not_roll_is_unknown():
    log = varied(ERRORS, np.random.default_rng(3))
    arm = KINEMATICS.module_positions[0] @ (1.0, 1j)
    turned = 1.5 * np.sin(0.7 * log.stamp)
    still = np.exp(1j * turned) * arm  # the base swings about the first module
    poses = np.column_stack((-still.real, -still.imag, turned))
    spans = np.abs(KINEMATICS.module_positions @ (1.0, 1j) - arm)
    tangents = np.angle(1j * (KINEMATICS.module_positions @ (1.0, 1j) - arm))
    recording = Recording(log.stamp, turned[:, np.newaxis] * spans,
                          np.broadcast_to(tangents, (len(turned), 4)))
    found = calibrate_by_poses(KINEMATICS, recording, poses)
    assert found.radius_scale[0] == 1.0
    assert found.steering_offset[0] == 0.0
    assert np.isinf([found.radius_scale_std[0], found.steering_offset_std[0]]).all()
    np.testing.assert_allclose(found.radius_scale[1:], 1.0, atol=1e-4)
    assert np.isfinite(found.radius_scale_std[1:]).all()


def test_a_gyro_is_unknown_where_it_is_silent_or_the_base_does_not_turn():
    log = varied(ERRORS, np.random.default_rng(4))
    silent = np.where(log.stamp < 25.0, np.nan, log.yaw)
    found = calibrate_by_poses(KINEMATICS, recording_of(log)._replace(yaw=silent), log.poses)
    assert (found.gyro_scale, found.gyro_scale_std) == (1.0, np.inf)
    silent = np.where(log.stamp < 2.0, np.nan, log.yaw)
    found = calibrate_by_poses(KINEMATICS, recording_of(log)._replace(yaw=silent), log.poses)
    assert found.gyro_scale == pytest.approx(ERRORS.gyro_scale, abs=0.0005)
    line, _ = straight(ERRORS, np.random.default_rng(4))
    assert by_poses(line).gyro_scale_std == np.inf


def test_a_gap_costs_its_windows_only():
    log = varied(ERRORS, np.random.default_rng(5))
    kept = (log.stamp < 10.0) | (log.stamp > 13.0)
    found = by_poses(log._replace(**{
        name: series[kept] for name, series in log._asdict().items()}))
    np.testing.assert_allclose(found.radius_scale, ERRORS.radius_scale, atol=0.0005)


@pytest.mark.parametrize('modules', [[0], [0, 1, 2, 3]])
def test_encoders_that_start_again_from_0_cost_their_window_only(modules):
    log = varied(ERRORS, np.random.default_rng(5))
    recording = recording_of(log)
    distances = recording.distances.copy()
    distances[:700, modules] += 200.0
    found = calibrate_by_poses(KINEMATICS, recording._replace(distances=distances), log.poses)
    np.testing.assert_allclose(found.radius_scale, ERRORS.radius_scale, atol=0.0005)


def test_a_wheel_at_rest_reads_as_little_as_a_simulator_makes_of_0():
    # The squares of such numbers are too small to divide by.
    measured, true = np.ones((20, 4), dtype=complex), np.ones((20, 4), dtype=complex)
    measured[:, 0], true[:, 0] = 1e-162, 1e-3
    assert not slipping(measured, true).any()


def test_refuses_what_is_of_no_use():
    log = varied(ERRORS, np.random.default_rng(6))
    recording = recording_of(log)
    refused = [
        ('too short', recording._replace(
            distances=np.zeros_like(recording.distances)), log.poses),
        ('contradict', recording._replace(
            distances=recording.distances[:, ::-1]), log.poses),
        ('increase', recording._replace(stamp=recording.stamp[::-1]), log.poses),
        ('finite', recording._replace(angles=recording.angles * np.nan), log.poses),
        ('finite', recording, log.poses * np.nan),
        ('in metres', recording, log.poses * (1000.0, 1000.0, 1.0)),
        ('does it move', recording, 0.0 * log.poses),
        ('does it move', recording, np.random.default_rng(7).normal(0.0, 1e-3, log.poses.shape)),
        ('shape', recording, log.poses[1:]),
        ('shape', recording._replace(angles=recording.angles[:, 1:]), log.poses)]
    for reason, bad, poses in refused:
        with pytest.raises(ValueError, match=reason):
            calibrate_by_poses(KINEMATICS, bad, poses)
    with pytest.raises(ValueError, match='not straight'):
        calibrate_by_distance(KINEMATICS, recording, 5.0)
    with pytest.raises(ValueError, match='in metres'):
        calibrate_by_distance(
            KINEMATICS, recording_of(straight(ERRORS, np.random.default_rng(6))[0]), 5500.0)
    for offset in (20.0, 90.0, 180.0):
        astray = Errors(np.ones(4), DEGREE * np.array([offset, 0.0, 0.0, 0.0]), 1.0)
        log, length = straight(astray, np.random.default_rng(6))
        with pytest.raises(ValueError, match='which one is wrong'):
            calibrate_by_distance(KINEMATICS, recording_of(log), length)
    for distance in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match='distance'):
            calibrate_by_distance(KINEMATICS, recording, distance)
