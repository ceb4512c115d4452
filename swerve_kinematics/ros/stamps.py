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
Time in the ROS shell: whole nanoseconds, so that a stamp that comes in goes out unchanged.

Seconds in a float64 resolve the time since 1970 to 0.2 microseconds only.
"""

from typing import Any

NANOSECONDS = 1_000_000_000
# Before every stamp, and far enough from the ends of int64 to subtract from any.
NEVER = -(1 << 62)
# The ends of a builtin_interfaces/Time.
LATEST = ((1 << 31) - 1) * NANOSECONDS + NANOSECONDS - 1
EARLIEST = -(1 << 31) * NANOSECONDS
# What a builtin_interfaces/Time is taken for whose nanoseconds make up a second or more, as those
# of a driver that overflow: it tells no time.
IMPOSSIBLE = EARLIEST


def nanoseconds(seconds: float) -> int:
    """Return a duration [s] in whole nanoseconds."""
    return round(seconds * NANOSECONDS)


def time_of(sec: int, nanosec: int) -> int:
    """Return a time [ns] given as in a builtin_interfaces/Time; IMPOSSIBLE if it is none."""
    return sec * NANOSECONDS + nanosec if nanosec < NANOSECONDS else IMPOSSIBLE


def nanoseconds_of(stamp: Any) -> int:
    """Return a builtin_interfaces/Time in nanoseconds, as `time_of` does."""
    return time_of(stamp.sec, stamp.nanosec)


def is_valid(stamp: int) -> bool:
    """Tell whether a stamp [ns] is one that a clock can have shown, and can be sent on."""
    return 0 <= stamp <= LATEST


def seconds_and_nanoseconds(time: int) -> tuple[int, int]:
    """Return a time [ns] as a builtin_interfaces/Time has it, the nearest that it can have."""
    if not EARLIEST <= time <= LATEST:
        time = LATEST if time > LATEST else EARLIEST
    return divmod(time, NANOSECONDS)


def set_stamp(stamp: Any, time: int) -> None:
    """Write a time [ns] to a builtin_interfaces/Time."""
    stamp.sec, stamp.nanosec = seconds_and_nanoseconds(time)
