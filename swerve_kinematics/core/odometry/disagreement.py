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

"""How wrong the wheels are: by how much the modules disagree, beside what is expected of them."""

from swerve_kinematics.core.odometry.uncertainty import LARGEST

# The errors are compared with the model over so many correlation times: enough independent
# samples for a ratio that is good to about 10 %.
MEMORY = 50.0
# In a shorter correlation time [s] the errors of every step are fresh, at up to 500 Hz.
SHORTEST_TIME = 1e-3


class Disagreement:
    """
    How many times more the modules disagree than the noise model says, in variance.

    The reduced chi-square of the modules' errors, smoothed. An error that changes sign from
    one step to the next does not add up (an encoder's last bit is put right by the following
    step), and one that lasts adds up more than its size tells. So the errors are low-passed
    over the correlation time before they are squared: that is their part in a random walk.

    Parameters
    ----------
    module_count : int
        Number of modules of the base, in use or not.
    correlation_time : float
        Time constant of the low pass [s].

    Attributes
    ----------
    inflation : float
        The factor on the model's variance, 1 or more.

    """

    def __init__(self, module_count: int, correlation_time: float) -> None:
        """Start with nothing seen."""
        self._time = max(correlation_time, SHORTEST_TIME)
        self._errors = [0j] * module_count
        self._seen = self._expected = 0.0
        self.inflation = 1.0

    def update(self, dt: float, used: tuple[int, ...], errors: list[complex],
               expected: float) -> None:
        """
        Take in one step.

        Parameters
        ----------
        dt : float
            Its duration [s].
        used : tuple of int (k,)
            Indices of the modules that took part.
        errors : list of complex (k,)
            Error of each used module in the step [m], seen along its wheel: errors stay with a
            wheel as it turns.
        expected : float
            What the model expects of the sum of their squares [m^2/s^2].

        """
        # With this gain, fresh errors come out with the variance that the model expects of
        # them at any rate of the updates (down to one in two correlation times).
        gain = dt / (self._time + 0.5 * dt)
        kept, added = 1.0 - gain, gain / dt
        if gain > 1.0:
            kept, added = 0.0, 1.0 / dt
        seen, lasting = 0.0, self._errors
        for module, error in zip(used, errors):
            now = kept * lasting[module] + added * error
            lasting[module] = now
            size = abs(now)
            seen += size * size
        gain = dt / (MEMORY * self._time)
        if gain > 1.0:
            gain = 1.0
        self._seen += gain * (seen - self._seen)
        self._expected += gain * (expected - self._expected)
        self.inflation = 1.0
        if self._seen > self._expected > 0.0:
            self.inflation = min(self._seen / self._expected, LARGEST)
