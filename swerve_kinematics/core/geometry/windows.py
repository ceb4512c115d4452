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

"""Spans of time in which to look at a recording, also where its clock was set by years."""

import numpy as np
from numpy.typing import NDArray

# A step between two samples that is longer than this [s] is a gap: an arc in it is guesswork. It
# is a judgement: 4 Hz are slow for encoders, and a base at 3 rad/s turns by less than 45 degrees.
LONGEST_STEP = 0.25
# A gap between two samples counts no longer than this [s]: nothing is known of it.
LONGEST_GAP = 60.0


def without_long_gaps(stamp: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return ascending stamps (t,) [s] with gaps of LONGEST_GAP at most."""
    gaps = np.diff(stamp, prepend=stamp[0])
    shortened: NDArray[np.float64] = stamp - np.cumsum(np.maximum(gaps - LONGEST_GAP, 0.0))
    return shortened


def window_edges(stamp: NDArray[np.float64], width: float) -> NDArray[np.intp]:
    """
    Return the indices (k + 1,) at which one window ends and the next one begins.

    Parameters
    ----------
    stamp : ndarray (t,)
        Ascending [s].
    width : float
        Of the windows [s]. Where a gap is longer, one window reaches over it.

    """
    stamp = without_long_gaps(stamp)
    begins = np.arange(stamp[0], stamp[-1], width)
    # By rounding, the last one of `arange` may lie behind its end.
    edges: NDArray[np.intp] = np.searchsorted(stamp, begins[begins <= stamp[-1]])
    # None twice: `np.unique` would load more of numpy while the base drives.
    return edges[np.diff(edges, prepend=-1) > 0]
