"""What a base may do, and the limiter that keeps a twist within it along its curve."""

import dataclasses
import math

from swerve_kinematics.core.geometry.planar import (
    between, fastest, PlanarTwist, scaled, straightened)

# Rounds of scaling and discretizing in turn. Each takes the misfit down by about half the
# turn of one period [rad] (0.02 at 2 rad/s and 50 Hz).
SATURATION_ROUNDS = 4


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

    Raises
    ------
    ValueError
        If a limit is not positive or is NaN.

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

    def __post_init__(self):
        """Refuse what cannot be a limit, and keep plain numbers."""
        for field in dataclasses.fields(self):
            value = float(getattr(self, field.name))
            if not value > 0.0:
                raise ValueError(f'{field.name} must be positive (inf: no limit), got {value}')
            object.__setattr__(self, field.name, value)

    @property
    def has_jerk(self):
        """Tell whether a jerk limit is set."""
        return min(self.max_linear_jerk, self.max_angular_jerk) < math.inf


def ratio(limit, value):
    """Return how often `value` >= 0 fits into `limit`: infinity for 0."""
    return limit / value if value > 0.0 else math.inf


def speed_scale(twist, offsets, limits):
    """
    Return the largest factor, at most 1, that brings a twist within the speed limits.

    One factor for the linear and the angular part: a curve stays the same curve.

    Parameters
    ----------
    twist : PlanarTwist
        Asked of the centre of rotation, in the base frame.
    offsets : list of complex
        Module positions from the centre of rotation [m].
    limits : ControllerLimits
        Those of linear, angular and module speed count.

    """
    return min(1.0,
               ratio(limits.max_linear_speed, abs(twist.velocity)),
               ratio(limits.max_angular_speed, abs(twist.omega)),
               ratio(limits.max_module_speed, fastest(twist, offsets)))


def saturated(twist, offsets, max_module_speed, dt):
    """
    Discretize a twist, and scale it until no module is too fast.

    The skew that `discretize` takes out grows with omega, so a scaled twist needs another
    one: scaling the discretized twist alone would leave the line that was asked for.

    Parameters
    ----------
    twist : PlanarTwist
        Of the centre of rotation, in the base frame, not yet discretized.
    offsets : list of complex
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
    scale, excess = 1.0, math.inf
    for _ in range(SATURATION_ROUNDS):
        straight = straightened(scaled(twist, scale), dt)
        excess = fastest(straight, offsets) / max_module_speed
        if excess <= 1.0:
            return straight, scale
        scale /= excess
    return scaled(straight, 1.0 / excess), scale


def limited_twist(target, previous, acceleration, limits, dt):
    """
    Return the twist to run next on the way from `previous` to `target`.

    The change goes straight to the target, linear and angular part by one common fraction:
    from rest and to rest the base stays on the curve of the target. With a jerk limit the
    present acceleration is bent into that direction, and lowered in time to arrive without
    overshoot. Where the limits contradict each other, that of speed comes before that of
    acceleration, and jerk is last.

    Parameters
    ----------
    target, previous : PlanarTwist
        The target within the speed limits.
    acceleration : PlanarTwist
        Of the previous step [m/s^2, rad/s^2]; used with a jerk limit only.
    limits : ControllerLimits
        Those of acceleration and jerk count; with jerk, those of chassis speed too.
    dt : float
        Positive [s].

    Returns
    -------
    PlanarTwist

    """
    change = PlanarTwist(target.velocity - previous.velocity, target.omega - previous.omega)
    fraction = _reachable_fraction(previous, change, limits, dt)
    if not limits.has_jerk:
        return between(previous, target, fraction)
    fraction = min(fraction, _braking_fraction(change, limits, dt))
    return _bent(between(previous, target, fraction), previous, acceleration, limits, dt)


def _reachable_fraction(previous, change, limits, dt):
    """Return the fraction of `change` that the acceleration limits allow within `dt`."""
    return min(1.0,
               ratio(_linear_reach(previous.velocity, change.velocity, limits, dt),
                     abs(change.velocity)),
               ratio(limits.max_angular_acceleration * dt, abs(change.omega)))


def _linear_reach(velocity, change, limits, dt):
    """
    Return how far [m/s] the velocity may move along `change` within `dt`.

    On a straight line in the velocity plane the speed falls up to the point nearest to rest
    and rises beyond it, so the deceleration limit holds before it, the other one after.
    """
    faster, slower = limits.max_linear_acceleration * dt, limits.max_linear_deceleration * dt
    falling = -(velocity.conjugate() * change).real / abs(change) if change else 0.0
    if falling <= 0.0:
        return faster
    if limits.has_jerk and falling < (1.0 - 1e-9) * abs(change):
        # Past the nearest point the acceleration could not drop to the other limit at once.
        slower = min(slower, faster)
    if slower <= falling:
        return slower
    return falling + faster * (1.0 - falling / slower)


def _braking_fraction(change, limits, dt):
    """
    Return the largest fraction of `change` from which the jerk limits still can brake.

    In N periods of falling acceleration, its last step one jerk step high, the change left
    is 1 = N f - N (N - 1) / 2 * jerk dt^2, f the first one's share. (The discrete
    time-optimal control of Han, "From PID to active disturbance rejection control", 2009.)
    """
    step = dt * dt * min(ratio(limits.max_linear_jerk, abs(change.velocity)),
                         ratio(limits.max_angular_jerk, abs(change.omega)))
    if step >= 1.0:
        return 1.0
    periods = math.ceil(0.5 * (math.sqrt(1.0 + 8.0 / max(step, 1e-18)) - 1.0))
    return 1.0 / periods + 0.5 * (periods - 1) * step


def _bent(wanted, previous, acceleration, limits, dt):
    """Return the twist nearest to `wanted` that the jerk limits allow, speed limits kept."""
    coasting = PlanarTwist(previous.velocity + acceleration.velocity * dt,
                           previous.omega + acceleration.omega * dt)
    bend = min(1.0,
               ratio(limits.max_linear_jerk * dt * dt, abs(wanted.velocity - coasting.velocity)),
               ratio(limits.max_angular_jerk * dt * dt, abs(wanted.omega - coasting.omega)))
    if bend == 1.0:
        return wanted
    twist = between(coasting, wanted, bend)
    change = PlanarTwist(twist.velocity - previous.velocity, twist.omega - previous.omega)
    twist = between(previous, twist, _reachable_fraction(previous, change, limits, dt))
    speed = max(limits.max_linear_speed, abs(previous.velocity))
    omega = max(limits.max_angular_speed, abs(previous.omega))
    return PlanarTwist(twist.velocity * min(1.0, ratio(speed, abs(twist.velocity))),
                       max(-omega, min(omega, twist.omega)))
