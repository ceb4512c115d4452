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

"""What a gap in the messages leaves unknown of the velocity, by accelerometer and wheels."""

# The velocity to begin at rests on one step, which a sensor that was reset may have spoilt: for
# so long [s], two steps at 50 Hz, wheels that contradict it are right, and it begins anew.
PROBATION = 0.03
# After a gap in which a moving base may have begun to slip, they must have borne it out for so
# long [s].
LONG_PROBATION = 0.3

# Where the joints were not heard, the force is a mean over a long step, and does not tell when in
# it the base sped up. A force that changes by so much in a second [m/s^3] moves the mean velocity
# by a twelfth of that, times the duration squared: 0.2 m/s in 0.44 s, as in hard driving. In steps
# of up to this [s] it is less than what wheels themselves do.
UNSEEN_JERK = 12.0
LONG_STEP = 0.15


class Gaps:
    """
    How far to trust the velocity in long steps, and after the force was not heard.

    Attributes
    ----------
    hides_slip : bool
        Whether wheels may have begun to slip in the latest gap.
    unseen : float
        What changes of the force do to the velocity unseen in a long step [m/s], else 0.
    contradiction : float
        By how much the wheels' velocity is off the expected one [m/s] where that is no reason not
        to believe them, but to doubt them; else 0.

    """

    def __init__(self) -> None:
        """Begin."""
        self.hides_slip = False
        self._age = self.unseen = self.contradiction = 0.0

    def begin(self) -> None:
        """Begin at the velocity of the wheels."""
        self._age = self.unseen = self.contradiction = 0.0

    def take_step(self, duration: float, error: float) -> None:
        """Take the duration of the longer of two steps [s], and how far wheels are off [m/s]."""
        if duration <= LONG_STEP:
            self.unseen = self.contradiction = 0.0
            return
        self.unseen = UNSEEN_JERK * duration * duration / 12.0
        self.contradiction = max(error - self.unseen, 0.0)

    def is_on_probation(self, dt: float) -> bool:
        """Take in a step [s]; return whether it begins so early that the wheels are right."""
        is_recent = self._age < (LONG_PROBATION if self.hides_slip else PROBATION)
        self._age += dt
        if not is_recent:
            self.hides_slip = False
        return is_recent

    def contradict(self, error: float) -> None:
        """Begin anew, for wheels are off by so much [m/s]."""
        if self.hides_slip:
            self._age, self.contradiction = 0.0, error
