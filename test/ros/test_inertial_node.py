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

"""The accelerometer of `imu` in the node: what it is worth, also when it comes late."""

from functools import cache
import itertools
import math
from pathlib import Path

from benchmarks import drives, inertial_drives
from nav_msgs.msg import Odometry
import numpy as np
from odometry_parts import OdometryParts, values
import pytest
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu

from swerve_kinematics.configuration.simulator import (
    SIMULATOR_DECLARATIONS, simulator_parameters_from)
from swerve_kinematics.core.geometry.rotations import from_roll_pitch_yaw
from swerve_kinematics.sim import sensors
from swerve_kinematics.sim.base import BaseCommand
from swerve_kinematics.sim.bodies import body_from
from swerve_kinematics.sim.imu import SimulatedImu
from swerve_kinematics.sim.parameters import base_from, faults_from

LOGS = Path(__file__).parents[1] / 'data' / 'imu'
NAMES = 'B2_mu05', 'C1_payload', 'L3_mu06', 'P1_push400', 'S1_slope'
GRAVITY = 9.81
IMU_PERIOD, JOINTS_EVERY = 0.005, 4
RADIUS = 0.05


@pytest.mark.parametrize('friction, part', [(0.1, 0.3), (0.15, 0.5), (0.2, 0.1)])
def test_on_a_slippery_floor_the_accelerometer_knows_better_than_the_wheels(friction, part):
    """Launches and locked braking on wet paint: all wheels slip at once."""
    place = [0.1, 0.05]
    parameters = simulator_parameters_from(values(SIMULATOR_DECLARATIONS, {
        'physics': 'mujoco', 'mujoco.friction': friction, 'imu_position': place,
        'encoder_resolution': 4096, 'accelerometer_bias': [0.1, -0.05],
        'gyro_noise_density': 1e-4}))
    body, config = body_from(parameters), base_from(parameters)
    sensor = SimulatedImu((), parameters.accelerometer_bias, 0.002)
    kinematics, rng = parameters.layout.kinematics, np.random.default_rng(1)
    wheels, judged = (OdometryParts(imu_position=place) for _ in range(2))
    twists = ((0.0, 0.0, 0.0), (1.5, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.5, 0.5),
              (0.0, 0.0, 0.0), (-1.0, 1.0, 0.0), (0.0, 0.0, 0.0))
    drift, errors = 0.0, []
    angle = np.zeros(4)
    for k in range(round(7.0 / IMU_PERIOD)):
        states = kinematics.inverse(twists[int(k * IMU_PERIOD)], held_angles=angle)
        angle = states.angle
        body.step(BaseCommand(states.speed / RADIUS, angle), IMU_PERIOD)
        now = 1.0 + k * IMU_PERIOD
        reading, drift = sensors.sense(
            config, faults_from(parameters), body.state, drift, IMU_PERIOD, rng)
        force, (roll_rate, pitch_rate, _) = body.inertial
        told = sensor.measure(
            reading.yaw, (roll_rate, pitch_rate, reading.yaw_rate), force, IMU_PERIOD)
        wheels.hear_imu(now, *told[:2], None)
        judged.hear_imu(now, *told)
        if k % JOINTS_EVERY == 0:
            joints = [*reading.drive_position, *reading.steering_position]
            errors.append([np.linalg.norm(parts.hear_joints(now, joints)[:2]
                                          - body.state.pose[:2]) for parts in (wheels, judged)])
    without, with_it = np.sqrt(np.mean(np.square(errors), axis=0))
    assert with_it < part * without
    assert judged.imu.accelerometer.fault is None


def test_the_node_says_that_its_accelerometer_is_frozen(client, start_node, reports):
    start_node(gyro_source='imu')
    imu = client.publisher(Imu, 'imu', qos_profile_sensor_data)
    turns = itertools.count()

    def move():
        stamp, k = client.node.get_clock().now().to_msg(), next(turns)
        message = Imu()
        message.header.stamp, message.linear_acceleration.z = stamp, GRAVITY
        message.angular_velocity.z = 0.001 * math.sin(k)
        imu.publish(message)
        client.send_joints(turns=(0.1 * k,) * 4, stamp=stamp)
    client.repeat_until(move, lambda: reports and 'accelerometer of the IMU is not used: frozen'
                        in reports[-1].message, 'the report')


def test_no_odometry_is_published_for_old_readings_of_encoders(client, start_node):
    start_node(gyro_source='imu')
    odometries = client.listen(Odometry, 'odom')
    imu = client.publisher(Imu, 'imu', qos_profile_sensor_data)
    is_new, turns = {}, itertools.count()

    def move():
        # 1 m/s, heard by the driver in every second step.
        stamp, k = client.node.get_clock().now().to_msg(), next(turns)
        is_new[stamp.sec, stamp.nanosec] = k % 2 == 0
        message = Imu()
        force, noise = message.linear_acceleration, 0.001 * math.sin(k)
        message.header.stamp, message.angular_velocity.z = stamp, noise
        force.x, force.y, force.z = noise, noise, GRAVITY + noise
        imu.publish(message)
        client.send_joints(turns=(0.8 * (k // 2),) * 4, stamp=stamp)

    def waits():
        stamps = [odometry.header.stamp for odometry in odometries[-15:]]
        return len(stamps) == 15 and all(is_new[stamp.sec, stamp.nanosec] for stamp in stamps)
    client.repeat_until(move, waits, 'odometries of new readings alone')


def imu_of(log):
    """Return times, yaws, rates (t, 3) and forces (t, 3) of an IMU at 200 Hz on a log at 50 Hz."""
    drive, rng = log.drive, np.random.default_rng(2)
    middles = 0.5 * (drive.stamp[1:] + drive.stamp[:-1])
    times = np.arange(drive.stamp[0], drive.stamp[-1], IMU_PERIOD)
    turn = np.diff(drive.yaw) / np.diff(drive.stamp)
    yaw_rate, *level = (np.interp(times, middles, means) for means in (
        turn, *log.rates[1:].T, *log.force[1:].T))
    noise = 0.03 * rng.standard_normal((len(times), 3))
    yaw = drive.yaw[0] + np.concatenate(((0.0,), np.cumsum(yaw_rate[1:] * IMU_PERIOD)))
    return (times, yaw, np.column_stack((*level[:2], yaw_rate)),
            np.column_stack((*level[2:], np.full(len(times), GRAVITY))) + noise)


@cache
def error_of(name, delay=0.0, imu_delay=0.0, lost=0.0):
    """
    Return the ATE [m] on a log whose IMU is stamped and sent late by `delay` [s].

    About every five seconds, it is not heard for a time `lost` [s].
    """
    log = inertial_drives.faulty(inertial_drives.load(LOGS / f'{name}.npz'),
                                 np.random.default_rng(1))
    drive = log.drive
    parts = OdometryParts(
        module_x=drive.modules[:, 0].tolist(), module_y=drive.modules[:, 1].tolist(),
        wheel_radii=[1.0], imu_position=log.place.tolist(), imu_delay=imu_delay)
    parts.odometry.reset(drive.truth[0])
    poses, samples = np.empty_like(drive.truth), list(zip(*imu_of(log)))
    heard = 0
    for k, stamp in enumerate(drive.stamp):
        while heard < len(samples) and samples[heard][0] + delay <= stamp + 1e-9:
            time, yaw, rates, force = samples[heard]
            if (time + 2.0) % 5.3 >= lost:
                parts.hear_imu(1.0 + time + delay, from_roll_pitch_yaw(0.0, 0.0, yaw),
                               rates.tolist(), force.tolist())
            heard += 1
        poses[k] = parts.hear_joints(
            1.0 + stamp, [*drive.distance[k].tolist(), *drive.angle[k].tolist()])
    return drives.position_error(poses, drive)


def test_a_delay_that_is_known_costs_little():
    ideal, known, unknown = (np.array([error_of(name, **delays) for name in NAMES]) for delays in (
        {}, {'delay': 0.01, 'imu_delay': 0.01}, {'delay': 0.01}))
    assert np.exp(np.mean(np.log(known / ideal))) < 1.15
    assert np.exp(np.mean(np.log(unknown / ideal))) > 1.2


def test_an_imu_that_is_lost_now_and_then_costs_little():
    ideal, lost = (np.array([error_of(name, **loss) for name in NAMES])
                   for loss in ({}, {'lost': 0.25}))
    assert np.mean(lost) < 4.0 * np.mean(ideal)
    assert np.median(lost / ideal) < 1.3
