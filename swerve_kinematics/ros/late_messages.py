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

"""Messages that are older than what is known: late ones, or those of a clock that was set back."""

from collections.abc import Hashable

# So many senders are kept in mind at once.
REMEMBERED = 64


class LateMessages:
    """
    Tells a clock that was set back, by however little, from messages that came late.

    One message may be late. The next one of the same sender is newer than what is known then.
    Where it is old too, and later than the first, the clock has been set. But where a message
    overtook others, these fill the hole that it left, and tell nothing of a clock. And one that is
    older than any late message tells of it at once.
    """

    def __init__(self) -> None:
        """Start without a late message."""
        self._latest: dict[Hashable, tuple[int, int]] = {}

    def tell_of_set_clock(self, stamp: int, known: int, before: int, oldest: int,
                          sender: Hashable = None) -> bool:
        """
        Take in a message, and return whether the clock must have been set back.

        Parameters
        ----------
        stamp : int
            Its time [ns].
        known : int
            Time [ns] of what is known from its sender.
        before : int
            Time [ns] of what was known before that.
        oldest : int
            Time [ns] before which no message is just late.
        sender : hashable
            Tells senders apart.

        """
        if stamp < oldest:
            return True
        if stamp >= known:
            return False
        latest, latest_known = self._latest.get(sender, (stamp, known))
        if stamp <= before:
            if len(self._latest) >= REMEMBERED:
                self._latest.clear()
            self._latest[sender] = stamp, known
        return known == latest_known and stamp > latest
