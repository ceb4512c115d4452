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

"""Where the wheels of a base are: what makes two kinematics the same."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.geometry.arrays import as_positions


class WheelLayout:
    """
    Constant positions of wheels, by which the kinematics made from them compare, hash and pickle.

    Parameters
    ----------
    positions : array_like (n, 2)
        From base_link [m].
    name : str
        What the caller knows the positions as, for the error.

    Raises
    ------
    ValueError
        If the shape is not (n, 2) or a position is not finite.

    """

    def __init__(self, positions: ArrayLike, name: str) -> None:
        """Check the positions."""
        self._positions = as_positions(positions, name)

    def __repr__(self) -> str:
        """Show the layout."""
        return f'{type(self).__name__}({self._positions.tolist()})'

    def __eq__(self, other: object) -> bool:
        """Tell whether both are of one kind and have their wheels at the same places."""
        if not isinstance(other, WheelLayout) or type(self) is not type(other):
            return NotImplemented
        return np.array_equal(self._positions, other._positions)

    def __hash__(self) -> int:
        """Return a number that is the same for equal layouts."""
        return hash((type(self), tuple(self._positions.ravel().tolist())))

    def __reduce__(self) -> tuple[type['WheelLayout'], tuple[NDArray[np.float64]]]:
        """Pickle the positions alone: the matrices are made from them, and read-only again."""
        return type(self), (self._positions,)
