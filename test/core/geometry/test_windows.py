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

"""Windows of a recording: their edges are samples, whatever its clock shows."""

import numpy as np
import pytest

from swerve_kinematics.core.geometry.windows import LONGEST_GAP, window_edges, without_long_gaps

WIDTH = 0.1


@pytest.mark.parametrize('start', [0.0, 1.0, 1e2, 1e4, 1e6, 1e9, 1.7e9])
@pytest.mark.parametrize('rate', [20, 50, 100])
def test_edges_are_samples_a_window_apart_wherever_a_regular_clock_starts(start, rate):
    rng = np.random.default_rng(rate)
    for count in rng.integers(100, 3000, 200):
        # Whole nanoseconds, as in a message.
        began = round((start + rng.random()) * 1e9)
        stamp = (began + np.round(np.arange(count) / rate * 1e9)) / 1e9
        edges = window_edges(stamp, WIDTH)
        assert edges[0] == 0
        assert edges[-1] < count
        # As pytest.approx, which compares the elements one by one.
        assert (np.abs(np.diff(stamp[edges]) - WIDTH) <= 1.0 / rate + 1e-6).all()


def test_samples_further_apart_than_a_window_are_all_edges():
    stamp = 1e9 + np.cumsum(np.full(100, 0.3))
    assert window_edges(stamp, WIDTH).tolist() == list(range(100))


def test_a_clock_that_is_set_forward_by_years_makes_one_long_window():
    stamp = np.array([0.0, 0.1, 1e9, 1e9 + 0.1])
    assert np.diff(without_long_gaps(stamp)) == pytest.approx([0.1, LONGEST_GAP, 0.1])
    assert window_edges(stamp, 1.0).tolist() == [0, 2]
