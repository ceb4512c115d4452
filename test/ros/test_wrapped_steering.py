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

"""Steering joints that read the same after a turn drive like those that count on."""

import math
import time

import numpy as np
import pytest
from test_descriptions import drive_figure, Robot

TURN = 2.0 * math.pi
# As absolute encoders read. The second kind wraps where the wheels point straight ahead.
WRAPS = {'+-pi': lambda angle: math.remainder(angle, TURN),
         '0 to 2 pi': lambda angle: angle % TURN}


class WatchedRobot(Robot):
    """A robot that remembers what its steering joints read, and what its drives are told."""

    def __init__(self, description, wrap=None):
        super().__init__(description, wrap)
        self.readings, self.told = [], []

    def drive_by(self, twist):
        super().drive_by(twist)
        self.readings.append(self.steering)
        self.told.append(self.command.drive_velocity)


@pytest.mark.parametrize('wrap', WRAPS.values(), ids=WRAPS)
@pytest.mark.parametrize('description', [
    {'steering_offsets': [0.0, 0.0, 3.0, -1.5]},
    {'drive_coupling_ratio': [3.0, -3.0, 3.0, -3.0], 'drive_ratios': [6.75]},
    {'max_linear_jerk': 10.0, 'steering_directions': [-1.0]},
    {'steering_lower_limits': [-1.92], 'steering_upper_limits': [1.92],
     'steering_offsets': [0.0, 3.0, 0.0, 3.0]}], ids=['plain', 'coupled', 'jerk', 'limited'])
def test_a_base_drives_the_same_whether_its_steering_wraps_or_counts(description, wrap):
    wrapped, counting = WatchedRobot(description, wrap), WatchedRobot(description)
    odometry, truth, _ = drive_figure(wrapped)
    expected, counted, _ = drive_figure(counting)
    leaps = np.abs(np.diff(wrapped.readings, axis=0)) > math.pi
    assert leaps.sum() > 3
    assert not (np.abs(np.diff(counting.readings, axis=0)) > math.pi).any()
    np.testing.assert_allclose(wrapped.told, counting.told, atol=1e-6)
    np.testing.assert_allclose(truth, counted, atol=1e-6)
    np.testing.assert_allclose(odometry, expected, atol=1e-6)


@pytest.mark.parametrize('wrap', WRAPS.values(), ids=WRAPS)
def test_a_node_does_not_halt_where_a_steering_joint_wraps(client, start_node, wrap):
    start_node(gyro_source='none', cmd_vel_timeout=20.0, feedback_timeout=20.0)
    client.begin_feedback()
    begun = since = time.monotonic()
    turns, angles = np.zeros(4), np.zeros(4)

    def turn_the_direction():
        """Do as the joints are told, while the base goes in ever another direction."""
        nonlocal since, turns, angles
        now = time.monotonic()
        if client.steering and client.drive:
            angles = np.array(client.steering[-1].data)
            turns = turns + (now - since) * np.array(client.drive[-1].data)
        since = now
        client.send_joints([wrap(angle) for angle in angles], turns)
        heading = 2.0 * max(0.0, now - begun - 1.0)
        client.send_twist(0.5 * math.cos(heading), 0.5 * math.sin(heading))
        return heading
    client.repeat_until(lambda: None, lambda: turn_the_direction() > 2.5 * TURN, 'two turns', 0.0)
    told = np.array([command.data for command in client.drive])
    at_speed = int(np.argmax(np.abs(told).min(axis=1) > 9.0))
    assert at_speed > 0
    # Full speed is 10 rad/s; a little of it is missing while the modules lag.
    assert np.abs(told[at_speed:]).min() > 8.0
    steps = np.diff([command.data for command in client.steering], axis=0)
    assert (np.abs(steps) > math.pi).any()
    assert np.abs([math.remainder(step, TURN) for step in steps.ravel()]).max() < 0.5
