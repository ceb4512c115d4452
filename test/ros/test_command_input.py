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

"""Which velocity command holds: no graph needed."""

from dataclasses import replace
import math

import pytest

from swerve_kinematics.ros.command_input import CommandInput, STOP
from swerve_kinematics.ros.timeline import Moment

S = 1_000_000_000  # ns
TIMEOUT = S // 2
STAMP = 1_700_000_000 * S


def at(time):
    """Return the moment at a real time [ns], stamped by a clock that agrees."""
    return Moment(STAMP + time, time, time)


NOW = at(0)


def command_input():
    return CommandInput(TIMEOUT, 'base_link', 'odom')


def test_a_command_has_come_once_it_is_valid():
    commands = command_input()
    commands.accept((math.nan, 0.0, 0.0), NOW)
    assert not commands.has_come
    commands.accept(STOP, NOW)
    assert commands.has_come


@pytest.mark.parametrize('twist, interval, pauses', [
    ((0.3, 0.0, 0.0), TIMEOUT, 0), ((0.3, 0.0, 0.0), 2 * TIMEOUT, 2), (STOP, 2 * TIMEOUT, 0)])
def test_commands_that_come_after_the_base_had_to_stop_are_counted(twist, interval, pauses):
    commands = command_input()
    for number in range(3):
        commands.accept(twist, at(number * interval))
    commands.accept(STOP, at(9 * S))
    commands.accept((0.0, 0.0, 1.0), at(18 * S))
    assert commands.pauses == pauses


def test_a_command_holds_until_its_timeout():
    commands = command_input()
    assert commands.twist(NOW) == STOP
    commands.accept((1.0, 2.0, 3.0), NOW)
    assert commands.twist(NOW) == (1.0, 2.0, 3.0)
    assert commands.twist(at(TIMEOUT)) == (1.0, 2.0, 3.0)
    assert commands.twist(at(TIMEOUT + 1)) == STOP


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('axis', range(3))
def test_a_command_that_is_not_finite_is_refused_whole(axis, bad):
    commands = command_input()
    commands.accept((1.0, 2.0, 3.0), NOW)
    twist = [0.1, 0.2, 0.3]
    twist[axis] = bad
    assert commands.accept(twist, at(TIMEOUT)) is not None
    # The last valid command and its timeout run on.
    assert commands.twist(at(TIMEOUT)) == (1.0, 2.0, 3.0)
    assert commands.twist(at(TIMEOUT + 1)) == STOP
    assert sum(commands.ignored.values()) == 1


@pytest.mark.parametrize('stamp, refused', [
    (0, None), (STAMP, None), (STAMP - TIMEOUT, None), (STAMP + TIMEOUT, None),
    (STAMP - TIMEOUT - 1, 'cmd_vel too old'), (STAMP + TIMEOUT + 1, 'cmd_vel from the future')])
def test_a_stamped_command_must_be_fresh_and_0_means_now(stamp, refused):
    commands = command_input()
    assert commands.accept_stamped((1.0, 0.0, 0.0), NOW, stamp, 'base_link') == refused
    assert commands.twist(NOW) == (STOP if refused else (1.0, 0.0, 0.0))
    assert commands.ignored[refused] == (refused is not None)


@pytest.mark.parametrize('frame, in_field', [('', False), ('base_link', False), ('odom', True)])
def test_the_frame_of_a_stamped_command_says_how_to_read_it(frame, in_field):
    commands = command_input()
    assert commands.accept_stamped((1.0, 0.0, 0.0), NOW, 0, frame) is None
    assert commands.in_field_frame == in_field


def test_a_command_in_another_frame_is_refused():
    commands = command_input()
    assert commands.accept_stamped((1.0, 0.0, 0.0), NOW, 0, 'map') is not None
    assert commands.twist(NOW) == STOP


@pytest.mark.parametrize('jump', [-600 * S, 600 * S])
def test_the_age_of_a_command_is_not_that_of_its_stamp(jump):
    commands = command_input()
    commands.accept((1.0, 0.0, 0.0), NOW)
    assert commands.twist(Moment(STAMP + jump, TIMEOUT, TIMEOUT)) == (1.0, 0.0, 0.0)
    assert commands.twist(Moment(STAMP + jump, TIMEOUT + 1, TIMEOUT + 1)) == STOP


def test_a_command_that_waited_while_the_process_was_frozen_is_refused():
    commands = command_input()
    commands.accept((1.0, 0.0, 0.0), NOW)
    woken = replace(at(3 * S), woke=3 * S)
    assert commands.accept((2.0, 0.0, 0.0), woken) == 'cmd_vel of unknown age'
    assert commands.twist(woken) == STOP
    later = replace(at(4 * S), woke=3 * S)
    assert commands.accept((2.0, 0.0, 0.0), later) is None
