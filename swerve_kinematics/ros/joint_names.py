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

"""Where joint_states have the joints that the node needs, by their names, and which they lack."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
import itertools
from operator import itemgetter
from typing import NamedTuple

# Name lists remembered at once; a publisher that invents new ones must not fill the memory.
REMEMBERED = 64
# Names at least this much alike, of 1, may be meant; 0.6 is difflib's own default.
LIKENESS = 0.6
# More names than this that are like none of those that are missing tell nobody anything.
LISTED = 8


class Slots(NamedTuple):
    """
    Where a message has what.

    Attributes
    ----------
    joints : list of (int, int)
        The joints in it, each with its place.
    gyro : int or None
        The place of the gyro.
    pick : callable or None
        Picks the numbers of the joints, in their order, out of those of a message; None unless
        all joints are there.

    """

    joints: list[tuple[int, int]]
    gyro: int | None
    pick: Callable[[Sequence[float]], tuple[float, ...]] | None


class JointNames:
    """
    Finds joints by their names, once for each list of names.

    Parameters
    ----------
    joints : sequence of str
        What the node needs.
    gyro : str or None
        Joint that stands for the gyro; None if there is none.

    """

    def __init__(self, joints: Sequence[str], gyro: str | None) -> None:
        """Start with no list of names seen."""
        self._joints, self._gyro = joints, gyro
        self._slots_by_names: dict[tuple[str, ...], Slots] = {}

    def slots(self, names: tuple[str, ...]) -> Slots:
        """Return where a message with these names has what; a name listed twice is nowhere."""
        slots = self._slots_by_names.get(names)
        if slots is None:
            if len(self._slots_by_names) >= REMEMBERED:
                self._slots_by_names.clear()
            slots = self._slots_by_names[names] = self._found(names)
        return slots

    def _found(self, names: tuple[str, ...]) -> Slots:
        """Look for the joints among names."""
        times = Counter(names)
        place = {name: index for index, name in enumerate(names) if times[name] == 1}
        joints = [(joint, place[name]) for joint, name in enumerate(self._joints)
                  if name in place]
        is_complete = len(joints) == len(self._joints)
        return Slots(joints, place.get(self._gyro) if self._gyro else None,
                     itemgetter(*[slot for _, slot in joints]) if is_complete else None)

    def without_position(self, fresh: frozenset[int]) -> str | None:
        """Return in words which joints are not among the fresh ones; None if no names came."""
        if not any(self._slots_by_names):
            return None
        stale = [name for joint, name in enumerate(self._joints) if joint not in fresh]
        return f'joint_states have no usable position of {", ".join(stale)}'

    @property
    def missing(self) -> str | None:
        """
        Return in words which joints never came; None if there are none, or no names came at all.

        With the nearest name that is there for each that is missing, or with those that there
        are where none is near. One that is listed twice in every message did not come either,
        for nobody knows which of its values holds.
        """
        seen = set(itertools.chain.from_iterable(self._slots_by_names))
        found = {joint for slots in self._slots_by_names.values() for joint, _ in slots.joints}
        unusable = [name for joint, name in enumerate(self._joints) if joint not in found]
        if not unusable or not seen:
            return None
        missing = [name for name in unusable if name not in seen]
        repeated = [name for name in unusable if name in seen]
        return '; '.join([*_lacks(missing, sorted(seen - set(self._joints))),
                          *[f'joint_states list {name} twice' for name in repeated]])


def _lacks(missing: Sequence[str], spare: Sequence[str]) -> Iterator[str]:
    """Yield in words what is missing, if anything is, and what is there instead."""
    if missing:
        yield f'joint_states lack {", ".join(missing)}'
        from difflib import get_close_matches  # only here: few nodes ever miss one
        near = [match for name in missing
                for match in get_close_matches(name, spare, 1, LIKENESS)]
        there_is = list(dict.fromkeys(near)) or spare[:LISTED]
        if there_is:
            yield f'there is {", ".join(there_is)}'
