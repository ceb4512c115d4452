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

"""Forces of collisions are told from spikes, and from a sensor that fails."""

import cmath
import math

from hypothesis import given, strategies as st
import numpy as np
import pytest

from swerve_kinematics.ros.collisions import RangeCheck

DRIVING = 0.3 - 0.2j


def believed(forces, period):
    """Return which of the forces are believed that come after a while of driving."""
    check = RangeCheck()
    assert all(check.believes(period, DRIVING) for _ in range(50))
    return [check.believes(period, force) for force in forces]


def pressed(duration, gained, period, begin):
    """Return means over periods of a force like half a sine wave, by the velocity it gives."""
    edges = np.arange(-begin, duration + 2.0 * period, period)
    velocity = 0.5 * gained * (1.0 - np.cos(np.pi * np.clip(edges / duration, 0.0, 1.0)))
    return DRIVING + np.diff(velocity) / period


@given(st.floats(0.05, 0.25), st.floats(0.3, 2.0), st.floats(-math.pi, math.pi),
       st.sampled_from((200.0, 250.0, 400.0)), st.floats(0.0, 1.0))
def test_a_collision_is_believed_from_its_beginning_to_its_end(
        duration, gained, direction, rate, phase):
    forces = pressed(duration, cmath.rect(gained, direction), 1.0 / rate, phase / rate)
    assert all(believed(forces.tolist(), 1.0 / rate))


@given(st.floats(19.0, 1e9), st.floats(-math.pi, math.pi), st.integers(1, 500))
def test_what_comes_out_of_nothing_is_not_believed_however_long_it_lasts(size, direction, count):
    assert not any(believed([cmath.rect(size, direction)] * count, 0.005))
    # Nor is a part that rings.
    assert not any(believed([cmath.rect(size, direction + math.pi * k) for k in range(count)],
                            0.005))


@pytest.mark.parametrize('force', [
    complex(math.nan, 1.0), complex(0.0, math.inf), complex(-math.inf, math.nan),
    complex(1.7e308, -1.7e308)])
def test_what_is_no_force_is_not_believed(force):
    assert believed([force, DRIVING], 0.005) == [False, True]


def test_a_sensor_that_creeps_to_the_end_of_its_range_is_not_believed_for_long():
    told = believed([complex(force) for force in [4.0, 8.0, 12.0, 16.0, *[19.6] * 100]], 0.005)
    assert sum(told[4:]) <= 20
    assert not any(told[24:])
