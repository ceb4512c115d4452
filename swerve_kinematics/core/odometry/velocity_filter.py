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

"""The velocity of an accelerometer, what misleads it, and the creep of tyres: a Kalman filter."""

import math

# What an accelerometer and a floor are like. A data sheet's 100 ug/sqrt(Hz) would be 0.001
# m/s/sqrt(s); a wheeled base shakes more than its sensor hisses.
VIBRATION = 0.02  # [m/s/sqrt(s)]
# Offset of a MEMS accelerometer (up to 0.2 m/s^2), and one degree of mounting, or two.
BIAS_STD, BIAS_DRIFT = 0.3, 0.002  # [m/s^2], [m/s^2/sqrt(s)]
# 2.3 degrees: buildings' floors slope by up to 2 %, and a base sits askew on soft tyres. The
# drift holds at rest and is twice that at 1 m/s: floors change as one drives, as a rule by half a
# degree within a second. Where gyros follow the lean, it drifts as they do: 0.01 deg/s of offset
# left, 0.02 deg/sqrt(s) of noise and the bouncing of the base make 0.02 at most.
LEAN_STD, LEAN_DRIFT = 0.4, 0.05  # [m/s^2], [m/s^2/sqrt(s)]
FOLLOWED_DRIFT = 0.02  # [m/s^2/sqrt(s)]
# A tyre that carries a force creeps: wheels run ahead of the base by this time [s] multiplied by
# its acceleration, and encoders that are read late lag behind it likewise. 10 ms are 3 cm/s at
# 3 m/s^2; rubber with a slip stiffness of 15 times its load gives 2 cm/s there, at 1 m/s. The
# drift, 5 ms in 100 m, allows for the next floor.
CREEP_STD, LARGEST_CREEP = 0.015, 0.05  # [s]
CREEP_DRIFT = 0.0005  # [s/sqrt(m)]
# A sensor that is mounted askew by three degrees shows this part of every force to the side.
MOUNTING = 0.05
# A base that coasted and ends up further off than so many standard deviations was pushed, or
# believed the wrong wheels at the start: bias and lean are not all there is to it.
LARGEST_STDS = 4.0


class VelocityFilter:
    """
    Kalman filter of a velocity that an accelerometer moves on and wheels correct.

    Vectors are complex numbers, x + iy in the base frame. The states are of the same kind in x
    and y, so each has one variance (of x, and of y), and two of them have one complex
    covariance `E[a b*]`. What wheels measure is `velocity + creep * acceleration`.

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
    creep : float
        By how much the wheels run ahead of the base, per acceleration [s]: what the tyres give
        way by, less the delay of the encoders. A real number: tyres give way along the force.
    acceleration : complex
        Of the sensor's place, by the last prediction [m/s^2].
    variance : float
        Of the velocity, in x and in y [m^2/s^2].
    wheel_velocity, wheel_variance : complex, float
        What the last prediction expects the wheels to measure, before their own errors.
    way_error : complex
        How much further than predicted [m] the base has coasted, as corrections of the
        velocity have told since this was last set to 0.

    """

    def __init__(self) -> None:
        """Start with nothing known but what such sensors and floors are like."""
        self.velocity = self.bias = self.lean = 0j
        self.acceleration = self.wheel_velocity = 0j
        self.creep = self.variance = self.wheel_variance = 0.0
        self._bias_variance, self._lean_variance = BIAS_STD ** 2, LEAN_STD ** 2
        self._creep_variance = CREEP_STD ** 2
        self._with_bias = self._with_lean = self._bias_with_lean = 0j
        self._with_creep = self._creep_with_bias = self._creep_with_lean = 0j
        self.way_error = 0j
        self.forget_way()

    def forget_way(self) -> None:
        """Begin a new way, of which nothing is wrong yet."""
        # Its covariances with the states.
        self._way_velocity = self._way_bias = self._way_lean = self._way_creep = 0j

    @property
    def force_std(self) -> float:
        """Return by how much bias, lean and mounting may mislead the force, in x and y [m/s^2]."""
        # A rest tells their sum, long before a turn tells the one from the other.
        askew = MOUNTING * abs(self.acceleration)
        return math.sqrt(self._bias_variance + self._lean_variance
                         + 2.0 * self._bias_with_lean.real + askew * askew)

    @property
    def known_creep(self) -> float:
        """
        Return the part of the creep [s] that is beyond doubt.

        The further the estimate exceeds its own standard deviation, the more of it counts. Thus
        wheels that do not creep stay exact.
        """
        square = self.creep * self.creep
        return self.creep * square / (square + self._creep_variance)

    def restart(self, velocity: complex, variance: float, acceleration: complex = 0j) -> None:
        """Take over a velocity by the wheels [m/s] whose past is unknown, and its variance."""
        self.velocity = velocity - self.creep * acceleration
        self.variance = variance + abs(acceleration) ** 2 * self._creep_variance
        self.acceleration = acceleration
        self._with_bias = self._with_lean = self._with_creep = 0j
        self.forget_way()
        self._expect_wheels()

    def forget_lean(self) -> None:
        """Allow for any ordinary floor, after motion that nobody saw."""
        self.lean = self._with_lean = self._bias_with_lean = self._creep_with_lean = 0j
        self._lean_variance = LEAN_STD ** 2

    def forget_bias(self) -> None:
        """Allow for any ordinary sensor, after it has misled the base."""
        self.bias = self._with_bias = self._bias_with_lean = self._creep_with_bias = 0j
        self._bias_variance = BIAS_STD ** 2

    def predict(self, interval: float, back: complex, gained: complex,
                tilted: complex | None) -> None:
        """
        Move on to the next step.

        Parameters
        ----------
        interval : float
            Between the middles of the two steps [s].
        back : complex
            What turns a vector of the last step into base axes: the base has turned under it.
        gained : complex
            Velocity by the sensor's force alone [m/s], seen from the new heading.
        tilted : complex or None
            Change of the lean by the rates about x and y [m/s^2], None where they are unknown.

        """
        h, forth = interval, back.conjugate()
        before, lean = back * self.velocity, back * self.lean
        self.lean = lean if tilted is None else lean + tilted
        change = gained - h * (self.bias + 0.5 * (lean + self.lean))
        self.velocity, self.acceleration = before + change, change / h
        if self._way_velocity:
            self._way_velocity -= h * (back * self._way_bias + self._way_lean)
            self._way_bias *= back
            self._way_creep *= back
        # P <- F P F' + Q with F = [[back, -h, -h back, 0], [0, 1, 0, 0], [0, 0, back, 0], ...].
        with_bias = (back * (self._with_bias - h * self._bias_with_lean.conjugate())
                     - h * self._bias_variance)
        with_lean = (self._with_lean - h * self._lean_variance
                     - h * forth * self._bias_with_lean)
        self._creep_with_lean *= forth
        self._with_creep = (back * self._with_creep
                            - h * (self._creep_with_bias + self._creep_with_lean).conjugate())
        self.variance += VIBRATION * VIBRATION * h - h * (
            back * self._with_bias + self._with_lean + with_bias + with_lean).real
        self._with_bias, self._with_lean = with_bias, with_lean
        self._bias_with_lean *= forth
        self._bias_variance += BIAS_DRIFT * BIAS_DRIFT * h
        speed = abs(self.velocity)
        drift = LEAN_DRIFT * (1.0 + speed) if tilted is None else FOLLOWED_DRIFT
        self._lean_variance += drift * drift * h
        self._creep_variance += CREEP_DRIFT * CREEP_DRIFT * (speed * h)
        self._expect_wheels()

    def _expect_wheels(self) -> None:
        """Predict what the wheels measure: H P H' with H = [1, 0, 0, acceleration]."""
        rate = self.acceleration
        self.wheel_velocity = self.velocity + self.creep * rate
        self.wheel_variance = self.variance + (
            rate.conjugate() * (2.0 * self._with_creep + rate * self._creep_variance)).real

    def coast(self, dt: float) -> None:
        """Take in that the base has moved on with the predicted velocity for `dt` [s]."""
        self._way_velocity += dt * self.variance
        self._way_bias += dt * self._with_bias
        self._way_lean += dt * self._with_lean
        self._way_creep += dt * self._with_creep

    def correct(self, innovation: complex, variance: float) -> None:
        """
        Take in a velocity by the wheels.

        Parameters
        ----------
        innovation : complex
            That velocity less the expected one [m/s].
        variance : float
            Of that velocity, in x and in y [m^2/s^2].

        """
        # Covariances of what the wheels measure with the states, H P, and the gains.
        rate = self.acceleration
        velocity = self.variance + rate * self._with_creep.conjugate()
        bias = self._with_bias + rate * self._creep_with_bias
        lean = self._with_lean + rate * self._creep_with_lean
        creep = self._with_creep + rate * self._creep_variance
        precision = 1.0 / (self.wheel_variance + variance)
        velocity_gain, bias_gain = precision * velocity.conjugate(), precision * bias.conjugate()
        lean_gain, creep_gain = precision * lean.conjugate(), precision * creep.conjugate()
        if self._way_velocity:
            self._correct_way(innovation, precision, velocity, bias, lean, creep)
        self.velocity += velocity_gain * innovation
        self.bias += bias_gain * innovation
        self.lean += lean_gain * innovation
        self.creep += (creep_gain * innovation).real
        if abs(self.creep) > LARGEST_CREEP:
            self.creep = math.copysign(LARGEST_CREEP, self.creep)
        self.variance -= (velocity_gain * velocity).real
        self._with_bias -= velocity_gain * bias
        self._with_lean -= velocity_gain * lean
        self._with_creep -= velocity_gain * creep
        self._bias_variance -= (bias_gain * bias).real
        self._bias_with_lean -= bias_gain * lean
        self._lean_variance -= (lean_gain * lean).real
        self._creep_with_bias -= creep_gain * bias
        self._creep_with_lean -= creep_gain * lean
        self._creep_variance -= (creep_gain * creep).real

    def reconcile(self, innovation: complex, variance: float) -> None:
        """
        Take in a velocity by wheels that have come back, for a `restart` with it.

        All of an innovation belongs to the way that was coasted. From one that is too large to be
        theirs, bias, lean and creep learn less: as if it was uncertain accordingly.

        Parameters
        ----------
        innovation : complex
            That velocity less the expected one [m/s].
        variance : float
            Of that velocity, in x and in y [m^2/s^2].

        """
        self.way_error += self._way_gain(1.0 / (self.wheel_variance + variance)) * innovation
        self.forget_way()
        total = abs(innovation) ** 2 / LARGEST_STDS ** 2
        self.correct(innovation, max(variance, total - self.wheel_variance))

    def _way_gain(self, precision: float) -> complex:
        """Return how much of an innovation belongs to the way, at the precision of both [s]."""
        return precision * (self._way_velocity + self.acceleration.conjugate() * self._way_creep)

    def _correct_way(self, innovation: complex, precision: float, velocity: complex,
                     bias: complex, lean: complex, creep: complex) -> None:
        """Take in what a velocity by the wheels tells of the way, as `correct` does."""
        gain = self._way_gain(precision)
        self.way_error += gain * innovation
        self._way_velocity -= gain * velocity
        self._way_bias -= gain * bias
        self._way_lean -= gain * lean
        self._way_creep -= gain * creep
