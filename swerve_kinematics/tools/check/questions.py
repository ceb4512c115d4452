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

"""Progress for people, and questions to them that do not keep a robot waiting."""

from collections.abc import Callable, Sequence
import os
from select import select
import sys
from typing import TextIO

# The answer where nobody can see what joints read.
HARDLY = 'hardly'


def progress(text: str) -> None:
    """Show where a check is, on one line."""
    if sys.stderr.isatty():
        print(f'\r{text:<76}', end='', file=sys.stderr, flush=True)


def said(text: str, file: TextIO | None = None) -> None:
    """Write a line, in place of the progress; to standard output if nothing else is given."""
    progress('')
    if sys.stderr.isatty():
        print('\r', end='', file=sys.stderr)
    print(text, file=file, flush=True)


class Questions:
    """
    Asks what no sensor knows, and sees to the robot until there is an answer.

    Parameters
    ----------
    asks_nothing : bool
        Whether to take the first of the possible answers for granted.

    """

    def __init__(self, asks_nothing: bool) -> None:
        """Start with nothing typed."""
        self.asks_nothing = asks_nothing
        self._typed = b''

    def choice(self, question: str, options: Sequence[str],
               meanwhile: Callable[[], object]) -> str:
        """
        Return which of some answers is given.

        Parameters
        ----------
        question : str
            In words.
        options : sequence of str
            Possible answers.
        meanwhile : callable
            Called over and over; takes its time, and may raise to end it all.

        Returns
        -------
        str

        Raises
        ------
        ValueError
            If nobody is there to answer.

        """
        if self.asks_nothing:
            return options[0]
        answer = ''
        while answer not in options:
            progress('')
            print(f'\r{question} [{"/".join(options)}] ', end='', flush=True)
            answer = self._line(meanwhile)
        return answer

    def is_so(self, question: str, meanwhile: Callable[[], object]) -> bool:
        """Return whether the answer is yes."""
        return self.choice(question, ('y', 'n'), meanwhile) == 'y'

    def _line(self, meanwhile: Callable[[], object]) -> str:
        """Return the next line that is typed."""
        while b'\n' not in self._typed:
            # Past the buffer of `input`, which would hide from `select` what is there.
            if select([sys.stdin], [], [], 0.0)[0]:
                typed = os.read(sys.stdin.fileno(), 1024)
                if not typed:
                    raise ValueError('nobody is there to answer: stopped; run it in a terminal')
                self._typed += typed
            else:
                meanwhile()
        line, _, self._typed = self._typed.partition(b'\n')
        return line.decode(errors='replace').strip()
