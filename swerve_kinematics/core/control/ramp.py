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

"""The ramp between two twists, on the curve of the target and within the accelerations."""

import math

from swerve_kinematics.core.control.limits import ControllerLimits, ratio
from swerve_kinematics.core.geometry.planar import between, difference, fastest, PlanarTwist

# Relative, of a change that ends at the point nearest to rest.
ROUNDING = 1e-9
# A jerk that changes less of the way in one period than this takes a billion of them: as good as
# for ever.
SMALLEST_STEP = 1e-18
# One that could change so many times the way ends an acceleration at once, as good as.
LARGE_STEP = 10.0


def ramped(target: PlanarTwist, previous: PlanarTwist, offsets: list[complex],
           limits: ControllerLimits, dt: float) -> PlanarTwist:
    """
    Return the twist to make for in this period on the way from `previous` to `target`.

    The change goes straight to the target, linear and angular part by one common fraction:
    from rest and to rest the base stays on the curve of the target. With a jerk limit the
    change is lowered in time to arrive without overshoot.

    Parameters
    ----------
    target, previous : PlanarTwist
        The target within the speed limits.
    offsets : list of complex
        Module positions from the centre of rotation [m].
    limits : ControllerLimits
        Those of acceleration and jerk count.
    dt : float
        Positive [s].

    Returns
    -------
    PlanarTwist

    """
    change = difference(previous, target)
    fraction = min(1.0,
                   ratio(_linear_reach(previous.velocity, change.velocity, limits, dt),
                         abs(change.velocity)),
                   ratio(limits.max_angular_acceleration * dt, abs(change.omega)))
    if limits.has_jerk:
        # What the drives can do is here a limit of the base: no setpoint may lag behind.
        fraction = min(fraction, _braking_fraction(change, limits, dt),
                       ratio(limits.max_module_acceleration * dt, fastest(change, offsets)))
    return between(previous, target, fraction)


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
    if limits.has_jerk and falling < (1.0 - ROUNDING) * abs(change):
        # Past the nearest point the acceleration could not drop to the other limit at once.
        slower = min(slower, faster)
    if slower <= falling:
        return slower
    return falling + faster * (1.0 - falling / slower)


def _braking_fraction(change: PlanarTwist, limits: ControllerLimits, dt: float) -> float:
    """
    Return the largest fraction of `change` from which the jerk limits still can brake.

    An acceleration a takes `a^2 / (2 jerk)` to end if it falls steadily, and less in periods, of
    whatever length: within each it is already as low as at its end. As much of the change must be
    left: `1 - f = f^2 / (2 step)`, with f the part of the change and `step` that of the jerk.
    """
    step = dt * dt * min(ratio(limits.max_linear_jerk, abs(change.velocity)),
                         ratio(limits.max_angular_jerk, abs(change.omega)))
    if step >= LARGE_STEP:
        return 1.0
    return 2.0 / (1.0 + math.sqrt(1.0 + 2.0 / max(step, SMALLEST_STEP)))
