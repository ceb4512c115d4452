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

"""How long a step has lasted: as its stamps say, unless the clock was set forward in it."""

import math

from swerve_kinematics.core.odometry.traction import USUAL_GRIP

# The values are judgements, within what test_duration.py tells: it fails for FACTOR 2.5, SCATTER
# 0.03, SHORT 0.4, LATEST_WEIGHT 0.1 or 0.6, or LONGEST_USUAL 0.05.

# A step counts as unusual from this factor, and from this much more [s], than the usual duration
# on: two steps would be a factor of 2, and stamps scatter by up to `gyro.STAMP_JITTER` at either
# end, seldom at both. Below the second factor, it made up for a stamp that came late.
FACTOR, SCATTER = 1.5, 0.015
SHORT = 0.7
# The usual duration is a mean in which the latest step has this weight. No step counts there as
# longer than this [s], that of feedback at 10 Hz, so that those after lost messages do not seem
# short.
LATEST_WEIGHT, LONGEST_USUAL = 0.3, 0.1
# A clock is not set more often than once in this time [s]: what looks like it is a habit of the
# driver (see `wheel_time.py`).
RARE = 10.0
# In a usual step a base changes its speed by no more than this part of it: at 1 m/s and 50 Hz
# tyres of USUAL_GRIP make 0.16. A step that changes it by more is taken at its stamps' word.
USUAL_CHANGE = 0.2


class Pace:
    """
    The time between samples, by stamps that the wheels must bear out.

    Where a clock is set forward between two samples, the wheels roll as far as in any other step:
    less far than they would in the hardest stop, by what the stamps say. So they do where only a
    stamp is late, as that of a message which was held up. Then the next steps are short by their
    stamps, but last as long as usual until they have made up for it.

    Parameters
    ----------
    count : int
        Number of wheels, n.

    Attributes
    ----------
    usual : float
        Duration of a step, of late [s].

    """

    def __init__(self, count: int) -> None:
        """Start without a step."""
        self._root = math.sqrt(count)
        self.usual = self._way = self._duration = 0.0
        self._ahead = 0.0  # by how much the latest stamps are late, or the clock was set [s]
        self._since = RARE  # time since it was set [s]

    def interrupt(self) -> None:
        """Forget the last step, around a gap, which is none itself."""
        self._duration = 0.0

    def duration(self, dt: float, way: float) -> float:
        """
        Return how long a step has lasted [s].

        Parameters
        ----------
        dt : float
            By its stamps [s].
        way : float
            Root of the sum of squares of how far each wheel rolled in it [m]; NaN where one is
            not known.

        """
        usual = self.usual
        if self._ahead and dt >= SHORT * usual:
            if self._ahead > SHORT * usual:
                # No stamp was late, the clock was set: nothing makes up for that.
                self._since = 0.0
            self._ahead = 0.0
        if dt > FACTOR * usual and self._since > RARE and self._was_set_forward(dt, way):
            self._ahead, dt = dt - usual, usual
        elif self._ahead:
            made_up = min(self._ahead, usual - dt)
            self._ahead -= made_up
            dt += made_up
        elif self._duration:
            counted = dt if dt < LONGEST_USUAL else LONGEST_USUAL
            self.usual += LATEST_WEIGHT * (counted - usual)
        self._way, self._duration = way, dt
        self._since += dt
        return dt

    def _was_set_forward(self, dt: float, way: float) -> bool:
        """Return whether the clock was set in a step that was long by its stamps."""
        usual, way = self.usual, way / self._root
        if not (usual and dt > usual + SCATTER):
            return False
        before = self._way / (self._root * self._duration) if self._duration else math.nan
        braking = min(dt, before / USUAL_GRIP)
        least = braking * (before - 0.5 * USUAL_GRIP * braking)
        return way < least and abs(way / usual - before) <= USUAL_CHANGE * before
