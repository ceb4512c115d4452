"""
One step of swerve odometry: the modules' arcs as chords, their votes, the wheel that slips.

Vectors are complex numbers here, x + iy: `1j * r` is r turned by +90 degrees and
`exp(1j * a)` the direction a. All of them are seen from the heading halfway through the
step, where the formulas are shortest. A step is about one set of a few modules, where
Python's own numbers are several times as fast as arrays.
"""

import cmath
import math
import operator
from typing import NamedTuple, Optional

from swerve_kinematics.core.geometry.angles import scalar_sinc, sinc


class Step(NamedTuple):
    """
    The rigid motion that the modules agree on for one step.

    Attributes
    ----------
    used : tuple of int (k,)
        Indices of the modules it rests on.
    group : Group
        Their geometry.
    slipping : int or None
        Index of the module left out because it contradicts the others, if any.
    turn : float
        Change of heading [rad].
    displacement : complex
        Of base_link [m], seen from the heading halfway through the step.
    errors : list of complex (k,)
        What each used module's vote is off that displacement [m].
    spread : float
        Root mean square of the errors [m].
    directions : list of complex (k,)
        Unit vectors along the used wheels halfway through the step.
    length : float
        Root mean square of the used modules' chords [m].
    wheel_turn : float
        Change of heading by the used wheels alone [rad]; NaN where they cannot tell it.

    """

    used: tuple
    group: 'Group'
    slipping: Optional[int]
    turn: float
    displacement: complex
    errors: list
    spread: float
    directions: list
    length: float
    wheel_turn: float


class Group:
    """
    Constant geometry of the modules that a step rests on.

    Attributes
    ----------
    size : int
        How many they are, k.
    quarter : list of complex (k,)
        Module positions turned by +90 degrees [m]: how far each moves per radian of turn.
    centroid : complex
        Mean of the module positions [m].
    inertia : float
        Sum of the squared distances from the centroid [m^2]; 0 where all modules are at
        one point, and rotation cannot be told from translation.

    """

    def __init__(self, positions):
        """Build it from the positions (k,) [m] as complex numbers."""
        self.size = len(positions)
        self.quarter = [1j * position for position in positions]
        self.centroid = sum(positions) / self.size
        arms = [1j * (position - self.centroid) for position in positions]
        self.inertia = sum(abs(arm) ** 2 for arm in arms)
        if self.inertia <= 1e-18 * (1.0 + abs(self.centroid)) ** 2:
            self.inertia = 0.0
        self._lever = [arm.conjugate() / self.inertia if self.inertia else 0j for arm in arms]
        # What is left of the identity once a module's own part in the fit is taken off, along
        # and across its arm: the leverages of the least-squares fit.
        self._directions = [cmath.rect(1.0, -cmath.phase(arm)) for arm in arms]
        self._free = 1.0 - 1.0 / self.size
        self._free_across = [max(self._free - abs(arm * lever), 1e-9)
                             for arm, lever in zip(arms, self._lever)]

    def rate(self, velocities):
        """Return the yaw rate [rad/s] of the rigid body that fits the velocities best."""
        return sum(map(operator.mul, self._lever, velocities)).real

    def turn(self, chords):
        """Return the change of heading [rad] of the rigid motion that fits the chords best."""
        # A rigid turn moves a module by 2 sin(turn / 2) for each metre of its arm.
        return 2.0 * math.asin(min(max(0.5 * self.rate(chords), -1.0), 1.0))

    def votes(self, chords, turn):
        """Return the displacement of base_link that each module implies (k,) [m]."""
        factor = 2.0 * math.sin(0.5 * turn)
        return [chord - factor * quarter for chord, quarter in zip(chords, self.quarter)]

    def suspect(self, errors, heading_known):
        """
        Return the place in the group of the module without which the others agree best.

        Leaving out module j lowers the sum of squared errors by `e_j' (I - H_j)^-1 e_j`, with
        H_j its block of the hat matrix (Cook & Weisberg, Residuals and Influence in
        Regression, 2.2): no fit needs to be repeated.
        """
        if heading_known:
            gains = [abs(error) for error in errors]
        else:
            local = map(operator.mul, errors, self._directions)
            gains = [error.imag ** 2 / self._free + error.real ** 2 / free
                     for error, free in zip(local, self._free_across)]
        return gains.index(max(gains))


class Layout:
    """
    All modules of a base, and the groups that remain when some are left out.

    Parameters
    ----------
    module_positions : ndarray (n, 2)
        From base_link [m].

    """

    def __init__(self, module_positions):
        """Keep the positions; groups are built when first used."""
        self._positions = [complex(x, y) for x, y in module_positions.tolist()]
        self._groups = {}

    def group(self, used):
        """Return the geometry of the modules with the indices `used`, a tuple."""
        if used not in self._groups:
            self._groups[used] = Group([self._positions[module] for module in used])
        return self._groups[used]


def chords(distance, steering, direction, turn):
    """
    Return the displacement of each module over a step: for arrays, of many steps at once.

    A wheel that rolls `distance` while its direction turns steadily by `steering` (relative
    to the base) plus `turn` (of the base) runs along an arc. The chord of that arc is shorter
    by sinc of half the turning and points to the direction at half time. Exact for a constant
    twist and for constant steering rates; the angle at the end of the step, which the common
    method takes, is wrong by half the turning.

    Parameters
    ----------
    distance, steering : ndarray (k,)
        Rolled [m] and steered [rad] in the step.
    direction : ndarray of complex (k,)
        Unit vectors along the wheels halfway through the step.
    turn : float
        Change of heading in the step [rad].

    Returns
    -------
    ndarray of complex (k,)
        Chords [m], seen from the heading halfway through the step.

    """
    return distance * sinc(0.5 * (steering + turn)) * direction


def solve_step(layout, used, distance, angle, steering, turn, tolerance, ratio):
    """
    Return the rigid motion that explains one step, without the wheel that slips.

    Parameters
    ----------
    layout : Layout
        All modules of the base, those out of use too.
    used : tuple of int (k,)
        Indices of the modules with data.
    distance : list of float (n,)
        Rolled in the step [m].
    angle, steering : list of float (n,)
        Steering angle at the start of the step and its change [rad].
    turn : float or None
        Change of heading [rad] by a gyro; None to take it from the wheels.
    tolerance : float
        Spread of the votes [m] that is no slip.
    ratio : float
        A module is left out if the spread falls by this factor without it.

    Returns
    -------
    Step or None
        None if the modules in use cannot tell the motion.

    """
    step = _fit(layout, used, distance, angle, steering, turn)
    # Three votes are the fewest of which two can overrule one; the heading costs one more.
    enough = 3 if turn is not None else 4
    if step is None or len(used) < enough or step.spread <= tolerance:
        return step
    suspect = used[step.group.suspect(step.errors, turn is not None)]
    others = tuple(module for module in used if module != suspect)
    without = _fit(layout, others, distance, angle, steering, turn)
    if without is None or ratio * without.spread > step.spread:
        return step
    return without._replace(slipping=suspect)


def _fit(layout, used, distance, angle, steering, turn):
    """Return the Step of the modules with the indices `used`, None if they cannot tell it."""
    if not used:
        return None
    group = layout.group(used)
    if turn is None and not group.inertia:
        return None
    directions = [cmath.rect(1.0, angle[i] + 0.5 * steering[i]) for i in used]

    def arcs(turn):
        return [distance[i] * scalar_sinc(0.5 * (steering[i] + turn)) * direction
                for i, direction in zip(used, directions)]

    paths = arcs(turn or 0.0)
    wheel_turn = group.turn(paths) if group.inertia else math.nan
    if turn is None:
        # The chords need the turn that they are to tell: the second pass knows it.
        paths = arcs(wheel_turn)
        turn = wheel_turn = group.turn(paths)
    votes = group.votes(paths, turn)
    displacement = sum(votes) / group.size
    errors = [vote - displacement for vote in votes]
    return Step(used, group, None, turn, displacement, errors, _rms(errors), directions,
                _rms(paths), wheel_turn)


def _rms(values):
    """Return the root mean square of complex values."""
    return math.hypot(*map(abs, values)) / math.sqrt(len(values))
