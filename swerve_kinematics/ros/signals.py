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

"""The signals that end a process, and how it learns of them."""

from collections.abc import Callable
import signal
from types import FrameType

# A closed terminal and a lost ssh connection are as good a reason to stop as Ctrl-C and Ctrl-\.
ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)


def heed(handler: Callable[[int, FrameType | None], object]) -> None:
    """Let the signals to end call a handler, save those that are ignored, as SIGHUP by nohup."""
    for number in ENDING_SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, handler)


def collected_signals() -> list[int]:
    """Return the list that the signals to end will be appended to."""
    signals: list[int] = []
    heed(lambda received, _: signals.append(received))
    return signals
