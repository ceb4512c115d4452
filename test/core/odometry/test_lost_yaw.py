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

"""What a yaw that comes back after a silence tells of the turn meanwhile."""

from hypothesis import given
from inertial_replay import DRIVE, replay, spinning
import numpy as np
import pytest
from strategies import seeds

from swerve_kinematics.core.odometry.catch_up import FASTEST_TURN
from swerve_kinematics.core.odometry.lost_yaw import LONGEST_LOSS

PERIOD = DRIVE.stamp[1] - DRIVE.stamp[0]
# Wheels on the left spin, so that they tell of a turn that is none.
LEFT = np.array((1.0, 0.0, 1.0, 0.0))
NEVER = len(DRIVE.stamp)


def between(start, end):
    """Return which samples are between two times [s]."""
    return (DRIVE.stamp >= start) & (DRIVE.stamp < end)


def slipping(start, end, share=0.4):
    """Return the drive whose left wheels run ahead by this part from `start` to `end` [s]."""
    return spinning(DRIVE, start, end, 1.0 + share * LEFT)


def errors_of(drive, lost, zero=0.0):
    """Return the errors of the poses (t, 3) with a gyro that is lost at times."""
    yaw = np.where(lost, np.nan, drive.yaw)
    back = np.flatnonzero(lost)
    if back.size:
        yaw[back[-1]:] += zero
    poses = replay(drive._replace(yaw=yaw, yaw_rate=np.full_like(yaw, np.nan)), None)[1]
    return poses - drive.truth


def headings(drive, lost, zero=0.0):
    """Return the errors of the heading (t,) [rad] with a gyro that is lost at times."""
    return errors_of(drive, lost, zero)[:, 2]


def test_what_the_wheels_told_wrongly_while_the_yaw_was_lost_is_put_right():
    drive, lost = slipping(4.0, 4.6), between(4.0, 4.6)
    errors = headings(drive, lost)
    assert np.abs(errors[between(4.5, 4.6)]).max() > 0.1
    assert np.abs(errors[between(6.5, 99.0)]).max() < 2e-3


def test_the_heading_never_jumps():
    drive, lost = slipping(4.0, 4.6), between(4.0, 4.6)
    changes = np.abs(np.diff(headings(drive, lost)))[between(4.62, 99.0)[1:]]
    assert 0.0 < changes.max() <= FASTEST_TURN * PERIOD * (1.0 + 1e-9)


@given(seeds)
def test_the_heading_ends_up_as_the_gyro_tells_whatever_was_lost(seed):
    rng = np.random.default_rng(seed)
    lost = np.zeros(len(DRIVE.stamp), dtype=bool)
    for start in np.cumsum(rng.uniform(1.5, 4.0, 3)):
        lost |= between(start, start + rng.uniform(0.02, 1.2))
    errors = headings(DRIVE, lost)
    assert np.abs(errors[-50:]).max() < 2e-3
    assert np.abs(np.diff(errors)).max() < 0.01


@pytest.mark.parametrize('zero', [1.0, -2.5, 0.3])
def test_a_sensor_that_was_restarted_does_not_turn_the_base(zero):
    lost = between(4.0, 5.0)
    np.testing.assert_allclose(
        headings(DRIVE, lost, zero), headings(DRIVE, lost, 1.5), atol=1e-12)
    assert np.abs(headings(DRIVE, lost, zero)).max() < 0.02


def test_after_a_long_silence_the_wheels_are_believed():
    lost = between(4.0, 4.1 + LONGEST_LOSS)
    errors = headings(slipping(4.0, 4.6), lost)
    assert np.ptp(errors[between(4.7, 99.0)]) < 0.02


def test_a_yaw_that_is_left_out_while_the_rate_goes_on_corrects_nothing():
    yaw = np.where(between(4.0, 5.5), np.nan, DRIVE.yaw)
    yaw[between(5.5, 99.0)] += 0.04
    poses = replay(DRIVE._replace(yaw=yaw), None)[1]
    assert np.abs(poses[:, 2] - DRIVE.truth[:, 2]).max() < 1e-3


def headings_by_rate(drive, lost, untold=NEVER, lacking=0.0):
    """
    Return the errors of the heading (t,) [rad] with a gyro of rates that is lost at times.

    The integral is not told with the sample `untold`, and from there on it lacks a turn [rad].
    """
    rate, integral = (np.where(lost, np.nan, told) for told in (drive.yaw_rate, drive.yaw + 3.0))
    integral[untold:untold + 1] = np.nan
    integral[untold:] -= lacking
    drive = drive._replace(yaw=np.full_like(rate, np.nan), yaw_rate=rate)
    return replay(drive, None, integral=integral)[1][:, 2] - drive.truth[:, 2]


def test_the_integral_of_a_rate_tells_like_a_yaw_what_was_turned_meanwhile():
    drive, lost = slipping(4.0, 4.2), between(4.0, 4.2)
    errors = headings_by_rate(drive, lost)
    assert np.abs(errors[between(4.1, 4.2)]).max() > 0.03
    assert np.abs(errors[between(6.5, 99.0)]).max() < 2e-3


def test_an_integral_that_lacks_a_silence_corrects_nothing_but_the_next_loss():
    lost = between(4.0, 4.6)
    untold = np.flatnonzero(lost)[-1] + 1
    errors = headings_by_rate(DRIVE, lost, untold, lacking=0.05)
    assert np.abs(errors).max() < 0.01
    again = between(8.0, 8.2)
    errors = headings_by_rate(slipping(8.0, 8.2), lost | again, untold, lacking=0.05)
    assert np.abs(errors[again]).max() > 0.03
    assert np.abs(errors[between(10.5, 99.0)]).max() < 0.01


def test_the_way_goes_on_along_the_heading_that_the_gyro_tells_at_once():
    drive, lost = slipping(4.0, 4.6), between(4.0, 4.6)
    errors = errors_of(drive, lost)[between(4.62, 99.0)]
    # It has not turned yet.
    assert abs(errors[0, 2]) > 0.1
    assert np.abs(errors[:, :2] - errors[0, :2]).max() < 5e-3
