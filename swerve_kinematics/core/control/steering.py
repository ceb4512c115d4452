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

"""Which of its angles a module steers to, and what is left where a range leaves none."""

import cmath
import dataclasses
import functools
import math

import numpy as np
from numpy.typing import ArrayLike

from swerve_kinematics.core.control.setpoints import at_rest, QUARTER_TURN, Setpoint
from swerve_kinematics.core.geometry.angles import phase, scalar_nearest_equivalent, TURN
from swerve_kinematics.core.geometry.clamping import clamped
from swerve_kinematics.core.kinematics.modules import FLIP_TOLERANCE
from swerve_kinematics.core.kinematics.swerve import MIN_SPEED

# Around a quarter turn from where a module is, both of its angles cost the same: within this
# band [rad] it keeps the choice it made, so that noise does not turn it back and forth.
FLIP_HYSTERESIS = 0.1
# Beyond how much of a turn [rad] the drive runs reversed, by whether it does so already; None
# where nothing was chosen.
REVERSED_BEYOND = {None: QUARTER_TURN + FLIP_TOLERANCE,
                   False: QUARTER_TURN + FLIP_TOLERANCE + FLIP_HYSTERESIS,
                   True: QUARTER_TURN + FLIP_TOLERANCE - FLIP_HYSTERESIS}

# No joint is found further beyond an end stop than this [rad]: it counts its turns otherwise.
FARTHEST_BEYOND = 0.5
# An angle [rad] this little beyond the end of a range is still taken for the end.
END_TOLERANCE = 1e-9


@dataclasses.dataclass(frozen=True)
class SteeringRange:
    """
    The angles a steering joint can take.

    Attributes
    ----------
    lower, upper : float
        [rad]; infinite both for a continuous joint.

    """

    lower: float = -math.inf
    upper: float = math.inf

    @functools.cached_property
    def is_continuous(self) -> bool:
        """Tell whether the joint has no end stops."""
        return self.lower == -math.inf and self.upper == math.inf

    def nearest(self, angle: float) -> float:
        """Return the angle in the range that is nearest to `angle` [rad]."""
        return max(self.lower, min(self.upper, angle))

    def counted(self, angle: float) -> float:
        """Return the angle [rad], less whole turns where these take it out of the range."""
        if self._is_near(angle) or self.upper - self.lower > TURN:
            return angle
        middle = 0.5 * (self.lower + self.upper)
        moved = scalar_nearest_equivalent(angle, middle)
        return moved if self._is_near(moved) else angle

    def _is_near(self, angle: float) -> bool:
        """Tell whether a joint with this range may be found at an angle [rad]."""
        return abs(angle - self.nearest(angle)) <= FARTHEST_BEYOND


def steering_ranges(count: int, lower_limits: ArrayLike | None,
                    upper_limits: ArrayLike | None) -> list[SteeringRange]:
    """
    Return the ranges of `count` modules.

    Parameters
    ----------
    count : int
        Number of modules.
    lower_limits, upper_limits : array_like (count,) or None
        [rad]; None for no limit.

    Returns
    -------
    list of SteeringRange

    Raises
    ------
    ValueError
        If a limit is missing or NaN, or a range is empty.

    """
    lower = np.full(count, -np.inf) if lower_limits is None else np.asarray(lower_limits, float)
    upper = np.full(count, np.inf) if upper_limits is None else np.asarray(upper_limits, float)
    for limits, name in ((lower, 'lower'), (upper, 'upper')):
        if limits.shape != (count,):
            raise ValueError(f'steering_{name}_limits must have shape ({count},), '
                             f'got {limits.shape}')
    if not (lower < upper).all():
        raise ValueError(f'steering_lower_limits must be below steering_upper_limits, '
                         f'got {lower.tolist()} and {upper.tolist()}')
    return [SteeringRange(*limits) for limits in zip(lower.tolist(), upper.tolist())]


def choose(velocity: complex, present: Setpoint, measured: float, flipped: bool | None,
           steering_range: SteeringRange, slack: float = 0.0
           ) -> tuple[Setpoint, bool | None, bool]:
    """
    Choose the angle and the drive direction for a module velocity.

    Of all angles along the line of the velocity, the one nearest to where the module is; it
    counts on from the measured turn, so crossing +-pi never unwinds one. Next to the end of
    a range, the nearest one inside.

    Parameters
    ----------
    velocity : complex
        [m/s] in the base frame. Below `MIN_SPEED` it has no direction: the module holds.
    present : Setpoint
        What the module was told before.
    measured : float
        Steering angle [rad], multi-turn.
    flipped : bool or None
        The choice to keep within `FLIP_HYSTERESIS` of a quarter turn; None for no choice.
    steering_range : SteeringRange
        What the joint can take, its turns counted as in `measured`.
    slack : float
        How fast a wheel may slide sideways [m/s] to stay at the end of its range.

    Returns
    -------
    goal : Setpoint
        Rim speed and angle to make for.
    flipped : bool or None
        Whether the drive runs reversed; None while nothing was chosen.
    blocked : bool
        Whether neither angle for the velocity is in the range; the goal is the end stop.

    """
    speed, blocked = abs(velocity), False
    if speed < MIN_SPEED:
        return Setpoint(0.0, present.angle), flipped, False
    turn = math.remainder(phase(velocity) - measured, math.tau)
    flipped = abs(turn) > REVERSED_BEYOND[flipped]
    if flipped:
        turn -= math.copysign(math.pi, turn)
    if steering_range.is_continuous:
        angle = measured + clamped(turn, QUARTER_TURN)
    else:
        angle, half_turns = steering_range.nearest(measured + turn), 0
        beyond = abs(measured + turn - angle)
        if speed * beyond > slack or at_rest(present):
            angle, half_turns, beyond = _within_range(measured + turn, steering_range)
        flipped, blocked = flipped != bool(half_turns % 2), speed * beyond > slack
        speed *= math.cos(beyond)
    return Setpoint(-speed if flipped else speed, angle), flipped, blocked


def _within_range(angle: float, steering_range: SteeringRange) -> tuple[float, int, float]:
    """Return the angle moved into the range by half turns, their number, and what is left over."""
    lower, upper, half_turns = steering_range.lower, steering_range.upper, 0
    if angle > upper + END_TOLERANCE:
        half_turns = -math.ceil((angle - upper - END_TOLERANCE) / math.pi)
    elif angle < lower - END_TOLERANCE:
        half_turns = math.ceil((lower - END_TOLERANCE - angle) / math.pi)
    moved = angle + half_turns * math.pi
    # A range of half a turn has an angle for any direction, however a huge one is rounded.
    if (lower - END_TOLERANCE <= moved <= upper + END_TOLERANCE
            or upper - lower >= math.pi):
        return steering_range.nearest(moved), half_turns, 0.0
    # One angle is below the range, the other, half a turn on, above it. The nearer one counts;
    # where both are about as near, that on the side of the module.
    if moved > upper:
        moved, half_turns = moved - math.pi, half_turns - 1
    below, above = lower - moved, moved + math.pi - upper
    is_clear = abs(below - above) > FLIP_HYSTERESIS
    if above < below if is_clear else angle > upper:
        return upper, half_turns + 1, above
    return lower, half_turns, below


def within_bounds(setpoint: Setpoint, measured: float, steering_range: SteeringRange) -> Setpoint:
    """
    Return a setpoint kept within what the joint may ever be told.

    A continuous joint is never told to be more than a quarter turn from where it is, one with
    end stops never to be beyond them.
    """
    speed, angle = setpoint
    if not steering_range.is_continuous:
        return Setpoint(speed, steering_range.nearest(angle))
    if abs(angle - measured) <= QUARTER_TURN:
        return setpoint
    return Setpoint(speed, measured + clamped(angle - measured, QUARTER_TURN))


def counted_from(setpoint: Setpoint, measured: float) -> Setpoint:
    """Return the setpoint that points like another, its turns counted as in `measured` [rad]."""
    speed, angle = setpoint
    if abs(angle - measured) <= math.pi:
        return setpoint
    return Setpoint(speed, scalar_nearest_equivalent(angle, measured))


def leaves_range(setpoint: Setpoint, goal: Setpoint, steering_range: SteeringRange) -> bool:
    """Tell whether a module that turns to its goal while it drives would pass an end stop."""
    if steering_range.is_continuous or at_rest(setpoint) or goal.angle == setpoint.angle:
        return False
    turn = phase(cmath.rect(*goal) * cmath.rect(*setpoint).conjugate())
    end = setpoint.angle + turn
    return not steering_range.lower - END_TOLERANCE <= end <= steering_range.upper + END_TOLERANCE


def x_pattern(offsets: list[complex]) -> list[complex]:
    """
    Return the directions (list of complex) that lock a base: every wheel along its radius.

    A module in the middle of all of them has no direction, 0.
    """
    middle = sum(offsets) / len(offsets)
    return [offset - middle for offset in offsets]
