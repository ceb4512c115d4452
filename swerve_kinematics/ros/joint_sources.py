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

"""Several publishers of the same joints: which of their stories is believed."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
import math
import time
from typing import Any

from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.core.odometry.wrapping import WRAPS
from swerve_kinematics.ros.stamps import NANOSECONDS

# No wheel and no module turns faster than this [rad/s]. Where the middleware numbers no messages,
# or one is lost, a joint that is further off belongs to another publisher.
FASTEST = 100.0
REFUSED = 'joint states from another publisher'
# So many are kept at once: publishers that come and go must not fill the memory.
REMEMBERED_STORIES = 16


class Story:
    """
    What one publisher says of its joints, message after message.

    Attributes
    ----------
    names : tuple of str
        All names in its messages.
    joints : dict of str to int
        The joints that matter, with their places among the names.
    ratios : list of float
        Turns of each of these joints for one turn of its wheel or module.
    number : int or None
        That the publisher gave its latest message.
    began, heard : int
        When its first and its latest message came [ns].
    believed : bool
        Whether its joints are taken from it.
    has_moved : bool
        Whether its values have changed; without numbers, since it was last told from another one.

    """

    def __init__(self, names: tuple[str, ...], joints: dict[str, int], ratios: list[float],
                 number: int | None, now: int) -> None:
        """Start with the first message, which is not taken yet."""
        self.names, self.joints, self.ratios, self.number = names, joints, ratios, number
        self.began, self.heard, self._values = now, now, [math.nan] * len(joints)
        self.believed = self.has_moved = False

    def distance(self, values: list[float]) -> float:
        """Return by how much [rad] the wheel or module furthest off has turned; 0 if unknown."""
        return max((_moved(old, new) / ratio
                    for old, new, ratio in zip(self._values, values, self.ratios)
                    if math.isfinite(new - old)), default=0.0)

    def go_on(self, values: list[float], number: int | None, now: int) -> None:
        """Take the next message."""
        self.has_moved |= self.distance(values) > 0.0
        self._values, self.number, self.heard = values, number, now

    def is_followed_by(self, number: int | None) -> bool:
        """Tell whether a message with this number is the publisher's next one."""
        return number is not None and self.number is not None and number == self.number + 1

    def may_go_on(self, values: list[float], number: int | None, now: int) -> bool:
        """Tell whether a message could be a later one of this publisher."""
        if number is not None and self.number is not None and number <= self.number:
            return False
        elapsed = (now - self.heard) / NANOSECONDS
        return self.distance(values) <= FASTEST * max(elapsed, 0.02)


class JointSources:
    """
    Believes one publisher where several publish the same joints.

    A message says nothing of who sent it, but the middleware numbers those of each publisher,
    and the values of each go on from its own. Which story is true cannot be known; it is the
    first one, unless it stands still, like the zeros of a joint_state_publisher, while another
    moves. A story that falls silent gives way to one that moves, or that began after its end, as
    that of a driver that is started again. But one that was told beside it must move first: where
    the drivers die, the base must stop and not drive by a placeholder.

    While a single publisher is there, a message costs a comparison and a look at the clock.

    Parameters
    ----------
    joints : mapping of str to float
        Those that matter, with the turns of each for one turn of its wheel or module.
    timeout : int
        After which a publisher has fallen silent [ns]; may change.
    count_publishers : callable
        Returns how many publishers there are now.
    on_change : callable
        Is called when another story is believed than before.

    Attributes
    ----------
    ignored : collections.Counter
        How many messages were not believed.

    """

    def __init__(self, joints: Mapping[str, float], timeout: int,
                 count_publishers: Callable[[], int], on_change: Callable[[], None]) -> None:
        """Start with no publisher."""
        self._joints, self.timeout = joints, timeout
        self._count_publishers, self._on_change = count_publishers, on_change
        self._stories: list[Story] = []
        self._several, self._reported = False, 0
        # The latest message of a publisher that is alone: names, positions, number and time [ns].
        self._last: tuple[tuple[str, ...], Sequence[float], int | None, int] = (), (), 0, 0
        self.ignored: Counter[str] = Counter()

    def report(self) -> bool:
        """See how many publishers there are; tell whether one was refused since last time."""
        self._look()
        reported, self._reported = self._reported, self.ignored.total()
        return self._reported > reported

    def _look(self) -> None:
        """See whether there are several publishers; once one was refused, it may come back."""
        several = bool(self.ignored) or self._count_publishers() > 1
        if several and not self._several:
            # Who was alone until now is believed, though another one's message may come first.
            self._is_told_by_a_believed_story(*self._last)
        self._several = several

    def believes(self, names: Sequence[str], positions: Sequence[float],
                 info: dict[str, Any]) -> bool:
        """
        Tell whether a JointState is to be used.

        Parameters
        ----------
        names : sequence of str
            Its names.
        positions : sequence of float
            Its positions [rad], which may be fewer.
        info : dict
            What rclpy says of the message.

        """
        number = info.get('publication_sequence_number')
        message = tuple(names), positions, number, time.monotonic_ns()
        if not self._several:
            # Two publishers number their messages each for itself.
            last = self._last[2]
            if number is not None and (last is None or number != last + 1):
                self._look()
            if not self._several:
                self._last = message
                return True
        believed = self._is_told_by_a_believed_story(*message)
        if not believed:
            self.ignored[REFUSED] += 1
        return believed

    def _is_told_by_a_believed_story(self, names: tuple[str, ...], positions: Sequence[float],
                                     number: int | None, now: int) -> bool:
        """Add a message to the story that it belongs to; tell whether that is believed."""
        joints = {name: place for place, name in enumerate(names) if name in self._joints}
        if not joints:
            return True
        values = [positions[place] if place < len(positions) else math.nan
                  for place in joints.values()]
        story = self._story(names, values, number, now)
        if story is None:
            story = Story(names, joints, [self._joints[name] for name in joints], number, now)
            for other in self._stories:
                if number is None and other.names == names:
                    # Until now it may have been told by both: from here on it must move itself.
                    other.has_moved = False
            self._stories = [*self._stories[1 - REMEMBERED_STORIES:], story]
        story.go_on(values, number, now)
        return story.believed or self._comes_to_be_believed(story, now)

    def _story(self, names: tuple[str, ...], values: list[float], number: int | None,
               now: int) -> Story | None:
        """Return the story that a message goes on with, None if it begins one."""
        candidates = [story for story in self._stories if story.names == names]
        following = [story for story in candidates if story.is_followed_by(number)]
        possible = [story for story in candidates if story.may_go_on(values, number, now)]
        # The next number alone says little: where a message was lost, that may be another one's.
        both = [story for story in following if story in possible]
        if not possible and self._is_one_unheard(now):
            return None
        # Of two that fit as well, the one heard last: the other may have died long ago.
        return min(both or possible or following,
                   key=lambda story: (story.distance(values), -story.heard), default=None)

    def _is_one_unheard(self, now: int) -> bool:
        """Tell whether there are more publishers than stories are being told."""
        heard = sum(now - story.heard <= self.timeout for story in self._stories)
        return heard < self._count_publishers()

    def _comes_to_be_believed(self, story: Story, now: int) -> bool:
        """Believe a story if those that are believed on the same joints give way to it."""
        rivals = [rival for rival in self._stories
                  if rival.believed and rival.joints.keys() & story.joints.keys()]
        for rival in rivals:
            is_silent = now - rival.heard > self.timeout
            if story.has_moved:
                gives_way = is_silent or not rival.has_moved
            else:
                gives_way = is_silent and rival.heard < story.began
            if not gives_way:
                return False
        for rival in rivals:
            rival.believed = False
        story.believed = True
        if rivals:
            self._on_change()
        return True


def turns_of_joints(layout: Layout) -> dict[str, float]:
    """Return the joints of a base, with the turns of each for one turn of its wheel or module."""
    joints = layout.joints
    return {layout.gyro_joint: 1.0,
            **dict(zip(layout.drive_joints, map(abs, joints.drive_ratios))),
            **dict(zip(layout.steering_joints, map(abs, joints.steering_ratios)))}


def _moved(old: float, new: float) -> float:
    """Return how far [rad] a joint has moved that may have wrapped; 0 is a placeholder's value."""
    way = abs(new - old)
    return min(way, *(abs(way - period) for period in WRAPS)) if old and new else way
