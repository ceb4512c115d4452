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

"""What the modules of a base were told last, and how they go on from there."""

import cmath
from collections.abc import Sequence
from dataclasses import replace
from itertools import repeat
import math

from numpy.typing import ArrayLike

from swerve_kinematics.core.control.limits import ControllerLimits, saturated, speed_scale
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.control.plan import Plan
from swerve_kinematics.core.control.projection import Projection
from swerve_kinematics.core.control.setpoints import (
    at_rest, common_fraction, nearest_setpoint, next_setpoint, Setpoint,
    within_reach)
from swerve_kinematics.core.control.steering import (
    choose, counted_from, leaves_range, SteeringRange, within_bounds, x_pattern)
from swerve_kinematics.core.geometry.arrays import as_floats
from swerve_kinematics.core.geometry.clamping import clamped
from swerve_kinematics.core.geometry.planar import (
    displacing, module_velocities, PlanarTwist, scaled, straightened)
from swerve_kinematics.core.kinematics.swerve import MIN_SPEED

# No joint turns this far [rad]: what reads as more is not known.
ANGLE_CEILING = 1e12


class ModuleGroup:
    """
    The modules of one base: what each was told, in module order.

    Parameters
    ----------
    ranges : list of SteeringRange (n,)
        What the steering joints can take.

    Attributes
    ----------
    setpoints : list of Setpoint (n,)
        Where the modules were told to be, their velocities those of a rigid base.
    speeds : list of float (n,)
        The rim speeds [m/s] told, less than those of the setpoints while steering lags.
    flipped : sequence of (bool or None) (n,)
        Which drives run reversed; None where nothing was chosen.

    """

    def __init__(self, positions: Sequence[complex], ranges: list[SteeringRange]) -> None:
        """Start at rest, with steering angles still to be measured."""
        self._ranges = ranges
        self._projection = Projection(positions, ranges)
        self._has_end_stops = not all(joint.is_continuous for joint in ranges)
        self.setpoints = [Setpoint(0.0, joint.nearest(0.0)) for joint in ranges]
        self.reset()

    def reset(self) -> None:
        """Forget all motion: the wheels stand still, at the angles that are measured next."""
        self.setpoints = [Setpoint(0.0, angle) for _, angle in self.setpoints]
        self.speeds = [0.0] * len(self.setpoints)
        self.flipped: Sequence[bool | None] = [None] * len(self.setpoints)
        self._known = [False] * len(self.setpoints)

    def locate(self, measured_angles: ArrayLike | None) -> tuple[list[float], bool]:
        """
        Return where the modules are, and if all are known now; adopt those first seen.

        A joint that reads the same after a turn leaps by one, and what its module was told leaps
        with it; one with end stops is counted as they are.
        """
        if measured_angles is None:
            self._known = [True] * len(self.setpoints)
            return [setpoint.angle for setpoint in self.setpoints], True
        measured = as_floats(measured_angles, len(self.setpoints), 'measured_angles')
        all_known = True
        for i, (angle, joint) in enumerate(zip(measured, self._ranges)):
            if not abs(angle) < ANGLE_CEILING:  # nor is NaN
                measured[i], all_known = self.setpoints[i].angle, False
                continue
            if not joint.is_continuous:
                angle = measured[i] = joint.counted(angle)
            if not self._known[i]:
                self.setpoints[i] = Setpoint(0.0, joint.nearest(angle))
                self._known[i] = True
            elif joint.is_continuous:
                self.setpoints[i] = counted_from(self.setpoints[i], angle)
        return measured, all_known

    def choose(self, twist: PlanarTwist, offsets: list[complex], measured: list[float],
               dt: float = 0.0
               ) -> tuple[Sequence[Setpoint], Sequence[bool | None], Sequence[bool]]:
        """Return the goals for a twist, and which modules run reversed and which are blocked."""
        # What `straightened` makes of a velocity grows with the yaw rate. It shall not drive a
        # module over the end of its range that was well within it when the base set off.
        slack = 0.5 * dt * abs(twist.omega * twist.velocity) if self._has_end_stops else 0.0
        goals, flipped, blocked = zip(*map(
            choose, module_velocities(twist, offsets), self.setpoints, measured, self.flipped,
            self._ranges, repeat(slack)))
        return goals, flipped, blocked

    def reachable(self, twist: PlanarTwist, offsets: Offsets, measured: list[float],
                  limits: ControllerLimits, dt: float) -> tuple[PlanarTwist, list[bool]]:
        """Return the nearest twist that all modules can do, and which are in the way, if any."""
        if not self._projection.is_needed:
            return twist, []
        straight = straightened(twist, dt)
        *_, unreachable = self.choose(straight, offsets, measured, dt)
        if not any(unreachable):
            return twist, []

        def largest_turn(candidate: PlanarTwist, stopped: frozenset[int]) -> float:
            goals, _, blocked = self.choose(candidate, offsets, measured, dt)
            if any(blocked[i] for i in range(len(blocked)) if i not in stopped):
                return math.inf
            return max(abs(goal.angle - angle) for goal, angle in zip(goals, measured))
        middle = sum(offsets) / len(offsets)
        twist = displacing(self._projection.nearest(straight, middle, largest_turn), dt)
        return scaled(twist, speed_scale(twist, offsets, limits)), list(unreachable)

    def plan_for(self, twist: PlanarTwist, scale: float, offsets: Offsets,
                 measured: list[float], limits: ControllerLimits, dt: float) -> Plan:
        """Return the plan whose modules move the base with a twist in this very period."""
        # Discretize; where that makes a module too fast, scale and do it again. Where jerk is
        # limited, that was seen to in advance: no step on the way may be scaled.
        straight, saturation = saturated(
            twist, offsets, math.inf if limits.has_jerk else limits.max_module_speed, dt)
        # Velocities of the modules, and the nearest angle in range for each.
        goals, flipped, _ = self.choose(straight, offsets, measured, dt)
        return Plan(scaled(twist, saturation), goals, flipped, scale * saturation,
                    [False] * len(goals), self._can_reach(goals, limits, dt))

    def keeping(self, twist: PlanarTwist, goals: Sequence[Setpoint], limits: ControllerLimits,
                dt: float) -> Plan:
        """Return the plan of a base that goes nowhere new."""
        count = len(goals)
        return Plan(twist, goals, [None] * count, 1.0, [False] * count,
                    self._can_reach(goals, limits, dt))

    def _can_reach(self, goals: Sequence[Setpoint], limits: ControllerLimits, dt: float) -> bool:
        """Tell whether every module can take its goal in this very period."""
        return within_reach(self.setpoints, goals, limits.max_steering_rate * dt,
                            limits.max_module_acceleration * dt)

    def reverses(self, twist: PlanarTwist, offsets: list[complex]) -> bool:
        """Tell whether every module that moves would move the other way in a twist."""
        is_moving = False
        for setpoint, velocity in zip(self.setpoints, module_velocities(twist, offsets)):
            if not at_rest(setpoint):
                if (cmath.rect(*setpoint).conjugate() * velocity).real >= 0.0:
                    return False
                is_moving = True
        return is_moving

    def turn_at_rest(self, twist: PlanarTwist, offsets: list[complex],
                     measured: list[float]) -> float:
        """Return the greatest turn [rad] that a module at rest would need for a twist."""
        goals, _, _ = self.choose(twist, offsets, measured)
        return max(abs(goal.angle - setpoint.angle)
                   for goal, setpoint in zip(goals, self.setpoints))

    def passes_end_stop(self, plan: Plan, twist: PlanarTwist, offsets: Offsets,
                        measured: list[float], limits: ControllerLimits, dt: float) -> bool:
        """Tell whether a module would pass an end stop on its way to a goal, or to a twist."""
        if not self._has_end_stops:
            return False
        if any(map(leaves_range, self.setpoints, plan.goals, self._ranges)):
            return True
        if plan.twist == twist:
            return False
        final = self.plan_for(twist, 1.0, offsets, measured, limits, dt)
        return any(map(leaves_range, self.setpoints, final.goals, self._ranges))

    def turned_within_range(self, goals: Sequence[Setpoint]) -> list[Setpoint]:
        """Return the goals without those that lie past an end stop: such a module stays put."""
        return [nearest_setpoint(start, goal, 0.0) if leaves_range(start, goal, joint) else goal
                for start, goal, joint in zip(self.setpoints, goals, self._ranges)]

    def turning_at_rest(self, plan: Plan, next_plan: Plan) -> Plan:
        """Return a plan in which modules that stand, and are to, turn as the next one asks."""
        choices = [
            (Setpoint(goal.speed, next_goal.angle), next_flip)
            if at_rest(start) and at_rest(goal) else (goal, flip)
            for start, goal, flip, next_goal, next_flip in zip(
                self.setpoints, plan.goals, plan.flipped, next_plan.goals, next_plan.flipped)]
        goals, flipped = zip(*choices)
        return replace(plan, goals=goals, flipped=flipped)

    @property
    def is_at_rest(self) -> bool:
        """Tell whether all wheels stand."""
        return all(map(at_rest, self.setpoints)) and max(map(abs, self.speeds)) < MIN_SPEED

    @property
    def peak_speed(self) -> float:
        """Return the speed [m/s] of the fastest module."""
        return max(abs(setpoint.speed) for setpoint in self.setpoints)

    def scaled(self, factor: float) -> list[Setpoint]:
        """Return the goals that keep every angle and scale all speeds."""
        return [Setpoint(factor * speed, angle) for speed, angle in self.setpoints]

    def locked_goals(self, offsets: list[complex], measured: list[float]) -> list[Setpoint]:
        """Return the goals of modules at rest that turn to the X."""
        pattern = map(choose, x_pattern(offsets), self.setpoints, measured,
                      [None] * len(offsets), self._ranges)
        return [Setpoint(0.0, goal.angle) for goal, _, _ in pattern]

    def reach(self, plan: Plan, limits: ControllerLimits, dt: float) -> float:
        """Return the largest common fraction of the way to the goals that all modules can go."""
        if plan.is_near:
            return 1.0
        return common_fraction(self.setpoints, plan.goals, limits.max_steering_rate * dt,
                               limits.max_module_acceleration * dt)

    def advance(self, plan: Plan, measured: list[float], limits: ControllerLimits,
                dt: float) -> float:
        """
        Go to the goals as far as all modules can, and return that fraction of the way.

        It is common to all, so that the wheels never fight each other.
        """
        goals, fraction = plan.goals, 1.0
        if not plan.is_near:
            fraction, steering_step = self.reach(plan, limits, dt), limits.max_steering_rate * dt
            goals = [next_setpoint(start, goal, fraction, steering_step)
                     for start, goal in zip(self.setpoints, goals)]
        self._take(goals, measured, limits, dt)
        return fraction

    def advance_each(self, goals: Sequence[Setpoint], measured: list[float],
                     limits: ControllerLimits, dt: float) -> None:
        """Go as far to its goal as each module can, where the base cannot wait for them."""
        steering_step = limits.max_steering_rate * dt
        self._take([nearest_setpoint(start, goal, steering_step)
                    for start, goal in zip(self.setpoints, goals)], measured, limits, dt)

    def _take(self, setpoints: Sequence[Setpoint], measured: list[float],
              limits: ControllerLimits, dt: float) -> None:
        """
        Take new setpoints, kept within what the joints may be told.

        A wheel that still swings drives only along what is commanded of it, at a bounded rate.
        """
        drive_step = limits.max_module_acceleration * dt
        self.setpoints = list(map(within_bounds, setpoints, measured, self._ranges))
        self.speeds = [
            _rim_speed(speed * math.cos(angle - present), before, drive_step,
                       limits.max_module_speed)
            for (speed, angle), present, before in zip(self.setpoints, measured, self.speeds)]


def _rim_speed(wanted: float, before: float, drive_step: float, max_speed: float) -> float:
    """Return a rim speed that is as near to the wanted one as it may be."""
    if abs(wanted) > max_speed:
        # Above a limit that was lowered just now, a speed falls, but never rises.
        wanted = clamped(wanted, max(max_speed, abs(before)))
    change = wanted - before
    return before + (change if abs(change) <= drive_step else math.copysign(drive_step, change))
