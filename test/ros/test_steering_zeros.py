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
from odometry_parts import OdometryParts
import pytest

from swerve_kinematics.ros.drive import Drive
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds
from swerve_kinematics.ros.steering_zeros import SteeringZeros
from swerve_kinematics.ros.timeline import Moment


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


class Base:
    """A base that is steered about, and its joints, heard late, rarely and not always."""

    def __init__(self, random, joint_rate, rate, latency, loss, is_stamped, **parameters):
        self.parts = OdometryParts(gyro_source='none', **parameters)
        self.drive, self.random = Drive(self.parts.parameters), random
        self.joint_rate, self.rate, self.latency = joint_rate, rate, latency
        self.loss, self.is_stamped = loss, is_stamped
        self.time, self.turns, self.twist = 1.0, 0.0, (0.0, 0.0, 0.0)
        self.angles = self.told = random.uniform(-3.0, 3.0, 4)
        self.zeros, self.has_power, self.under_way = np.zeros(4), True, []

    def steer_about(self):
        """Take another command every now and then, or stop."""
        if self.random.random() < 0.05:
            self.twist = tuple(self.random.choice([0.0, 1.0]) * self.random.uniform(-1.0, 1.0, 3))

    def go_on(self, duration, about=True):
        """Live on in steps of 5 ms; return whether a zero was found lost."""
        was_lost = False
        for step in range(round(duration / 0.005)):
            self.time += 0.005
            if self.has_power:
                farthest = 0.005 * self.joint_rate
                self.angles = self.angles + np.clip(
                    self.told - self.zeros - self.angles, -farthest, farthest)
            if step % round(200.0 / self.rate) == 0 and self.random.random() >= self.loss:
                late = self.random.uniform(0.5, 1.0) * self.latency
                self.under_way.append((self.time + late, self.time, self.angles + self.zeros))
            while self.under_way and self.under_way[0][0] <= self.time:
                self.hear(*self.under_way.pop(0)[1:])
            if step % 4 == 0:
                self.control(about)
            was_lost |= any(self.drive.lost)
        return was_lost

    def now(self):
        return Moment(*[nanoseconds(self.time)] * 3)

    def hear(self, stamp, angles):
        """Hear the joints."""
        self.turns += 0.1
        sample = self.parts.feedback.read(
            nanoseconds(stamp if self.is_stamped else self.time), self.parts.names,
            [self.turns] * 4 + angles.tolist(), [])
        if sample is not None:
            self.drive.measured(sample.stamp, sample.angles, None, self.now())

    def control(self, about):
        """Command the joints."""
        if about:
            self.steer_about()
        self.drive.input.accept(self.twist, self.now())
        angles = self.drive.step(self.now(), 0.0).steering_angles
        if angles is not None:
            self.told = np.array(angles)


@pytest.mark.parametrize('joint_rate', [4.0, 12.0, math.inf])
@pytest.mark.parametrize('rate, latency, loss', [
    (200.0, 0.02, 0.0), (200.0, 0.2, 0.3), (50.0, 0.05, 0.1), (20.0, 0.2, 0.1), (10.0, 0.1, 0.0)])
@pytest.mark.parametrize('max_steering_rate', [0.0, 8.0])
def test_no_base_that_steers_about_stops_however_late_and_rarely_its_joints_are_heard(
        joint_rate, rate, latency, loss, max_steering_rate):
    for seed in range(3):
        base = Base(np.random.default_rng(seed), joint_rate, rate, latency, loss, seed % 2,
                    max_steering_rate=max_steering_rate)
        assert not base.go_on(4.0)
        base.has_power = False  # and catches up with what it was told once that is back
        assert not base.go_on(1.0)
        base.has_power = True
        assert not base.go_on(2.0)
        assert base.drive.mode in ('driving', 'stopped')


@pytest.mark.parametrize('joint_rate', [4.0, 12.0])
@pytest.mark.parametrize('rate, latency, loss', [(200.0, 0.1, 0.1), (50.0, 0.02, 0.0)])
@pytest.mark.parametrize('restarted', [[2], [0, 1, 2, 3]])
def test_a_base_that_drives_straight_stops_where_a_joint_begins_again_at_zero(
        joint_rate, rate, latency, loss, restarted):
    far = 0
    for angle in np.linspace(-3.0, 3.0, 8):
        base = Base(np.random.default_rng(5), joint_rate, rate, latency, loss, True)
        base.twist = (math.cos(angle), math.sin(angle), 0.0)
        assert not base.go_on(1.5, about=False)
        read = base.angles[restarted]
        base.zeros[restarted] = -read
        is_far = max(abs(math.remainder(each, 2.0 * math.pi)) for each in read) > 0.7
        far += is_far
        assert base.go_on(0.5, about=False) or not is_far
    assert far >= 4
