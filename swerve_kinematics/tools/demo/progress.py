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

"""How the drive goes, while it lasts: a line that fits any terminal."""

import os
from shutil import get_terminal_size
from time import monotonic
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

LEGEND = 'time, command, position by odometry, and its distance from the ground truth:'


class Progress:
    """
    One line of the terminal that is written over and over, or lines in a log.

    A dumb terminal counts as a log: it could not go back to the start of the line.

    Parameters
    ----------
    stream : file
        Where to write.

    """

    def __init__(self, stream: TextIO) -> None:
        """Choose how to write by what the stream is."""
        self._stream = stream
        self._in_place = stream.isatty() and os.environ.get('TERM', 'dumb') != 'dumb'
        self._interval = 0.1 if self._in_place else 3.0
        self._due: float | None = None

    def show(self, time: float, command: NDArray[np.float64], odometry: NDArray[np.float64],
             truth: NDArray[np.float64]) -> None:
        """
        Write the line, if it is time to.

        Parameters
        ----------
        time : float
            From the start of the figure [s].
        command : ndarray (3,)
            The twist commanded [m/s, m/s, rad/s].
        odometry, truth : ndarray (3,)
            Poses of one moment [m, m, rad].

        """
        if self._due is None:
            self._stream.write(f'{LEGEND}\n')
        elif monotonic() < self._due:
            return
        self._due = monotonic() + self._interval
        # The last column stays free: a terminal may break the line as soon as it is full.
        width = get_terminal_size().columns - 1
        text = line(time, command, odometry, truth)
        # Spaces, where an escape sequence would do: not every terminal knows those.
        self._stream.write(f'\r{text[:width]:{width}}' if self._in_place else f'{text}\n')
        self._stream.flush()

    def finish(self) -> None:
        """Leave the last line standing."""
        if self._in_place and self._due is not None:
            self._stream.write('\n')
            self._stream.flush()


def line(time: float, command: NDArray[np.float64], odometry: NDArray[np.float64],
         truth: NDArray[np.float64]) -> str:
    """Return what `Progress.show` writes of its arguments: less than 80 characters."""
    vx, vy, omega = command
    x, y, _ = odometry
    error = 1e3 * np.hypot(*(odometry - truth)[:2])
    return (f'{time:4.1f} s: vx {vx:5.2f} vy {vy:5.2f} m/s omega {omega:5.2f} rad/s, '
            f'x {x:5.2f} y {y:5.2f} m, off {error:4.1f} mm')
