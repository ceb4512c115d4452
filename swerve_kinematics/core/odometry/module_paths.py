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

"""How each module has moved in a step: the chord of its arc, and how its path leaves it."""

import cmath
import math

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.odometry.readings import UNKNOWN

# Steps that differ in length by more than this factor tell nothing about each other.
LARGEST_RATIO = 2.5

# Nor does a step in which a wheel turned further than this [rad]: the expansion is about
# small turns, and a wheel that turns so fast for its step stands nearly still.
LARGEST_TURN = 1.0


class ModulePaths:
    """
    The paths of all modules in the present step, by their encoders and the step before.

    A chord knows the mean direction of an arc that was run at constant speed and constant
    turning rate. Where both change linearly, the path ends beside it: the integral of
    `(v + v' t) (c t / h + c'' (t^2 - h^2 / 4) / 2)` over the step, with speed and turning rate
    through the middles of the two steps, is `w (d c' - d' c)`. Here d and c are the distance
    and the turning of this step of duration h, d' and c' those of the step before, of
    duration H, scaled by h / H, and `w = h / (6 (h + H))`.

    Parameters
    ----------
    count : int
        Number of modules.

    Attributes
    ----------
    rolled, steered : list of float (n,)
        Distance [m] and change of the steering angle [rad] in the step; NaN where unknown.
    directions : list of complex (n,)
        Unit vectors along the wheels halfway through the step.

    """

    def __init__(self, count: int) -> None:
        """Wait for the first sample."""
        unknown = [math.nan] * count
        self._distances, self._angles = unknown, unknown
        self.rolled, self.steered = unknown, unknown
        self.directions = [UNKNOWN] * count
        self._rolled_before, self._steered_before = unknown, unknown
        self._turn_before = self._duration_before = 0.0
        self._weight = 0.0  # w h / H, for d' and c' as they were

    def update(self, distances: list[float], angles: list[float]) -> None:
        """
        Take in the sample that ends a step.

        Parameters
        ----------
        distances, angles : list of float (n,)
            Cumulative distances [m] and steering angles [rad], NaN where unknown.

        """
        rolled, steered, directions = [], [], []
        for distance, last_distance, angle, last_angle in zip(
                distances, self._distances, angles, self._angles):
            change = math.remainder(angle - last_angle, TURN)
            rolled.append(distance - last_distance)
            steered.append(change)
            directions.append(cmath.rect(1.0, last_angle + 0.5 * change))
        self.rolled, self.steered, self.directions = rolled, steered, directions
        self._distances, self._angles = distances, angles

    def take_duration(self, dt: float) -> None:
        """Take in how long the step has lasted [s]."""
        before = self._duration_before
        if before and 1.0 / LARGEST_RATIO <= dt / before <= LARGEST_RATIO:
            self._weight = dt / before * dt / (6.0 * (dt + before))
        else:
            self._weight = 0.0

    def of(self, used: tuple[int, ...], turn: float) -> list[complex]:
        """
        Return the displacements of modules over the step [m], seen from halfway through it.

        Parameters
        ----------
        used : tuple of int (k,)
            The modules, all of them with data.
        turn : float
            Change of heading in the step [rad].

        """
        rolled, steered, directions = self.rolled, self.steered, self.directions
        rolled_before, steered_before = self._rolled_before, self._steered_before
        weight, turn_before, paths = self._weight, self._turn_before, []
        for i in used:
            way, turned, aside = rolled[i], steered[i] + turn, 0.0
            if weight:
                before = steered_before[i] + turn_before
                if abs(turned) <= LARGEST_TURN and abs(before) <= LARGEST_TURN:
                    aside = weight * (way * before - rolled_before[i] * turned)
            half = 0.5 * turned
            chord = way * (math.sin(half) / half) if half else way
            paths.append(complex(chord, aside) * directions[i])
        return paths

    def keep(self, dt: float, turn: float, used: tuple[int, ...]) -> None:
        """
        Let the next step follow on this one.

        Parameters
        ----------
        dt : float
            Its duration [s].
        turn : float
            Change of heading in it [rad].
        used : tuple of int
            The modules that took part; the others have no past.

        """
        self._duration_before, self._turn_before = dt, turn
        self._rolled_before, self._steered_before = self.rolled, self.steered
        if len(used) < len(self.steered):
            self._steered_before = [angle if module in used else math.nan
                                    for module, angle in enumerate(self.steered)]

    def forget(self) -> None:
        """Let the next step follow on none."""
        self._duration_before = 0.0
