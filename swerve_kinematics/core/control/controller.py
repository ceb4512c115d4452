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

"""From a twist to module commands that the modules can follow: the command pipeline."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from swerve_kinematics.core.control.command import ModuleCommand
from swerve_kinematics.core.control.jerk import smoothed
from swerve_kinematics.core.control.limits import ControllerLimits, saturated
from swerve_kinematics.core.control.module_group import ModuleGroup
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.control.pace import turn_back
from swerve_kinematics.core.control.passing import must_come_to_rest
from swerve_kinematics.core.control.plan import Plan
from swerve_kinematics.core.control.quiet import must_turn
from swerve_kinematics.core.control.ramp import ramped
from swerve_kinematics.core.control.shaping import shaped, stopping_factor
from swerve_kinematics.core.control.steering import steering_ranges
from swerve_kinematics.core.control.target import Target
from swerve_kinematics.core.geometry.planar import (
    are_parallel, between, finite_twist, PlanarTwist, rate_between, REST, scaled, seen_from,
    turned)
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

IDLE_MODES = ('hold', 'lock')
UNREACHABLE_POLICIES = ('project', 'stop')

# A step outside this range [s] is a repeated call or a stall, not a control period: it moves
# nothing, or as much as the longest.
SHORTEST_STEP, LONGEST_STEP = 1e-9, 1.0


class SwerveController:
    """
    Turns twists into module commands, one control period at a time.

    For every two successive commands, dt apart: no `|speed|` exceeds `max_module_speed`, no
    speed changes by more than `max_module_acceleration * dt`, no angle by more than
    `max_steering_rate * dt` besides the whole turns by which a wrapped measurement leaps, and no
    continuous joint is commanded more than 90 degrees away from where it is measured. The last
    one takes precedence over the rate: a module that is found elsewhere, moved by force or after
    a `reset`, is commanded from there. A joint with end stops is never commanded beyond them. A
    speed above a limit that was just lowered only falls.

    `max_module_acceleration` bounds the rate of the rim speed, which is what the drive motor
    must deliver. The velocity vector also turns with the steering, but that takes side grip
    instead of drive torque, and is bounded by `max_steering_rate`.

    Parameters
    ----------
    kin : SwerveKinematics
        Gives the module positions from base_link [m].
    limits : ControllerLimits
        Of the chassis and of its modules; none by default.
    center_of_rotation : array_like (2,)
        The point whose velocity the twist is, from base_link [m].
    steering_lower_limits, steering_upper_limits : array_like (n,), optional
        Ranges of the steering joints [rad]; continuous where not given or infinite.
    idle_mode : str
        'hold' keeps the steering angles at rest, 'lock' turns the wheels to an X.
    unreachable_policy : str
        What to do with a twist for which a steering range has no angle: 'project' executes
        the nearest twist that all modules can do, 'stop' comes to rest and stays there.

    Attributes
    ----------
    locked : bool
        Whether motion is refused because the wheels are, or are about to be, in an X.

    Raises
    ------
    ValueError
        If the centre is not two finite numbers, a steering range is empty or does not match
        the modules, or the idle mode or the policy is unknown.

    """

    def __init__(self, kin: SwerveKinematics, limits: ControllerLimits = ControllerLimits(),
                 center_of_rotation: ArrayLike = (0.0, 0.0),
                 steering_lower_limits: ArrayLike | None = None,
                 steering_upper_limits: ArrayLike | None = None,
                 idle_mode: str = 'hold', unreachable_policy: str = 'project') -> None:
        """Start at rest, with steering angles still to be measured."""
        self._positions = [complex(x, y) for x, y in kin.module_positions.tolist()]
        self._modules = ModuleGroup(self._positions, steering_ranges(
            len(self._positions), steering_lower_limits, steering_upper_limits))
        self.limits = limits
        self._center, self._twist, self._acceleration = 0j, REST, REST
        self.center_of_rotation = center_of_rotation
        self.idle_mode = idle_mode
        if unreachable_policy not in UNREACHABLE_POLICIES:
            raise ValueError(f'unreachable_policy must be one of {UNREACHABLE_POLICIES}, '
                             f'got {unreachable_policy!r}')
        self._must_reach = unreachable_policy == 'stop'
        self.locked = False
        self.reset()

    def reset(self) -> None:
        """
        Forget all motion: the wheels stand still, at the angles that are measured next.

        This is for emergencies. Else the limits of acceleration give way only to those of module
        speed and grip, and those of jerk only to limits of speed that were lowered.
        """
        self._target = Target()
        self._twist = self._acceleration = REST
        self._start = REST, REST  # twist and acceleration from which the limits count
        self._modules.reset()

    @property
    def center_of_rotation(self) -> tuple[float, float]:
        """Return the point (x, y) whose velocity the twist is, from base_link [m]."""
        return self._center.real, self._center.imag

    @center_of_rotation.setter
    def center_of_rotation(self, value: ArrayLike) -> None:
        """Take a new point; the motion under way stays the same."""
        center = np.asarray(value, dtype=float)
        if center.shape != (2,) or not np.isfinite(center).all():
            raise ValueError(f'center_of_rotation must be two finite numbers, got {value!r}')
        moved = complex(*center.tolist()) - self._center
        self._center += moved
        self._offsets = Offsets(self._positions, self._center)
        self._twist = seen_from(self._twist, moved)
        self._acceleration = seen_from(self._acceleration, moved)

    @property
    def idle_mode(self) -> str:
        """Return what the modules do at rest, 'hold' or 'lock'."""
        return self._idle_mode

    @idle_mode.setter
    def idle_mode(self, value: str) -> None:
        """Take another mode."""
        if value not in IDLE_MODES:
            raise ValueError(f'idle_mode must be one of {IDLE_MODES}, got {value!r}')
        self._idle_mode = value

    def lock(self) -> None:
        """Stop, turn the wheels to an X, and refuse to move until unlocked."""
        self.locked = True

    def unlock(self) -> None:
        """Obey twists again."""
        self.locked = False

    def update(self, twist: ArrayLike, measured_angles: ArrayLike | None, dt: float,
               heading: float | None = None, measured_twist: ArrayLike | None = None
               ) -> ModuleCommand:
        """
        Advance by one control period and return the command for the next.

        Parameters
        ----------
        twist : array_like (3,)
            `[vx, vy, omega]` [m/s, m/s, rad/s] of the centre of rotation, in the base frame,
            or in the field frame if a heading is given.
        measured_angles : array_like (n,) or None
            Steering angles [rad], counting turns or wrapped: those of the command are counted
            as these are, or as the end stops. NaN where not known: then the base stops, the
            wheel of a module never seen stands, and its angle is a mere 0. None for open
            loop: the modules are where they were told to be.
        dt : float
            Time [s] since the previous update. At 0 the previous command is repeated.
        heading : float, optional
            Heading of the base in the field [rad].
        measured_twist : array_like (3,), optional
            What base_link does, in the base frame, where a new measurement has come. A base
            that stays behind by more than its drives explain is held by something: the
            command then comes down to what is measured, and its ramp begins there.

        Returns
        -------
        ModuleCommand

        Raises
        ------
        ValueError
            If an array has the wrong shape, or `dt` is negative or NaN.

        """
        if not dt >= 0.0:
            raise ValueError(f'dt must be zero or more, got {dt}')
        measured, all_known = self._modules.locate(measured_angles)
        # A twist that is not finite is refused whole: the last valid one stays the target.
        refused = not self._target.accept(twist, heading)
        if dt <= SHORTEST_STEP:
            return self._command(refused=refused)
        dt = float(dt) if dt < LONGEST_STEP else LONGEST_STEP
        self._target.pass_time(
            self._twist, self._measured(measured_twist), self._offsets, self.limits, dt)
        self._start = self._motion(self._target.twist.velocity, dt)
        # The goal of every module, within the limits of the chassis.
        if all_known and not self.locked:
            plan = self._plan(measured, dt)
        else:
            plan = self._stop(measured, dt)
        # As much of the way there as all modules can go.
        if self.limits.has_jerk and not self._modules.is_at_rest:
            fraction = self._modules.reach(plan, self.limits, dt)
            plan = self._eased(plan, fraction, measured, dt)
            self._modules.advance_each(plan.goals, measured, self.limits, dt)
            self._twist = plan.twist
        else:
            fraction = self._modules.advance(plan, measured, self.limits, dt)
            self._twist = between(self._twist, plan.twist, fraction)
        self._modules.flipped = plan.flipped
        self._acceleration = (
            rate_between(self._start[0], self._twist, dt) if self.limits.has_jerk else REST)
        return self._command(plan.scale, fraction, plan.unreachable, refused)

    def _measured(self, measured_twist: ArrayLike | None) -> PlanarTwist | None:
        """Return what the centre of rotation does, None if nothing new is known."""
        twist = None if measured_twist is None else finite_twist(measured_twist, 'measured_twist')
        return seen_from(twist, self._center) if twist and self._center else twist

    def _motion(self, goal: complex, dt: float) -> tuple[PlanarTwist, PlanarTwist]:
        """
        Return twist and acceleration of the previous period as the limits shall see them.

        Neither a straight line in the world nor an arc of the base needs an acceleration, though
        the first turns back in the base frame, which turns, and the second does in the world.
        """
        velocity, omega = self._twist
        turn = turn_back(velocity, goal, omega * dt)
        if turn == 0.0 or self.limits.has_jerk and not self._target.turning.is_straight(omega):
            return self._twist, self._acceleration
        return turned(self._twist, turn), turned(self._acceleration, turn)

    def _plan(self, measured: list[float], dt: float) -> Plan:
        """Return the plan towards the target: to drive, or first to stop if need be."""
        if self._target.twist == REST:
            return self._stop(measured, dt)
        wanted, scale = self._target.within(self.limits, self._offsets)
        if self.limits.has_jerk:
            # Beforehand, for no step on the way may be scaled.
            _, pace = saturated(wanted, self._offsets, self.limits.max_module_speed, dt)
            wanted, scale = scaled(wanted, pace), scale * pace
        wanted, unreachable = self._reachable(wanted, measured, dt)
        if unreachable:
            if self._must_reach or wanted == REST:
                return replace(self._stop(measured, dt), unreachable=unreachable)
            self._start = self._motion(wanted.velocity, dt)
        twist = self._shaped(wanted, dt)
        if twist != wanted:
            # The way to a twist that all modules can do may lead through others.
            nearest, strays = self._reachable(twist, measured, dt)
            twist = self._shaped(nearest, dt) if strays else twist
        plan = self._modules.plan_for(twist, scale, self._offsets, measured, self.limits, dt)
        if self._target.quiet.is_quiet and must_turn(self._modules.setpoints, plan.goals):
            return self._stop(measured, dt)
        if must_come_to_rest(self._modules, plan, wanted, self._twist, measured, self._offsets,
                             self.limits, dt):
            plan = self._stop(measured, dt)
        return replace(plan, unreachable=unreachable) if unreachable else plan

    def _reachable(self, twist: PlanarTwist, measured: list[float],
                   dt: float) -> tuple[PlanarTwist, list[bool]]:
        """Return the nearest twist that all modules can do, and which are in the way, if any."""
        return self._modules.reachable(twist, self._offsets, measured, self.limits, dt)

    def _shaped(self, wanted: PlanarTwist, dt: float) -> PlanarTwist:
        """Return the twist on the way to a wanted one that the limits of the base allow."""
        previous, acceleration = self._start
        return shaped(wanted, previous, self._twist, acceleration, self._offsets, self.limits, dt)

    def _eased(self, plan: Plan, fraction: float, measured: list[float], dt: float) -> Plan:
        """Return a plan that the modules can follow better, as far as the jerk limits allow."""
        if fraction == 1.0:
            return plan
        previous, acceleration = self._start
        twist = smoothed(between(previous, plan.twist, fraction), previous, acceleration,
                         self._offsets, self.limits, dt)
        eased = self._modules.plan_for(twist, 1.0, self._offsets, measured, self.limits, dt)
        # A wheel that stands in it, as that which the base turns about, must turn beforehand.
        return replace(self._modules.turning_at_rest(eased, plan), scale=plan.scale,
                       unreachable=plan.unreachable)

    def _stop(self, measured: list[float], dt: float) -> Plan:
        """Return the plan to slow down along the present curve; at rest, to hold or to lock."""
        # The base keeps its curve: the acceleration counts from its twist as it stands.
        present, acceleration = self._start = self._twist, self._acceleration
        if self._modules.is_at_rest:
            goals = self._modules.scaled(0.0)
            if self.locked or self._idle_mode == 'lock':
                goals = self._modules.locked_goals(self._offsets, measured)
            return self._modules.keeping(REST, goals, self.limits, dt)
        slower = smoothed(ramped(REST, present, self._offsets, self.limits, dt), present,
                          acceleration, self._offsets, self.limits, dt)
        if not are_parallel(slower, present):
            plan = self._modules.plan_for(slower, 1.0, self._offsets, measured, self.limits, dt)
            return replace(plan, goals=self._modules.turned_within_range(plan.goals))
        factor = stopping_factor(
            slower, present, self._offsets, self._modules.peak_speed, self.limits, dt)
        return self._modules.keeping(
            scaled(present, factor), self._modules.scaled(factor), self.limits, dt)

    def _command(self, scale: float = 1.0, fraction: float = 0.0,
                 unreachable: list[bool] | None = None, refused: bool = False) -> ModuleCommand:
        """Return the present state as a command."""
        modules = self._modules
        return ModuleCommand(
            list(modules.speeds), [angle for _, angle in modules.setpoints],
            self._twist, scale, fraction, unreachable or [False] * len(modules.speeds), refused,
            self._target.following.is_held)
