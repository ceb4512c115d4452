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

"""Whether the base stands still, by its encoders."""

from collections.abc import Sequence
import math

from swerve_kinematics.core.geometry.angles import TURN

# At rest for this long [s] without a module moving by more than this [m], [rad]: 1 mm/s, and
# beyond what the last bit of a 12-bit encoder on a 50 mm wheel flickers (0.08 mm, 1.5 mrad).
# Steering counts too, for a wheel that turns on the spot twists the base a little. But its control
# may hunt within the play of its gears: judgement, 1.7 degrees, by which a wheel that scrubs on
# the spot shifts the base by 0.02 mm (`step_noise.SCRUB_SHIFT`).
REST_TIME = 0.2
REST_DISTANCE = 0.2e-3
REST_STEERING = 0.03


class RestDetector:
    """Tells by the encoders whether the base has stood still for a while."""

    def __init__(self) -> None:
        """Start in motion."""
        self._distances: Sequence[float] = ()
        self._angles: Sequence[float] = ()
        self._time = 0.0

    def update(self, dt: float, distances: Sequence[float], angles: Sequence[float]) -> bool:
        """
        Return whether no module has moved for `REST_TIME`.

        Parameters
        ----------
        dt : float
            Time since the last call [s].
        distances, angles : sequence of float (n,)
            Cumulative distances [m] and steering angles [rad]. NaN counts as motion.

        """
        if self._has_moved(distances, angles):
            self._distances, self._angles, self._time = distances, angles, 0.0
            return False
        self._time += dt
        return self._time > REST_TIME

    def _has_moved(self, distances: Sequence[float], angles: Sequence[float]) -> bool:
        """Return whether a module is not where it was when the base came to rest."""
        if have_rolled(distances, self._distances):
            return True
        for angle, last in zip(angles, self._angles):
            if not abs(math.remainder(angle - last, TURN)) <= REST_STEERING:
                return True
        return False


def have_rolled(distances: Sequence[float], since: Sequence[float]) -> bool:
    """
    Return whether any module has rolled by more than its encoder flickers.

    Parameters
    ----------
    distances, since : sequence of float (n,)
        Cumulative distances now and before [m]. NaN counts as motion, and so does an empty
        `since`.

    """
    for distance, last in zip(distances, since):
        if not abs(distance - last) <= REST_DISTANCE:
            return True
    return len(since) == 0
