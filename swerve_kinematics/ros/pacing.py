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

"""When the control loop wakes."""

from typing import Any, Callable

from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds

# A base at rest repeats its command at this pace [ns]. Each time costs rclpy more than all that
# the node computes, while a watchdog behind the command topics is fed often enough.
REST_PERIOD = nanoseconds(0.05)


def rest_period(period: int) -> int:
    """Return the time [ns] between two commands at rest, given that on the move."""
    return max(period, REST_PERIOD)


class Pacer:
    """
    Wakes the control loop a period after the latest command, on real time and on simulated time.

    Simulated time may run fast, so the loop follows it; or it stands, and real time goes on.

    Parameters
    ----------
    node : rclpy.node.Node
        Gets the timers.
    period : int
        Between two commands [ns].
    callback : callable
        The control loop.

    """

    def __init__(self, node: Node, period: int, callback: Callable[[], None]) -> None:
        """Start to wake it."""
        self._node, self._period, self._callback = node, period, callback
        self._real = node.create_timer(
            period / NANOSECONDS, callback, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._simulated: Any = None
        self._paced = period  # the period of the timers

    def commanded(self, is_settled: bool, is_simulated: bool) -> None:
        """Set when the next command is due; later where it would only repeat this one."""
        period = rest_period(self._period) if is_settled else self._period
        if period != self._paced:
            self._paced = self._real.timer_period_ns = period
            if self._simulated is not None:
                self._simulated.timer_period_ns = period
        if is_simulated:
            if self._simulated is None:
                self._simulated = self._node.create_timer(period / NANOSECONDS, self._callback)
            _begin_anew(self._real, period)
        elif self._simulated is not None:
            self._node.destroy_timer(self._simulated)
            self._simulated = None

    def restart(self) -> None:
        """Count the period from now on: a command has come from elsewhere."""
        _begin_anew(self._real, self._paced)
        if self._simulated is not None:
            _begin_anew(self._simulated, self._paced)


def _begin_anew(timer: Any, period: int) -> None:
    """
    Let the period [ns] of a timer begin now, as `Timer.reset` does, without waking the executor.

    A reset wakes it for nothing, which costs more than the command. A call moves the next one by
    the timer's period: here by as much of it as has gone by.
    """
    handle = timer.handle
    gone = period - handle.time_until_next_call()
    if gone <= 0:  # the period has just become shorter
        timer.reset()
        return
    handle.change_timer_period(gone)
    handle.call_timer()
    handle.change_timer_period(period)
