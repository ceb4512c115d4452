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

"""Tests of how the odometry learns the bias of its gyro: at rest, and against the wheels."""

import numpy as np
from odometry_drives import after_rest, constant_drive, feed, KIN, odometry, TWIST
import pytest

from swerve_kinematics.core.odometry.gyro import GyroBiasFilter
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise


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


@pytest.mark.parametrize('rate', [20, 500])
def test_wheels_that_are_read_often_teach_as_much(rate):
    variances = []
    for period in (0.02, 1.0 / rate):
        drive = constant_drive(KIN, TWIST, steps=round(10.0 / period), period=period)
        last_bit = OdometryNoise().distance_resolution
        odo = SwerveOdometry(KIN)
        feed(odo, drive._replace(distance=last_bit * np.round(drive.distance / last_bit)))
        variances.append(odo._bias.variance)
    assert variances[1] == pytest.approx(variances[0], rel=0.25)


def test_what_a_slow_gyro_makes_up_for_at_once_teaches_nothing():
    bias = GyroBiasFilter(initial_std=0.001, drift=0.0)
    for _ in range(200):
        for error in (0.05, 0.05, 0.05, -0.15):
            bias.compare(0.05, error, 1e-4)
    assert abs(bias.bias) < 1e-6


def test_several_steps_teach_together_what_they_teach_one_by_one():
    together, one_by_one = GyroBiasFilter(), GyroBiasFilter()
    rng = np.random.default_rng(0)
    for _ in range(100):
        error, variance = 0.004 + 0.01 * rng.standard_normal(), rng.uniform(1e-3, 1e-2)
        together.compare(0.02, error, variance)
        one_by_one.correct(error, variance)
    together.learn()
    assert together.bias == pytest.approx(one_by_one.bias, rel=1e-9)
    assert together.variance == pytest.approx(one_by_one.variance, rel=1e-9)


def test_wheels_and_a_gyro_that_are_said_to_be_perfect_teach_the_bias_at_once():
    perfect = OdometryNoise(distance_noise=0.0, steering_noise=0.0, distance_resolution=0.0,
                            slip_speed=0.0, gyro_noise=0.0)
    drive, bias = constant_drive(KIN, TWIST), np.radians(0.5)
    odo = SwerveOdometry(KIN, noise=perfect)
    feed(odo, drive._replace(yaw=drive.yaw + bias * drive.stamp))
    assert odo.gyro_bias == pytest.approx(bias, rel=1e-3)


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


@pytest.mark.parametrize('creep', [0.002, 0.004, 0.006])
@pytest.mark.parametrize('bias', [-0.008, 0.008])
def test_tyres_that_creep_while_a_base_spins_up_do_not_pass_for_a_bias(creep, bias):
    """It spins up at once, by 5 rad/s^2, and nothing else tells the bias before."""
    stamp = np.arange(75) * 0.02
    rate = np.minimum(5.0 * stamp, 2.5)
    turned = np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * 0.02)))
    arms = KIN.module_positions @ (1, 1j)
    angles = np.angle(1j * arms)
    odo = SwerveOdometry(KIN)
    for now, turn, speed in zip(stamp, turned, rate):
        odo.update(now, np.abs(arms) * (turn + creep * speed), angles, turn + bias * now)
    assert abs(odo.pose[2] - turned[-1]) < 3.0 * np.sqrt(odo.pose_covariance[2, 2])
