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

"""Stamps by another clock than the node's: how far they are off, and what they are by its own."""

from swerve_kinematics.ros.stamps import is_valid, NANOSECONDS

# How fast the difference may follow the sender's clock [ns per ns]: much faster than crystals
# drift, and too slow to be seen in an interval.
SLEW = 1e-3
# A difference that is further off than this [ns] is that of another clock, or of one that was set.
JUMP = NANOSECONDS // 2


class SenderClock:
    """
    Follows the difference between the node's clock and that of a sender's stamps.

    A stamp that no clock can have shown tells of none.
    """

    def __init__(self) -> None:
        """Start without a message."""
        self._difference: int | None = None
        self._smallest: int | None = None
        self._stamp = 0

    def stamp_of(self, stamp: int, now: int, restamps: bool) -> int:
        """
        Return the time [ns] of a message that came when the node's clock showed `now`.

        That is its stamp, by the node's clock where it `restamps`, or `now` without a stamp.
        """
        if not stamp:
            return now
        if restamps:
            return self.restamped(stamp, now)
        self.observe(stamp, now)
        return stamp

    def observe(self, stamp: int, now: int) -> None:
        """Take note of a stamp [ns] that came when the node's clock showed `now`."""
        late = now - stamp
        # A simulated clock shows 0 as long as it is silent: there is nothing to compare with.
        if now and is_valid(stamp) and (
                self._smallest is None or abs(late) < abs(self._smallest)):
            self._smallest = late

    def restamped(self, stamp: int, now: int) -> int:
        """Return a stamp of the sender [ns] by the node's clock; intervals stay the sender's."""
        if not is_valid(stamp):
            return stamp
        late = now - stamp
        if self._difference is None or abs(late - self._difference) > JUMP:
            self._difference = late
        else:
            step = round(SLEW * abs(stamp - self._stamp))
            self._difference += max(-step, min(step, late - self._difference))
        self._stamp = stamp
        return stamp + self._difference

    def report(self, tolerance: int) -> float | None:
        """
        Return how far [s] every stamp since the last report was behind, less than 0 if ahead.

        None if one was within the tolerance [ns].
        """
        smallest, self._smallest = self._smallest, None
        if smallest is None or abs(smallest) <= tolerance:
            return None
        return smallest / NANOSECONDS
