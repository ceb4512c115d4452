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

"""Tests of what the covariance says of bases that are not calibrated."""

from benchmarks import drives
import numpy as np
from odometry_drives import after_rest, CORNERS, nees_along, odometry
import pytest

from swerve_kinematics.core.odometry.chord import fit
from swerve_kinematics.core.odometry.group import Groups
from swerve_kinematics.core.odometry.module_paths import ModulePaths
from swerve_kinematics.core.odometry.pose_covariance import PoseCovariance
from swerve_kinematics.core.odometry.steady_errors import SteadyErrors


def uncalibrated(drive, radius_std, offset_std, rng):
    """Return the drive as wheels of other radii and steering offsets report it."""
    count = drive.distance.shape[1]
    return drive._replace(
        distance=drive.distance * (1.0 + radius_std * rng.standard_normal(count)),
        angle=drive.angle + offset_std * rng.standard_normal(count))


def wandering(seed):
    """Return a drive of 40 s from rest."""
    return drives.from_rest(drives.smooth_motion(
        CORNERS, 50, seed=seed, finest=1000, pace=drives.Pace(1.2, 1.0, 1.5)))


@pytest.mark.parametrize('radius_std, offset_std', [(0.02, 0.0), (0.0, 0.03), (0.01, 0.02)])
def test_covariance_tells_the_truth_about_a_base_that_is_not_calibrated(radius_std, offset_std):
    nees = []
    for run in range(8):
        drive = uncalibrated(wandering(run), radius_std, offset_std, np.random.default_rng(run))
        nees += nees_along(odometry(pose=drive.truth[0]), drive, skipped=400)
    assert 0.5 < np.mean(nees) < 6.0


@pytest.mark.parametrize('radius_std, offset_std', [(0.02, 0.0), (0.0, 0.03), (0.005, 0.01)])
def test_a_gyro_does_not_learn_from_modules_that_are_not_calibrated(radius_std, offset_std):
    bias, errors = np.radians(0.5), []
    for run in range(4):
        drive = after_rest(uncalibrated(
            wandering(run), radius_std, offset_std, np.random.default_rng(run)), 50)
        odo = odometry(pose=drive.truth[0], estimate_gyro_bias=True)
        for k, stamp in enumerate(drive.stamp):
            odo.update(stamp, drive.distance[k], drive.angle[k], drive.yaw[k] + bias * stamp)
        errors.append(odo.gyro_bias - bias)
    assert np.abs(errors).max() < np.radians(0.02)


@pytest.mark.parametrize('to_and_fro', [False, True])
@pytest.mark.parametrize('wrong, angle', [(0.04, 0.0), (0.0, 0.05), (-0.03, -0.03)])
def test_what_one_wheel_has_wrong_takes_the_mean_along_for_its_share(wrong, angle, to_and_fro):
    errors, paths, group = SteadyErrors(4), ModulePaths(4), Groups(CORNERS).of((0, 1, 2, 3))
    ways = 0.01 * np.arange(2001.0)
    if to_and_fro:
        ways = 3.0 * np.sin(ways / 3.0)
    for k, way in enumerate(ways.tolist()):
        paths.update([way * (1.0 + wrong), way, way, way], [angle, 0.0, 0.0, 0.0])
        if k:
            step = fit(paths, group, 0.0)
            errors.update(group.used, np.divide(step.errors, paths.directions).tolist(),
                          paths.rolled)
    share = abs((1.0 + wrong) * np.exp(1j * angle) - 1.0) / 4.0
    assert np.sqrt(errors.variance) == pytest.approx(share, rel=0.1)


def test_what_is_always_the_same_part_of_the_way_ends_where_the_way_does():
    covariance = PoseCovariance(np.zeros((3, 3)), 0.0)
    covariance.scale_variance = 0.02 ** 2
    for displacement, distance in ((3.0 + 4.0j, 5.0), (-3.0 + 0.0j, 4.0), (-4.0j, 0.0)):
        covariance.propagate(displacement, 0j, 0.0, 0.0, 0.0)
        stds = np.sqrt(np.diag(np.reshape(covariance.pose, (3, 3)))[:2])
        np.testing.assert_allclose(stds, 0.02 * distance, atol=1e-4)


def test_modules_that_agree_are_as_sure_as_they_were():
    # Errors that all of them share do not show.
    drive, stds = wandering(0), []
    for scale in (1.0, 1.05):
        odo = odometry(pose=drive.truth[0])
        drives.replay(odo, drive._replace(distance=scale * drive.distance), yaw=False)
        stds.append(np.sqrt(odo.pose_covariance.diagonal()))
    assert stds[0][0] < 0.06
    np.testing.assert_allclose(stds[1], stds[0], rtol=0.15)


def test_a_wheel_that_slips_is_not_taken_for_one_that_is_not_calibrated():
    odo = odometry()
    ways = np.multiply.outer(np.linspace(0.0, 20.0, 1001), np.ones(4))
    ways[500:510, 0] += np.linspace(0.0, 0.6, 10)
    ways[510:, 0] += 0.6
    for k, way in enumerate(ways):
        odo.update(0.02 * k, way, np.zeros(4), 0.0)
    assert np.sqrt(odo.pose_covariance[0, 0]) < 0.05
