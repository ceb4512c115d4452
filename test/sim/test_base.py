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

"""The simulated base without ROS: limits, lag, the true pose, and each fault of the sensors."""

from dataclasses import replace

import numpy as np
import pytest

from swerve_kinematics import se2_compose, se2_exp, SwerveKinematics
from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.sim.actuators import Actuator
from swerve_kinematics.sim.base import (
    at_rest, BaseCommand, BaseConfig, hold, MAX_STEP, step)
from swerve_kinematics.sim.sensors import counted, sense, SensorFaults

RADIUS = 0.05
CONFIG = BaseConfig(
    kinematics=SwerveKinematics([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)]),
    joints=ModuleJoints([RADIUS] * 4),
    drive=Actuator(time_constant=0.05, max_speed=40.0, max_acceleration=100.0),
    steering=Actuator(time_constant=0.03, max_speed=8.0, max_acceleration=150.0))
PERIOD = 0.01


def commanded(wheel_speed, steering_angle):
    """Return a command with one setpoint for all modules, or one for each."""
    return BaseCommand(np.broadcast_to(wheel_speed, 4).astype(float),
                       np.broadcast_to(steering_angle, 4).astype(float))


def states_over(command, duration, config=CONFIG, start=None):
    """Return the states after each period of holding a command."""
    states = [at_rest(config) if start is None else start]
    for _ in range(round(duration / PERIOD)):
        states.append(step(config, states[-1], command, PERIOD))
    return states


def in_motion(target, config=CONFIG):
    """Return a state that already moves with a twist, and the command that keeps it so."""
    speed, angle = config.kinematics.inverse(target)
    command = commanded(speed / RADIUS, angle)
    state = replace(
        at_rest(config), wheel_speed=command.drive_velocity,
        steering_angle=command.steering_position, twist=np.array(target))
    return state, command


def readings_over(faults, states, seed=7, config=CONFIG):
    """Return the readings of the sensors at each state."""
    generator, drift, readings = np.random.default_rng(seed), 0.0, []
    for state in states:
        reading, drift = sense(config, faults, state, drift, PERIOD, generator)
        readings.append(reading)
    return readings


def column(rows, name):
    """Return one attribute of all rows as an array."""
    return np.array([getattr(row, name) for row in rows])


def test_speeds_and_accelerations_stay_within_the_limits_and_reach_them():
    states = states_over(commanded([1e3, -1e3, 20.0, 0.0], [50.0, -50.0, 0.2, 0.0]), 3.0)
    for name, actuator in (('wheel_speed', CONFIG.drive), ('steering_rate', CONFIG.steering)):
        speed = column(states, name)
        assert np.abs(speed).max() == pytest.approx(actuator.max_speed)
        rate = np.diff(speed, axis=0) / PERIOD
        assert np.abs(rate).max() == pytest.approx(actuator.max_acceleration)


def test_a_small_step_of_the_wheel_speed_is_a_first_order_lag():
    states = states_over(commanded(1.0, 0.0), 0.3)
    times = PERIOD * np.arange(len(states))
    expected = 1.0 - np.exp(-times / CONFIG.drive.time_constant)
    np.testing.assert_allclose(column(states, 'wheel_speed')[:, 0], expected, atol=1e-12)


def test_a_small_step_of_the_steering_is_a_first_order_lag():
    states = states_over(commanded(0.0, 0.01), 0.3)
    missing = 1.0 - column(states, 'steering_angle')[:, 0] / 0.01
    at = round((CONFIG.steering.time_constant + 0.05) / PERIOD)
    assert missing[at] == pytest.approx(np.exp(-PERIOD * at / 0.03), abs=0.02)


@pytest.mark.parametrize('angle', [0.01, 0.3, -1.5, 7.0])
def test_steering_arrives_without_running_past_its_target(angle):
    steering = column(states_over(commanded(0.0, angle), 2.0), 'steering_angle') / angle
    assert steering[-1] == pytest.approx(1.0, abs=1e-9)
    assert steering.max() <= 1.0 + 1e-3


def test_a_command_a_turn_away_is_a_turn_to_steer():
    final = states_over(commanded(0.0, 2.0 * np.pi), 2.0)[-1]
    np.testing.assert_allclose(final.steering_angle, 2.0 * np.pi, atol=1e-9)


@pytest.mark.parametrize('target', [
    (1.0, 0.0, 0.0), (0.0, -0.7, 0.0), (0.0, 0.0, 2.0), (1.0, 0.5, -1.5)])
def test_the_truth_of_a_constant_twist_is_its_arc(target):
    state, command = in_motion(target)
    final = states_over(command, 5.0, start=state)[-1]
    np.testing.assert_allclose(final.pose, se2_exp(np.multiply(target, 5.0)), atol=1e-9)
    np.testing.assert_allclose(final.twist, target, atol=1e-12)


def test_the_truth_is_the_motion_of_the_wheels_to_a_tenth_of_a_millimetre():
    """Ten seconds of driving and steering hard, against slices twenty times as short."""
    state, exact = at_rest(CONFIG), np.zeros(3)
    middles = (np.arange(20) + 0.5)[:, np.newaxis] / 20
    for k in range(round(10.0 / MAX_STEP)):
        time = k * MAX_STEP
        command = commanded(20.0 + 10.0 * np.cos(2.0 * time),
                            np.sin(3.0 * time) + 0.1 * np.arange(4))
        new = step(CONFIG, state, command, MAX_STEP)
        distances = RADIUS * MAX_STEP / 20 * (
            state.wheel_speed + middles * (new.wheel_speed - state.wheel_speed))
        angles = state.steering_angle + middles * (new.steering_angle - state.steering_angle)
        for slice_motion in CONFIG.kinematics.forward((distances, angles)):
            exact = se2_compose(exact, se2_exp(slice_motion))
        state = new
    np.testing.assert_allclose(state.pose, exact, atol=1e-4)
    assert (RADIUS * state.wheel_angle > 9.0).all()


def test_hold_stops_the_wheels_and_keeps_the_modules():
    config = replace(CONFIG, joints=ModuleJoints(
        [RADIUS] * 4, steering_offsets=[0.1, -0.2, 0.0, 0.3]))
    state, _ = in_motion((1.0, 0.5, 1.0), config)
    final = states_over(hold(config, state), 1.0, config, state)[-1]
    np.testing.assert_allclose(final.wheel_speed, 0.0, atol=1e-5)
    np.testing.assert_allclose(final.steering_angle, state.steering_angle)


def test_ideal_sensors_tell_the_truth():
    state, command = in_motion((0.8, -0.4, 1.2))
    states = states_over(command, 1.0, start=state)
    for reading, state in zip(readings_over(SensorFaults(), states), states):
        np.testing.assert_allclose(reading.drive_position, state.wheel_angle, rtol=1e-15)
        np.testing.assert_array_equal(reading.steering_position, state.steering_angle)
        assert reading.yaw == state.pose[2]
        assert reading.yaw_rate == pytest.approx(1.2)
        assert not reading.dropped


def test_an_encoder_gives_the_last_full_count():
    count = 2.0 * np.pi / 4096
    np.testing.assert_allclose(
        counted(np.array([0.0, 0.99, 1.01, -0.01]) * count, 4096) / count, [0.0, 0.0, 1.0, -1.0])


def test_gyro_bias_is_in_the_rate_and_grows_in_the_yaw():
    states = states_over(hold(CONFIG, at_rest(CONFIG)), 1.0)
    readings = readings_over(SensorFaults(gyro_bias=0.02), states)
    np.testing.assert_allclose(column(readings, 'yaw_rate'), 0.02)
    np.testing.assert_allclose(
        column(readings, 'yaw'), 0.02 * PERIOD * np.arange(1, len(states) + 1))


def test_gyro_noise_has_its_density_and_the_yaw_is_the_sum_of_the_rates():
    faults = SensorFaults(gyro_noise_density=1e-3)
    readings = readings_over(faults, [at_rest(CONFIG)] * 4000)
    rate = column(readings, 'yaw_rate')
    assert rate.std() == pytest.approx(1e-3 / np.sqrt(PERIOD), rel=0.05)
    np.testing.assert_allclose(column(readings, 'yaw'), np.cumsum(rate) * PERIOD, atol=1e-12)


def test_samples_are_dropped_as_often_as_asked():
    readings = readings_over(
        SensorFaults(dropped_sample_probability=0.2), [at_rest(CONFIG)] * 4000)
    assert column(readings, 'dropped').mean() == pytest.approx(0.2, abs=0.02)


def test_a_slipping_wheel_spins_faster_than_the_ground_passes():
    state, command = in_motion((1.0, 0.0, 0.0))
    states = states_over(command, 1.0, start=state)
    reading = readings_over(SensorFaults(slipping_wheel=2, slip_factor=1.5), states)[-1]
    np.testing.assert_allclose(reading.drive_position * RADIUS, [1.0, 1.0, 1.5, 1.0])
    np.testing.assert_allclose(reading.drive_velocity * RADIUS, [1.0, 1.0, 1.5, 1.0])
    np.testing.assert_allclose(states[-1].pose, [1.0, 0.0, 0.0], atol=1e-9)


def test_a_steering_offset_is_read_but_not_steered():
    config = replace(CONFIG, joints=ModuleJoints([RADIUS] * 4, steering_offsets=[0.1] * 4))
    states = states_over(commanded(10.0, 0.5), 2.0, config)
    reading = readings_over(SensorFaults(), states, config=config)[-1]
    np.testing.assert_allclose(reading.steering_position, 0.5, atol=1e-9)
    speed = states[-1].twist
    assert np.arctan2(speed[1], speed[0]) == pytest.approx(0.4)


def test_the_same_seed_gives_the_same_readings():
    faults = SensorFaults(
        gyro_noise_density=1e-3, dropped_sample_probability=0.3, encoder_resolution=100)
    states = [at_rest(CONFIG)] * 50
    first, again, other = (readings_over(faults, states, seed) for seed in (3, 3, 4))
    for name in ('yaw', 'yaw_rate', 'dropped', 'drive_position'):
        np.testing.assert_array_equal(column(first, name), column(again, name))
    assert (column(first, 'yaw') != column(other, 'yaw')).all()


def test_nothing_is_changed_in_place():
    state, command = in_motion((1.0, 0.5, 1.0))
    before = [getattr(state, name).copy() for name in state.__dataclass_fields__]
    step(CONFIG, state, command, 0.1)
    for name, value in zip(state.__dataclass_fields__, before):
        np.testing.assert_array_equal(getattr(state, name), value)


def described(**joints):
    """Return the base with joints of another kind."""
    return replace(CONFIG, joints=ModuleJoints([RADIUS] * 4, **joints))


def test_the_joints_of_a_base_are_obeyed_and_read_as_described():
    config = described(drive_ratios=[5.0, -5.0, 1.0, 1.0], steering_ratios=[1.0, -2.0, 1.0, 3.0])
    command = commanded([50.0, -50.0, 10.0, 10.0], [0.5, -1.0, 0.5, 1.5])
    states = states_over(command, 2.0, config)
    np.testing.assert_allclose(states[-1].twist, 0.5 * np.array(
        [np.cos(0.5), np.sin(0.5), 0.0]), atol=1e-6)
    reading = readings_over(SensorFaults(), states, config=config)[-1]
    np.testing.assert_allclose(reading.steering_position, [0.5, -1.0, 0.5, 1.5], atol=1e-6)
    np.testing.assert_allclose(reading.drive_velocity, [50.0, -50.0, 10.0, 10.0], atol=1e-6)
    np.testing.assert_allclose(reading.drive_position / states[-1].wheel_angle,
                               [5.0, -5.0, 1.0, 1.0])


def test_a_coupled_wheel_gives_way_as_its_module_steers_unless_the_drive_turns_along():
    config = described(drive_coupling_ratios=[1.5] * 4)
    final = states_over(commanded(0.0, 1.0), 2.0, config)[-1]
    np.testing.assert_allclose(final.wheel_angle, -1.5, atol=1e-6)
    reading = readings_over(SensorFaults(), [final], config=config)[-1]
    np.testing.assert_allclose(reading.drive_position, 0.0, atol=1e-6)
