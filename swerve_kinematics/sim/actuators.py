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

"""The motors of the simulated base: joints with a lag, a greatest speed and acceleration."""

from dataclasses import dataclass
from math import copysign, sqrt


@dataclass(frozen=True)
class Actuator:
    """
    First-order lag of a joint, and its limits.

    Attributes
    ----------
    time_constant : float
        Time [s] in which 63 % of a small change of the command is done.
    max_speed : float
        Greatest joint speed [rad/s].
    max_acceleration : float
        Greatest change of the joint speed [rad/s^2].

    """

    time_constant: float
    max_speed: float
    max_acceleration: float


def limited_speed(actuator: Actuator, speed: float, target: float, dt: float) -> float:
    """
    Return the joint speed after `dt` of going from `speed` to `target`.

    Parameters
    ----------
    actuator : Actuator
        Gives the greatest speed and acceleration.
    speed, target : float
        [rad/s].
    dt : float
        [s].

    Returns
    -------
    float
        `target` limited to the greatest speed, and the change to the greatest acceleration.

    """
    reach = actuator.max_acceleration * dt
    target = max(-actuator.max_speed, min(target, actuator.max_speed))
    return speed + max(-reach, min(target - speed, reach))


def approach_speed(actuator: Actuator, distance: float) -> float:
    """
    Return the speed at which a joint can close in on a target without running past it.

    Proportional to the distance while that brakes gently enough: `d / tau`. Farther off, the
    speed from which constant braking ends in that law: `sqrt(2 a (d - a tau^2 / 2))`. Both
    parts and their slopes meet at `d = a tau^2`.

    Parameters
    ----------
    actuator : Actuator
        Its time constant is tau, its greatest acceleration a.
    distance : float
        What is left to go [rad].

    Returns
    -------
    float
        [rad/s], with the sign of `distance`, not limited to the actuator's speed.

    """
    tau, braking = actuator.time_constant, actuator.max_acceleration
    knee = braking * tau ** 2
    if abs(distance) <= knee:
        return distance / tau
    return copysign(sqrt(2.0 * braking * (abs(distance) - 0.5 * knee)), distance)
