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
The nearest twist that all modules can do, where end stops keep some from a commanded one.

Nearest by the sum of the squared differences of all module velocities. Seen from the middle of the
modules, that is the length of a vector: the velocity, and the yaw rate times the root mean square
distance of the modules. A module at an end stop moves along one line, which leaves a plane of such
vectors; two modules leave the line in which their planes meet, and more of them the same line or
rest. So there are few twists to compare.
"""

from collections.abc import Callable, Sequence
import itertools
import math
from typing import NamedTuple

from swerve_kinematics.core.control.steering import SteeringRange
from swerve_kinematics.core.geometry.planar import PlanarTwist, REST, seen_from

Vector = tuple[float, float, float]

# What a turn of a wheel by 1 rad counts for, as a part of the commanded velocities: of two twists
# that are about as near, the base takes the one that is less trouble, and stays with it.
TURN_COST = 0.05
# Relative: planes this nearly parallel are one, and what is no nearer than rest by more is rest.
ROUNDING = 1e-9


class Face(NamedTuple):
    """
    The twists that keep one or two modules at an end stop.

    Attributes
    ----------
    stopped : frozenset of int
        Those modules.
    axis : tuple of float (3,)
        Of length 1: across a plane, or along a line.
    is_plane : bool
        Whether one end stop leaves a plane; two leave a line, those of one module that on which
        it stands.

    """

    stopped: frozenset[int]
    axis: Vector
    is_plane: bool

    def nearest(self, wanted: Vector) -> Vector:
        """Return its vector nearest to another one."""
        part = _dot(self.axis, wanted)
        along = part * self.axis[0], part * self.axis[1], part * self.axis[2]
        if self.is_plane:
            return wanted[0] - along[0], wanted[1] - along[1], wanted[2] - along[2]
        return along


class Projection:
    """
    Finds the nearest twist that all modules can do.

    Parameters
    ----------
    positions : list of complex
        Of the modules, from whatever point [m].
    ranges : list of SteeringRange
        What their steering joints can take.

    Attributes
    ----------
    is_needed : bool
        Whether there is any twist that a module cannot do.

    """

    def __init__(self, positions: Sequence[complex], ranges: list[SteeringRange]) -> None:
        """Find all faces of the range of the base once."""
        middle = sum(positions) / len(positions)
        arms = [position - middle for position in positions]
        self._arm = math.sqrt(sum(abs(arm) ** 2 for arm in arms) / len(arms))
        planes = [Face(frozenset([module]), _normal(angle, arm / self._arm), True)
                  for module, (arm, joint) in enumerate(zip(arms, ranges))
                  if joint.upper - joint.lower < math.pi
                  for angle in (joint.lower, joint.upper)]
        lines = (Face(first.stopped | second.stopped, _cross(first.axis, second.axis), False)
                 for first, second in itertools.combinations(planes, 2))
        self._faces = planes + [face._replace(axis=_unit(face.axis)) for face in lines
                                if _dot(face.axis, face.axis) > ROUNDING ** 2]
        self.is_needed = bool(planes)

    def nearest(self, twist: PlanarTwist, middle: complex,
                largest_turn: Callable[[PlanarTwist, frozenset[int]], float]) -> PlanarTwist:
        """
        Return the nearest of all twists that keep modules at an end stop, or rest.

        Parameters
        ----------
        twist : PlanarTwist
            Of the centre of rotation, in the base frame.
        middle : complex
            Of the modules, from the centre of rotation [m].
        largest_turn : callable
            Gives the largest turn [rad] that a wheel needs for a twist which keeps a set of
            modules at their end stops; infinity where another module cannot do it.

        """
        velocity, omega = seen_from(twist, middle)
        wanted = velocity.real, velocity.imag, omega * self._arm
        size = math.sqrt(_dot(wanted, wanted))
        nearest, least = REST, (1.0 - ROUNDING) * size
        possible = ((face.nearest(wanted), face.stopped) for face in self._faces)
        for missed, vector, stopped in sorted(
                (math.dist(wanted, vector), vector, stopped) for vector, stopped in possible):
            if missed >= least:
                break
            x, y, spin = vector
            candidate = seen_from(PlanarTwist(complex(x, y), spin / self._arm), -middle)
            cost = missed + TURN_COST * size * largest_turn(candidate, stopped)
            if cost < least:
                nearest, least = candidate, cost
        return nearest


def _normal(angle: float, arm: complex) -> Vector:
    """Return the axis across the plane of all twists that move a module along one line."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return _unit((-sine, cosine, arm.real * cosine + arm.imag * sine))


def _unit(vector: Vector) -> Vector:
    """Return a vector of length 1 with the direction of another one."""
    length = math.sqrt(_dot(vector, vector))
    return vector[0] / length, vector[1] / length, vector[2] / length


def _dot(first: Vector, second: Vector) -> float:
    """Return the scalar product of two vectors."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def _cross(first: Vector, second: Vector) -> Vector:
    """Return the vector product of two vectors."""
    return (first[1] * second[2] - first[2] * second[1],
            first[2] * second[0] - first[0] * second[2],
            first[0] * second[1] - first[1] * second[0])
