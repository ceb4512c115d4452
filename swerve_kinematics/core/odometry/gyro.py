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

"""What any gyro is like, and how far the rate of this one is off."""

import math

# A step faster than the widest range of MEMS gyros (2000 deg/s) is a sensor that was zeroed
# or restarted, not a turn.
MAX_YAW_RATE = math.radians(2000.0)
# Stamps wander by a few milliseconds against what they are of, and where messages were held up,
# several have almost the same one: within this much time [s] more may move than is possible by
# the stamps. It is half a period at 50 Hz (judgement: in it a wheel at 10 m/s rolls 0.1 m, which
# no reset of an encoder is likely to stay within).
STAMP_JITTER = 0.01

# A rate below this [rad/s] may be the bias of an uncalibrated gyro: 6 deg/s.
LARGEST_BIAS = 0.1

# Innovations beyond this many standard deviations are clipped: a rate that the model does
# not expect moves the bias a little, not all the way.
CLIP = 3.0

# Gyro and base are compared over this time [s], two periods of the slowest gyro. One that is heard
# more rarely than the wheels is carried on with its rate, and makes up in one step for what that
# missed in many.
WINDOW = 0.2


def largest_turn(dt: float) -> float:
    """Return how far [rad] a base can turn, at the most, in a step of `dt` [s] by its stamps."""
    return MAX_YAW_RATE * max(dt, STAMP_JITTER)


class GyroBiasFilter:
    """
    Kalman filter with one state, the constant part of a gyro's rate error.

    Parameters
    ----------
    initial_std : float
        Standard deviation of the bias at the start, about 0 [rad/s].
    drift : float
        How the bias wanders: standard deviation after one second [rad/s], growing with the
        square root of time.

    Attributes
    ----------
    bias : float
        Estimate [rad/s], to be subtracted from the gyro's rate.
    variance : float
        Of the estimate [(rad/s)^2].

    Raises
    ------
    ValueError
        If a parameter is negative or not finite.

    """

    def __init__(self, initial_std: float = math.radians(1.0),
                 drift: float = math.radians(0.001)) -> None:
        """Start with no bias known."""
        if not (0.0 <= initial_std < math.inf and 0.0 <= drift < math.inf):
            raise ValueError('initial_std and drift must be zero or more and finite, '
                             f'got {initial_std}, {drift}')
        self.bias = 0.0
        self.variance = initial_std ** 2
        self._drift = drift ** 2
        # What the steps of late tell together: weight, weighted sum, and their time [s].
        self._weight = self._weighted = self._time = 0.0

    def predict(self, dt: float) -> None:
        """Let the bias wander for `dt` [s]."""
        self.variance += self._drift * dt

    def compare(self, dt: float, rate_error: float, variance: float) -> float:
        """
        Take in a step, and learn from it and those before it as soon as they are a window.

        Or as soon as they tell more than what is known so far.

        Parameters
        ----------
        dt : float
            Its duration [s].
        rate_error, variance : float
            As for `correct`.

        Returns
        -------
        float
            The gain, as of `correct`; 0 as long as nothing is learnt.

        """
        if not variance > 0.0:
            return self.correct(rate_error, variance)
        weight = 1.0 / variance
        self._weight += weight
        self._weighted += weight * rate_error
        self._time += dt
        is_enough = self._time >= WINDOW or self._weight * self.variance > 1.0
        return self.learn() if is_enough else 0.0

    def learn(self) -> float:
        """Learn from the steps that were taken in so far; return the gain, 0 if there are none."""
        weight, weighted = self._weight, self._weighted
        self._weight = self._weighted = self._time = 0.0
        return self.correct(weighted / weight, 1.0 / weight) if weight else 0.0

    def correct(self, rate_error: float, variance: float) -> float:
        """
        Take in one measurement of the bias.

        Parameters
        ----------
        rate_error : float
            Rate by the gyro less the true rate as known from elsewhere [rad/s]: 0 at rest,
            or the wheels'. Ignored when not finite.
        variance : float
            Of `rate_error` [(rad/s)^2].

        Returns
        -------
        float
            The gain: the share of the innovation that was accepted.

        """
        total = self.variance + variance
        if not (math.isfinite(rate_error) and 0.0 < total < math.inf):
            return 0.0
        limit = CLIP * math.sqrt(total)
        innovation = rate_error - self.bias
        if abs(innovation) > limit:
            innovation = math.copysign(limit, innovation)
        gain = self.variance / total
        self.bias += gain * innovation
        self.variance *= 1.0 - gain
        return gain
