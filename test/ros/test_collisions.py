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


def told(forces, period):
    """Return which of the forces count in the end that come after a while of driving."""
    check, counted = RangeCheck(), []
    assert all(check.believes(period, DRIVING) for _ in range(50))
    for force in forces:
        counted.append(check.believes(period, force))
        if check.confirms:
            assert not counted[-2]
            counted[-2] = True
    return np.array(counted)


def pressed(share, duration, gained, period, begin):
    """Return means over periods of a force by the share (of time) of velocity that it gives."""
    edges = np.arange(-begin, duration + 2.0 * period, period)
    return DRIVING + gained * np.diff(share(np.clip(edges / duration, 0.0, 1.0))) / period


@given(st.sampled_from((lambda part: part, lambda part: 0.5 * (1.0 - np.cos(np.pi * part)))),
       st.floats(0.03, 0.1), st.floats(0.3, 2.0), st.floats(-math.pi, math.pi),
       st.sampled_from((200.0, 250.0, 400.0)), st.floats(0.0, 1.0))
def test_a_collision_counts_from_its_beginning_to_its_end(
        share, duration, gained, direction, rate, phase):
    gained = cmath.rect(gained, direction)
    forces = pressed(share, duration, gained, 1.0 / rate, phase / rate)
    counted = told(forces.tolist(), 1.0 / rate)
    assert abs(np.sum(forces[~counted]) / rate) < 0.1 * abs(gained)


@given(st.floats(19.0, 1e9), st.floats(-math.pi, math.pi), st.integers(1, 500))
def test_neither_a_spike_nor_a_part_that_rings_is_a_collision(size, direction, count):
    spike = cmath.rect(size, direction)
    assert told([DRIVING, spike, DRIVING, DRIVING], 0.005).tolist() == [True, False, True, True]
    assert not told([spike, -spike] * count, 0.005).any()


@pytest.mark.parametrize('force', [
    complex(math.nan, 1.0), complex(0.0, math.inf), complex(-math.inf, math.nan),
    complex(1.7e308, -1.7e308), complex(200.0)])
def test_what_is_no_force_of_a_base_does_not_count_however_long_it_lasts(force):
    assert told([DRIVING, *[force] * 9, DRIVING], 0.005).tolist() == [True, *[False] * 9, True]


@pytest.mark.parametrize('approach', [[], [4.0, 8.0, 12.0, 16.0]])
def test_a_sensor_at_the_end_of_its_range_counts_no_longer_than_a_collision(approach):
    counted = told(list(map(complex, approach + [19.6] * 200)), 0.005)
    assert counted.sum() - len(approach) <= 20
    assert not counted[len(approach) + 20:].any()


@pytest.mark.parametrize('half', [1, 2, 3, 7])
@pytest.mark.parametrize('quiet', [0, 1, 2])
def test_a_sensor_that_is_shaken_does_not_count(half, quiet):
    once = [30j] * half + [DRIVING] * quiet + [-30j] * half + [DRIVING] * quiet
    forces = np.array(once * 100)
    counted = told(forces.tolist(), 0.005)
    assert counted[forces == DRIVING].all()
    # Only at first.
    assert not counted[200:][forces[200:] != DRIVING].any()
    # It comes to count again.
    check = RangeCheck()
    for force in [*forces.tolist(), *[DRIVING] * 300, 12j]:
        check.believes(0.005, force)
    assert check.believes(0.005, 20j)
