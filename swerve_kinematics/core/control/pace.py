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
How fast a curve can be run: what its turns ask of motors and floor, whatever the ramp.

A straight line in the world, driven by a base that turns, is a velocity that turns back in the
base frame. So is any curve that the base does not follow with its heading. Neither can be run
faster than its steering and its drives allow; slower, each is the same curve.
"""

import math

from swerve_kinematics.core.control.limits import ControllerLimits, ratio
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.geometry.angles import phase
from swerve_kinematics.core.geometry.clamping import clamped
from swerve_kinematics.core.geometry.planar import PlanarTwist

# A turn of the commanded velocity is averaged over this time [s]: a few messages of a slow sender.
AVERAGING_TIME = 0.2
# The part of an acceleration limit that a turn may take; the rest leads back to the curve.
TURNING_PART = 0.9
# A turn of the command counts as undoing the base's own up to this many times that of one
# period: a slow sender undoes several periods at once.
MOST_UNDONE = 3.0
# The part of the base's turn that a command must undo to be taken for a line in the world.
STRAIGHT = 0.7
# A larger change of direction [rad] between two commands is a jump, not a turn.
LARGEST_TURN = 0.5
# A velocity that turns more slowly [rad/s] turns for no one.
SLOWEST_TURN = 1e-3
# Where a module passes the point that the base turns about, its direction turns over at once,
# and no speed above 0 is slow enough. It shall not stop the base: this part always remains.
SLOWEST_PASS = 0.3


class Turning:
    """How the commanded velocity turns in the base frame, averaged over a short time."""

    def __init__(self) -> None:
        """Begin with what does not turn."""
        # All in [rad/s]: of the commanded velocity's direction; the same, of turns that can
        # have undone those of the base; and of the base.
        self._rate = self._undone = self._omega = 0.0

    def pass_time(self, before: complex, commanded: complex, omega: float, dt: float) -> None:
        """
        Take one more period into account.

        Parameters
        ----------
        before, commanded : complex
            Commanded velocities [m/s] of the last period and of this one, in the base frame.
        omega : float
            Yaw rate of the base in the last period [rad/s].
        dt : float
            Positive [s].

        """
        rate = 0.0
        if commanded != before and commanded and before:
            turn = phase(commanded * before.conjugate())
            if abs(turn) <= LARGEST_TURN:
                rate = turn / dt
        share = dt / (AVERAGING_TIME + dt)
        self._omega += share * (omega - self._omega)
        undone = clamped(rate, MOST_UNDONE * abs(self._omega))
        self._rate += share * (rate - self._rate)
        self._undone += share * (undone - self._undone)

    def is_straight(self, omega: float) -> bool:
        """Tell whether the velocity is sure to keep to a line in the world at this yaw rate."""
        needed = STRAIGHT * max(abs(omega), abs(self._omega))
        return self._undone * omega < 0.0 and abs(self._undone) >= needed

    def scale(self, twist: PlanarTwist, offsets: Offsets, limits: ControllerLimits) -> float:
        """
        Return the largest factor, at most 1, at which a twist can be run while it turns.

        Parameters
        ----------
        twist : PlanarTwist
            Within the speed limits, in the base frame.
        offsets : Offsets
            Module positions from the centre of rotation [m].
        limits : ControllerLimits
            Those of the accelerations and of the steering rate count.

        """
        if abs(self._rate) < SLOWEST_TURN and abs(self._undone) < SLOWEST_TURN:
            return 1.0
        # How much of the base's own turn the velocity undoes: 1 on a straight line.
        straightness = (min(1.0, -self._undone / self._omega)
                        if self._undone * self._omega < 0.0 else 0.0)
        speed = abs(twist.velocity)
        needed = speed * abs(self._rate + straightness * self._omega)
        least = TURNING_PART * limits.least_linear_acceleration
        scale = 1.0 if needed <= least else least / needed
        line_rate = straightness * abs(twist.omega)
        if line_rate > 0.0 and speed > 0.0:
            if limits.max_module_acceleration < math.inf:
                pull = line_rate * min(speed, abs(twist.omega) * offsets.reach)
                scale = min(scale, math.sqrt(ratio(
                    TURNING_PART * limits.max_module_acceleration, pull)))
            if limits.max_steering_rate < math.inf:
                scale = min(scale, _steering_scale(twist, line_rate, offsets, limits))
        return scale


def turn_back(velocity: complex, goal: complex, base_turn: float) -> float:
    """
    Return the part of the base's own turn that brings a velocity nearest to its goal.

    Parameters
    ----------
    velocity, goal : complex
        [m/s], in the base frame before and after the turn.
    base_turn : float
        [rad].

    Returns
    -------
    float
        Angle [rad] by which to turn the velocity: from -base_turn, which keeps it straight in
        the world, to 0, which keeps it fixed to the base.

    """
    change = goal * velocity.conjugate()
    if base_turn == 0.0 or not change:
        return 0.0
    turn = phase(change)
    if 0.0 <= -turn / base_turn <= 1.0:
        return turn
    # Outside, one of the ends is nearest: the one with the greater cosine.
    return -base_turn if math.cos(turn + base_turn) > math.cos(turn) else 0.0


def _steering_scale(twist: PlanarTwist, line_rate: float, offsets: Offsets,
                    limits: ControllerLimits) -> float:
    """
    Return the factor at which the steering follows a velocity that turns back in the base.

    A module's velocity is V + i omega r. While V turns, its steering rate is greatest where
    the two point against each other: `rate V / |V - |omega r||`. Before that point the base
    slows down in time: `k^2 = k0^2 + 2 b s`, with s the turn that is left and b what the
    limits of the base allow k to fall in a unit of time.
    """
    velocity, omega = twist
    speed, slowest, spin_rate = abs(velocity), 1.0, -1j * omega
    needed = line_rate * speed
    if limits.max_steering_rate * (speed - abs(omega) * offsets.reach) >= needed:
        return 1.0
    for offset in offsets:
        spin = spin_rate * offset
        gap = abs(speed - abs(spin))
        if limits.max_steering_rate * gap >= needed or not spin:
            continue
        passing = max(SLOWEST_PASS, limits.max_steering_rate * gap / needed)
        # Positive while the two directions draw nearer to each other.
        ahead = math.copysign(1.0, omega) * phase(velocity * spin.conjugate())
        left = ahead if ahead > 0.0 else math.tau + ahead
        fall = min(ratio(limits.max_linear_deceleration, speed),
                   ratio(limits.max_angular_acceleration, abs(omega)))
        slowest = min(slowest, math.sqrt(passing * passing + 2.0 * fall * left / line_rate))
    return slowest
