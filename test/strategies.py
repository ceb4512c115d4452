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

"""Seeded random layouts and data for the properties of the core."""

import math

from hypothesis import strategies as st
import numpy as np

MODULE_COUNTS = (2, 3, 4, 6, 8)
# Of quaternions: where a square overflows, or vanishes, a plausible angle might come out.
NO_ROTATIONS = [
    (0.0,) * 4, (math.nan,) * 4, (math.inf, 0.0, 0.0, 0.0), (0.0, 0.0, 1e308, 1e308),
    (0.0, 0.0, 1e160, 1e150), (1e-170,) * 4]

seeds = st.integers(0, 2 ** 32 - 1)


@st.composite
def layouts(draw, counts=MODULE_COUNTS):
    """
    Draw module positions (n, 2) [m] without symmetry, and base_link inside or outside of them.

    The modules sit near the corners of a polygon, so that no two of them are closer than a
    few centimetres.
    """
    count = draw(st.sampled_from(counts))
    base_link_distance = draw(st.sampled_from((0.0, 3.0)))
    rng = np.random.default_rng(draw(seeds))
    bearing = 2.0 * np.pi / count * (np.arange(count) + rng.uniform(-0.3, 0.3, count))
    positions = rng.uniform(0.2, 1.0, count) * np.exp(1j * bearing)
    positions += base_link_distance * np.exp(1j * rng.uniform(-np.pi, np.pi))
    return np.stack((positions.real, positions.imag), axis=-1)


@st.composite
def twists(draw, count=20):
    """Draw `count` twists up to about 6 m/s and 6 rad/s, shape (count, 3)."""
    return np.random.default_rng(draw(seeds)).normal(scale=2.0, size=(count, 3))
