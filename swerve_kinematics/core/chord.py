"""
One step of swerve odometry: the modules' arcs as chords, their votes, the wheel that slips.

Vectors are complex numbers here, x + iy: `1j * r` is r turned by +90 degrees and
`exp(1j * a)` the direction a. All of them are seen from the heading halfway through the
step, where the formulas are shortest.
"""

import math
from typing import NamedTuple

import numpy as np

from swerve_kinematics.core.angles import sinc


class Step(NamedTuple):
    """
    The rigid motion that the modules agree on for one step.

    Attributes
    ----------
    used : ndarray of bool (n,)
        The modules it rests on.
    group : Group
        Their geometry.
    slipping : ndarray of bool (n,)
        The module left out because it contradicts the others, if any.
    turn : float
        Change of heading [rad].
    displacement : complex
        Of base_link [m], seen from the heading halfway through the step.
    errors : ndarray of complex (k,)
        What each used module's vote is off that displacement [m].
    directions : ndarray of complex (k,)
        Unit vectors along the used wheels halfway through the step.
    length : float
        Root mean square of the used modules' chords [m].
    wheel_turn : float
        Change of heading by the used wheels alone [rad]; NaN where they cannot tell it.

    """

    used: np.ndarray
    group: 'Group'
    slipping: np.ndarray
    turn: float
    displacement: complex
    errors: np.ndarray
    directions: np.ndarray
    length: float
    wheel_turn: float

    @property
    def spread(self):
        """Return the root mean square of the errors [m]."""
        return _rms(self.errors)


class Group:
    """
    Constant geometry of the modules that a step rests on.

    Attributes
    ----------
    quarter : ndarray of complex (k,)
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
        self.quarter = 1j * positions
        self.centroid = positions.mean()
        arms = 1j * (positions - self.centroid)
        self.inertia = float(np.sum(np.abs(arms) ** 2))
        if self.inertia <= 1e-18 * (1.0 + np.abs(self.centroid)) ** 2:
            self.inertia = 0.0
        self._lever = np.conj(arms) / self.inertia if self.inertia else 0.0 * arms
        # What is left of the identity once a module's own part in the fit is taken off, along
        # and across its arm: the leverages of the least-squares fit.
        self._directions = np.exp(-1j * np.angle(arms))
        self._free = 1.0 - 1.0 / self.size
        self._free_across = np.maximum(self._free - np.abs(arms * self._lever), 1e-9)

    def rate(self, velocities):
        """Return the yaw rate [rad/s] of the rigid body that fits the velocities best."""
        return float((self._lever @ velocities).real)

    def turn(self, chords):
        """Return the change of heading [rad] of the rigid motion that fits the chords best."""
        # A rigid turn moves a module by 2 sin(turn / 2) for each metre of its arm.
        return 2.0 * math.asin(min(max(0.5 * self.rate(chords), -1.0), 1.0))

    def votes(self, chords, turn):
        """Return the displacement of base_link that each module implies (k,) [m]."""
        return chords - 2.0 * math.sin(0.5 * turn) * self.quarter

    def suspect(self, errors, heading_known):
        """
        Return the index of the module without which the others agree best.

        Leaving out module j lowers the sum of squared errors by `e_j' (I - H_j)^-1 e_j`, with
        H_j its block of the hat matrix (Cook & Weisberg, Residuals and Influence in
        Regression, 2.2): no fit needs to be repeated.
        """
        if heading_known:
            return np.argmax(np.abs(errors))
        local = errors * self._directions
        return np.argmax(local.imag ** 2 / self._free + local.real ** 2 / self._free_across)


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
        self._positions = module_positions[:, 0] + 1j * module_positions[:, 1]
        self._groups = {}

    def group(self, used):
        """Return the geometry of the modules marked in `used`, bool (n,)."""
        key = used.tobytes()
        if key not in self._groups:
            self._groups[key] = Group(self._positions[used])
        return self._groups[key]


def chords(distance, steering, direction, turn):
    """
    Return the displacement of each module over a step.

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
    used : ndarray of bool (n,)
        Modules with data.
    distance : ndarray (n,)
        Rolled in the step [m].
    angle, steering : ndarray (n,)
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
    if step is None or len(step.errors) < enough or step.spread <= tolerance:
        return step
    slipping = np.zeros_like(used)
    slipping[np.flatnonzero(used)[step.group.suspect(step.errors, turn is not None)]] = True
    without = _fit(layout, used & ~slipping, distance, angle, steering, turn)
    if without is None or ratio * without.spread > step.spread:
        return step
    return without._replace(slipping=slipping)


def _fit(layout, used, distance, angle, steering, turn):
    """Return the Step of the modules marked in `used`, or None if they cannot tell it."""
    if not used.any():
        return None
    group = layout.group(used)
    if turn is None and not group.inertia:
        return None
    distance, steering = distance[used], steering[used]
    direction = np.exp(1j * (angle[used] + 0.5 * steering))
    arcs = chords(distance, steering, direction, turn or 0.0)
    wheel_turn = group.turn(arcs) if group.inertia else np.nan
    if turn is None:
        # The chords need the turn that they are to tell: the second pass knows it.
        arcs = chords(distance, steering, direction, wheel_turn)
        turn = wheel_turn = group.turn(arcs)
    votes = group.votes(arcs, turn)
    displacement = votes.sum() / group.size
    return Step(used, group, np.zeros_like(used), turn, displacement, votes - displacement,
                direction, _rms(arcs), wheel_turn)


def _rms(values):
    """Return the root mean square of complex values."""
    return math.sqrt(np.vdot(values, values).real / len(values))
