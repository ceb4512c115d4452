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

"""How far from the prediction wheels are believed: in a step, and in the mean of many."""

import math

from swerve_kinematics.core.odometry.stamp_jitter import StampJitter

# A wheel is believed within this of the prediction: unsteady creep and encoders [m/s], radius
# and direction (a part of the speed), and so many standard deviations of the prediction itself
# and of what jitter of the stamps and the encoders' last bit make of the wheels' velocity.
GATE_SPEED = 0.05
GATE_RATIO = 0.02
GATE_STDS = 3.0
# Whoever measures where the accelerometer is may be off by so much [m], as a rule by less than
# twice that: in a base that turns, its place moves unlike that of which the wheels tell.
PLACE_STD = 0.005


class Gate:
    """
    How far off the velocity of the wheels may be while they grip.

    Attributes
    ----------
    stamps : StampJitter
        By how much their stamps scatter.
    offset : complex
        Velocity by the wheels less the expected one in the step [m/s].
    jitter : float
        Standard deviation of what the timing and the encoders make of a step's velocity [m/s].
    calm : float
        The same of the mean of many steps [m/s].
    share : float
        Of a step in that mean.

    """

    def __init__(self) -> None:
        """Start with stamps that are right."""
        self.forget_stamps()
        self.offset, self.jitter, self.calm, self._own = 0j, 0.0, 0.0, 0.0
        self.share = 1.0

    def forget_stamps(self) -> None:
        """Take stamps for right."""
        self.stamps = StampJitter()

    def take_step(self, dt: float, back: complex, offset: complex, wheels: float,
                  predicted: float, rate: float, unseen: float, resolution: float) -> None:
        """
        Find out how far off the wheels may be in a step.

        Parameters
        ----------
        dt : float
            Its duration [s].
        back : complex
            What turns a vector of the step before into base axes, which have turned since.
        offset : complex
            Velocity by the wheels less the expected one [m/s].
        wheels, predicted : float
            Speed by the wheels and by the accelerometer [m/s].
        rate : float
            Of the base's turn [rad/s].
        unseen : float
            What a force that changed in a long step may hide of the velocity [m/s].
        resolution : float
            Of the encoders [m].

        """
        stamps = self.stamps
        if unseen:
            stamps.interrupt()
        self.offset = offset
        self.jitter = math.hypot(unseen, stamps.std(dt, back, offset, wheels, resolution))
        self._own = math.hypot(own_error(predicted), GATE_STDS * PLACE_STD * rate)
        # In a mean of many steps, errors of stamps cancel but for the first and the last one.
        # So much counts each in one that they leave no worse than wheels are of themselves.
        self.share = self._own / (self._own + stamps.scatter)
        self.calm = self.share * self.jitter

    def width(self, jitter: float, std: float = 0.0) -> float:
        """
        Return how far off wheels may be [m/s].

        With jitter that makes so much of it, and a prediction with this standard deviation.
        """
        return math.hypot(self._own, GATE_STDS * jitter) + GATE_STDS * std


def own_error(speed: float) -> float:
    """Return how far off wheels may be of themselves at a speed [m/s]."""
    return GATE_SPEED + GATE_RATIO * speed
