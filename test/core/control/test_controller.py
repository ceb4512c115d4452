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

"""The command pipeline, one behaviour at a time."""

import math

import numpy as np
import pytest

from swerve_kinematics import discretize, ModuleStates, optimize, SwerveKinematics
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits

DT = 0.02
KIN = SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
LIMITS = ControllerLimits(
    max_linear_speed=2.0, max_angular_speed=4.0, max_linear_acceleration=4.0,
    max_linear_deceleration=5.0, max_angular_acceleration=8.0, max_module_speed=2.5,
    max_module_acceleration=10.0, max_steering_rate=10.0)
ZEROS = np.zeros(4)


def drive(controller, twist, steps, measured=ZEROS, heading=None):
    """Return the commands of some periods, the modules following each at once."""
    commands = []
    for _ in range(steps):
        commands.append(controller.update(twist, measured, DT, heading))
        measured = commands[-1].angle
    return commands


def test_without_limits_the_goal_is_reached_at_once():
    measured = np.array([0.1, -3.0, 7.0, 40.0])
    command = SwerveController(KIN).update((1.0, -0.4, 0.8), measured, DT)
    goal = optimize(KIN.inverse(discretize((1.0, -0.4, 0.8), DT)), measured)
    np.testing.assert_allclose(np.cos(command.angle - goal.angle), 1.0)
    np.testing.assert_allclose(command.speed, goal.speed * np.cos(goal.angle - measured))
    np.testing.assert_allclose(command.twist, (1.0, -0.4, 0.8))
    assert (command.scale, command.fraction, command.refused) == (1.0, 1.0, False)


def test_the_command_in_the_steady_state_is_the_commanded_twist():
    command = drive(SwerveController(KIN, LIMITS), (0.8, -0.3, 1.2), 100)[-1]
    np.testing.assert_allclose(
        KIN.forward(ModuleStates(command.speed, command.angle)),
        discretize((0.8, -0.3, 1.2), DT), atol=1e-12)
    np.testing.assert_allclose(command.twist, (0.8, -0.3, 1.2))


def test_wheels_stand_until_the_modules_have_turned():
    commands = drive(SwerveController(KIN, LIMITS), (0.0, 1.0, 0.0), 12)
    turning = [command for command in commands if command.fraction == 0.0]
    assert len(turning) == 7  # 90 degrees at 0.2 rad each, the last of them while driving off
    assert all((command.speed == 0.0).all() and (command.twist == 0.0).all()
               for command in turning)
    lag = math.pi / 2 - 7 * 0.2
    assert commands[7].speed == pytest.approx([4.0 * DT * math.cos(lag)] * 4)
    assert commands[7].angle == pytest.approx([math.pi / 2] * 4)


def test_a_stop_holds_every_angle_and_keeps_the_curve():
    controller = SwerveController(KIN, LIMITS)
    cruise = drive(controller, (1.0, 0.5, 2.0), 60)[-1]
    stop = drive(controller, (0.0, 0.0, 0.0), 40, cruise.angle)
    for command in stop:
        np.testing.assert_array_equal(command.angle, cruise.angle)
        np.testing.assert_allclose(
            np.outer(command.twist, cruise.twist), np.outer(cruise.twist, command.twist),
            atol=1e-12)
    speeds = np.array([cruise.speed] + [command.speed for command in stop])
    assert (np.diff(np.abs(speeds), axis=0) <= 0.0).all()
    assert (speeds[-1] == 0.0).all()
    fall = np.diff([math.hypot(*command.twist[:2]) for command in stop])
    assert fall.min() >= -5.0 * DT - 1e-9


def test_zero_from_the_start_leaves_the_modules_where_they_are():
    measured = np.array([1.0, -20.0, 3.0, 0.5])
    command = SwerveController(KIN, LIMITS).update((0.0, 0.0, 0.0), measured, DT)
    np.testing.assert_array_equal(command.angle, measured)
    np.testing.assert_array_equal(command.speed, ZEROS)


def test_crossing_pi_never_unwinds_a_turn():
    controller, angle = SwerveController(KIN, LIMITS), np.full(4, 6 * math.pi)
    for direction in np.arange(0.0, 9.0, 0.02):
        command = controller.update((math.cos(direction), math.sin(direction), 0.0), angle, DT)
        assert np.abs(command.angle - angle).max() < 0.2
        angle = command.angle
    assert angle == pytest.approx([6 * math.pi + 9.0] * 4, abs=0.1)


@pytest.mark.parametrize('turns', [-2, -1, 0, 1, 5])
@pytest.mark.parametrize('limits', [(-1.9, 1.9), (-0.3, 0.5), (0.1, 4.0), (-2.6, 2.6)])
def test_a_joint_with_end_stops_stays_where_it_is_however_its_turns_are_counted(limits, turns):
    at = np.array([0.2, 0.3, 0.4, 0.5])
    controller = SwerveController(KIN, LIMITS, steering_lower_limits=[limits[0]] * 4,
                                  steering_upper_limits=[limits[1]] * 4)
    for _ in range(3):
        command = controller.update((0.0, 0.0, 0.0), at + turns * math.tau, DT)
        assert command.angle == pytest.approx(at)


@pytest.mark.parametrize('beyond', [0.01, 0.4])
@pytest.mark.parametrize('end', [1.9, math.pi, 9.0])
def test_a_joint_that_is_pushed_over_an_end_stop_is_not_sent_round(beyond, end):
    controller = SwerveController(KIN, LIMITS, steering_lower_limits=[-end] * 4,
                                  steering_upper_limits=[end] * 4)
    command = controller.update((0.0, 0.0, 0.0), [end + beyond, -end - beyond, end, -end], DT)
    assert command.angle.tolist() == [end, -end, end, -end]


def test_a_reversal_needs_no_steering():
    controller = SwerveController(KIN, LIMITS)
    drive(controller, (1.0, 0.0, 0.0), 30)
    back = drive(controller, (-1.0, 0.0, 0.0), 40)
    assert all((command.angle == 0.0).all() for command in back)
    assert back[-1].speed == pytest.approx([-1.0] * 4)


def test_a_reversal_onto_another_curve_first_stops_along_the_old_one():
    controller = SwerveController(KIN, LIMITS)
    drive(controller, (1.0, 0.0, 0.0), 30)
    back = drive(controller, (-1.0, 0.1, 0.2), 60)
    assert np.abs([command.angle for command in back]).max() < 0.2
    for command in back:
        assert command.twist[0] <= 0.0 or command.twist[1:] == pytest.approx([0.0, 0.0])
    assert back[-1].twist == pytest.approx([-1.0, 0.1, 0.2])


def test_a_small_turn_of_the_velocity_keeps_the_base_moving():
    controller = SwerveController(KIN, LIMITS)
    drive(controller, (1.0, 0.0, 0.0), 30)
    turn = drive(controller, (0.0, 0.0, 3.0), 60, ZEROS)
    assert min(np.abs(command.speed).max() for command in turn) > 0.5


def test_field_centric_twists_are_turned_by_the_heading():
    command = drive(SwerveController(KIN, LIMITS), (1.0, 0.0, 0.0), 60, heading=math.pi / 2)[-1]
    assert command.twist == pytest.approx([0.0, -1.0, 0.0], abs=1e-12)


def test_a_line_in_the_field_takes_no_acceleration_while_the_base_turns():
    controller = SwerveController(KIN, ControllerLimits(max_linear_acceleration=0.5))
    heading, measured = 0.0, ZEROS
    for _ in range(300):
        command = controller.update((1.0, 0.0, 2.0), measured, DT, heading)
        heading, measured = heading + command.twist[2] * DT, command.angle
    assert math.hypot(*command.twist[:2]) == pytest.approx(1.0)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_a_twist_that_is_not_finite_is_refused_whole(bad):
    controller = SwerveController(KIN, LIMITS)
    drive(controller, (1.0, 0.0, 0.0), 60)
    for twist, heading in (
            ((0.0, bad, 0.0), None), ((0.5, 0.0, bad), 0.3), ((1.0, 1.0, 1.0), bad)):
        command = controller.update(twist, ZEROS, DT, heading)
        assert command.refused
        np.testing.assert_allclose(command.speed, 1.0)
    assert not controller.update((1.0, 0.0, 0.0), ZEROS, DT).refused


def test_unknown_angles_keep_the_wheels_still():
    controller = SwerveController(KIN, LIMITS)
    for measured in (np.full(4, np.nan), np.array([1.0, np.nan, 1.0, 1.0])):
        command = drive(controller, (1.0, 0.0, 0.0), 1, measured)[-1]
        assert (command.speed == 0.0).all() and np.isfinite(command.angle).all()
    np.testing.assert_array_equal(command.angle, [1.0, 0.0, 1.0, 1.0])
    measured = np.array([1.0, 2.0, 1.0, 1.0])
    command = controller.update((0.0, 0.0, 0.0), measured, DT)
    np.testing.assert_array_equal(command.angle, measured)


def test_an_angle_lost_on_the_way_ramps_to_a_stop():
    controller = SwerveController(KIN, LIMITS)
    drive(controller, (1.0, 0.0, 0.0), 60)
    lost = np.array([0.0, 0.0, np.nan, 0.0])
    commands = [controller.update((1.0, 0.0, 0.0), lost, DT) for _ in range(11)]
    assert commands[0].speed == pytest.approx([0.9] * 4)
    np.testing.assert_allclose(commands[-1].speed, 0.0, atol=1e-12)
    np.testing.assert_array_equal(commands[-1].angle, ZEROS)


def test_open_loop_takes_the_modules_to_be_where_they_were_told():
    controller = SwerveController(KIN, LIMITS)
    for _ in range(60):
        command = controller.update((0.0, 1.0, 0.0), None, DT)
    assert command.angle == pytest.approx([math.pi / 2] * 4)
    assert command.speed == pytest.approx([1.0] * 4)


@pytest.mark.parametrize('dt', [0.0, 1e-12])
def test_no_time_no_movement(dt):
    controller = SwerveController(KIN, LIMITS)
    before = drive(controller, (1.0, 0.3, 0.5), 20)[-1]
    after = controller.update((-1.0, 0.0, 3.0), ZEROS, dt)
    for field in ('speed', 'angle', 'twist'):
        np.testing.assert_array_equal(getattr(after, field), getattr(before, field))


@pytest.mark.parametrize('dt', [-1.0, -1e-12, math.nan])
def test_time_does_not_go_backwards(dt):
    with pytest.raises(ValueError, match='dt must be zero or more'):
        SwerveController(KIN).update((1.0, 0.0, 0.0), ZEROS, dt)


def test_a_stall_counts_as_one_second():
    limits = ControllerLimits(max_linear_acceleration=0.5)
    command = SwerveController(KIN, limits).update((3.0, 0.0, 0.0), ZEROS, math.inf)
    assert command.speed == pytest.approx([0.5] * 4)


def test_reset_stops_the_wheels_and_starts_where_the_modules_are():
    controller = SwerveController(KIN, LIMITS)
    drive(controller, (1.0, 0.0, 0.0), 60)
    controller.reset()
    found = np.full(4, 2.0)
    command = controller.update((0.0, 0.0, 0.0), found, DT)
    np.testing.assert_array_equal(command.angle, found)
    np.testing.assert_array_equal(command.speed, ZEROS)
    np.testing.assert_array_equal(command.twist, np.zeros(3))


def test_a_module_found_elsewhere_is_told_to_go_from_there():
    controller = SwerveController(KIN, LIMITS)
    drive(controller, (1.0, 0.0, 0.0), 60)
    pushed = np.array([0.0, 0.0, 0.0, 3.0])
    command = controller.update((1.0, 0.0, 0.0), pushed, DT)
    assert np.abs(command.angle - pushed).max() <= math.pi / 2 + 1e-9


def test_the_wheel_of_a_module_that_lags_drives_only_along_the_command():
    limits = ControllerLimits(max_steering_rate=100.0)
    command = SwerveController(KIN, limits).update((0.6, 0.8, 0.0), ZEROS, DT)
    assert command.speed == pytest.approx([0.6] * 4)


def test_a_command_reads_well_in_a_console():
    ends = np.radians([60.0] * 4)
    controller = SwerveController(KIN, LIMITS, (0.0, 0.0), -ends, ends)
    assert repr(controller.update((0.0, 0.0, 0.0), ZEROS, DT)) == (
        'ModuleCommand(speed=[0.000, 0.000, 0.000, 0.000] m/s, '
        'angle=[0.000, 0.000, 0.000, 0.000] rad, twist=[0.000, 0.000, 0.000])')
    repeated = repr(controller.update((0.0, 9.0, math.nan), ZEROS, DT))
    assert repeated.endswith('refused)') and 'unreachable' not in repeated
    assert 'unreachable=[True, True, True, True]' in repr(
        controller.update((0.0, 1.0, 0.0), ZEROS, DT))


def test_saturation_is_reported():
    command = drive(SwerveController(KIN, LIMITS), (5.0, 0.0, 0.0), 60)[-1]
    assert command.scale == pytest.approx(0.4)
    assert command.twist == pytest.approx([2.0, 0.0, 0.0])


def test_lock_stops_makes_the_x_and_refuses_motion_until_unlocked():
    controller = SwerveController(KIN, LIMITS)
    drive(controller, (1.0, 0.0, 0.0), 60)
    controller.lock()
    commands = drive(controller, (1.0, 0.0, 0.0), 60)
    assert controller.locked
    assert all((command.angle == 0.0).all() for command in commands
               if np.abs(command.speed).max() > 1e-6)
    assert commands[0].speed == pytest.approx([0.9] * 4)
    radial = math.atan2(0.2, 0.3)
    assert commands[-1].angle == pytest.approx([radial, -radial, -radial, radial])
    assert not commands[-1].speed.any()
    controller.unlock()
    last = drive(controller, (1.0, 0.0, 0.0), 60, commands[-1].angle)[-1]
    assert last.speed == pytest.approx([1.0] * 4)


def test_idle_mode_lock_makes_the_x_at_rest_and_drives_off_when_asked():
    controller = SwerveController(KIN, LIMITS, idle_mode='lock')
    radial = math.atan2(0.2, 0.3)
    command = drive(controller, (0.0, 0.0, 0.0), 20)[-1]
    assert command.angle == pytest.approx([radial, -radial, -radial, radial])
    assert drive(controller, (1.0, 0.0, 0.0), 60, command.angle)[-1].speed.min() > 0.99


def test_the_centre_of_rotation_is_the_point_whose_velocity_is_commanded():
    controller = SwerveController(KIN, LIMITS, center_of_rotation=(0.3, 0.2))
    command = drive(controller, (0.0, 0.0, 1.0), 60)[-1]
    assert command.speed[0] == 0.0 and np.abs(command.speed[1:]).min() > 0.3
    assert command.twist == pytest.approx([0.0, 0.0, 1.0])
    assert command.angle[0] == 0.0


def test_a_new_centre_of_rotation_does_not_disturb_the_motion():
    controller = SwerveController(KIN, LIMITS)
    before = drive(controller, (1.0, 0.0, 1.0), 60)[-1]
    controller.center_of_rotation = (0.5, 0.0)
    assert controller.center_of_rotation == (0.5, 0.0)
    after = controller.update((1.0, 0.5, 1.0), before.angle, DT)
    np.testing.assert_allclose(after.twist, (1.0, 0.5, 1.0))
    np.testing.assert_allclose(after.speed, before.speed, atol=0.01)


@pytest.mark.parametrize('arguments, message', [
    ({'center_of_rotation': (0.0, math.nan)}, 'center_of_rotation must be'),
    ({'center_of_rotation': 1.0}, 'center_of_rotation must be'),
    ({'idle_mode': 'coast'}, 'idle_mode must be'),
    ({'steering_lower_limits': [0.0]}, 'steering_lower_limits must have')])
def test_bad_settings_are_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        SwerveController(KIN, **arguments)


@pytest.mark.parametrize('twist, measured, name', [
    ((1.0, 0.0), ZEROS, 'twist'), ((1.0, 0.0, 0.0), np.zeros(3), 'measured_angles')])
def test_wrong_shapes_are_named(twist, measured, name):
    with pytest.raises(ValueError, match=name):
        SwerveController(KIN).update(twist, measured, DT)
