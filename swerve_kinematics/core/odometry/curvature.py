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

"""How the path of a wheel leaves the direction of its chord, by the step before."""

# Steps that differ in length by more than this factor tell nothing about each other.
LARGEST_RATIO = 2.5

# Nor does a step in which a wheel turned further than this [rad]: the expansion is about
# small turns, and a wheel that turns so fast for its step stands nearly still.
LARGEST_TURN = 1.0


class Bend:
    """
    What the step before says about the curvature of the present one.

    A chord knows the mean direction of an arc that was run at constant speed and constant
    turning rate. Where both change linearly, the path ends beside it: the integral of
    `(v + v' t) (c t / h + c'' (t^2 - h^2 / 4) / 2)` over the step, with speed and turning rate
    through the middles of the two steps, is `w (d c' - d' c)`. Here d and c are the distance
    and the turning of this step of duration h, d' and c' those of the step before, of
    duration H, scaled by h / H, and `w = h / (6 (h + H))`.

    Parameters
    ----------
    weight : float
        `w h / H`, for distances and turnings of the step before as they were.
    rolled, steered : list of float (n,)
        Distance [m] and change of the steering angle [rad] in the step before.
    turn : float
        Change of heading in it [rad].
    used : tuple of int
        The modules that took part in that step; the others have no past.

    """

    def __init__(self, weight: float, rolled: list[float], steered: list[float], turn: float,
                 used: tuple[int, ...]) -> None:
        """Keep the step before."""
        self._weight, self._turn, self._used = weight, turn, used
        self._rolled, self._steered = rolled, steered

    def sideways(self, module: int, rolled: float, turned: float) -> float:
        """Return how far [m] the path of a module ends to the left of its mean direction."""
        if module not in self._used:
            return 0.0
        before = self._steered[module] + self._turn
        if -LARGEST_TURN <= turned <= LARGEST_TURN and -LARGEST_TURN <= before <= LARGEST_TURN:
            return self._weight * (rolled * before - self._rolled[module] * turned)
        return 0.0


STRAIGHT = Bend(0.0, [], [], 0.0, ())


def bend_after(duration_before: float, rolled: list[float], steered: list[float], turn: float,
               used: tuple[int, ...], duration: float) -> Bend:
    """
    Return the Bend of a step that follows another one without a gap.

    Parameters
    ----------
    duration_before : float
        Of that step [s].
    rolled, steered : list of float (n,)
        Of that step [m], [rad].
    turn : float
        Change of heading in it [rad].
    used : tuple of int
        The modules it rests on.
    duration : float
        Of the present step [s].

    """
    ratio = duration / duration_before
    if not 1.0 / LARGEST_RATIO <= ratio <= LARGEST_RATIO:
        return STRAIGHT
    weight = ratio * duration / (6.0 * (duration + duration_before))
    return Bend(weight, rolled, steered, turn, used)
