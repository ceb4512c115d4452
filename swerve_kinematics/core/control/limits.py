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

"""What a base may do, and the factor that keeps a twist within its limits of speed."""

import dataclasses
import functools
import math

from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.geometry.planar import (
    difference, fastest, PlanarTwist, scaled, straightened)

# Rounds of scaling and discretizing in turn. Each takes the misfit down by about half the
# turn of one period [rad] (0.02 at 2 rad/s and 50 Hz).
SATURATION_ROUNDS = 4
# Relative, of a sum that is compared with a limit.
ROUNDING = 1e-12
# A smaller limit allows no motion, and what is divided by it overflows.
SMALLEST = 1e-12


@dataclasses.dataclass(frozen=True)
class ControllerLimits:
    """
    Limits of the chassis and of its modules; infinity means no limit.

    Attributes
    ----------
    max_linear_speed : float
        Of the centre of rotation [m/s].
    max_angular_speed : float
        [rad/s].
    max_linear_acceleration, max_linear_deceleration : float
        Of the velocity vector [m/s^2], while its length grows and while it shrinks.
    max_angular_acceleration : float
        [rad/s^2], both ways.
    max_linear_jerk : float
        [m/s^3].
    max_angular_jerk : float
        [rad/s^3].
    max_module_speed : float
        Rim speed [m/s].
    max_module_acceleration : float
        Rate of the rim speed [m/s^2], both ways.
    max_steering_rate : float
        [rad/s].
    max_grip_acceleration : float
        What the floor can hold [m/s^2]: the horizontal acceleration of every wheel contact over
        the ground.
    min_steering_speed : float
        Rim speed [m/s] of a command, averaged over 0.1 s, for which wheels turn; 0 for any. A
        slower command moves wheels only that need not turn for it.

    Raises
    ------
    ValueError
        If a limit is not positive, below 1e-12 or NaN, or `min_steering_speed` is not finite.

    """

    max_linear_speed: float = math.inf
    max_angular_speed: float = math.inf
    max_linear_acceleration: float = math.inf
    max_linear_deceleration: float = math.inf
    max_angular_acceleration: float = math.inf
    max_linear_jerk: float = math.inf
    max_angular_jerk: float = math.inf
    max_module_speed: float = math.inf
    max_module_acceleration: float = math.inf
    max_steering_rate: float = math.inf
    max_grip_acceleration: float = math.inf
    min_steering_speed: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what cannot be a limit, and keep plain numbers."""
        for field in dataclasses.fields(self):
            value = float(getattr(self, field.name))
            if field.name == 'min_steering_speed':
                if not 0.0 <= value < math.inf:
                    raise ValueError(f'{field.name} must be zero or more, got {value}')
            elif not value >= SMALLEST:
                raise ValueError(f'{field.name} must be positive (inf: no limit), and no less '
                                 f'than {SMALLEST:g}, got {value}')
            object.__setattr__(self, field.name, value)

    @functools.cached_property
    def has_jerk(self) -> bool:
        """Tell whether a jerk limit is set."""
        return min(self.max_linear_jerk, self.max_angular_jerk) < math.inf

    @functools.cached_property
    def least_linear_acceleration(self) -> float:
        """Return the linear acceleration [m/s^2] that is allowed whichever way the speed goes."""
        return min(self.max_linear_acceleration, self.max_linear_deceleration)


def ratio(limit: float, value: float) -> float:
    """Return how often `value` >= 0 fits into `limit`: infinity for 0."""
    return limit / value if value > 0.0 else math.inf


def speed_scale(twist: PlanarTwist, offsets: Offsets, limits: ControllerLimits) -> float:
    """
    Return the largest factor, at most 1, that brings a twist within the speed limits.

    One factor for the linear and the angular part: a curve stays the same curve.

    Parameters
    ----------
    twist : PlanarTwist
        Of the centre of rotation, in the base frame.
    offsets : Offsets
        Module positions from the centre of rotation [m].
    limits : ControllerLimits
        Those of linear, angular and module speed count.

    """
    linear, angular = abs(twist.velocity), abs(twist.omega)
    if (linear <= limits.max_linear_speed and angular <= limits.max_angular_speed
            and _is_slow(twist, offsets, limits.max_module_speed)):
        return 1.0
    return min(1.0, ratio(limits.max_linear_speed, linear),
               ratio(limits.max_angular_speed, angular),
               ratio(limits.max_module_speed, fastest(twist, offsets)))


def _is_slow(twist: PlanarTwist, offsets: Offsets, max_module_speed: float) -> bool:
    """Tell at a glance whether no module can be too fast: none is faster than this sum."""
    speed = abs(twist.velocity) + abs(twist.omega) * offsets.reach
    return speed <= max_module_speed * (1.0 - ROUNDING)


def can_change(start: PlanarTwist, end: PlanarTwist, offsets: list[complex],
               limits: ControllerLimits, dt: float) -> bool:
    """Tell whether the limits of acceleration, not of jerk, allow a change within `dt` [s]."""
    return (abs(end.velocity - start.velocity) <= limits.least_linear_acceleration * dt
            and abs(end.omega - start.omega) <= limits.max_angular_acceleration * dt
            and (limits.max_module_acceleration == math.inf
                 or fastest(difference(start, end), offsets)
                 <= limits.max_module_acceleration * dt))


def saturated(twist: PlanarTwist, offsets: Offsets, max_module_speed: float,
              dt: float) -> tuple[PlanarTwist, float]:
    """
    Discretize a twist, and scale it until no module is too fast.

    The skew that `discretize` takes out grows with omega, so a scaled twist needs another
    one: scaling the discretized twist alone would leave the line that was commanded.

    Parameters
    ----------
    twist : PlanarTwist
        Of the centre of rotation, in the base frame, not yet discretized.
    offsets : Offsets
        Module positions from the centre of rotation [m].
    max_module_speed : float
        [m/s].
    dt : float
        Control period [s].

    Returns
    -------
    straight : PlanarTwist
        The scaled twist, discretized.
    scale : float
        In (0, 1]: the factor on `twist`.

    """
    straight, scale, excess = straightened(twist, dt), 1.0, math.inf
    if _is_slow(straight, offsets, max_module_speed):
        return straight, scale
    for _ in range(SATURATION_ROUNDS):
        straight = straightened(scaled(twist, scale), dt)
        excess = fastest(straight, offsets) / max_module_speed
        if excess <= 1.0:
            return straight, scale
        scale /= excess
    return scaled(straight, 1.0 / excess), scale
