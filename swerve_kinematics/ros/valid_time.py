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

"""A /clock that shows an impossible time is left out."""

from typing import Any, Callable

from rclpy.time_source import CLOCK_TOPIC

from swerve_kinematics.ros.qos import EventlessNode
from swerve_kinematics.ros.stamps import is_valid, nanoseconds_of


class ValidTimeNode(EventlessNode):
    """
    A node whose simulated time is always one that a stamp can have.

    rclpy's own subscription to /clock raises for a negative time, and for one beyond the end of
    a stamp as soon as that time is written to a message.

    Attributes
    ----------
    impossible_times : int
        How many messages on /clock were ignored.

    """

    impossible_times = 0

    def create_subscription(
            self, msg_type: Any, topic: str, callback: Callable[..., None],
            *args: Any, **options: Any) -> Any:
        """Create a subscription, that of rclpy to /clock with a check of its times."""
        if topic == CLOCK_TOPIC:
            callback = self._checked(callback)
        return super().create_subscription(msg_type, topic, callback, *args, **options)

    def _checked(self, callback: Callable[[Any], None]) -> Callable[[Any], None]:
        """Return a callback for a Clock that passes possible times on, and counts the others."""
        def check(message: Any) -> None:
            if message.clock.sec >= 0 and is_valid(nanoseconds_of(message.clock)):
                callback(message)
            else:
                self.impossible_times += 1
        return check
