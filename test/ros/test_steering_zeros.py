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

"""Which readings of steering joints show that a joint has lost its zero."""

import math

import numpy as np
import pytest

from swerve_kinematics.ros.stamps import NANOSECONDS
from swerve_kinematics.ros.steering_zeros import SteeringZeros


class Joints:
    """Four steering joints that are read at a rate, of a base that drives."""

    def __init__(self, rate=100.0, has_driven=True):
        self.zeros, self.rate, self.stamp = SteeringZeros(4), rate, NANOSECONDS
        self.has_driven = has_driven
        self.read([0.8] * 4)

    def read(self, angles, elapsed=None, commands=((0.8,) * 4,)):
        """Read the angles after a time [s], mostly a period; return which zeros are lost."""
        for told in commands:
            self.zeros.command(told, self.has_driven)
        self.stamp += round((elapsed or 1.0 / self.rate) * NANOSECONDS)
        self.zeros.read(self.stamp, list(angles))
        return self.zeros.lost

    def settle(self, angles):
        """Read the same for half a second; return which zeros are lost."""
        for _ in range(max(2, int(0.5 * self.rate))):
            lost = self.read(angles)
        return lost


@pytest.mark.parametrize('rate', [20.0, 50.0, 100.0, 500.0])
@pytest.mark.parametrize('elapsed', [None, 2.0])
def test_a_joint_that_begins_again_at_zero_is_lost_until_it_reads_what_it_did(rate, elapsed):
    joints = Joints(rate)
    assert joints.settle([0.8] * 4) == [False] * 4
    joints.read([0.8, 0.0, 0.8, 0.8], elapsed=elapsed)
    assert joints.settle([0.8, 0.0, 0.8, 0.8]) == [False, True, False, False]
    joints.read([0.8, 0.0, 0.0, 0.8])
    assert joints.settle([0.8, 0.0, 0.0, 0.8]) == [False, True, True, False]
    assert joints.settle([0.8] * 4) == [False] * 4


def test_a_joint_that_turns_to_its_command_meanwhile_is_found_again_all_the_same():
    joints = Joints()
    joints.read([0.0, 0.8, 0.8, 0.8])
    for angle in np.linspace(0.0, 0.8, 41):
        lost = joints.read([angle, 0.8, 0.8, 0.8])
    assert lost[0]  # it points to 1.6 now
    assert joints.settle([1.6, 0.8, 0.8, 0.8]) == [False] * 4


@pytest.mark.parametrize('step', [-3.0, -0.5, 0.5, 3.0])
def test_a_glitch_a_whole_turn_and_readings_before_the_first_drive_are_no_loss(step):
    joints = Joints()
    for _ in range(20):
        assert not any(joints.read([0.8 + step, 0.8, 0.8, 0.8]))
        assert not any(joints.read([0.8] * 4))
    assert not any(joints.settle([0.8 + 2.0 * math.pi, 0.8 - 4.0 * math.pi, 0.8, 0.8]))
    joints = Joints(has_driven=False)
    assert not any(joints.settle([0.8 + step] * 4))


def test_modules_may_be_elsewhere_after_a_long_silence_or_where_time_begins_anew():
    for elapsed in 11.0, -0.5:
        joints = Joints()
        assert not any(joints.read([0.0] * 4, elapsed=elapsed))
        assert not any(joints.settle([0.0] * 4))


def test_modules_may_have_turned_as_they_were_told_while_they_were_not_heard():
    joints = Joints()
    assert not any(joints.read([-0.7] * 4, 0.4, [(0.8,) * 4, (-0.7,) * 4, (1.5,) * 4]))
    assert not any(joints.read([-0.7] * 4, 0.4, [(-0.7,) * 4] * 5))


@pytest.mark.parametrize('rate', [20.0, 100.0])
@pytest.mark.parametrize('steering_rate', [2.0, 8.0, 20.0])
def test_modules_that_follow_their_commands_lose_nothing(rate, steering_rate):
    random = np.random.default_rng(1)
    joints, angles, told, late = Joints(rate), np.full(4, 0.8), np.full(4, 0.8), np.full(4, 0.8)
    for _ in range(2000):
        elapsed, commands = random.choice([0.2, 1.0, 1.0, 1.8, 5.0]) / rate, []
        # The time of the reading, and that of its stamp.
        turned = steering_rate * elapsed * random.uniform(0.5, 1.5)
        for _ in range(3):
            if random.random() < 0.05:
                told = angles + random.uniform(-3.0, 3.0, 4)
            commands.append(told.tolist())
            angles = angles + np.clip(told - angles, -turned / 3.0, turned / 3.0)
        assert not any(joints.read(late, elapsed, commands))
        late = angles
