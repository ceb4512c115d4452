"""Limits of the chassis: the curve is kept, and no rate exceeds its limit."""

import math

import numpy as np
import pytest

from swerve_kinematics import discretize, SwerveKinematics
from swerve_kinematics.core.control.limits import (
    ControllerLimits, limited_twist, saturated, speed_scale)
from swerve_kinematics.core.geometry.planar import PlanarTwist, rate_between, REST

DT = 0.02
POSITIONS = [(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)]
OFFSETS = [complex(x, y) for x, y in POSITIONS]


def ramp(target, limits, start=REST, steps=400):
    """Return the twists on the way to `target`, `start` first, up to the arrival."""
    twists, acceleration = [start], REST
    for _ in range(steps):
        twists.append(limited_twist(target, twists[-1], acceleration, limits, DT))
        acceleration = rate_between(twists[-2], twists[-1], DT)
        if twists[-1] == twists[-2] == target:
            break
    return twists


@pytest.mark.parametrize('value', [0.0, -1.0, math.nan])
def test_a_limit_that_is_not_positive_is_named(value):
    with pytest.raises(ValueError, match='max_linear_jerk must be positive'):
        ControllerLimits(max_linear_jerk=value)


def test_limits_are_plain_numbers():
    assert type(ControllerLimits(max_linear_speed=np.float64(2.0)).max_linear_speed) is float


@pytest.mark.parametrize('limits, scale', [
    ({}, 1.0), ({'max_linear_speed': 1.0}, 0.5), ({'max_angular_speed': 1.0}, 0.25),
    ({'max_module_speed': 1.0}, 1.0 / math.hypot(2.0 + 4 * 0.2, 4 * 0.3)),
    ({'max_linear_speed': 1.0, 'max_angular_speed': 1.0}, 0.25)])
def test_one_factor_brings_a_twist_within_all_speed_limits(limits, scale):
    twist = PlanarTwist(2.0 + 0j, 4.0)
    assert speed_scale(twist, OFFSETS, ControllerLimits(**limits)) == pytest.approx(scale)


def test_no_limit_means_at_once():
    target = PlanarTwist(3.0 - 2.0j, 5.0)
    assert limited_twist(target, REST, REST, ControllerLimits(), DT) is target


LIMITS = [
    ControllerLimits(max_linear_acceleration=2.0, max_linear_deceleration=4.0,
                     max_angular_acceleration=1.5),
    ControllerLimits(max_linear_acceleration=2.0, max_linear_deceleration=4.0,
                     max_angular_acceleration=1.5, max_linear_jerk=9.0, max_angular_jerk=7.0)]


@pytest.mark.parametrize('limits', LIMITS)
def test_from_rest_and_to_rest_the_curve_is_that_of_the_target(limits):
    target = PlanarTwist(1.5 + 0.6j, -0.8)
    for twists in (ramp(target, limits), ramp(REST, limits, start=target)):
        assert len(twists) > 10
        for velocity, omega in twists:
            assert abs(velocity * target.omega - target.velocity * omega) < 1e-12


def test_the_limiting_part_runs_at_its_limit():
    rise = np.array([twist.velocity.real for twist in ramp(PlanarTwist(1 + 0j, 0.0), LIMITS[0])])
    fall = np.array([twist.velocity.real for twist in ramp(
        REST, LIMITS[0], start=PlanarTwist(1 + 0j, 0.0))])
    np.testing.assert_allclose(np.diff(rise)[:24], 2.0 * DT)
    np.testing.assert_allclose(np.diff(fall)[:12], -4.0 * DT)


def test_a_reversal_brakes_up_to_rest_and_accelerates_beyond_it():
    twist = limited_twist(
        PlanarTwist(-1 + 0j, 0.0), PlanarTwist(0.04 + 0j, 0.0), REST, LIMITS[0], DT)
    assert twist.velocity.real == pytest.approx(-2.0 * DT / 2)


def test_the_jerk_limit_holds_and_nothing_overshoots():
    target = PlanarTwist(1.7 + 0j, 0.9)
    twists = ramp(target, LIMITS[1])
    speeds = np.array([twist.velocity.real for twist in twists])
    rates = np.diff(speeds, prepend=0.0) / DT
    assert twists[-1] == target
    assert speeds.max() == target.velocity.real
    assert np.abs(np.diff(rates)).max() <= 9.0 * DT + 1e-9
    # With a constant jerk and no other limit, v = a^2 / j: the time is 2 sqrt(v / j).
    free = ramp(target, ControllerLimits(max_linear_jerk=9.0))
    assert len(free) * DT == pytest.approx(2.0 * math.sqrt(1.7 / 9.0), abs=4 * DT)


def test_random_targets_keep_every_limit():
    rng = np.random.default_rng(1)
    for _ in range(60):
        rate, jerk = rng.uniform(0.5, 3.0), rng.uniform(3.0, 20.0)
        limits = ControllerLimits(2.0, 3.0, rate, rate, 4.0, jerk)
        twists, acceleration = [REST], REST
        for _ in range(6):
            target = PlanarTwist(complex(*rng.uniform(-1.4, 1.4, 2)), rng.uniform(-3, 3))
            for _ in range(int(rng.choice([5, 30, 150]))):
                twists.append(limited_twist(target, twists[-1], acceleration, limits, DT))
                acceleration = rate_between(twists[-2], twists[-1], DT)
        velocity = np.array([twist.velocity for twist in twists])
        omega = np.array([twist.omega for twist in twists])
        assert np.abs(velocity).max() <= 2.0 + 1e-9
        assert np.abs(omega).max() <= 3.0 + 1e-9
        assert np.abs(np.diff(velocity)).max() <= rate * DT + 1e-9
        assert np.abs(np.diff(omega)).max() <= 4.0 * DT + 1e-9
        assert np.abs(np.diff(velocity, 2)).max() <= jerk * DT ** 2 + 1e-9


def test_saturated_scales_before_it_discretizes():
    twist, dt = PlanarTwist(3.0 + 1.0j, 6.0), 0.05
    straight, scale = saturated(twist, OFFSETS, 1.2, dt)
    states = SwerveKinematics(POSITIONS).inverse(discretize(scale * np.array([3.0, 1.0, 6.0]), dt))
    assert states.speed.max() == pytest.approx(1.2, abs=1e-6)
    expected = discretize(scale * np.array([3.0, 1.0, 6.0]), dt)
    np.testing.assert_allclose(
        [straight.velocity.real, straight.velocity.imag, straight.omega], expected, rtol=1e-6)


def test_saturated_leaves_a_slow_twist_alone():
    assert saturated(PlanarTwist(1.0 + 0j, 0.0), OFFSETS, 1.2, DT) == ((1.0 + 0j, 0.0), 1.0)
