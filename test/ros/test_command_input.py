"""Which velocity command holds: no graph needed."""

import math

import pytest

from swerve_kinematics.ros.command_input import CommandInput, STOP

S = 1_000_000_000  # ns
TIMEOUT = S // 2
NOW = 1_700_000_000 * S


def command_input():
    return CommandInput(TIMEOUT, 'base_link', 'odom')


def test_a_command_holds_until_its_timeout():
    commands = command_input()
    assert commands.twist(NOW) == STOP
    commands.accept((1.0, 2.0, 3.0), NOW)
    assert commands.twist(NOW) == (1.0, 2.0, 3.0)
    assert commands.twist(NOW + TIMEOUT) == (1.0, 2.0, 3.0)
    assert commands.twist(NOW + TIMEOUT + 1) == STOP


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('axis', range(3))
def test_a_command_that_is_not_finite_is_refused_whole(axis, bad):
    commands = command_input()
    commands.accept((1.0, 2.0, 3.0), NOW)
    twist = [0.1, 0.2, 0.3]
    twist[axis] = bad
    assert commands.accept(twist, NOW + TIMEOUT) is not None
    # The last valid command and its timeout run on.
    assert commands.twist(NOW + TIMEOUT) == (1.0, 2.0, 3.0)
    assert commands.twist(NOW + TIMEOUT + 1) == STOP
    assert sum(commands.ignored.values()) == 1


@pytest.mark.parametrize('stamp, refused', [
    (0, None), (NOW, None), (NOW - TIMEOUT, None), (NOW + TIMEOUT, None),
    (NOW - TIMEOUT - 1, 'cmd_vel too old'), (NOW + TIMEOUT + 1, 'cmd_vel from the future')])
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


def test_a_command_expires_when_the_clock_is_set_back():
    commands = command_input()
    commands.accept((1.0, 0.0, 0.0), NOW)
    assert commands.twist(NOW - 10 * S) == STOP
