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

"""How grave a finding is: by how long it has lasted, with hysteresis."""

from collections.abc import Iterable, Mapping
import math
from typing import NamedTuple


class Patience(NamedTuple):
    """
    How long a finding must last [s] to be reported, to be grave, and to be gone.

    Attributes
    ----------
    warn, error : float
        Of evidence without a break; infinite for a finding that is never grave.
    clear : float
        Of evidence to the contrary without a break.

    """

    warn: float
    error: float
    clear: float


class Grade(NamedTuple):
    """Where a finding stands: its words, since when it is seen, and when it was seen last."""

    message: str
    since: float
    seen: float
    reported: bool


class Grading:
    """
    Keeps findings while they last, so that reports neither flicker nor come too soon.

    Parameters
    ----------
    patience : Patience
        The same for all findings of this kind.

    """

    def __init__(self, patience: Patience) -> None:
        """Start with nothing found."""
        self._patience = patience
        self._grades: dict[str, Grade] = {}
        self._now = -math.inf

    def update(self, found: Mapping[str, str], now: float) -> None:
        """
        Take in what is found now, or nothing: evidence to the contrary.

        Call it only when there is evidence: what was found remains until then.

        Parameters
        ----------
        found : mapping of str to str
            Message by what tells findings apart.
        now : float
            Time [s].

        """
        self._begin_at(now)
        patience = self._patience
        for key, message in found.items():
            old = self._grades.get(key)
            since = now if old is None else old.since
            self._grades[key] = Grade(message, since, now, (
                old is not None and old.reported) or now - since >= patience.warn)
        for key in self._grades.keys() - found.keys():
            grade = self._grades[key]
            if not grade.reported or now - grade.seen >= patience.clear:
                del self._grades[key]

    def lasts(self, is_found: bool, now: float) -> bool:
        """Do as `update` where there is one thing to find; return whether it is reported."""
        self.update({'': ''} if is_found else {}, now)
        return bool(self.findings())

    def forget(self, keys: Iterable[str]) -> None:
        """Drop findings at once, by what tells them apart: something else explains them."""
        for key in keys:
            self._grades.pop(key, None)

    def _begin_at(self, now: float) -> None:
        """Take the time [s]; where the clock was set back, what was found moves with it."""
        back = min(now - self._now, 0.0)
        if back:
            self._grades = {key: grade._replace(since=grade.since + back, seen=grade.seen + back)
                            for key, grade in self._grades.items()}
        self._now = now

    def findings(self) -> list[tuple[bool, str]]:
        """Return whether each reported finding is grave, and its message."""
        return [(grade.seen - grade.since >= self._patience.error, grade.message)
                for grade in self._grades.values() if grade.reported]
