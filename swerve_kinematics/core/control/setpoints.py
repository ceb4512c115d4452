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
From one module setpoint to the next: what steering and drives can do in one period.

Velocities are complex numbers x + iy in the base frame [m/s] (see `planar`). A set of modules
moves by one common fraction of the way from where it is to its goal: then the velocities in
between belong to a twist of the base too, and the wheels never fight each other.
"""

import cmath
from collections.abc import Sequence
import math
from typing import NamedTuple

from swerve_kinematics.core.geometry.angles import phase
from swerve_kinematics.core.geometry.clamping import clamped
from swerve_kinematics.core.kinematics.modules import FLIP_TOLERANCE
from swerve_kinematics.core.kinematics.swerve import MIN_SPEED

QUARTER_TURN = 0.5 * math.pi
# How fast a wheel may slide sideways [m/s] where its velocity turns over next to rest: so slow a
# wheel just reverses its drive instead of turning round, which would hold up the base.
SLIDING_SPEED = 0.01


class Setpoint(NamedTuple):
    """
    What one module is told.

    Attributes
    ----------
    speed : float
        Rim speed [m/s], negative where the drive is reversed.
    angle : float
        Steering angle [rad], multi-turn.

    """

    speed: float
    angle: float


def steering_fraction(start: complex, goal: complex, max_step: float) -> float:
    """
    Return the largest fraction of a velocity change that turns it by at most `max_step`.

    On the way `u + s (w - u)` the velocity has turned by the angle whose tangent is
    `s (u x w) / (u.u + s (u.w - u.u))`; set to `max_step` and solved for s. More than a
    quarter turn is never taken at once.

    Parameters
    ----------
    start, goal : complex
        Velocities u and w [m/s]; u must not be zero.
    max_step : float
        [rad].

    Returns
    -------
    float
        In [0, 1].

    """
    product = start.conjugate() * goal
    square = abs(start) ** 2
    needed, growth = abs(product.imag) * _cotangent(max_step), product.real - square
    return min(1.0, square / (needed - growth)) if needed > growth else 1.0


def _cotangent(angle: float) -> float:
    """Return 1 / tan(angle) up to a quarter turn, 0 beyond; a great number for 0."""
    # It stays finite when it is multiplied by the square of any speed.
    return 1.0 / max(math.tan(angle), 1e-150) if angle < QUARTER_TURN else 0.0


def drive_fraction(start: complex, goal: complex, max_step: float) -> float:
    """
    Return the largest fraction of a velocity change before its length changes too much.

    The first root of `|u + s (w - u)| = |u| +- max_step`, a quadratic in s.

    Parameters
    ----------
    start, goal : complex
        Velocities u and w [m/s].
    max_step : float
        Change of the rim speed [m/s], up or down.

    Returns
    -------
    float
        In [0, 1].

    """
    change = goal - start
    square = abs(change) ** 2
    if square == 0.0 or max_step == math.inf:
        return 1.0
    speed, along = abs(start), (start.conjugate() * change).real
    if along < 0.0 and speed > max_step:
        room = max_step * (2.0 * speed - max_step)
        discriminant = along * along - square * room
        if discriminant >= 0.0:
            return min(1.0, room / (math.sqrt(discriminant) - along))
    room = max_step * (2.0 * speed + max_step)
    root = math.sqrt(along * along + square * room)
    return min(1.0, room / (root + along) if along > 0.0 else (root - along) / square)


def at_rest(setpoint: Setpoint) -> bool:
    """Tell whether a module is too slow for its velocity to have a direction."""
    return abs(setpoint.speed) < MIN_SPEED


def within_reach(start: Sequence[Setpoint], goal: Sequence[Setpoint], steering_step: float,
                 drive_step: float) -> bool:
    """Tell whether every module can take its goal in this very period."""
    for (speed, angle), (goal_speed, goal_angle) in zip(start, goal):
        if not (abs(goal_angle - angle) <= steering_step
                and abs(goal_speed - speed) <= drive_step):
            return False
    return True


def common_fraction(start: Sequence[Setpoint], goal: Sequence[Setpoint], steering_step: float,
                    drive_step: float) -> float:
    """
    Return the largest common fraction of the way to the goal that every module can go.

    Parameters
    ----------
    start, goal : sequence of Setpoint
        What the modules were told before, and where they are to go, in module order.
    steering_step : float
        Change of a steering angle in one period [rad].
    drive_step : float
        Change of a rim speed in one period [m/s].

    Returns
    -------
    float
        In [0, 1]. It is 0 while a module at rest must turn before it may drive.

    """
    if within_reach(start, goal, steering_step, drive_step):
        return 1.0
    return min(_module_fraction(s, g, steering_step, drive_step) for s, g in zip(start, goal))


def _module_fraction(start: Setpoint, goal: Setpoint, steering_step: float,
                     drive_step: float) -> float:
    """Return the largest fraction that one module can go."""
    if goal.angle == start.angle:
        change = abs(goal.speed - start.speed)
        return min(1.0, drive_step / change) if change > 0.0 else 1.0
    if at_rest(start):
        if abs(goal.angle - start.angle) > steering_step:
            return 0.0
        return drive_fraction(0j, complex(goal.speed), drive_step)
    if _turns_over(start, goal, steering_step):
        return _turning_over_fraction(start, goal, steering_step, drive_step)
    u, w = cmath.rect(*start), cmath.rect(*goal)
    return min(steering_fraction(u, w, steering_step), drive_fraction(u, w, drive_step))


def _turns_over(start: Setpoint, goal: Setpoint, steering_step: float) -> bool:
    """Tell whether a module may pass by rest as if through it: its drive reverses."""
    if start.speed * goal.speed >= 0.0:
        return False
    turn = abs(goal.angle - start.angle)
    left = max(0.0, turn - steering_step)
    return max(left, turn - left) < QUARTER_TURN and SLIDING_SPEED >= max(
        abs(start.speed) * math.sin(turn - left), abs(goal.speed) * math.sin(left))


def _turning_over_fraction(start: Setpoint, goal: Setpoint, steering_step: float,
                           drive_step: float) -> float:
    """Return the fraction up to which the speed along the wheel changes by at most a step."""
    turn = abs(goal.angle - start.angle)
    left = max(0.0, turn - steering_step)
    before, kept = abs(start.speed), abs(start.speed) * math.cos(turn - left)
    room = drive_step - (before - kept)
    return max(0.0, min(1.0, room / (kept + abs(goal.speed) * math.cos(left))))


def next_setpoint(start: Setpoint, goal: Setpoint, fraction: float,
                  steering_step: float) -> Setpoint:
    """
    Return the setpoint of one module a fraction of the way to its goal.

    A module at rest turns towards its goal whatever the fraction; its drive does not move
    while the fraction is 0.

    Parameters
    ----------
    start, goal : Setpoint
        What the module was told before, and where it is to go.
    fraction : float
        In [0, 1], common to all modules.
    steering_step : float
        Change of the steering angle in one period [rad].

    Returns
    -------
    Setpoint

    """
    turn = goal.angle - start.angle
    if fraction == 1.0 and abs(turn) <= steering_step:
        return goal
    if turn == 0.0 or at_rest(start):
        return Setpoint(start.speed + fraction * (goal.speed - start.speed),
                        start.angle + clamped(turn, steering_step))
    u, w = cmath.rect(*start), cmath.rect(*goal)
    velocity = u + fraction * (w - u)
    if _turns_over(start, goal, steering_step):
        angle = start.angle + clamped(turn, steering_step)
        return Setpoint((velocity * cmath.rect(1.0, -angle)).real, angle)
    axis = cmath.rect(math.copysign(1.0, start.speed), start.angle)
    return _along_line(velocity / axis, start, steering_step)


def nearest_setpoint(start: Setpoint, goal: Setpoint, steering_step: float) -> Setpoint:
    """Return the setpoint nearest to a goal: what it asks along the wheel as far as it turns."""
    angle = start.angle + clamped(goal.angle - start.angle, steering_step)
    if angle == goal.angle:
        return goal
    return Setpoint(goal.speed * math.cos(goal.angle - angle), angle)


def _along_line(velocity: complex, start: Setpoint, steering_step: float) -> Setpoint:
    """Return the setpoint for a velocity given from the axis on which the module drives."""
    speed = math.copysign(abs(velocity), start.speed)
    if abs(speed) < MIN_SPEED:
        return Setpoint(speed, start.angle)
    turn = phase(velocity)
    if abs(turn) > QUARTER_TURN + FLIP_TOLERANCE:
        speed, turn = -speed, turn - math.copysign(math.pi, turn)
    return Setpoint(speed, start.angle + clamped(turn, steering_step))
