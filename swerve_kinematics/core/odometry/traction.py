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

# The best tyres hold 1.2 g. Wheels that change their velocity faster than this [m/s^2], and by
# this much more [m/s] than encoders and uneven stamps explain, slip on any floor: nothing less
# will do here, where no accelerometer contradicts them.
BEST_GRIP = 12.0
SLACK = 0.1
# Few tyres hold 0.8 g: wheels whose velocity changes faster than this [m/s^2] lose their grip, or
# find it, where something else speaks for that as well.
USUAL_GRIP = 8.0
# Wheels that slip may do so because the floor is poor: rubber on a smooth, dusty or wet one has
# a friction of 0.3, and the base follows them with no more than this [m/s^2].
POOR_GRIP = 3.0
# And even on ice wheels pull a base that slides on them by this [m/s^2].
ICY_GRIP = 0.7
# In longer steps [s] a start cannot be told from a jump.
LONGEST_STEP = 0.15


class Traction:
    """Follows the wheels as fast as the best tyres let a base follow, or in slip a poor floor."""

    def __init__(self) -> None:
        """Start without a velocity."""
        self.interrupt()

    def interrupt(self) -> None:
        """Forget the velocity: the wheels tell the next one."""
        self._velocity: complex | None = None
        self._grip = BEST_GRIP

    def excess(self, dt: float, velocity: complex, turn: float, grip: float) -> float:
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
        grip : float
            Of the floor [m/s^2], for all that something else than this velocity tells: less than
            `BEST_GRIP` where the wheels are contradicted.

        """
        if self._velocity is None or dt > LONGEST_STEP:
            self._velocity, self._grip = velocity, BEST_GRIP
            return 0.0
        lag = velocity - self._velocity * cmath.rect(1.0, -turn)
        size = abs(lag)
        if size > BEST_GRIP * dt + SLACK and grip > POOR_GRIP:
            grip = POOR_GRIP
        if grip < self._grip:
            self._grip = grip
        excess = size - self._grip * dt
        if excess <= 0.0:
            self._velocity, self._grip = velocity, BEST_GRIP
            return 0.0
        self._velocity = velocity - excess / size * lag
        return excess if self._grip < BEST_GRIP else 0.0
