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

"""Tests of when a base coasts on its accelerometer, and of what ends it."""

from inertial_replay import ALIKE, CORNERS
import numpy as np
import pytest

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry import coasting
from swerve_kinematics.core.odometry.chord import Step
from swerve_kinematics.core.odometry.coasting import Coasting
from swerve_kinematics.core.odometry.inertial import Inertial
from swerve_kinematics.core.odometry.odometry import SwerveOdometry


def velocities_of(judge, steps):
    """Return what a judge makes of steps with these velocities of wheels and forces."""
    told = []
    for wheels, force in steps:
        still = wheels == 0.0
        if any(judge.judge(0.02, ALIKE, complex(wheels), complex(force), 0j, 0.0, still)):
            judge.settle(0.02, complex(wheels), 0.0)
        told.append(judge.velocity)
    return np.array(told)


def test_never_for_long_and_the_next_time_later():
    # Wheels that swing to and fro for ever, under a base that stands.
    judge, dt, coasts = Inertial(0j), 0.02, []
    for k in range(2000):
        velocity = 0j if k < 100 else 1.8 * np.sin(4.0 * dt * (k - 100)) + 0j
        believed = any(judge.judge(dt, ALIKE, velocity, 0j, None, 0.0))
        if believed:
            judge.settle(dt, velocity, 0.0)
        assert judge.coasting.time <= coasting.LONGEST_DISPUTE
        coasts.append(not believed)
    times = dt * np.flatnonzero(np.diff(np.array(coasts, dtype=int)))
    breaks = times[2::2] - times[1:-1:2]
    distrust = breaks[breaks > 4.0]
    assert distrust[0] == pytest.approx(coasting.DISTRUST_TIME, abs=0.5)
    assert distrust[1] == pytest.approx(2.0 * coasting.DISTRUST_TIME, abs=0.5)


def test_wheels_that_leap_have_no_grip_however_long_it_takes():
    # On ice the base follows wheels that spin, and then wheels that lock, at 0.8 m/s^2.
    judge, dt, speed = Inertial(0j), 0.02, 0.0
    for k in range(100 + 190):
        spinning = 100 <= k < 200
        force = 0.0 if k < 100 else 0.8 if spinning else -0.8
        wheels = complex(min(1.5, 0.3 * (k - 99)) if spinning else 0.0)
        believed = any(judge.judge(dt, ALIKE, wheels, complex(force), 0j, 0.0))
        if believed:
            judge.settle(dt, wheels, 0.0)
        speed = max(0.0, speed + force * dt)
        assert abs(judge.velocity - speed) < 0.1
    assert 190 * dt > coasting.LONGEST_DISPUTE


def test_an_offset_that_stays_is_the_accelerometers():
    # The wheels slip for 0.4 s and end up 0.3 m/s faster than the prediction says.
    judge, dt, coasts = Inertial(0j), 0.02, []
    for k in range(200):
        velocity = complex(min(max(k - 100, 0) * dt, 0.4) * 0.75 / 1.0)
        believed = any(judge.judge(dt, ALIKE, velocity, 0j, None, 0.0))
        if believed:
            judge.settle(dt, velocity, 0.0)
        coasts.append(not believed)
    assert any(coasts)
    assert not coasts[-1]
    assert abs(judge.velocity - 0.3) < 0.05
    assert sum(coasts) * dt < 1.0


@pytest.mark.parametrize('wrong', [0.5, -0.5, 0.5j])
def test_an_accelerometer_that_goes_wrong_is_found_out_by_wheels_that_do_not_pull(wrong):
    # While the base drives on steadily, and at the latest when it stands.
    pushing = np.concatenate((np.zeros(100), np.ones(50), np.zeros(100), np.full(25, -2.0)))
    force = np.concatenate((pushing, np.zeros(100)))
    speed = 0.02 * np.cumsum(force)
    force = force + wrong * (np.arange(len(force)) >= 200)
    judge = Inertial(0j)
    driving = velocities_of(judge, zip(speed[:275], force[:275]))
    assert 0.1 < np.abs(driving - speed[:275]).max() < 0.3
    standing = velocities_of(judge, zip(speed[275:], force[275:]))
    assert not judge.coasting.time
    assert np.abs(standing[round(coasting.UNPULLED_TIME / 0.02) + 2:]).max() < 0.15


@pytest.mark.parametrize('shown', [0.0, 1.0j, -0.5])
@pytest.mark.parametrize('acceleration', [1.5, 3.0])
def test_the_covariance_allows_for_either_that_may_have_been_wrong(shown, acceleration):
    odo, dt, way, speed = SwerveOdometry(SwerveKinematics(CORNERS)), 0.02, 0.0, 0.0
    noise = np.random.default_rng(1).normal(0.0, 0.02, (400, 2))
    for k in range(400):
        gained = min(acceleration * dt, 1.0 - speed) if k > 5 else 0.0
        way, speed = way + dt * (speed + 0.5 * gained), speed + gained
        force = shown * gained / dt
        odo.update(k * dt, np.full(4, way), np.zeros(4), 0.0, 0.0,
                   specific_force=noise[k] + (force.real, force.imag))
    # Such a sensor cannot be told from a push at first: it has led the pose astray.
    assert abs(odo.pose[0] - way) < 3.0 * np.sqrt(odo.pose_covariance[0, 0])
    assert odo.twist[0] == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize('stuck', [15.0, -5.0])
def test_the_covariance_allows_for_a_sensor_that_has_led_astray_until_it_was_left_out(stuck):
    odo, dt, speed = SwerveOdometry(SwerveKinematics(CORNERS)), 0.02, 1.0
    noise = np.random.default_rng(1).normal(0.0, 0.02, (100, 2))
    for k in range(100):
        force = None if k > 56 else noise[k] + (stuck * (k > 50), 0.0)
        odo.update(k * dt, np.full(4, k * dt * speed), np.zeros(4), 0.0, 0.0,
                   specific_force=force)
    error, std = abs(odo.pose[0] - 99 * dt * speed), np.sqrt(odo.pose_covariance[0, 0])
    assert 0.01 < error < 3.0 * std


@pytest.mark.parametrize('stuck', [1.5, 3.0, -6.0])
@pytest.mark.parametrize('reprimed', [False, True])
def test_the_covariance_allows_for_a_sensor_that_led_astray_until_a_gap(stuck, reprimed):
    odo = SwerveOdometry(SwerveKinematics(CORNERS))
    stamps = 0.02 * np.arange(105) + (0.0 if reprimed else 1.1) * (np.arange(105) >= 80)
    for k, stamp in enumerate(stamps):
        if k == 80:
            assert odo.coasting
            astray = abs(odo.pose[0] - stamps[79])
            if reprimed:
                odo.reprime()
        odo.update(stamp, np.full(4, stamp), np.zeros(4), 0.0,
                   specific_force=(stuck * (50 < k < 80), 0.0))
    assert 0.1 < astray < 3.0 * np.sqrt(odo.pose_covariance[0, 0])


def test_a_sensor_that_falls_silent_is_not_distrusted_for_ever():
    odo, dt = SwerveOdometry(SwerveKinematics(CORNERS)), 0.02
    distrust = []
    for k in range(1000):
        wrong = None if any(distrust) else (3.0 * (k > 200), 0.0)
        odo.update(dt * k, [dt * k] * 4, [0.0] * 4, 0.0, specific_force=wrong)
        distrust.append(odo.distrust)
    assert dt * np.count_nonzero(distrust) == pytest.approx(coasting.DISTRUST_TIME, abs=2.0 * dt)


@pytest.mark.parametrize('wrong', [2.5, -8.0, 15.0j])
def test_a_sensor_that_comes_loose_does_not_push_the_base_away(wrong):
    judge, dt, way, worst = Inertial(0j), 0.02, 0j, 0.0
    for k in range(500):
        # Driving in circles: wheels that keep their velocity are believed sooner.
        wheels = complex(np.exp(1j * k * dt))
        force = 1j * wheels + wrong * (k > 200)
        if any(judge.judge(dt, ALIKE, wheels, force, 0j, 0.0)):
            judge.settle(dt, wheels, 0.0)
        way += dt * (judge.velocity if judge.believed else wheels) - dt * wheels
        worst = max(worst, abs(way))
    assert 0.5 < worst < coasting.LONGEST_PUSH + 0.3


@pytest.mark.parametrize('speed, acceleration', [(1.5, 8.0), (2.0, 5.0), (-3.0, 10.0)])
def test_a_base_that_an_obstacle_holds_goes_nowhere_because_its_wheels_spin(speed, acceleration):
    # Nor afterwards, when they stop, and spin again.
    judge, dt, place = Inertial(0j), 0.02, 0.0
    for k in range(1000):
        since = 0.02 * (k % 100)
        way = min(acceleration * since, abs(speed), max(0.0, 10.0 * (1.0 - since)))
        wheels = complex(np.copysign(way, speed) * (k > 100))
        if any(judge.judge(dt, ALIKE, wheels, 0j, None, 0.0)):
            judge.settle(dt, wheels, 0.0)
        place += dt * judge.velocity.real
        assert abs(judge.velocity) < 0.2
    assert abs(place) < 0.2


def stopped_by_a_wall(stop, held, dt=0.02):
    """
    Return wheels and base (means of the steps) and force, where a wall stops a base.

    It rolls at 1 m/s, is stopped after three seconds within `stop` [s], and is held for so long
    [s] until its wheels stop. A second later it drives away.
    """
    time = 0.001 * np.arange(round((6.0 + held) / 0.001) + 1)
    away = np.interp(time, (4.0 + held, 5.0 + held), (0.0, -1.0))
    wheels = away + np.interp(
        time, (0.5, 1.5, 2.8 + held, 3.0 + held), (0.0, 1.0, 1.0, 0.0))
    base = away + np.interp(time, (0.5, 1.5, 3.0, 3.0 + stop), (0.0, 1.0, 1.0, 0.0))
    every = round(dt / 0.001)
    means = [speed[:-1].reshape(-1, every).mean(axis=1) for speed in (wheels, base)]
    return *means, np.diff(base[::every]) / dt


@pytest.mark.parametrize('speed, stop', [(0.4, 0.03), (1.0, 0.03), (-1.5, 0.1), (0.8j, 0.2)])
@pytest.mark.parametrize('held', [0.5, 2.0, 5.0])
@pytest.mark.parametrize('off', [0.0, 0.05 - 0.1j])
def test_a_base_that_is_stopped_against_its_wheels_stands(speed, stop, held, off):
    wheels, base, force = stopped_by_a_wall(stop, held)
    noise = np.random.default_rng(1).normal(0.0, 0.03, (2, len(force)))
    told = velocities_of(Inertial(0j, 160.0), zip(
        speed * wheels, speed * force + off + noise[0] + 1j * noise[1]))
    assert np.abs(told - speed * base).max() < 0.2
    assert abs(0.02 * np.sum(told - speed * base)) < 0.1


@pytest.mark.parametrize('speed', [0.5, 2.0])
def test_a_base_is_not_believed_to_be_held_for_ever(speed):
    wheels, _, force = stopped_by_a_wall(0.03, 20.0)
    judge, spell, distrust = Inertial(0j, 160.0), 0.0, 0.0
    for velocity, acting in zip(speed * wheels[:1000], speed * force):
        if any(judge.judge(0.02, ALIKE, complex(velocity), complex(acting), 0j, 0.0)):
            judge.settle(0.02, complex(velocity), 0.0)
        spell = max(spell, judge.coasting.time)
        distrust = max(distrust, judge.coasting.distrust)
    assert spell == pytest.approx(coasting.LONGEST_COASTING, abs=0.1)
    assert distrust == coasting.DISTRUST_TIME


@pytest.mark.parametrize('missed', [0.95, 1.0, 1.05])
def test_a_base_that_only_seems_to_have_been_stopped_has_rolled_once_it_slows_down(missed):
    wheels = np.interp(0.02 * np.arange(400), (0.5, 1.5, 4.0, 5.0), (0.0, 1.0, 1.0, 0.2))
    force = np.diff(wheels, prepend=0.0) / 0.02
    force[150:152] -= missed / 0.04
    told = velocities_of(Inertial(0j, 160.0), zip(wheels, force))
    assert np.abs(told)[170:200].max() < 0.1
    assert np.abs(told - wheels)[250:].max() < 0.1


@pytest.mark.parametrize('first', [-3.0, 0.0, 2.0])
@pytest.mark.parametrize('dt', [0.002, 0.02, 0.1])
def test_a_wrong_velocity_to_begin_at_is_not_coasted_on(first, dt):
    judge = Inertial(0j)
    for velocity in (first, *[0.5] * 200):
        assert all(judge.judge(dt, ALIKE, complex(velocity), 0j, None, 0.0))
        judge.settle(dt, complex(velocity), 0.0)
    assert abs(judge.velocity - 0.5) < 1e-3


def test_a_base_that_slides_on_wheels_that_stand_is_slowed_by_them():
    force = np.concatenate((np.zeros(100), np.ones(50), np.full(50, -1.0), np.zeros(50)))
    speed = 0.02 * np.cumsum(force)
    wheels = np.where(np.arange(len(force)) < 150, speed, 0.0)
    assert np.abs(velocities_of(Inertial(0j), zip(wheels, force)) - speed).max() < 0.05


@pytest.mark.parametrize('rest', [0.0, 0.3 - 0.2j])
@pytest.mark.parametrize('wrong', [2.5, -4.0, 6.0j])
def test_a_base_that_stands_as_at_its_last_rest_stands(rest, wrong):
    # A sensor that is wrong for half a second, a second before the base stops.
    force = np.concatenate((np.zeros(100), np.ones(50), np.zeros(100), np.full(50, -1.0)))
    wheels, dt = np.concatenate((0.02 * np.cumsum(force), np.zeros(100))), 0.02
    force = np.concatenate((force, np.zeros(100))) + complex(rest)
    force[200:225] += wrong
    judge, odo = Inertial(0j), SwerveOdometry(SwerveKinematics(CORNERS))
    told = velocities_of(judge, zip(wheels, force))
    assert np.abs(told - wheels)[200:300].max() > 0.5
    assert np.abs(told[300 + 20:]).max() < 0.02
    assert judge.coasting.distrust == 0.0
    way = dt * np.cumsum(wheels)
    for k, acting in enumerate(force):
        odo.update(dt * k, [way[k]] * 4, [0.0] * 4, 0.0,
                   specific_force=(acting.real, acting.imag))
    error, stds = odo.pose[:2] - (way[-1], 0.0), np.sqrt(odo.pose_covariance.diagonal()[:2])
    assert np.hypot(*error) < 3.0 * min(stds)


@pytest.mark.parametrize('push', [1.0, 3.0, 1.0j])
def test_a_base_that_is_pushed_over_wheels_that_stand_moves(push):
    force = push * np.concatenate((np.zeros(100), np.ones(50), np.full(25, -2.0)))
    speed = 0.02 * np.cumsum(force)
    told = velocities_of(Inertial(0j), zip(np.zeros(len(force)), force))
    assert np.abs(told - speed)[:-10].max() < 0.15 < 0.5 * np.abs(speed).max()


@pytest.mark.parametrize('accelerating', [0.0, 3.0])
@pytest.mark.parametrize('within', [True, False])
def test_wheels_come_back_once_they_change_as_the_prediction_does(accelerating, within):
    spell, dt, steps = Coasting(), 0.02, 0
    while not spell.has_regained(dt, 1.0, 0.3 - accelerating * dt * steps, True, within, 0.0, 0.0):
        steps += 1
        if steps > 50:
            break
    expected = coasting.REGAIN_TIME if within else coasting.AGREEMENT_TIME
    assert (steps > 50) == (accelerating > 0.0)
    assert accelerating or dt * steps == pytest.approx(expected, abs=dt)


@pytest.mark.parametrize('offset', [0.5, 1.5])
def test_an_offset_that_no_force_can_be_wrong_by_is_slip_however_steady(offset):
    # On ice in a curve, the wheels are off by the same for a second.
    spell, dt = Coasting(), 0.02
    while not spell.has_regained(dt, 1.0, offset + 0j, True, False, 0.1, 0.0):
        assert spell.time < 2.0
    assert spell.time == pytest.approx(offset / coasting.LARGEST_ERROR, abs=0.1)


@pytest.mark.parametrize('within', [True, False])
def test_one_step_of_any_length_is_no_agreement(within):
    spell, offsets = Coasting(), (1.0, -1.0, 1.0)
    assert not any(spell.has_regained(0.4, 1.0, offset + 0j, True, within, 0.0, 0.0)
                   for offset in offsets)


@pytest.mark.parametrize('credible, longest', [
    (lambda step: True, coasting.LONGEST_DISPUTE),
    (lambda step: step > 40, 40 * 0.02 + coasting.LONGEST_DISPUTE),
    (lambda step: step % 90 > 0, coasting.LONGEST_COASTING),
    (lambda step: False, coasting.LONGEST_COASTING)])
def test_wheels_that_are_credible_for_long_are_heard_sooner(credible, longest):
    spell, dt, step = Coasting(), 0.02, 0
    while not spell.is_too_long:
        step += 1
        assert not spell.has_regained(dt, 1.0, (-1.0) ** step + 0j, True, False, 0.0, 0.0)
        spell.dispute(dt, credible(step))
        assert spell.time < 10.0
    assert spell.time == pytest.approx(longest, abs=2.0 * dt)


@pytest.mark.parametrize('spread, longest', [
    (0.0, coasting.LONGEST_DISPUTE), (2.0, coasting.LONGEST_COASTING)])
def test_wheels_that_contradict_each_other_are_doubted_for_longer(spread, longest):
    # Wheels that swing to and fro under a base that stands: alike, or every one otherwise.
    judge, dt, spell = Inertial(0j), 0.02, 0.0
    apart = Step(ALIKE.group, [spread * dt * 1j ** module for module in range(4)], 0.0, 0.0, True)
    for k in range(700):
        mean = 0j if k < 100 else 1.8 * np.sin(4.0 * dt * (k - 100)) + 0j
        if any(judge.judge(dt, apart if k >= 100 else ALIKE, mean, 0j, None, 0.0)):
            judge.settle(dt, mean, 0.0)
        spell = max(spell, judge.coasting.time)
    assert spell == pytest.approx(longest, abs=2.0 * dt)
