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

"""Tells when joint states come far more rarely than the base is commanded, or times out."""

import math

from swerve_kinematics.ros.grading import Grading, Patience

# Feedback at less than this share of control_rate is far below it: a module can steer by a radian
# between two samples then, and where the wheel rolled meanwhile is guesswork.
LEAST_SHARE = 0.125
# With fewer in each feedback_timeout, the least delay of one stops the wheels.
LEAST_PER_TIMEOUT = 1.2
# Once reported, it must be better than that by this factor.
HYSTERESIS = 1.25
MEND = 'raise the rate of the driver or of the joint state broadcaster'
PATIENCE = Patience(warn=2.0, error=math.inf, clear=2.0)


class SlowFeedback:
    """Grades the rate of complete joint states."""

    def __init__(self) -> None:
        """Start with nothing found."""
        self._grading = Grading(PATIENCE)

    def findings(self, rate: float, control_rate: float, timeout: float,
                 now: float) -> list[str]:
        """
        Return what there is to say about the rate.

        Parameters
        ----------
        rate : float
            Of complete joint states since the last report [Hz]; 0 is silence, and told elsewhere.
        control_rate : float
            Of commands [Hz].
        timeout : float
            Silence of the joint states after which the wheels stop [s].
        now : float
            Time [s].

        Returns
        -------
        list of str

        """
        if rate > 0.0:
            counted = rate / (HYSTERESIS if self._grading.findings() else 1.0)
            found = {}
            if counted < LEAST_SHARE * control_rate:
                found['rate'] = f'far below control_rate {control_rate:.3g} Hz - {MEND}'
            if counted * timeout < LEAST_PER_TIMEOUT:
                found['timeout'] = (
                    f'too rarely for feedback_timeout {timeout:.3g} s - {MEND}, or the timeout')
            self._grading.update({key: f'joint_states arrive at {rate:.3g} Hz, {words}'
                                  for key, words in found.items()}, now)
        return [message for _, message in self._grading.findings()]
