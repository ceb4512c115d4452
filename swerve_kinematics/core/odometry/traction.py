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

"""How much of the wheels' velocity no tyre can have brought about: they spin, or lock."""

import cmath

# Rubber on a smooth, dusty or wet floor has a friction of 0.3: it moves the base by no more
# than this [m/s^2]. On a better floor a hard start only makes the covariance too large.
GRIP = 3.0
# In longer steps [s] a start cannot be told from a jump.
LONGEST_STEP = 0.15


class Traction:
    """Follows the wheels as fast as a poor floor lets the base follow."""

    def __init__(self) -> None:
        """Start without a velocity."""
        self._velocity: complex | None = None

    def interrupt(self) -> None:
        """Forget the velocity: the wheels tell the next one."""
        self._velocity = None

    def excess(self, dt: float, velocity: complex, turn: float) -> float:
        """
        Return by how much the base may lag behind the wheels [m/s].

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        velocity : complex
            By the wheels, in base axes [m/s].
        turn : float
            Of the base in the step [rad].

        """
        if self._velocity is None or dt > LONGEST_STEP:
            self._velocity = velocity
            return 0.0
        lag = velocity - self._velocity * cmath.rect(1.0, -turn)
        excess = abs(lag) - GRIP * dt
        if excess <= 0.0:
            self._velocity = velocity
            return 0.0
        self._velocity = velocity - excess / abs(lag) * lag
        return excess
