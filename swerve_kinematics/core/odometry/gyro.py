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

"""How far the rate of a gyro is off, and when the base is at rest to tell."""

from collections.abc import Sequence
import math

import numpy as np

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.geometry.clamping import clamped

# A step faster than the widest range of MEMS gyros (2000 deg/s) is a sensor that was zeroed
# or restarted, not a turn.
MAX_YAW_RATE = math.radians(2000.0)

# At rest for this long [s] without a module moving by more than this [m], [rad]: 1 mm/s, and
# beyond what the last bit of a 12-bit encoder on a 50 mm wheel flickers (0.08 mm, 1.5 mrad).
# Steering counts too, for a wheel that turns on the spot twists the base a little.
REST_TIME = 0.2
REST_DISTANCE = 0.2e-3
REST_STEERING = 0.03

# Innovations beyond this many standard deviations are clipped: a rate that the model does
# not expect moves the bias a little, not all the way.
CLIP = 3.0


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
        if not (0.0 <= initial_std < np.inf and 0.0 <= drift < np.inf):
            raise ValueError('initial_std and drift must be zero or more and finite, '
                             f'got {initial_std}, {drift}')
        self.bias = 0.0
        self.variance = initial_std ** 2
        self._drift = drift ** 2

    def predict(self, dt: float) -> None:
        """Let the bias wander for `dt` [s]."""
        self.variance += self._drift * dt

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
        innovation = clamped(rate_error - self.bias, limit)
        gain = self.variance / total
        self.bias += gain * innovation
        self.variance *= 1.0 - gain
        return gain


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
        for distance, last in zip(distances, self._distances):
            if not abs(distance - last) <= REST_DISTANCE:
                return True
        for angle, last in zip(angles, self._angles):
            if not abs(math.remainder(angle - last, TURN)) <= REST_STEERING:
                return True
        return len(self._distances) == 0
