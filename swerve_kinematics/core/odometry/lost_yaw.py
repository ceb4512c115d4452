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

"""What a gyro that was lost for a while tells of the turn meanwhile, once it is back."""

import math

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.odometry.step_noise import UNSEEN_YAW_RATE
from swerve_kinematics.core.odometry.yaw import JUMP, YawTracker

# A yaw that was lost for longer than this [s] may come from a sensor that was restarted.
LONGEST_LOSS = 2.0
# So may one that is off by more than so many standard deviations of the turn that was told: where
# all wheels slip, they turn further astray than they can tell.
LARGEST_STDS = 10.0


class LostYaw:
    """
    Tells how wrong the turn was that others told while the gyro's yaw was lost.

    A sensor that integrates its rate goes on doing so while its messages are lost. One that was
    restarted begins at another zero, which is only by chance near the heading that the wheels
    tell. A yaw that is left out while the rate goes on is no matter of this: it is not believed.
    Without a yaw, the integral of the rate tells as much after a silence that it bridges.
    """

    def __init__(self) -> None:
        """Start with nothing lost."""
        self.forget()

    def forget(self) -> None:
        """Never make up for the turns so far."""
        self._yaw = self._integral = math.nan
        self._turned = self._variance = self._time = 0.0

    @property
    def is_lost(self) -> bool:
        """Return whether a yaw is waited for."""
        return self._time > 0.0

    def error(self, dt: float, turn: float, variance: float, gyro: YawTracker) -> float:
        """
        Take in a step of a silence, or the one after it.

        Parameters
        ----------
        dt : float
            Its duration [s].
        turn : float
            Of the base, as told by others, and what the gyro's bias adds to it [rad].
        variance : float
            Of that turn [rad^2].
        gyro : YawTracker
            What the gyro says at both ends.

        Returns
        -------
        float
            What the turns since the yaw was lost lack [rad]; 0 while that is not known.

        """
        if not gyro.is_silent:
            # The rate came back without its integral over the silence, and without a yaw.
            self.forget()
            return 0.0
        if not self._time:
            if math.isnan(gyro.last_yaw) and math.isnan(gyro.last_integral):
                return 0.0
            self._yaw, self._integral = gyro.last_yaw, gyro.last_integral
        self._time += dt
        self._turned += turn
        self._variance += variance
        is_told, turned = gyro.trusted[0], gyro.yaw - self._yaw
        if math.isnan(turned):
            is_told, turned = gyro.trusted[1], gyro.integral - self._integral
        if math.isnan(turned):
            return 0.0
        error = math.remainder(turned - self._turned, TURN)
        is_told = (is_told and self._time <= LONGEST_LOSS
                   and abs(error) <= JUMP + UNSEEN_YAW_RATE * self._time
                   + LARGEST_STDS * math.sqrt(self._variance))
        self.forget()
        return error if is_told else 0.0
