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

"""The velocity of an accelerometer, its bias and the lean of the floor: a Kalman filter."""

import cmath
import math

# What an accelerometer and a floor are like. A data sheet's 100 ug/sqrt(Hz) would be 0.001
# m/s/sqrt(s); a wheeled base shakes more than its sensor hisses.
VIBRATION = 0.02  # [m/s/sqrt(s)]
# Offset of a MEMS accelerometer (up to 0.2 m/s^2), and one degree of mounting, or two.
BIAS_STD, BIAS_DRIFT = 0.3, 0.002  # [m/s^2], [m/s^2/sqrt(s)]
# 2.3 degrees: buildings' floors slope by up to 2 %, and a base sits askew on soft tyres. The
# drift holds at rest and is twice that at 1 m/s: floors change as one drives. Where gyros
# follow the lean, it drifts as they do: 0.01 deg/s of offset left, 0.02 deg/sqrt(s) of noise and
# the bouncing of the base make 0.02 at most.
LEAN_STD, LEAN_DRIFT = 0.4, 0.03  # [m/s^2], [m/s^2/sqrt(s)]
FOLLOWED_DRIFT = 0.02  # [m/s^2/sqrt(s)]


class VelocityFilter:
    """
    Kalman filter of a velocity that an accelerometer moves on and wheels correct.

    Vectors are complex numbers, x + iy in the base frame. The three states are of the same
    kind in x and y, so each has one variance (of x, and of y), and two of them have one
    complex covariance `E[a b*]`.

    Attributes
    ----------
    velocity : complex
        Of the sensor's place, mean over the last step [m/s].
    bias : complex
        What the sensor shows too much because it is off or mounted askew [m/s^2]: fixed to
        the base.
    lean : complex
        Gravity that leaks in because the floor leans [m/s^2]: fixed to the floor, so that it
        turns back as the base turns.
    variance : float
        Of the velocity, in x and in y [m^2/s^2].
    change : float
        By how much the last prediction changed the velocity, as a rate [m/s^2].
    way_error : complex
        How much further than predicted [m] the base has coasted, as corrections of the
        velocity have told since this was last set to 0.

    """

    def __init__(self) -> None:
        """Start with nothing known but what such sensors and floors are like."""
        self.velocity = self.bias = self.lean = 0j
        self.variance = self.change = 0.0
        self._bias_variance, self._lean_variance = BIAS_STD ** 2, LEAN_STD ** 2
        self._with_bias = self._with_lean = self._bias_with_lean = 0j
        # Covariances of the way that the base has coasted with the three states.
        self.way_error = self._way_velocity = self._way_bias = self._way_lean = 0j

    @property
    def force_std(self) -> float:
        """Return by how much bias and lean may mislead the force, in x and in y [m/s^2]."""
        return math.sqrt(self._bias_variance + self._lean_variance)

    def restart(self, velocity: complex, variance: float) -> None:
        """Take over a velocity [m/s] whose past is unknown, and its variance."""
        self.velocity, self.variance = velocity, variance
        self._with_bias = self._with_lean = 0j
        self._way_velocity = self._way_bias = self._way_lean = 0j

    def forget_lean(self) -> None:
        """Allow for any ordinary floor, after motion that nobody saw."""
        self.lean = self._with_lean = self._bias_with_lean = 0j
        self._lean_variance = LEAN_STD ** 2

    def predict(self, interval: float, turn: float, gained: complex,
                tilted: complex | None) -> None:
        """
        Move on to the next step.

        Parameters
        ----------
        interval : float
            Between the middles of the two steps [s].
        turn : float
            Of the base between them [rad]: under a velocity, which stays in the world.
        gained : complex
            Velocity by the sensor's force alone [m/s], seen from the new heading.
        tilted : complex or None
            Change of the lean by the rates about x and y [m/s^2], None where they are unknown.

        """
        h, back = interval, cmath.rect(1.0, -turn)
        forth = back.conjugate()
        before, lean = back * self.velocity, back * self.lean
        self.lean = lean if tilted is None else lean + tilted
        change = gained - h * (self.bias + 0.5 * (lean + self.lean))
        self.velocity = before + change
        self.change = abs(change) / h
        if self._way_velocity:
            self._way_velocity -= h * (back * self._way_bias + self._way_lean)
            self._way_bias *= back
        # P <- F P F' + Q with F = [[back, -h, -h back], [0, 1, 0], [0, 0, back]].
        with_bias = (back * (self._with_bias - h * self._bias_with_lean.conjugate())
                     - h * self._bias_variance)
        with_lean = (self._with_lean - h * self._lean_variance
                     - h * forth * self._bias_with_lean)
        self.variance += VIBRATION * VIBRATION * h - h * (
            back * self._with_bias + self._with_lean + with_bias + with_lean).real
        self._with_bias, self._with_lean = with_bias, with_lean
        self._bias_with_lean *= forth
        self._bias_variance += BIAS_DRIFT * BIAS_DRIFT * h
        drift = LEAN_DRIFT * (1.0 + abs(self.velocity)) if tilted is None else FOLLOWED_DRIFT
        self._lean_variance += drift * drift * h

    def coast(self, dt: float) -> None:
        """Take in that the base has moved on with the predicted velocity for `dt` [s]."""
        self._way_velocity += dt * self.variance
        self._way_bias += dt * self._with_bias
        self._way_lean += dt * self._with_lean

    def correct(self, innovation: complex, variance: float) -> None:
        """
        Take in a velocity by the wheels.

        Parameters
        ----------
        innovation : complex
            That velocity less the predicted one [m/s].
        variance : float
            Of that velocity, in x and in y [m^2/s^2].

        """
        total = self.variance + variance
        gain = self.variance / total
        with_bias, with_lean = self._with_bias, self._with_lean
        if self._way_velocity:
            self._correct_way(innovation, total)
        self.velocity += gain * innovation
        bias_gain, lean_gain = with_bias.conjugate() / total, with_lean.conjugate() / total
        self.bias += bias_gain * innovation
        self.lean += lean_gain * innovation
        self._bias_with_lean -= bias_gain * with_lean
        self._bias_variance -= (bias_gain * with_bias).real
        self._lean_variance -= (lean_gain * with_lean).real
        kept = variance / total
        self.variance *= kept
        self._with_bias *= kept
        self._with_lean *= kept

    def _correct_way(self, innovation: complex, total: float) -> None:
        """Take in what a velocity of this innovation and its variance tells of the way."""
        gain = self._way_velocity / total
        self.way_error += gain * innovation
        self._way_velocity -= gain * self.variance
        self._way_bias -= gain * self._with_bias
        self._way_lean -= gain * self._with_lean
