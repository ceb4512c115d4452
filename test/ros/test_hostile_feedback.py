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

"""Whatever numbers joints and IMU send, in whatever order: nothing fails, all stays finite."""

import math

import numpy as np
from odometry_parts import OdometryParts
import pytest

from swerve_kinematics.ros.conversions import StampedNumbers
from swerve_kinematics.ros.drive import Drive
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds
from swerve_kinematics.ros.timeline import Moment
from swerve_kinematics.ros.watch import Watch

MESSAGES = 150
NUMBERS = (0.0, 1.0, math.nan, math.inf, -math.inf, 1.7e308, -1e200, 5e-324, 1e12, -9e11, 1e6)
BASES = {
    'plain': {}, 'wrapped': {'drive_joint_period': 2.0 * math.pi},
    'coupled and geared': {
        'drive_coupling_ratio': [3.0, -3.0, 3.0, -3.0], 'drive_ratios': [6.75],
        'steering_ratios': [12.8], 'steering_directions': [-1.0], 'drive_joint_period': 12.56637},
    'limited': {'steering_lower_limits': [-1.9], 'steering_upper_limits': [1.9],
                'max_linear_jerk': 20.0, 'max_grip_acceleration': 3.0}}


class Pipeline:
    """What the node makes of its feedback, from numbers to commands."""

    def __init__(self, description):
        """Start without a measurement."""
        self.parts = OdometryParts(gyro_source='joint', **description)
        layout = self.parts.parameters.layout
        self.names = [*self.parts.names, layout.gyro_joint]
        self.drive, self.real = Drive(self.parts.parameters), 0
        self.watch = Watch(layout.module_names, layout.kinematics.module_positions, True)

    def joints(self, stamp, names, positions, velocities):
        """Take a JointState; return all that is published for it."""
        self.real += NANOSECONDS // 50
        moment = Moment(stamp, self.real, self.real)
        odometry = self.parts.odometry
        sample = self.parts.feedback.read(stamp, names, positions, velocities)
        if sample is not None:
            twist = odometry.estimate.twist if self.parts.tell(sample) else None
            self.drive.measured(sample.stamp, sample.angles, twist, moment)
            self.watch.add(sample.stamp, sample.distances, sample.angles, sample.yaw,
                           sample.yaw_rate)
        self.drive.input.accept((0.5, 0.2, 0.3), moment)
        command = self.drive.step(moment, odometry.yaw)
        self.watch.commanded(command.speeds, command.angles)
        self.watch.findings()
        estimate = odometry.estimate
        return [*estimate.pose, *estimate.twist, *estimate.pose_covariance,
                *estimate.twist_covariance, *command.wheel_speeds, *command.twist,
                *(command.steering_angles or [])]

    def inertia(self, stamp, numbers):
        """Take an Imu."""
        self.parts.imu.take(stamp, StampedNumbers(stamp, '', numbers))


def spoilt(rng, numbers, chance):
    """Return numbers some of which are hostile."""
    return [float(rng.choice(NUMBERS)) if rng.random() < chance else number
            for number in numbers]


@pytest.mark.parametrize('description', BASES.values(), ids=BASES)
def test_no_number_is_fatal_or_goes_on_as_one_that_is_not_finite(description):
    for seed in range(5):
        rng = np.random.default_rng(seed)
        pipeline, stamp, turns = Pipeline(description), NANOSECONDS, np.zeros(9)
        for _ in range(MESSAGES):
            step = rng.choice([0.02, 0.02, 0.02, 0.0, 0.3, 1.0, -0.1, -5.0])
            stamp = max(0, stamp + nanoseconds(step))
            turns += [0.3] * 4 + [0.02] * 4 + [0.01]
            chance = rng.choice([0.0, 0.1, 0.5])
            velocities = spoilt(rng, [15.0] * 4 + [1.0] * 4 + [0.5], chance)
            published = pipeline.joints(stamp, pipeline.names, spoilt(rng, turns.tolist(), chance),
                                        velocities[:rng.choice([0, 5, 9, 9])])
            assert np.isfinite(published).all()
            pipeline.inertia(stamp, tuple(spoilt(rng, [0.0, 0.0, 0.0, 1.0] + [0.1] * 33, chance)))
