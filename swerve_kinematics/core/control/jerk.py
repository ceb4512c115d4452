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

"""
How the acceleration itself may change, whatever is wanted all of a sudden.

An acceleration cannot end at once, so a base that accelerates is bound to go on to the speed at
which it could end: the coasting speed. As long as that is within the speed limits, so is all
that follows, however long its periods are: the limits are convex, and the way there is straight.
"""

from collections.abc import Sequence

from swerve_kinematics.core.control.limits import ControllerLimits, ratio
from swerve_kinematics.core.geometry.planar import (
    between, difference, fastest, PlanarTwist, rate_between, REST, scaled, straightened)

# Rounds of halving in the search for an acceleration from which the base can coast: a sixty-fourth
# of the range is left.
HALVINGS = 6
# The part of a speed limit that may be used: factors that bring a twist down to it are rounded.
FULL_LOAD = 1.0 + 1e-9
# A larger part comes neither from rounding nor from the turn of the base.
OVERLOAD = 1.0 + 1e-6


def smoothed(wanted: PlanarTwist, previous: PlanarTwist, acceleration: PlanarTwist,
             offsets: list[complex], limits: ControllerLimits, dt: float) -> PlanarTwist:
    """
    Return the twist nearest to the wanted one that the jerk limits allow.

    Parameters
    ----------
    wanted, previous : PlanarTwist
        What the other limits allow for this period, and what the base did in the last one.
    acceleration : PlanarTwist
        Of the last period [m/s^2, rad/s^2].
    offsets : list of complex
        Module positions from the centre of rotation [m].
    limits : ControllerLimits
        Those of jerk and of speed count.
    dt : float
        Positive [s].

    Returns
    -------
    PlanarTwist

    """
    if not limits.has_jerk:
        return wanted
    rate = rate_between(previous, wanted, dt)
    change = difference(acceleration, rate)
    bend = ratio(dt, _time_to_change(change, limits))
    if bend < 1.0:
        rate = _bent(rate, acceleration, bend, limits, dt)
        wanted = _moved(previous, rate, dt)
    loads = _coasting_loads(wanted, rate, offsets, limits, dt)
    if max(loads) <= FULL_LOAD:
        return wanted
    # The acceleration that ends in the shortest time leads to no more than was bound to come.
    safe = scaled(acceleration, 1.0 - min(1.0, ratio(
        dt, _time_to_change(acceleration, limits))))
    bounds = _coasting_loads(_moved(previous, safe, dt), safe, offsets, limits, dt)
    if max(bounds[:2]) > OVERLOAD:
        # Too much: a limit was lowered. Those of speed count for more than those of jerk.
        safe = REST
        bounds = _coasting_loads(previous, safe, offsets, limits, dt)
    allowed = [max(FULL_LOAD, bound) for bound in bounds]
    if _are_within(allowed, loads):
        return wanted
    for _ in range(HALVINGS):
        middle = between(safe, rate, 0.5)
        if _are_within(allowed, _coasting_loads(
                _moved(previous, middle, dt), middle, offsets, limits, dt)):
            safe = middle
        else:
            rate = middle
    return _moved(previous, safe, dt)


def _bent(wanted: PlanarTwist, acceleration: PlanarTwist, bend: float,
          limits: ControllerLimits, dt: float) -> PlanarTwist:
    """Return the acceleration a fraction of the way to the wanted one, both parts alike."""
    rate = between(acceleration, wanted, bend)
    limit = limits.least_linear_acceleration
    if not abs(wanted.velocity) <= limit < abs(rate.velocity):
        return rate
    # Too much once the speed no longer falls, or no longer grows. The linear part then does not
    # wait for the angular one, and becomes smaller before it turns.
    step, present = limits.max_linear_jerk * dt, abs(acceleration.velocity)
    change = wanted.velocity - acceleration.velocity
    velocity = acceleration.velocity + min(1.0, ratio(step, abs(change))) * change
    if abs(velocity) > limit:
        velocity = acceleration.velocity * max(limit, present - step) / present
    return PlanarTwist(velocity, rate.omega)


def _moved(twist: PlanarTwist, rate: PlanarTwist, dt: float) -> PlanarTwist:
    """Return a twist after `dt` [s] of a constant rate of change."""
    return PlanarTwist(twist.velocity + rate.velocity * dt, twist.omega + rate.omega * dt)


def _time_to_change(acceleration: PlanarTwist, limits: ControllerLimits) -> float:
    """Return how long [s] the jerk limits take for a change of acceleration."""
    return max(ratio(abs(acceleration.velocity), limits.max_linear_jerk),
               ratio(abs(acceleration.omega), limits.max_angular_jerk))


def _coasting_loads(twist: PlanarTwist, rate: PlanarTwist, offsets: list[complex],
                    limits: ControllerLimits, dt: float) -> tuple[float, float, float]:
    """
    Return the coasting speed as a part of each speed limit: linear, angular and of the modules.

    The acceleration falls steadily here. In steps, whatever their length will be, the base gains
    less speed.
    """
    coasting = _moved(twist, rate, 0.5 * _time_to_change(rate, limits))
    return (abs(coasting.velocity) / limits.max_linear_speed,
            abs(coasting.omega) / limits.max_angular_speed,
            fastest(straightened(coasting, dt), offsets) / limits.max_module_speed)


def _are_within(bounds: Sequence[float], loads: Sequence[float]) -> bool:
    """Tell whether no load exceeds its bound."""
    return all(load <= bound for load, bound in zip(loads, bounds))
