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
What the floor can hold: the horizontal acceleration of every wheel contact.

Seen from the world, a contact at r moves with u = v + i omega r, turned by the heading. Its
acceleration is `(u1 exp(i omega dt) - u0) / dt` from one period to the next: what changes the
speed, what turns with the base (centripetal), and what an angular acceleration adds, in one.
"""

import cmath
import math

from swerve_kinematics.core.control.limits import ratio
from swerve_kinematics.core.geometry.planar import (
    between, fastest, module_velocities, PlanarTwist, scaled)

# The part of the grip that a steady curve may take. What is left lets the base slow down on it,
# with all steering angles held.
STEADY_PART = 0.9
# The part that a change may take, besides; the rest is for what a period leaves out.
CHANGING_PART = 0.95
# The part that is left to slow down with on the tightest steady curve. On a tighter one, for which
# the limit was lowered, wheels slide anyway, and the base takes as much to get out of it.
LEAST_PART = math.sqrt(CHANGING_PART ** 2 - STEADY_PART ** 2)


def steady_scale(twist: PlanarTwist, offsets: list[complex], max_acceleration: float) -> float:
    """
    Return the largest factor, at most 1, on a twist whose curve the floor can hold.

    The centripetal acceleration `omega |u|` falls with the square of the factor.

    Parameters
    ----------
    twist : PlanarTwist
        Of the centre of rotation, in the base frame.
    offsets : list of complex
        Module positions from the centre of rotation [m].
    max_acceleration : float
        What the floor can hold [m/s^2].

    """
    pull = abs(twist.omega) * fastest(twist, offsets)
    return min(1.0, math.sqrt(ratio(STEADY_PART * max_acceleration, pull)))


def gripping(goal: PlanarTwist, start: PlanarTwist, previous: PlanarTwist,
             offsets: list[complex], max_acceleration: float, dt: float) -> PlanarTwist:
    """
    Return the twist nearest to the goal that the floor can hold.

    Parameters
    ----------
    goal : PlanarTwist
        Where to go in this period.
    start : PlanarTwist
        Where the change begins: `previous`, or that turned back by a part of the base's turn.
    previous : PlanarTwist
        What the base did in the last period.
    offsets : list of complex
        Module positions from the centre of rotation [m].
    max_acceleration : float
        What the floor can hold [m/s^2].
    dt : float
        Positive [s].

    """
    goal = scaled(goal, steady_scale(goal, offsets, max_acceleration))
    turn, grip, fraction = cmath.rect(1.0, previous.omega * dt), max_acceleration * dt, 1.0
    for was, begin, end in zip(
            module_velocities(previous, offsets), module_velocities(start, offsets),
            module_velocities(goal, offsets)):
        offset = turn * begin - was
        fraction = min(fraction, _held_fraction(
            offset, turn * (end - begin), _room(abs(offset), grip)))
    return between(start, goal, fraction)


def _room(pull: float, grip: float) -> float:
    """Return what part of `grip` all may take, `pull` of which the curve takes already."""
    room = max(CHANGING_PART * grip, math.hypot(pull, LEAST_PART * grip))
    return min(room, grip) if pull < grip else room


def _held_fraction(offset: complex, change: complex, room: float) -> float:
    """Return the largest f in [0, 1] with `|offset + f change| <= room`, or the best there is."""
    if abs(offset + change) <= room:
        return 1.0
    square, along = abs(change) ** 2, (offset.conjugate() * change).real
    if square == 0.0:
        return 1.0
    discriminant = along * along - square * (abs(offset) ** 2 - room * room)
    root = math.sqrt(discriminant) if discriminant > 0.0 else 0.0
    return max(0.0, min(1.0, (root - along) / square))


def slowest_factor(twist: PlanarTwist, offsets: list[complex], max_acceleration: float,
                   dt: float) -> float:
    """
    Return the least factor on a twist, in one period with all angles held, that the floor holds.

    From `|f exp(i omega dt) - 1| |u| <= room`, where the curve is not too tight already.

    Parameters
    ----------
    twist : PlanarTwist
        What the base does.
    offsets : list of complex
        Module positions from the centre of rotation [m].
    max_acceleration : float
        What the floor can hold [m/s^2].
    dt : float
        Positive [s].

    """
    if max_acceleration == math.inf:
        return -math.inf
    turn = twist.omega * dt
    grip = ratio(max_acceleration * dt, fastest(twist, offsets))
    pull = abs(math.sin(turn))
    room = _room(pull, grip)
    return math.cos(turn) - math.sqrt(room * room - pull * pull)
