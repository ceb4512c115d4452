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

"""How the lean of the floor changes under the base, by the gyros about x and y."""

from swerve_kinematics.core.odometry.gyro import LARGEST_BIAS

STANDARD_GRAVITY = 9.80665  # [m/s^2]

# The offset is learnt over so long [s] of slow motion, and used after so much of it [s]: until
# then the rates are as wrong as data sheets say, half a degree per second, and no use.
LEARNING_TIME = 2.0
LEAST_TIME = 0.5
# Motion is slow once it has been so for this long [s].
SLOW_TIME = 0.2


class TiltRates:
    """Follows the lean by the rates about x and y, less the offset that slow motion shows."""

    def __init__(self) -> None:
        """Start with an offset that is not known."""
        self._offset = 0j
        self._learnt = self._slow = 0.0

    def change(self, dt: float, rates: complex | None, is_slow: bool) -> complex | None:
        """
        Return the change of the gravity that leaks into x and y [m/s^2], None if unknown.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        rates : complex or None
            Mean rates about x and y in it [rad/s].
        is_slow : bool
            Whether the base stands or creeps, so that the floor tilts it no further.

        """
        self._slow = self._slow + dt if is_slow else 0.0
        if rates is None:
            return None
        # Faster than by any bias, the base is being tilted.
        if self._slow > SLOW_TIME and abs(rates) < LARGEST_BIAS:
            self._learnt = min(self._learnt + dt, LEARNING_TIME)
            self._offset += dt / max(self._learnt, dt) * (rates - self._offset)
        if self._learnt < LEAST_TIME:
            return None
        # Seen from a base that tilts, what points up turns the other way: by `up x rates` in a
        # second, whose part along x and y this is.
        return 1j * STANDARD_GRAVITY * dt * (rates - self._offset)
