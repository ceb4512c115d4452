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

"""Whether a base stands, though its accelerometer was last heard to have it moving."""

# A base stands when its wheels and its heading rest, the force keeps its value to within the
# first of these [m/s^2] for the time [s], and that value is the one of its last rest, to within
# the second. Tyres that slide brake the base by more, even on ice (`traction.ICY_GRIP`). It
# leaves room for another lean of the floor, and for another heading on the same one: judgement,
# 4 degrees. The first is three times the noise of a poor sensor, and less than a hand that pushes
# wavers by.
STEADY = 0.3
STAND_TIME = 0.3
SAME_REST = 0.7


class Standstill:
    """Remembers the force of the last rest, and tells by it that the base rests again."""

    def __init__(self) -> None:
        """Start without a rest."""
        self._rest: complex | None = None
        self._mean, self._time = 0j, 0.0

    def lasts(self, dt: float, force: complex | None, still: bool, contradicted: bool) -> bool:
        """
        Take in a step, and return whether the base stands by all that is known.

        Parameters
        ----------
        dt : float
            Its duration [s].
        force : complex or None
            Mean specific force in it [m/s^2], None where it is unknown.
        still : bool
            Whether wheels and heading rest.
        contradicted : bool
            Whether the accelerometer has contradicted the wheels: their rest proves nothing.

        """
        if force is None:
            self._time = 0.0
            return False
        if not self._time or abs(force - self._mean) > STEADY:
            self._time, self._mean = 0.0, force
        self._time += dt
        self._mean += dt / self._time * (force - self._mean)
        if not still or self._time < STAND_TIME:
            return False
        if not contradicted:
            self._rest = self._mean
        return self._rest is not None and abs(self._mean - self._rest) < SAME_REST
