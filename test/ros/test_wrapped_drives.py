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

"""Drive joints that wrap: the way that the odometry tells, given the period or not."""

from nav_msgs.msg import Odometry
import numpy as np
from odometry_parts import values
import pytest

from swerve_kinematics import SwerveOdometry
from swerve_kinematics.configuration.layout import LAYOUT_DECLARATIONS, layout_from
from swerve_kinematics.ros.feedback import JointFeedback

SECOND = 1_000_000_000  # ns
RADIUS = 0.05


def layout(period):
    """Return the default base, its drive joints wrapping at a period."""
    return layout_from(values(LAYOUT_DECLARATIONS, {'drive_joint_period': period}))


def distance(given, actual, rate, has_velocity, unit=1.0, gaps=()):
    """
    Return how far [m] the odometry has 20 m at 1 m/s, from rest to rest, and its feedback.

    Velocities may be in another unit, so many to the rad/s, and messages be lost in gaps (from,
    to) [s].
    """
    base = layout(given)
    names = [*base.drive_joints, *base.steering_joints]
    feedback = JointFeedback(base, None, SECOND // 2, SECOND // 5)
    odometry = SwerveOdometry(base.kinematics)
    stamp = np.arange(0.0, 21.6, 1.0 / rate)
    speed = np.clip(np.minimum(stamp - 0.3, 21.3 - stamp), 0.0, 1.0)
    way = np.concatenate(([0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) / rate)))
    turns = way[:, np.newaxis] / RADIUS + [0.3, 1.2, -2.0, 2.9]
    if actual:
        turns = (turns + 0.5 * actual) % actual - 0.5 * actual
    for time, drives, v in zip(stamp, turns.tolist(), unit * speed / RADIUS):
        if any(start < time < end for start, end in gaps):
            continue
        sample = feedback.read(round(time * SECOND), names, [*drives, *[0.0] * 4],
                               [*[float(v)] * 4, *[0.0] * 4] if has_velocity else [])
        odometry.update(time, sample.distances, sample.angles, velocities=sample.velocities)
    return odometry.pose[0], feedback


@pytest.mark.parametrize('period', [2 * np.pi, 4 * np.pi], ids=['pi', '2 pi'])
@pytest.mark.parametrize('rate', [100, 50, 20])
@pytest.mark.parametrize('has_velocity', [True, False], ids=['velocities', 'positions'])
@pytest.mark.parametrize('is_given', [True, False], ids=['given', 'found'])
def test_a_wrapped_base_goes_as_far_as_one_that_counts(period, rate, has_velocity, is_given):
    counting, _ = distance(0.0, 0.0, rate, has_velocity)
    wrapped, feedback = distance(period * is_given, period, rate, has_velocity)
    assert counting == pytest.approx(20.0, abs=0.02)
    assert wrapped == pytest.approx(counting, abs=1e-3)
    assert feedback.unwrapper.is_found is not is_given


@pytest.mark.parametrize('rate', [100, 50, 20])
@pytest.mark.parametrize('unit', [60.0 / (2.0 * np.pi), -1.0, 57.3])
def test_velocities_in_another_unit_do_not_miscount_where_messages_are_lost(rate, unit):
    gaps = [(time, time + 0.24) for time in np.arange(3.0, 19.0, 1.3)]
    wrapped, _ = distance(2 * np.pi, 2 * np.pi, rate, True, unit, gaps)
    assert wrapped == pytest.approx(20.0, abs=0.02)


def test_a_wrap_that_nobody_told_of_is_found_and_said_once(client, start_node, start_sim, reports):
    start_sim(drive_joint_period=2 * np.pi)
    node = start_node()
    truth = client.listen(Odometry, 'ground_truth')
    client.repeat_until(lambda: client.send_twist(vx=1.0), lambda: truth and client.odom and
                        truth[-1].pose.pose.position.x > 1.5, 'the base to drive')
    client.repeat_until(
        client.send_twist, lambda: any('set drive_joint_period to 6.28319' in report.message
                                       for report in reports), 'a word about the wraps')
    client.wait_until(lambda: client.odom[-1].twist.twist.linear.x < 1e-3, 'the base to stop')
    client.wait_for_count(client.odom, 3, 'odometry')
    assert client.odom[-1].pose.pose.position.x == pytest.approx(
        truth[-1].pose.pose.position.x, abs=5e-3)
    assert node.output.count('drive joints wrap: set') <= 2  # as a finding, and for itself
