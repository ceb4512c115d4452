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

"""What the functions on arrays share."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np

from swerve_kinematics.core.geometry.arrays import median


@given(st.lists(st.floats(-1e9, 1e9) | st.just(np.nan) | st.just(np.inf), min_size=1))
def test_the_median_is_that_of_numpy(values):
    with np.errstate(invalid='ignore'):
        np.testing.assert_allclose(median(np.array(values)), np.median(values), rtol=1e-15)


def test_there_is_no_median_of_nothing():
    assert np.isnan(median(np.array([])))
