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

"""The nearest twist for which every module has an angle in its range."""

import cmath
import math

from hypothesis import given, settings, strategies as st
import numpy as np
import pytest

from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.control.module_group import ModuleGroup
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.control.steering import SteeringRange
from swerve_kinematics.core.geometry.planar import module_velocities, PlanarTwist

FREE = SteeringRange()
LIMITS, DT = ControllerLimits(), 1e-6


def reachable(twist, offsets, ranges, angles):
    """Return the nearest twist that modules found at some angles can do, and the blocked ones."""
    group = ModuleGroup(offsets, ranges)
    group.locate(angles)
    return group.reachable(twist, Offsets(offsets), list(angles), LIMITS, DT)


def can_do(twist, offsets, ranges):
    """Tell whether all modules have an angle for a twist."""
    return all(abs(velocity) < 1e-6 or any(
        joint.lower - 1e-5 <= cmath.phase(velocity) + turn <= joint.upper + 1e-5
        for turn in np.arange(-4, 5) * math.pi)
        for velocity, joint in zip(module_velocities(twist, offsets), ranges))


def distance(first, second, offsets):
    """Return the root of the sum of all squared differences of module velocities."""
    return np.linalg.norm(np.subtract(
        module_velocities(first, offsets), module_velocities(second, offsets)))


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 2 ** 32 - 1))
def test_no_twist_that_all_modules_can_do_is_nearer(seed):
    rng = np.random.default_rng(seed)
    count = rng.integers(2, 6)
    offsets = [complex(*place) for place in rng.uniform(-0.6, 0.6, (count, 2))]
    ranges = [SteeringRange(*ends) if rng.random() < 0.8 else FREE
              for ends in rng.uniform((-1.5, 0.2), (-0.2, 1.5), (count, 2))]
    angles = [rng.uniform(max(joint.lower, -2.0), min(joint.upper, 2.0)) for joint in ranges]
    commanded = PlanarTwist(complex(*rng.uniform(-1, 1, 2)), rng.uniform(-2, 2))
    result, _ = reachable(commanded, offsets, ranges, angles)
    assert can_do(result, offsets, ranges)
    # A longer turn of the wheels is worth a little.
    size = distance(PlanarTwist(0j, 0.0), commanded, offsets)
    missed = distance(result, commanded, offsets) - 0.15 * size
    for attempt in range(100):
        shift = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 0)
        other = PlanarTwist(commanded.velocity + complex(*shift[:2]), commanded.omega + shift[2])
        assert (distance(other, commanded, offsets) >= missed
                or not can_do(other, offsets, ranges))


def test_sideways_a_base_goes_along_the_nearer_end_stop():
    offsets, joint = [0.3 + 0.2j, 0.3 - 0.2j, -0.3 + 0.2j, -0.3 - 0.2j], SteeringRange(-1.0, 1.0)
    twist, unreachable = reachable(PlanarTwist(1.0j, 0.0), offsets, [joint] * 4, [0.1] * 4)
    assert all(unreachable)
    assert twist.omega == pytest.approx(0.0, abs=1e-15)
    assert twist.velocity == pytest.approx(math.sin(1.0) * cmath.rect(1.0, 1.0), abs=1e-6)


@pytest.mark.parametrize('angles', [(1.4, -1.4, 1.4, -1.4), (-1.4, 1.4, 1.4, -1.4), (0, 0, 0, 0)])
def test_a_base_hardly_blocked_drives_on_wherever_its_wheels_point(angles):
    offsets, joint = [0.3 + 0.2j, 0.3 - 0.2j, -0.3 + 0.2j, -0.3 - 0.2j], SteeringRange(-1.4, 1.4)
    twist, unreachable = reachable(PlanarTwist(1.0j, 0.0), offsets, [joint] * 4, angles)
    assert all(unreachable)
    assert abs(twist.velocity - 1.0j) < 0.2 and abs(twist.omega) < 0.1


def test_nothing_changes_where_all_angles_are_in_range():
    commanded = PlanarTwist(1.0 + 0.2j, 0.5)
    result, unreachable = reachable(
        commanded, [0.3 + 0j, -0.3 + 0j], [SteeringRange(-2.0, 2.0), FREE], [0.0, 0.0])
    assert result is commanded and not any(unreachable)
