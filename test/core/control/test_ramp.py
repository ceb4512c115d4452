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

"""The ramp between two twists: the curve is kept, and no rate exceeds its limit."""

import numpy as np
import pytest

from swerve_kinematics.core.control.jerk import smoothed
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.control.ramp import ramped
from swerve_kinematics.core.geometry.planar import PlanarTwist, rate_between, REST

DT = 0.02
OFFSETS = [complex(x, y) for x in (0.3, -0.3) for y in (0.2, -0.2)]


def limited_twist(target, previous, acceleration, limits, dt):
    """Return the next twist on the way to `target`, within ramp and jerk."""
    wanted = ramped(target, previous, OFFSETS, limits, dt)
    return smoothed(wanted, previous, acceleration, OFFSETS, limits, dt)


def ramp(target, limits, start=REST, steps=400):
    """Return the twists on the way to `target`, `start` first, up to the arrival."""
    twists, acceleration = [start], REST
    for _ in range(steps):
        twists.append(limited_twist(target, twists[-1], acceleration, limits, DT))
        acceleration = rate_between(twists[-2], twists[-1], DT)
        if twists[-1] == twists[-2] == target:
            break
    return twists


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
