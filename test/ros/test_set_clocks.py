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

"""Clocks that are set while the base drives: twist and pose stay those of the base."""

import math

import numpy as np
from odometry_parts import OdometryParts, values
import pytest

from swerve_kinematics import se2_exp
from swerve_kinematics.configuration.node import NODE_DECLARATIONS, parameters_from
from swerve_kinematics.ros.accelerometer import AccelerometerFeedback, InertialSample
from swerve_kinematics.ros.gyro_feedback import GyroFeedback
from swerve_kinematics.ros.stamps import nanoseconds

MS = 1_000_000  # ns
LAYOUT = parameters_from(values(NODE_DECLARATIONS, {})).layout
KIN, RADIUS = LAYOUT.kinematics, LAYOUT.joints.wheel_radii[0]
PERIOD = 0.02
TWIST = np.array((1.4, -0.5, 0.9))
STEPS = [sign * step for step in (0.005, 0.01, 0.015, 0.02, 0.03, 0.05, 0.1, 0.3, 0.48, 1.0, 5.0)
         for sign in (1.0, -1.0)]


def drive(parts, step, gyro, reports_velocity):
    """Drive with one twist; after 2 s all clocks are set by a step [s]. Return what was told."""
    states = KIN.inverse(TWIST)
    wheels = states.speed / RADIUS
    told, times = [], []
    for k in range(200):
        time = PERIOD * k
        stamp = 1000.0 + time + (step if k >= 100 else 0.0)
        if gyro:
            for early in (0.01, 0.0):
                parts.feedback.read_gyro(
                    nanoseconds(stamp - early),
                    TWIST[2] * (time - early) if 'yaw' in gyro else math.nan,
                    TWIST[2] if 'rate' in gyro else math.nan)
        velocities = [*wheels, *[0.0] * 4] if reports_velocity else []
        sample = parts.feedback.read(nanoseconds(stamp), parts.names,
                                     [*(wheels * time), *states.angle], velocities)
        if parts.tell(sample):
            told.append(parts.odometry.twist)
            times.append(time)
    return np.array(told), np.array(times), se2_exp(TWIST * time)


@pytest.mark.parametrize('reports_velocity', [True, False])
@pytest.mark.parametrize('gyro', ['', 'rate', 'yaw', 'yaw and rate'])
def test_a_base_that_drives_does_not_leap_when_its_clock_is_set(gyro, reports_velocity):
    for step in STEPS:
        parts = OdometryParts(estimate_gyro_bias=False)
        twists, times, truth = drive(parts, step, gyro, reports_velocity)
        off = np.abs(twists - TWIST)
        # One doubtful step may be told with the time that its stamps say, if that is not absurd.
        assert (off[:, :2] < (0.7 if not reports_velocity else 0.05)).all(), step
        assert (off[:, 2] < 1.0).all(), step
        assert np.count_nonzero(off.max(axis=1) > 0.1) <= 2, step
        # Feedback goes on at once; at most a message is dropped, and one begins anew.
        assert np.diff(times).max() < 3.5 * PERIOD, step
        # What is not known of the way is no more than that, and the covariance knows.
        error = np.abs(parts.odometry.pose - truth)
        lost = 3.0 * PERIOD if np.diff(times).max() > 2.5 * PERIOD or abs(step) > 0.5 else 0.0
        assert error[2] < 0.03 + lost * TWIST[2], step
        assert np.hypot(*error[:2]) < 0.06 + lost * 3.0, step
        assert (error < 3.0 * np.sqrt(np.diag(parts.odometry.pose_covariance)) + 0.06).all(), step


def test_one_late_message_is_dropped_and_two_in_order_are_a_clock_set_back():
    parts = OdometryParts()
    read = [parts.feedback.read(stamp * MS, parts.names, [0.0] * 8, [])
            for stamp in (1000, 1020, 990, 1040, 1030, 1060, 1000, 1080, 1070, 1060, 1100,
                          1050, 1070, 1090)]
    assert [sample.stamp // MS for sample in read if sample] == [
        1000, 1020, 1040, 1060, 1080, 1100, 1070, 1090]
    assert [sample.stamp // MS for sample in read if sample and not sample.continuous] == [
        1000, 1070]


@pytest.mark.parametrize('overtaken', [1, 2, 3, 10])
@pytest.mark.parametrize('parts_of_set', [1, 2])
def test_messages_that_another_one_overtook_tell_of_no_clock(overtaken, parts_of_set):
    parts, gyro = OdometryParts(), GyroFeedback(500 * MS)
    stamps = np.arange(1000, 2000, 20)
    stamps[20:21 + overtaken] = np.roll(stamps[20:21 + overtaken], 1)
    samples = []
    for stamp in stamps:
        gyro.add(stamp * MS, math.nan, 1.0)
        for names in np.split(np.array(parts.names), parts_of_set):
            samples.append(parts.feedback.read(stamp * MS, names.tolist(), [0.0] * 8, []))
    assert sum(sample is not None for sample in samples) == len(stamps) - overtaken
    assert sum(bool(sample and not sample.continuous) for sample in samples) == 1
    assert gyro.breaks == 1


def test_the_clock_of_one_of_two_publishers_may_be_set_back():
    parts = OdometryParts()
    drives, steerings = parts.names[:4], parts.names[4:]
    samples = []
    for k in range(20):
        stamp = 1000 + 20 * k
        late = 150 if k >= 10 else 0
        parts_of_set = [
            parts.feedback.read(stamp * MS, drives, [0.1 * k] * 4, []),
            parts.feedback.read((stamp + 5 - late) * MS, steerings, [0.0] * 4, [])]
        samples.append(next((sample for sample in parts_of_set if sample), None))
    assert [k for k, sample in enumerate(samples) if sample is None] == [10, 11]
    assert [k for k, sample in enumerate(samples) if sample and not sample.continuous] == [0, 12]


def test_a_gyro_and_an_accelerometer_follow_a_clock_set_back():
    gyro, accelerometer = GyroFeedback(200 * MS), AccelerometerFeedback()
    for stamp in [*range(1000, 1100, 10), *range(1000, 1100, 10)]:
        gyro.add(stamp * MS, 0.0, 1.0)
        accelerometer.add(stamp * MS, InertialSample(1j, 0j, 9.8, (stamp, 1.0, 9.8)))
        if stamp > 1010:
            accelerometer.means(stamp * MS, [0.0])
    assert gyro.at(1090 * MS).integral == pytest.approx(0.09 + 0.08)
    assert accelerometer.means(1095 * MS, [0.0]).force == pytest.approx((0.0, 1.0))


def test_one_stale_sample_does_not_spoil_the_integral_of_a_gyro():
    gyro = GyroFeedback(200 * MS)
    for stamp in (5000, 5010, 5020, 1000, 5030, 5040):
        gyro.add(stamp * MS, math.nan, 1.0)
    assert gyro.at(5040 * MS).integral == pytest.approx(0.03)
