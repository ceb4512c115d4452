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

"""How much the stamps of the wheels' readings wander, by the trace that leaves in their speed."""

import math

from swerve_kinematics.core.odometry.readings import UNKNOWN

# The estimate is a mean over this time [s].
MEMORY = 3.0
# A base that is slower than this [m/s] tells nothing of its stamps.
LEAST_SPEED = 0.1
# From this part of the time between readings on, an accelerometer spoils more clean driving than
# it mends: velocities are off by 35 %, and some readings would have the stamps of earlier ones.
LARGEST_PART = 0.25
# No stamp is off by more than this [s]: wheels that went further astray than the base goes in so
# much time slip, or their encoders were reset.
LARGEST_OFFSET = 0.1


class StampJitter:
    """
    Tells by how much stamps scatter about the instants of their readings.

    A reading that is stamped too late makes its step seem too slow and the next one too fast,
    which looks like slip and adds up to nothing. In the successive changes of the velocity's
    error such pairs show as a negative covariance; slip, whether it comes at once or grows,
    makes none, however long the steps are.

    Attributes
    ----------
    variance : float
        Of a stamp [s^2].
    scatter : float
        Standard deviation of what stamps make of the wheels' velocity in the last step [m/s].

    """

    def __init__(self) -> None:
        """Start with stamps that are right."""
        self.variance = self.scatter = 0.0
        self._error = self._change = UNKNOWN
        self._rate = self._rate_before = 0.0
        self._way = self._duration = 0.0  # of the last step
        self._period = 0.0  # mean duration of a step [s]
        self._covariance = self._square_speed = 0.0

    @property
    def are_useless(self) -> bool:
        """Return whether stamps scatter so much that velocities tell of the stamps alone."""
        largest = LARGEST_PART * self._period
        return self.variance > largest * largest

    def interrupt(self) -> None:
        """Forget the last steps, after a gap; the stamps stay as they are."""
        self._error = self._change = UNKNOWN
        self._way = self._duration = 0.0

    def std(self, dt: float, back: complex, error: complex, speed: float,
            resolution: float) -> float:
        """
        Take in a step, and return what stamps and encoders make of the wheels' velocity [m/s].

        Parameters
        ----------
        dt : float
            Its duration by the stamps [s].
        back : complex
            What turns a vector of the step before into base axes, which have turned since.
        error : complex
            Velocity by the wheels less the expected one [m/s].
        speed : float
            By the wheels [m/s].
        resolution : float
            Of the encoders [m]. Their last bit leaves a trace like that of stamps which are off
            by up to half of it, and is not taken for that.

        """
        size = abs(error)
        # The speed that is expected is at least the difference of the other two.
        if size * dt > LARGEST_OFFSET * (abs(speed - size) + LEAST_SPEED):
            self.interrupt()
            error = self._error  # unknown: the next step must not be compared with this one
        change, before = error - back * self._error, back * self._change
        rate, last, first = 1.0 / dt, self._rate, self._rate_before
        # Of both steps: a stamp that is off makes one too short and the other too long.
        way = speed * dt
        speed = (self._way + way) / (self._duration + dt)
        self._way, self._duration = way, dt
        self._error, self._change = error, change
        self._rate, self._rate_before = rate, last
        square = resolution * resolution
        if before == before:
            # Stamps between steps of these rates make this of it, times variance and speed^2.
            share = -last * (rate + 2.0 * last + first)
            gain = dt / (MEMORY + dt)
            self._period += gain * (dt - self._period) if self._period else dt
            self._covariance += gain * (
                (change * before.conjugate()).real / share - self._covariance)
            self._square_speed += gain * (speed * speed - self._square_speed)
            excess = self._covariance - 0.25 * square
            self.variance = 0.0 if excess <= 0.0 else excess / (
                self._square_speed + LEAST_SPEED * LEAST_SPEED)
        # Both ends of a step count: two stamps, and two roundings with a variance of 1/12.
        rounding = resolution * rate / math.sqrt(6.0)
        if not self.variance:
            self.scatter = 0.0
            return rounding
        self.scatter = math.sqrt(2.0 * self.variance) * speed * rate
        return math.hypot(self.scatter, rounding)
