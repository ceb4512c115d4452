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
that follows, for they are convex and the way there is straight.
"""

from swerve_kinematics.core.control.limits import ControllerLimits, ratio
from swerve_kinematics.core.geometry.planar import (
    between, difference, fastest, PlanarTwist, rate_between, scaled, straightened)

# Rounds of halving in the search for an acceleration from which the base can coast: a sixty-fourth
# of the range is left.
HALVINGS = 6
# By this part a speed limit may be exceeded: a factor that brings a twist within it is rounded.
TOLERANCE = 1e-9
# More periods than these, hours, need not be told apart.
MOST_PERIODS = 10 ** 6


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
    if _can_coast(wanted, rate, offsets, limits, dt):
        return wanted
    # The acceleration that ends in the shortest time leads to the very coasting speed as before.
    safe = scaled(acceleration, 1.0 - min(1.0, ratio(
        dt, _time_to_change(acceleration, limits))))
    if not _can_coast(_moved(previous, safe, dt), safe, offsets, limits, dt):
        return wanted  # a speed limit was lowered
    for _ in range(HALVINGS):
        middle = between(safe, rate, 0.5)
        if _can_coast(_moved(previous, middle, dt), middle, offsets, limits, dt):
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


def _coasting_time(periods: float) -> float:
    """Return how many periods of an acceleration are left that ends in so many, step by step."""
    steps = min(int(periods), MOST_PERIODS)
    return steps - 0.5 * steps * (steps + 1) / periods if steps else 0.0


def _can_coast(twist: PlanarTwist, rate: PlanarTwist, offsets: list[complex],
               limits: ControllerLimits, dt: float) -> bool:
    """Tell whether the acceleration can end before a speed limit is exceeded."""
    coasting = _moved(twist, rate, _coasting_time(_time_to_change(rate, limits) / dt) * dt)
    return (abs(coasting.velocity) <= limits.max_linear_speed * (1.0 + TOLERANCE)
            and abs(coasting.omega) <= limits.max_angular_speed * (1.0 + TOLERANCE)
            and fastest(straightened(coasting, dt), offsets)
            <= limits.max_module_speed * (1.0 + TOLERANCE))
