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

"""Whether wheels point straight ahead where their offsets say so, which only the eye can tell."""

from collections.abc import Callable, Sequence
import math

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.tools.check.lifted_base import LiftedBase
from swerve_kinematics.tools.check.questions import progress, Questions

# How fast modules turn straight ahead [rad/s].
STRAIGHTENING = 1.0


def crooked_modules(base: LiftedBase, questions: Questions) -> list[int]:
    """
    Turn all modules straight ahead, as far as their joints tell, and ask which are not.

    Parameters
    ----------
    base : LiftedBase
        At rest, with its modules where they were at the start.
    questions : Questions
        For what no sensor knows.

    Returns
    -------
    list of int
        None where an end stop keeps a module from pointing ahead: nothing is turned then.

    """
    ends = [_ahead(angle, *limits)
            for angle, limits in zip(base.angles, base.seen.steering_ranges)]
    if not all(lower <= end <= upper
               for end, (lower, upper) in zip(ends, base.seen.steering_ranges)):
        return []
    progress('straight ahead')
    _turn(base, ends)
    straight = base.commanding(ends)
    base.seen.wait_until_still(straight)
    return _seen_crooked(base, questions, straight)


def _ahead(angle: float, lower: float, upper: float) -> float:
    """Return the angle [rad] at which a module points ahead; without end stops the nearest one."""
    return TURN * round(angle / TURN) if math.isinf(upper - lower) else 0.0


def _turn(base: LiftedBase, ends: Sequence[float]) -> None:
    """Turn the modules to their ends [rad], all in the same time."""
    ways = [end - angle for end, angle in zip(ends, base.angles)]
    seconds, share = max(map(abs, ways)) / STRAIGHTENING, 0.0

    def command() -> None:
        base.commanding([end - (1.0 - share) * way for end, way in zip(ends, ways)])()
    for time in base.moving(seconds, command):
        share = time / seconds


def _seen_crooked(base: LiftedBase, questions: Questions,
                  meanwhile: Callable[[], None]) -> list[int]:
    """Return which wheels someone sees pointing elsewhere."""
    names = base.seen.layout.module_names
    crooked: list[str] = []
    question = 'Which wheel does not point straight ahead now, to within a few degrees?'
    while (answer := questions.choice(
            question, ('none', *(name for name in names if name not in crooked)),
            base.seen.keeping(meanwhile))) != 'none':
        crooked.append(answer)
        question = 'Which other one?'
    return [names.index(name) for name in crooked]
