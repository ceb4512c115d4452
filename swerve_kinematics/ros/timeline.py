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
Which clock counts for what.

Stamps, of what comes in and of what goes out, are times of the node's clock, whatever it does.
They are compared with that clock where a stamped command arrives, and with one another; they
never pace the base.

Without simulated time, ramps and ages (of a command, of feedback) run on real time, which goes
on through a suspended computer and is not set by anyone. A system clock that is stepped or slewed
changes stamps, and nothing else.

With simulated time, ramps and ages run on how far the simulated clock has travelled, forwards or
backwards: where it is set back or loops, what was received before grows old all the same. A step
of a ramp is as long as the steps of that clock. In a pause the base keeps doing what it is told.

A simulated clock that goes at less than a twentieth of real time stands: it is paused, or its
simulator has died, or was never there. Then ramps and the age of a command run on real time, so
that a zero command, a lock and silence stop the base whatever that clock does. Feedback, which a
paused simulator does not send, is given twenty times its timeout of real time.

A process that was frozen (by a debugger, a suspended computer, a starved machine) for longer than
a command may be silent does not know how old the commands are that it finds waiting, nor what the
wheels have done: it ignores such commands, and begins its ramp anew.
"""

from dataclasses import dataclass, replace
import time
from typing import Any, Callable

from swerve_kinematics.ros.stamps import nanoseconds, NEVER

# A simulated clock slower than one in so many is said to stand; over how long [ns] that is judged.
SLOWEST, WINDOW = 20, nanoseconds(0.3)
# What arrives within this time [ns] after a freeze has been waiting, for all we know.
BACKLOG = nanoseconds(0.1)
# That goes on while the computer is suspended, where there is such a clock.
REAL_CLOCK = getattr(time, 'CLOCK_BOOTTIME', time.CLOCK_MONOTONIC)


def real_time() -> int:
    """Return a time [ns] that nobody sets and that goes on while the computer is suspended."""
    return time.clock_gettime_ns(REAL_CLOCK)


@dataclass(slots=True)
class Moment:
    """
    One moment on all clocks.

    Attributes
    ----------
    stamp : int
        Time [ns] of the node's clock.
    elapsed : int
        Time [ns] that ramps and ages run on; it never goes back.
    real : int
        Real time [ns].
    grain : int
        Length [ns] of a step of the simulated clock; 0 without simulated time.
    stands : bool
        Whether there is simulated time, and it stands.
    woke : int
        Real time [ns] at the end of the latest freeze of the process.

    """

    stamp: int
    elapsed: int
    real: int
    grain: int = 0
    stands: bool = False
    woke: int = NEVER

    def age(self, since: 'Moment') -> int:
        """Return how long ago [ns] a moment was for ramps and commands."""
        age = self.elapsed - since.elapsed
        return max(age, self.real - since.real) if self.stands else age

    def feedback_age(self, since: 'Moment') -> int:
        """Return how old [ns] feedback is that arrived at an earlier moment."""
        age, real_age = self.elapsed - since.elapsed, (self.real - since.real) // SLOWEST
        return age if age > real_age else real_age

    def has_backlog(self) -> bool:
        """Tell whether what arrives now may have waited for the process to go on."""
        return self.real - self.woke < BACKLOG


LONG_AGO = Moment(NEVER, NEVER, NEVER)


class Timeline:
    """
    Reads the clocks.

    Parameters
    ----------
    clock : rclpy.clock.ROSClock
        The node's clock.
    patience : int
        Time [ns] between two readings that makes a freeze; may change.
    real, system : callable
        Return the real time and the system's [ns].

    Attributes
    ----------
    is_simulated : bool
        Whether the node's clock was on simulated time at the latest reading.

    """

    def __init__(self, clock: Any, patience: int, real: Callable[[], int] = real_time,
                 system: Callable[[], int] = time.time_ns) -> None:
        """Begin at the first reading."""
        self._clock, self._real, self._system = clock, real, system
        # What `ROSClock.ros_time_is_active` ends up in.
        self._is_on_simulated_time = clock.handle.get_ros_time_override_is_enabled
        self.patience = patience
        self.is_simulated = False
        self._last: Moment | None = None
        self._begin(LONG_AGO)

    def now(self) -> Moment:
        """Return the present moment."""
        is_simulated, real = self._is_on_simulated_time(), self._real()
        # Without simulated time rclpy's clock is the system's, which answers at once.
        stamp = self._clock.now().nanoseconds if is_simulated else self._system()
        last = self._last or Moment(stamp, 0, real)
        if is_simulated != self.is_simulated:
            self.is_simulated = is_simulated
            last = replace(last, stamp=stamp)  # no time passes between two clocks
            self._begin(last)
        woke = real if real - last.real > self.patience else last.woke
        if is_simulated:
            # A clock that shows 0 has not begun: its first time comes after no time.
            step = stamp - last.stamp if last.stamp else 0
            elapsed = last.elapsed + self._travelled(step)
            self._judge(elapsed, real)
            now = Moment(stamp, elapsed, real, min(self._steps), self._stands, woke)
        else:
            now = Moment(stamp, last.elapsed + real - last.real, real, 0, False, woke)
        self._last = now
        return now

    def _begin(self, moment: Moment) -> None:
        """Begin to observe another clock."""
        self._steps = 0, 0
        self._stands, self._judged = False, moment

    def _travelled(self, step: int) -> int:
        """
        Note a step [ns] of the simulated clock, and return its length.

        One backwards says nothing of the grain of a clock, and those that follow it begin anew:
        two clocks that take turns have none.
        """
        if step:
            self._steps = (self._steps[1], step) if step > 0 else (0, 0)
        return abs(step)

    def _judge(self, elapsed: int, real: int) -> None:
        """Find out, now and then, whether the simulated clock stands."""
        if real - self._judged.real >= WINDOW:
            self._stands = (elapsed - self._judged.elapsed) * SLOWEST < real - self._judged.real
            self._judged = Moment(0, elapsed, real)
