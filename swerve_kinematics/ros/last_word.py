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

"""The stop with which a process that commands a base takes its leave."""

from collections.abc import Callable
from time import monotonic, sleep

# For how long [s] the last stop is repeated, and how often at least. A best-effort listener
# acknowledges nothing, may lose a message, and loses those it has not read yet when the process
# that sent them ends: it needs the time to run once, on a busy machine.
LAST_WORD, LEAST_STOPS = 0.4, 10


def repeat_stop(publish: Callable[[], object], wait_for_delivery: Callable[[], object],
                duration: float = LAST_WORD, longest_period: float = LAST_WORD) -> None:
    """
    Publish a stop over and over until whoever listens must have heard it.

    Parameters
    ----------
    publish : callable
        Publishes it once.
    wait_for_delivery : callable
        Waits until those listeners that acknowledge have it.
    duration : float
        For how long to repeat it [s].
    longest_period : float
        Between two of them [s].

    """
    period = min(longest_period, LAST_WORD / LEAST_STOPS)
    end = monotonic() + duration
    while monotonic() < end:
        publish()
        sleep(period)
    wait_for_delivery()
