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

"""Which samples of an accelerometer to believe, those of collisions among them."""

import math

from swerve_kinematics.core.odometry.inertial import USUAL_RANGE

# The widest range [m/s^2] that sensors of this kind are set to, 16 g, and how long a collision
# presses like that [s]: a sensor that says so for longer is at the end of its range, or broken.
LARGEST_HIT, LONGEST_HIT = 160.0, 0.1
# The force of a collision follows on one of at least this part of it, in its direction: so it does
# in one of 50 ms that is sampled at 200 Hz. What comes out of nothing is a spike, or a fault.
LEAST_RISE = 0.25


class RangeCheck:
    """Tells forces of driving and of collisions from those of a sensor that is out of range."""

    def __init__(self) -> None:
        """Start at rest."""
        self._believed, self._hit = 0j, 0.0

    def believes(self, dt: float, force: complex) -> bool:
        """
        Take a sample; return whether a base drives, or collides, with such a force.

        Parameters
        ----------
        dt : float
            Time since the sample before [s].
        force : complex
            Specific force [m/s^2], or not finite.

        """
        size = math.hypot(force.real, force.imag)
        if size <= USUAL_RANGE:
            self._hit = 0.0
        else:
            self._hit += dt
            # False where the force is no number, too.
            rises = (self._believed * force.conjugate()).real >= LEAST_RISE * size * size
            if not (rises and size <= LARGEST_HIT and self._hit <= LONGEST_HIT):
                return False
        self._believed = force
        return True
