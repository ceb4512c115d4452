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

"""Tests of the chord of a wheel's arc: one formula, for a single step and for arrays of many."""

from hypothesis import given, strategies as st
import numpy as np
import pytest
from strategies import layouts, seeds

from swerve_kinematics.core.odometry.chord import chords, fit
from swerve_kinematics.core.odometry.group import Groups
from swerve_kinematics.core.odometry.module_paths import ModulePaths


@given(distance=st.floats(-1.0, 1.0), angle=st.floats(-3.0, 3.0), steering=st.floats(-1.0, 1.0),
       turn=st.floats(-1.0, 1.0))
def test_a_step_and_the_arrays_of_many_steps_take_the_same_chord(distance, angle, steering, turn):
    # A single module on base_link: its chord is the displacement.
    paths, steering = ModulePaths(1), angle + steering - angle
    paths.update([0.0], [angle])
    paths.update([distance], [angle + steering])
    step = fit(paths, Groups(np.zeros((1, 2))).of((0,)), turn)
    direction = np.exp(1j * np.array([angle + 0.5 * steering]))
    many = chords(np.array([distance]), np.array([steering]), direction, turn)
    assert abs(step.displacement - many[0]) < 1e-15


@given(layout=layouts((3, 4, 6, 8)), seed=seeds, heading_known=st.booleans())
def test_how_well_modules_agree_without_one_is_what_a_fit_without_it_says(
        layout, seed, heading_known):
    rng, groups, count = np.random.default_rng(seed), Groups(layout), len(layout)
    everyone = groups.of(tuple(range(count)))
    ways = rng.standard_normal(count) + 1j * rng.standard_normal(count)
    # The chords are so short that no arc matters.
    turn = 0.0 if heading_known else everyone.turn(list(1e-6 * ways))
    _, errors = everyone.motion(list(1e-6 * ways), turn)
    place, spread = everyone.suspect(errors, heading_known)
    spreads = []
    for left_out in range(count):
        others = groups.of(tuple(module for module in range(count) if module != left_out))
        rest = [1e-6 * ways[module] for module in others.used]
        turn = 0.0 if heading_known else others.turn(rest)
        spreads.append(others.rms(others.motion(rest, turn)[1]))
    assert spread == pytest.approx(min(spreads), rel=1e-6, abs=1e-12)
    assert spreads[place] == pytest.approx(min(spreads), rel=1e-6, abs=1e-12)
