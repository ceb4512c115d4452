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

"""Feedback stamped by another clock: reported, and translated on request."""

from builtin_interfaces.msg import Time
import numpy as np
import pytest
from rosgraph_msgs.msg import Clock

from swerve_kinematics.ros.sender_clock import SenderClock
from swerve_kinematics.ros.stamps import IMPOSSIBLE, nanoseconds_of

MS, S = 1_000_000, 1_000_000_000


def test_intervals_stay_those_of_the_sender_whatever_the_delay():
    clock, generator = SenderClock(), np.random.default_rng(1)
    stamps = 7 * S + 20 * MS * np.arange(500)
    nows = 1_800_000_000 * S + stamps + generator.integers(0, 15 * MS, 500)
    translated = [clock.restamped(int(stamp), int(now)) for stamp, now in zip(stamps, nows)]
    np.testing.assert_allclose(np.diff(translated), 20 * MS, rtol=1.1e-3)
    assert np.abs(np.subtract(translated, nows)).max() < 16 * MS


def test_a_sender_that_starts_again_is_followed_at_once():
    clock = SenderClock()
    clock.restamped(900 * S, 1000 * S)
    assert clock.restamped(1 * S, 1001 * S) == 1001 * S


def test_a_difference_is_reported_and_a_late_message_is_none():
    clock = SenderClock()
    for stamp, now in ((1 * S, 101 * S), (2 * S, 102 * S)):
        clock.observe(stamp, now)
    assert clock.report(S // 2) == 100.0
    clock.observe(3 * S, 3 * S + 5 * MS)
    clock.observe(4 * S, 9 * S)
    assert clock.report(S // 2) is None
    assert clock.report(S // 2) is None


def test_a_silent_simulated_clock_is_none_that_a_sender_differs_from():
    clock = SenderClock()
    clock.observe(1_700_000_000 * S, 0)
    assert clock.report(S // 2) is None


@pytest.mark.parametrize('stamp', [IMPOSSIBLE, -1])
def test_a_stamp_that_no_clock_can_have_shown_tells_of_none(stamp):
    clock = SenderClock()
    clock.observe(stamp, 1000 * S)
    assert clock.report(S // 2) is None
    before = clock.restamped(900 * S, 1000 * S)
    assert clock.restamped(stamp, 1000 * S + 17 * MS) == stamp
    # Its intervals are still those of the sender, whatever the delay.
    assert clock.restamped(900 * S + 20 * MS, 1000 * S + 27 * MS) - before < 21 * MS


@pytest.mark.parametrize('is_simulated, remedy', [
    (False, 'restamp_feedback'), (True, 'use_sim_time')])
def test_stamps_of_another_clock_are_reported(client, start_node, reports, is_simulated, remedy):
    start_node(gyro_source='none')
    if is_simulated:
        client.node.create_publisher(Clock, '/clock', 10)
    stamps = iter(Time(sec=2 + k // 50, nanosec=20 * MS * (k % 50)) for k in range(100_000))
    client.repeat_until(
        lambda: client.send_joints(stamp=next(stamps)),
        lambda: reports and 'stamps of joint_states' in reports[-1].message
        and remedy in reports[-1].message, 'the report')


def test_restamped_feedback_has_odometry_of_now(client, start_node, reports):
    start_node(gyro_source='none', restamp_feedback=True)
    stamps = iter(Time(sec=2 + k // 50, nanosec=20 * MS * (k % 50)) for k in range(100_000))
    client.repeat_until(
        lambda: client.send_joints(stamp=next(stamps)),
        lambda: len(client.odom) > 10, 'odometry')
    now = client.node.get_clock().now().nanoseconds
    assert abs(now - nanoseconds_of(client.odom[-1].header.stamp)) < 2 * S
