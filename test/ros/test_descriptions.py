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

"""Bases of many kinds follow the figure of eight, and their odometry knows where they are."""

import math

import numpy as np
from odometry_parts import OdometryParts, values
import pytest

from swerve_kinematics.configuration.simulator import (
    SIMULATOR_DECLARATIONS, simulator_parameters_from)
from swerve_kinematics.ros.drive import Drive
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds
from swerve_kinematics.ros.timeline import Moment
from swerve_kinematics.sim import base, sensors
from swerve_kinematics.sim.imu import SimulatedImu
from swerve_kinematics.sim.parameters import base_from
from swerve_kinematics.tools.demo.figure_eight import FigureEight, follow, plan

FIGURE = FigureEight(length=6.0, width=3.0, turns=1, duration=24.0, ramp=2.0)
PERIOD = 0.01  # s
RIGHT = 0.5 * math.pi


def ring(count, radius=0.35):
    """Return the parameters of modules on a circle."""
    bearing = 2.0 * np.pi * np.arange(count) / count
    return {'module_names': [f'module_{i}' for i in range(count)],
            'module_x': (radius * np.cos(bearing)).tolist(),
            'module_y': (radius * np.sin(bearing)).tolist()}


BASES = {
    'plain': {},
    'mirrored': {'drive_directions': [1.0, -1.0, 1.0, -1.0],
                 'steering_offsets': [0.3, 2.8, -1.0, 3.0]},
    'clockwise': {'steering_directions': [-1.0], 'steering_offsets': [0.7, -0.7, 2.0, 0.0]},
    'geared': {'drive_ratios': [6.75], 'steering_ratios': [12.8]},
    'coupled': {'drive_directions': [1.0, -1.0, 1.0, -1.0], 'drive_ratios': [6.75],
                'drive_coupling_ratio': [3.0, -3.0, 3.0, -3.0]},
    'wrapped': {'drive_joint_period': 2.0 * np.pi},
    'two modules': ring(2), 'three modules': ring(3), 'six modules': ring(6),
    'eight modules': ring(8),
    'limited': {'steering_lower_limits': [-1.92], 'steering_upper_limits': [1.92]},
    'IMU upside down': {'gyro_source': 'imu', 'imu_orientation': [math.pi, 0.0, 0.3]},
    'all at once': {
        **ring(3), 'wheel_radii': [0.05, 0.06, 0.07], 'drive_directions': [-1.0, 1.0, -1.0],
        'drive_ratios': [5.0, 6.0, 7.0], 'drive_coupling_ratio': [1.0, -2.0, 0.5],
        'drive_joint_period': 4.0 * np.pi, 'steering_directions': [-1.0, 1.0, -1.0],
        'steering_ratios': [2.0], 'steering_offsets': [1.0, 2.0, -3.0],
        'gyro_source': 'imu', 'imu_orientation': [0.0, RIGHT, 0.0]},
}


class Robot:
    """
    The node's parts and the simulated base, in one process and as fast as it goes.

    Its steering joints count on, unless `wrap` tells what they read instead.
    """

    def __init__(self, description, wrap=None):
        self.wrap = wrap
        self.parts = OdometryParts(**{'gyro_source': 'joint', **description})
        self.odometry = self.parts.odometry
        self.drive = Drive(self.parts.parameters)
        simulator = simulator_parameters_from(values(SIMULATOR_DECLARATIONS, description))
        self.config = base_from(simulator)
        self.state = base.at_rest(self.config)
        self.command = base.hold(self.config, self.state)
        self.sensor = None
        if self.parts.parameters.gyro_source == 'imu':
            self.sensor = SimulatedImu(simulator.imu_orientation)
        self.now, self.rng = NANOSECONDS, np.random.default_rng(1)

    def sense(self):
        """Move for a period, and let the odometry see it."""
        self.state = base.step(self.config, self.state, self.command, PERIOD)
        self.now += nanoseconds(PERIOD)
        reading, _ = sensors.sense(
            self.config, sensors.SensorFaults(), self.state, 0.0, PERIOD, self.rng)
        if self.sensor:
            orientation, rates, _ = self.sensor.measure(
                reading.yaw, (0.0, 0.0, reading.yaw_rate), (0.0, 0.0, 9.81), PERIOD)
            self.parts.hear_imu(self.now / NANOSECONDS, orientation, rates, None)
        self.steering = [self.wrap(angle) if self.wrap else angle
                         for angle in reading.steering_position]
        sample = self.parts.feedback.read(
            self.now, [*self.parts.names, 'gyro_joint'],
            [*reading.drive_position, *self.steering, reading.yaw],
            [*reading.drive_velocity, *reading.steering_velocity, reading.yaw_rate])
        twist = self.odometry.estimate.twist if self.parts.tell(sample) else None
        self.drive.measured(sample.stamp, sample.angles, twist, self.moment)

    @property
    def moment(self):
        """Return the present."""
        return Moment(self.now, self.now, self.now)

    def drive_by(self, twist):
        """Command a twist."""
        self.drive.input.accept(tuple(twist), self.moment, False)
        command = self.drive.step(self.moment, self.odometry.yaw)
        angles = command.steering_angles
        if self.wrap:  # such a driver takes the shorter way
            at = np.array(self.config.joints.steering_positions(
                self.state.steering_angle.tolist()))
            angles = at + [math.remainder(angle, 2.0 * math.pi) for angle in angles - at]
        self.command = base.BaseCommand(np.array(command.wheel_speeds), np.array(angles))


def drive_figure(robot):
    """Drive the figure of eight by the odometry; return odometry, truth and plan (t, 3)."""
    rows = []
    for time in np.arange(-0.2, FIGURE.duration + 1.0, 2.0 * PERIOD):
        robot.sense()
        robot.sense()
        target, velocity = plan(FIGURE, time)
        robot.drive_by(follow(target, velocity, robot.odometry.pose, 1.0))
        rows.append((robot.odometry.pose, robot.state.pose, target))
    return (np.array(series) for series in zip(*rows))


@pytest.mark.parametrize('description', BASES.values(), ids=BASES)
def test_the_base_follows_the_figure_and_the_odometry_the_base(description):
    robot = Robot(description)
    odometry, truth, target = drive_figure(robot)
    way = np.hypot(*np.diff(truth[:, :2], axis=0).T).sum()
    error = np.hypot(*(odometry - truth)[:, :2].T).max()
    assert way > 14.0
    assert error < 0.002 * way
    assert np.abs(odometry - truth)[:, 2].max() < 0.005
    # Lag of the drives and turns of the steering at the start, not a wrong way.
    limited = 'steering_lower_limits' in description
    assert np.hypot(*(truth - target)[:, :2].T).max() < (0.8 if limited else 0.15)
    assert np.hypot(*(truth - target)[-1, :2]) < 0.02
    assert not robot.parts.feedback.ignored


def test_a_coupled_wheel_that_stands_stays_where_it_is_while_its_module_steers():
    robot = Robot({'drive_coupling_ratio': [3.0], 'max_module_acceleration': 0.0})
    for _ in range(25):
        robot.sense()
        robot.sense()
        robot.drive_by((0.0, 0.1, 0.0))
    assert np.abs(robot.state.steering_angle).min() == pytest.approx(RIGHT, abs=0.05)
    # Left to itself, each wheel would have rolled back by 0.24 m.
    assert np.abs(robot.state.wheel_angle).max() < 0.2 * 3.0 * RIGHT
    # The lags of drive and steering differ: so it swings a little, and comes back.
    assert abs(robot.state.pose[0]) < 0.1
