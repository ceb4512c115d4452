"""The ramp between two twists: acceleration and jerk kept within their limits."""

import math

from swerve_kinematics.core.control.limits import ControllerLimits, ratio
from swerve_kinematics.core.geometry.planar import between, PlanarTwist


def limited_twist(target: PlanarTwist, previous: PlanarTwist, acceleration: PlanarTwist,
                  limits: ControllerLimits, dt: float) -> PlanarTwist:
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


def _reachable_fraction(previous: PlanarTwist, change: PlanarTwist, limits: ControllerLimits,
                        dt: float) -> float:
    """Return the fraction of `change` that the acceleration limits allow within `dt`."""
    return min(1.0,
               ratio(_linear_reach(previous.velocity, change.velocity, limits, dt),
                     abs(change.velocity)),
               ratio(limits.max_angular_acceleration * dt, abs(change.omega)))


def _linear_reach(velocity: complex, change: complex, limits: ControllerLimits,
                  dt: float) -> float:
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


def _braking_fraction(change: PlanarTwist, limits: ControllerLimits, dt: float) -> float:
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


def _bent(wanted: PlanarTwist, previous: PlanarTwist, acceleration: PlanarTwist,
          limits: ControllerLimits, dt: float) -> PlanarTwist:
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
