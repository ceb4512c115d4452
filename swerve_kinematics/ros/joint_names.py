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

"""Which joints the node misses in joint_states, and what their names may be there."""

from collections.abc import Iterable, Sequence

# Names at least this much alike, of 1, may be meant; 0.6 is difflib's own default.
LIKENESS = 0.6


def missing_joints(wanted: Sequence[str], seen: Iterable[str]) -> str | None:
    """
    Return what joint_states lacks, in words, None if it lacks nothing.

    Parameters
    ----------
    wanted : sequence of str
        Joints that the node needs.
    seen : iterable of str
        All names that came.

    Returns
    -------
    str or None
        With the nearest name that is there for each that is missing.

    """
    there = set(seen)
    missing = [name for name in wanted if name not in there]
    if not missing or not there:
        return None
    from difflib import get_close_matches  # only here: few nodes ever miss one
    spare = sorted(there - set(wanted))
    near = [match for name in missing for match in get_close_matches(name, spare, 1, LIKENESS)]
    hint = f'; there is {", ".join(dict.fromkeys(near))}' if near else ''
    return f'joint_states lacks {", ".join(missing)}{hint}'
