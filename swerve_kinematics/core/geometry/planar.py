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
Twists and module velocities as complex numbers, for the controller.

A vector (x, y) of the base frame is the number x + iy: turning it is one product, and
`conj(a) * b` holds the dot and the cross product of a and b. The controller works on one set
of a few modules at a time, where Python's own numbers are ten times as fast as arrays. The
functions for arrays of any shape are in `swerve` and `se2`; the tests hold both to agree.
"""

import cmath
from collections.abc import Sequence
import math
from typing import NamedTuple

from numpy.typing import ArrayLike

from swerve_kinematics.core.geometry.arrays import as_floats
from swerve_kinematics.core.geometry.clamping import clamped

# A command may be held for less time than the period that led to it, never for so long that
# the base turns by more than this [rad] in it: a late update must not skew the next motion.
MAX_HELD_TURN = 0.5 * math.pi
# No base is faster [m/s, rad/s]; it keeps the arithmetic of a controller without limits finite.
SPEED_CEILING = 1e6


class PlanarTwist(NamedTuple):
    """
    A twist, or its rate of change.

    Attributes
    ----------
    velocity : complex
        vx + i vy [m/s] in the base frame.
    omega : float
        [rad/s].

    """

    velocity: complex
    omega: float

    @property
    def parts(self) -> tuple[float, float, float]:
        """Return the twist as a tuple `(vx, vy, omega)`."""
        return self.velocity.real, self.velocity.imag, self.omega


REST = PlanarTwist(0j, 0.0)


def finite_twist(value: ArrayLike, name: str) -> PlanarTwist | None:
    """
    Return `[vx, vy, omega]`, known to the caller as `name`; None if one is not finite.

    What is faster than any base is scaled down to `SPEED_CEILING`.
    """
    vx, vy, omega = as_floats(value, 3, name)
    twist = PlanarTwist(complex(vx, vy), omega)
    if abs(vx) <= SPEED_CEILING and abs(vy) <= SPEED_CEILING and abs(omega) <= SPEED_CEILING:
        return twist
    if not all(map(math.isfinite, twist.parts)):
        return None
    return scaled(twist, SPEED_CEILING / max(map(abs, twist.parts)))


def scaled(twist: PlanarTwist, factor: float) -> PlanarTwist:
    """Return the twist times a factor: the same curve at another speed."""
    if factor == 1.0:
        return twist
    return PlanarTwist(twist.velocity * factor, twist.omega * factor)


def between(start: PlanarTwist, end: PlanarTwist, fraction: float) -> PlanarTwist:
    """Return the twist a fraction of the way from `start` to `end`; at 1 `end` itself."""
    if fraction >= 1.0:
        return end
    return PlanarTwist(start.velocity + fraction * (end.velocity - start.velocity),
                       start.omega + fraction * (end.omega - start.omega))


def difference(start: PlanarTwist, end: PlanarTwist) -> PlanarTwist:
    """Return the change that takes `start` to `end`."""
    return PlanarTwist(end.velocity - start.velocity, end.omega - start.omega)


def product(first: PlanarTwist, second: PlanarTwist, arm: float = 1.0) -> float:
    """Return the scalar product of two twists, their turns counted at the distance `arm` [m]."""
    return ((first.velocity.conjugate() * second.velocity).real
            + arm * arm * first.omega * second.omega)


def rate_between(start: PlanarTwist, end: PlanarTwist, dt: float) -> PlanarTwist:
    """Return the rate of change that takes `start` to `end` in `dt` [s]."""
    return PlanarTwist((end.velocity - start.velocity) / dt, (end.omega - start.omega) / dt)


def turned(twist: PlanarTwist, angle: float) -> PlanarTwist:
    """Return the twist seen from a frame turned by `-angle` [rad]."""
    return PlanarTwist(twist.velocity * cmath.rect(1.0, angle), twist.omega)


def seen_from(twist: PlanarTwist, moved: complex) -> PlanarTwist:
    """Return the twist of a point that lies `moved` [m] from the one whose twist is given."""
    return PlanarTwist(twist.velocity + 1j * twist.omega * moved, twist.omega)


def straightened(twist: PlanarTwist, dt: float) -> PlanarTwist:
    """
    Return the twist that, held for `dt` [s], displaces the base as `twist` asks.

    The same as `se2.discretize`, for a turn of at most `MAX_HELD_TURN`.
    """
    return PlanarTwist(twist.velocity / _chord(twist.omega, dt), twist.omega)


def displacing(twist: PlanarTwist, dt: float) -> PlanarTwist:
    """Return the displacement per time that holding `twist` for `dt` [s] gives: the inverse."""
    return PlanarTwist(twist.velocity * _chord(twist.omega, dt), twist.omega)


def _chord(omega: float, dt: float) -> complex:
    """Return the mean direction of the base over a period, the chord of its turn."""
    half_turn = 0.5 * clamped(omega * dt, MAX_HELD_TURN)
    if half_turn == 0.0:
        return 1.0
    return cmath.rect(math.sin(half_turn) / half_turn, half_turn)


def module_velocities(twist: PlanarTwist, offsets: Sequence[complex]) -> list[complex]:
    """
    Return the velocity of every module.

    Parameters
    ----------
    twist : PlanarTwist
        Of the centre of rotation.
    offsets : list of complex
        Module positions from the centre of rotation [m].

    Returns
    -------
    list of complex
        [m/s].

    """
    velocity, spin = twist.velocity, 1j * twist.omega
    return [velocity + spin * offset for offset in offsets]


def fastest(twist: PlanarTwist, offsets: Sequence[complex]) -> float:
    """Return the speed [m/s] of the fastest module, as `module_velocities`."""
    return max(map(abs, module_velocities(twist, offsets)))


def speed_at(twist: PlanarTwist, arm: float) -> float:
    """Return the speed [m/s] of a twist, its turn counted at the distance `arm` [m]."""
    return math.hypot(abs(twist.velocity), arm * twist.omega)


def are_parallel(first: PlanarTwist, second: PlanarTwist) -> bool:
    """Tell whether two twists are of one curve, at whatever speed, but for rounding."""
    size, square = product(second, second), product(first, first)
    along = product(first, second) / size if size > 0.0 else 0.0
    across = PlanarTwist(first.velocity - along * second.velocity,
                         first.omega - along * second.omega)
    return product(across, across) <= 1e-18 * square
