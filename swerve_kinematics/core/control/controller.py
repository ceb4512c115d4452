"""From a twist to module commands that the modules can follow: the command pipeline."""

import cmath
import math
from typing import NamedTuple

import numpy as np

from swerve_kinematics.core.control.limits import (
    ControllerLimits, limited_twist, ratio, saturated, speed_scale)
from swerve_kinematics.core.control.setpoints import (
    at_rest, clamped, common_fraction, next_setpoint, Setpoint, within_reach)
from swerve_kinematics.core.control.steering import (
    choose, choose_all, leaves_range, steering_ranges, within_bounds, x_pattern)
from swerve_kinematics.core.geometry.arrays import as_floats
from swerve_kinematics.core.geometry.planar import (
    between, displacing, module_velocities, PlanarTwist, product, rate_between, REST, scaled,
    turned)
from swerve_kinematics.core.kinematics.swerve import MIN_SPEED

IDLE_MODES = ('hold', 'lock')

# A step outside this range [s] is a repeated call or a stall, not a control period: it moves
# nothing, or as much as the longest.
SHORTEST_STEP, LONGEST_STEP = 1e-9, 1.0

# No base is faster [m/s, rad/s]; it keeps the arithmetic of a controller without limits finite.
SPEED_CEILING = 1e6


class ModuleCommand(NamedTuple):
    """
    What the modules are told, and what became of the twist.

    The numbers are Python's own, and `speed`, `angle`, `twist` and `unreachable` give them as
    arrays.

    Attributes
    ----------
    speeds : list of float (n,)
        Rim speeds [m/s], negative where the drive is reversed.
    angles : list of float (n,)
        Steering angles [rad], multi-turn.
    executed : PlanarTwist
        The twist being executed, in the base frame: like the twist asked for, the velocity of
        the centre of rotation.
    scale : float
        In (0, 1]: the factor by which the asked twist was too fast for the speed limits.
    fraction : float
        In [0, 1]: how much of the wanted change the modules can make in this period.
    blocked : list of bool (n,)
        Modules whose steering range holds no angle for the asked motion; the twist is then
        the nearest one that all modules can do.
    refused : bool
        Whether the twist was not finite. The last valid one stays the target.

    """

    speeds: list
    angles: list
    executed: PlanarTwist
    scale: float
    fraction: float
    blocked: list
    refused: bool

    @property
    def speed(self):
        """Return `speeds` as an array (n,) [m/s]."""
        return np.array(self.speeds)

    @property
    def angle(self):
        """Return `angles` as an array (n,) [rad]."""
        return np.array(self.angles)

    @property
    def twist(self):
        """Return `executed` as an array (3,) `[vx, vy, omega]` [m/s, m/s, rad/s]."""
        return np.array(self.executed.parts)

    @property
    def unreachable(self):
        """Return `blocked` as an array (n,) of bool."""
        return np.array(self.blocked)


class _Plan(NamedTuple):
    """Where base and modules would be at its end if nothing held the modules back."""

    twist: PlanarTwist
    goals: list
    flipped: list
    scale: float
    unreachable: list


class SwerveController:
    """
    Turns twists into module commands, one control period at a time.

    For every two successive commands, dt apart: no |speed| exceeds `max_module_speed`, no
    speed changes by more than `max_module_acceleration * dt`, no angle by more than
    `max_steering_rate * dt`, and no continuous joint is told to be more than 90 degrees from
    where it is measured. The last comes before the rate: a module found elsewhere, by force
    or after a `reset`, is told to go from there.

    `max_module_acceleration` bounds the rate of the rim speed, which is what the drive motor
    must deliver. The velocity vector also turns with the steering, but that asks for side
    grip, not for drive torque, and is bounded by `max_steering_rate`.

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

    Raises
    ------
    ValueError
        If the centre is not two finite numbers, a steering range is empty or does not match
        the modules, or the idle mode is unknown.

    """

    def __init__(self, kin, limits=ControllerLimits(), center_of_rotation=(0.0, 0.0),
                 steering_lower_limits=None, steering_upper_limits=None, idle_mode='hold'):
        """Start at rest, with steering angles still to be measured."""
        self._positions = [complex(x, y) for x, y in kin.module_positions.tolist()]
        self._ranges = steering_ranges(
            len(self._positions), steering_lower_limits, steering_upper_limits)
        self._has_end_stops = not all(joint.is_continuous for joint in self._ranges)
        self.limits = limits
        self._center, self._twist = 0j, REST
        self.center_of_rotation = center_of_rotation
        self.idle_mode = idle_mode
        self._locked = False
        self._setpoints = [Setpoint(0.0, 0.0)] * len(self._positions)
        self.reset()

    def reset(self):
        """Forget all motion: the wheels stand, and are next found at their measured angles."""
        self._target = self._twist = self._acceleration = REST
        self._setpoints = [Setpoint(0.0, angle) for _, angle in self._setpoints]
        self._speeds = [0.0] * len(self._setpoints)
        self._flipped = [None] * len(self._setpoints)
        self._known = [False] * len(self._setpoints)

    @property
    def center_of_rotation(self):
        """Return the point (x, y) whose velocity the twist is, from base_link [m]."""
        return self._center.real, self._center.imag

    @center_of_rotation.setter
    def center_of_rotation(self, value):
        """Take a new point; the motion under way stays the same."""
        center = np.asarray(value, dtype=float)
        if center.shape != (2,) or not np.isfinite(center).all():
            raise ValueError(f'center_of_rotation must be two finite numbers, got {value}')
        moved = complex(*center.tolist()) - self._center
        self._center += moved
        self._offsets = [position - self._center for position in self._positions]
        self._twist = PlanarTwist(self._twist.velocity + 1j * self._twist.omega * moved,
                                  self._twist.omega)

    @property
    def idle_mode(self):
        """Return what the modules do at rest, 'hold' or 'lock'."""
        return self._idle_mode

    @idle_mode.setter
    def idle_mode(self, value):
        """Take another mode."""
        if value not in IDLE_MODES:
            raise ValueError(f'idle_mode must be one of {IDLE_MODES}, got {value!r}')
        self._idle_mode = value

    @property
    def locked(self):
        """Tell whether motion is refused, for the wheels are, or are about to be, in an X."""
        return self._locked

    def lock(self):
        """Stop, turn the wheels to an X, and refuse to move until unlocked."""
        self._locked = True

    def unlock(self):
        """Obey twists again."""
        self._locked = False

    def update(self, twist, measured_angles, dt, heading=None):
        """
        Advance by one control period and return the command for the next.

        Parameters
        ----------
        twist : array_like (3,)
            `[vx, vy, omega]` [m/s, m/s, rad/s] of the centre of rotation, in the base frame,
            or in the field frame if a heading is given.
        measured_angles : array_like (n,) or None
            Steering angles [rad], multi-turn; NaN where not known: then the base stops, the
            wheel of a module never seen stands, and its angle is a mere 0. None for open
            loop: the modules are where they were told to be.
        dt : float
            Time [s] since the previous update. At 0 the previous command is repeated.
        heading : float, optional
            Heading of the base in the field [rad].

        Returns
        -------
        ModuleCommand

        Raises
        ------
        ValueError
            If an array has the wrong shape.

        """
        measured, all_known = self._locate(measured_angles)
        # 1. A twist that is not finite is refused whole: the last valid one stays the target.
        # 2. A field-centric twist is turned into the base frame.
        refused = not self._accept(twist, heading)
        if not dt > SHORTEST_STEP:
            return self._command(refused=refused)
        dt = min(float(dt), LONGEST_STEP)
        previous, acceleration = self._motion(heading is not None, dt)
        # 3. to 7. The goal of every module, within the limits of the chassis.
        if all_known and not self._locked:
            plan = self._plan(previous, acceleration, measured, dt)
        else:
            plan = self._stop(measured, dt)
        # 8. As much of the way there as all modules can go.
        fraction, setpoints = self._advance(plan.goals, measured, dt)
        # 9. A wheel that still swings drives only along what was asked of it.
        speeds = self._swinging_speeds(setpoints, measured, dt)

        twist = between(self._twist, plan.twist, fraction)
        self._acceleration = rate_between(previous, twist, dt)
        self._twist, self._flipped = twist, plan.flipped
        self._setpoints, self._speeds = setpoints, speeds
        return self._command(plan.scale, fraction, plan.unreachable, refused)

    def _locate(self, measured_angles):
        """Return where the modules are, and if all are known now; adopt those first seen."""
        if measured_angles is None:
            self._known = [True] * len(self._setpoints)
            return [setpoint.angle for setpoint in self._setpoints], True
        measured = as_floats(measured_angles, len(self._setpoints), 'measured_angles')
        all_known = True
        for i, angle in enumerate(measured):
            if not math.isfinite(angle):
                measured[i], all_known = self._setpoints[i].angle, False
            elif not self._known[i]:
                self._setpoints[i], self._known[i] = Setpoint(0.0, angle), True
        return measured, all_known

    def _accept(self, twist, heading):
        """Make a finite twist the target, in the base frame; tell whether it was finite."""
        x, y, omega = as_floats(twist, 3, 'twist')
        if not all(map(math.isfinite, (x, y, omega, heading or 0.0))):
            return False
        factor = min(1.0, ratio(SPEED_CEILING, max(abs(x), abs(y), abs(omega))))
        asked = PlanarTwist(complex(x * factor, y * factor), omega * factor)
        self._target = asked if heading is None else turned(asked, -heading)
        return True

    def _motion(self, in_field, dt):
        """
        Return twist and acceleration of the previous period as the limits shall see them.

        A straight line in the field needs no acceleration, though in the base frame, which
        turns, its velocity turns back.
        """
        if not in_field:
            return self._twist, self._acceleration
        turn = -self._twist.omega * dt
        return turned(self._twist, turn), turned(self._acceleration, turn)

    def _plan(self, previous, acceleration, measured, dt):
        """Return the plan towards the target: to drive, or first to stop if need be."""
        if self._target == REST:
            return self._stop(measured, dt)
        # 3. Limits of speed, acceleration and jerk, by one common scale.
        scale = speed_scale(self._target, self._offsets, self.limits)
        asked = scaled(self._target, scale)
        limited = limited_twist(asked, previous, acceleration, self.limits, dt)
        # 4. and 6. Discretize; where that makes a module too fast, scale and do it again.
        straight, saturation = saturated(
            limited, self._offsets, self.limits.max_module_speed, dt)
        # 5. and 7. Velocities of the modules, and the nearest angle in range for each.
        possible, choices, unreachable = choose_all(
            straight, self._offsets, self._setpoints, measured, self._flipped, self._ranges)
        goals, flipped, _ = map(list, zip(*choices))
        if self._must_stop(goals, asked, limited == asked, measured, dt):
            return self._stop(measured, dt)._replace(unreachable=unreachable)
        twist = displacing(possible, dt) if any(unreachable) else scaled(limited, saturation)
        return _Plan(twist, goals, flipped, scale * saturation, unreachable)

    def _must_stop(self, goals, asked, arriving, measured, dt):
        """
        Tell whether the base must come to rest before the modules can go for their goals.

        So it must where all modules reverse: on the way from one twist to the other they
        would swing about at a crawl, while at rest they need only the shorter turn, or none.
        And where one must turn round within its range, the long way.
        """
        if arriving and within_reach(self._setpoints, goals, *self._steps(dt)):
            return False
        velocities = module_velocities(asked, self._offsets)
        along = [(cmath.rect(*setpoint).conjugate() * velocity).real
                 for setpoint, velocity in zip(self._setpoints, velocities)
                 if not at_rest(setpoint)]
        if along and max(along) < 0.0:
            return True
        if not self._has_end_stops:
            return False
        _, final, _ = choose_all(
            asked, self._offsets, self._setpoints, measured, self._flipped, self._ranges)
        final_goals = [choice.goal for choice in final]
        return any(map(leaves_range, self._setpoints, goals, self._ranges)) or any(
            map(leaves_range, self._setpoints, final_goals, self._ranges))

    def _stop(self, measured, dt):
        """Return the plan to slow down along the present curve; at rest, to hold or to lock."""
        present, none = self._twist, [None] * len(self._setpoints)
        if self._is_at_rest():
            return _Plan(REST, self._resting_goals(measured), none, 1.0, [False] * len(none))
        size = product(present, present)
        along = product(self._acceleration, present) / size if size > 0.0 else 0.0
        slower = limited_twist(REST, present, scaled(present, along), self.limits, dt)
        factor = product(slower, present) / size if size > 0.0 else 0.0
        peak = max(abs(setpoint.speed) for setpoint in self._setpoints)
        factor = min(factor, max(1.0, ratio(self.limits.max_module_speed, peak)))
        goals = [Setpoint(factor * speed, angle) for speed, angle in self._setpoints]
        return _Plan(scaled(present, factor), goals, none, 1.0, [False] * len(none))

    def _is_at_rest(self):
        """Tell whether all wheels stand."""
        return all(map(at_rest, self._setpoints)) and max(map(abs, self._speeds)) < MIN_SPEED

    def _resting_goals(self, measured):
        """Return the goals of modules at rest: their angles held, or the X."""
        if not self._locked and self._idle_mode == 'hold':
            return [Setpoint(0.0, angle) for _, angle in self._setpoints]
        pattern = [choose(direction, setpoint, angle, None, steering_range).goal
                   for direction, setpoint, angle, steering_range in zip(
                       x_pattern(self._offsets), self._setpoints, measured, self._ranges)]
        return [Setpoint(0.0, angle) for _, angle in pattern]

    def _steps(self, dt):
        """Return how much a steering angle [rad] and a rim speed [m/s] may change in `dt`."""
        return self.limits.max_steering_rate * dt, self.limits.max_module_acceleration * dt

    def _advance(self, goals, measured, dt):
        """Return the common fraction of the way to the goals that is feasible, and its end."""
        steering_step, drive_step = self._steps(dt)
        fraction = common_fraction(self._setpoints, goals, steering_step, drive_step)
        setpoints = []
        for start, goal, angle, steering_range in zip(
                self._setpoints, goals, measured, self._ranges):
            reached = next_setpoint(start, goal, fraction, steering_step)
            setpoints.append(within_bounds(reached, start, angle, steering_range))
        return fraction, setpoints

    def _swinging_speeds(self, setpoints, measured, dt):
        """Return the rim speeds times the cosine of the steering error, at a bounded rate."""
        _, drive_step = self._steps(dt)
        return [before + clamped(setpoint.speed * math.cos(setpoint.angle - angle) - before,
                                 drive_step)
                for setpoint, angle, before in zip(setpoints, measured, self._speeds)]

    def _command(self, scale=1.0, fraction=0.0, blocked=None, refused=False):
        """Return the present state as a command."""
        return ModuleCommand(
            list(self._speeds), [setpoint.angle for setpoint in self._setpoints], self._twist,
            scale, fraction, blocked or [False] * len(self._speeds), refused)
