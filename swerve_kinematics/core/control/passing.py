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
How a base gets past the twists at which one of its modules nearly stands.

On the straight way from one twist to another, a module whose velocity turns by more than a
quarter turn passes near rest. The nearer, the faster its direction turns over there, and the
base would have to wait for its steering. Passing exactly through rest it need not turn at all:
its drive reverses. So a base leads a module that could not turn in time through rest; and where
every module reverses, it comes to rest itself if that is sooner.
"""

import cmath
import math

from swerve_kinematics.core.control.limits import ControllerLimits, speed_scale
from swerve_kinematics.core.control.module_group import ModuleGroup
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.control.plan import Plan
from swerve_kinematics.core.geometry.angles import phase
from swerve_kinematics.core.geometry.planar import (
    difference, fastest, module_velocities, PlanarTwist, speed_at)

# A module that would have to turn this many times as fast as it can is led through rest: there
# the detour takes about as long as waiting for the module would.
LED_SWING = 2.5
# How far aside the detour may lead, as a part of the way that is left: it always leads nearer.
LARGEST_DETOUR = 0.7
# No velocity passes nearer to rest [m/s], for the sake of the arithmetic.
NEAREST = 1e-9


def passing(target: PlanarTwist, previous: PlanarTwist, offsets: Offsets,
            limits: ControllerLimits, dt: float) -> PlanarTwist:
    """
    Return the twist to make for in this period so that no module holds up the base.

    The velocity of the module that would hold it up most is led along a circle through rest:
    on it the direction of the module turns evenly. Seen from u on the way to w, the tangent is
    the straight way w - u, turned by the angle of -u / w. The target is moved to where the way
    of the module has that tangent, as little as possible.

    Parameters
    ----------
    target, previous : PlanarTwist
        Where the base is to go in the end, and what it did in the last period.
    offsets : Offsets
        Module positions from the centre of rotation [m].
    limits : ControllerLimits
        Those of the accelerations and of the steering rate count.
    dt : float
        Positive [s].

    Returns
    -------
    PlanarTwist
        `target` where no module needs to be led, and from rest, to rest and along a curve.

    """
    reversing = [
        (offset, velocity, goal) for offset, velocity, goal in zip(
            offsets, module_velocities(previous, offsets), module_velocities(target, offsets))
        if (velocity.conjugate() * goal).real < 0.0]
    if not reversing or limits.max_steering_rate == math.inf:
        return target
    change = difference(previous, target)
    time = _time_for(change, offsets, limits, dt)
    swings = [_swing(velocity, goal, time, limits) for _, velocity, goal in reversing]
    worst = max(swings)
    if time <= dt or worst <= LED_SWING:
        return target
    aim = _led_through_rest(target, offsets, *reversing[swings.index(worst)])
    aside, arm = difference(target, aim), _rms_arm(offsets)
    if (speed_at(aside, arm) > LARGEST_DETOUR * speed_at(change, arm)
            or speed_scale(aim, offsets, limits) < 1.0):
        return target
    return aim


def must_come_to_rest(modules: ModuleGroup, plan: Plan, target: PlanarTwist,
                      previous: PlanarTwist, measured: list[float], offsets: Offsets,
                      limits: ControllerLimits, dt: float) -> bool:
    """
    Tell whether the base must come to rest before the modules can go for their goals.

    So it must where one of them has to turn round within its range, the long way. And where all of
    them reverse, and waiting for them to swing about at a crawl would take longer: at rest they
    need only the shorter turn, or none.

    Parameters
    ----------
    modules : ModuleGroup
        What they were told before.
    plan : Plan
        Where they are to go in this period.
    target, previous : PlanarTwist
        Where the base is to go in the end, and what it did in the last period.
    measured : list of float
        Steering angles [rad].
    offsets : Offsets
        Module positions from the centre of rotation [m].
    limits : ControllerLimits
        Those of the accelerations and of the steering rate count.
    dt : float
        Positive [s].

    """
    if modules.passes_end_stop(plan, target, offsets, measured, limits, dt):
        return True
    if plan.is_near and plan.twist == target:
        return False
    return modules.reverses(target, offsets) and is_sooner_by_rest(
        target, previous, modules.turn_at_rest(target, offsets, measured), offsets, limits, dt)


def is_sooner_by_rest(target: PlanarTwist, previous: PlanarTwist, turn: float,
                      offsets: list[complex], limits: ControllerLimits, dt: float) -> bool:
    """
    Tell whether a base arrives sooner by coming to rest than by going straight to a twist.

    Parameters
    ----------
    target, previous : PlanarTwist
        Where the base is to go, and what it did in the last period.
    turn : float
        The greatest turn that a module needs at rest [rad].
    offsets : list of complex
        Module positions from the centre of rotation [m].
    limits : ControllerLimits
        Those of the accelerations and of the steering rate count.
    dt : float
        Positive [s].

    """
    change = difference(previous, target)
    straight = _time_for(change, offsets, limits, dt)
    swing = max(_swing(velocity, goal, straight, limits) for velocity, goal in zip(
        module_velocities(previous, offsets), module_velocities(target, offsets)))
    by_rest = (_time_for(previous, offsets, limits, dt) + _time_for(target, offsets, limits, dt)
               + turn / limits.max_steering_rate)
    return by_rest <= straight + _holdup(swing) / limits.max_steering_rate


def _time_for(change: PlanarTwist, offsets: list[complex], limits: ControllerLimits,
              dt: float) -> float:
    """Return about how long [s] a change of twist takes, at the least one period."""
    return max(dt, abs(change.velocity) / limits.least_linear_acceleration,
               abs(change.omega) / limits.max_angular_acceleration,
               fastest(change, offsets) / limits.max_module_acceleration)


def _swing(velocity: complex, goal: complex, time: float, limits: ControllerLimits) -> float:
    """Return how many times as fast as it can a module would have to turn, nearest to rest."""
    product = velocity.conjugate() * goal
    if product.real >= 0.0:
        return 0.0  # it turns by a quarter turn at most
    size = abs(goal - velocity)
    nearest = max(abs(product.imag) / size, NEAREST)
    return size / (time * limits.max_steering_rate * nearest)


def _holdup(swing: float) -> float:
    """
    Return for how long a module holds up its base, times its steering rate.

    Along the straight way, s from the point nearest to rest, its direction turns as
    `swing / (1 + (s / nearest)^2)`. Where that is more than 1, the base has to go slower.
    """
    if swing <= 1.0:
        return 0.0
    end = math.sqrt(swing - 1.0)
    return 2.0 * (math.atan(end) - end / swing)


def _rms_arm(offsets: list[complex]) -> float:
    """Return the root mean square distance [m] of the modules from the centre of rotation."""
    return math.sqrt(sum(abs(offset) ** 2 for offset in offsets) / len(offsets))


def _led_through_rest(target: PlanarTwist, offsets: list[complex], offset: complex,
                      velocity: complex, goal: complex) -> PlanarTwist:
    """Return the twist nearest to the target towards which a module goes through rest."""
    change, bend = goal - velocity, phase(-velocity * goal.conjugate())
    across = 1j * cmath.rect(1.0, bend) * change / abs(change)
    spin = (across.conjugate() * 1j * offset).real
    square = _rms_arm(offsets) ** 2
    moved = abs(change) * math.sin(bend) / (square + spin * spin)
    return PlanarTwist(target.velocity + moved * square * across, target.omega + moved * spin)
