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

"""Whether an accelerometer is turned against the wheels, as a wrong yaw of its mounting is."""

import math

from swerve_kinematics.core.geometry.angles import phase
from swerve_kinematics.core.odometry.mounting_proof import MountingProof

# The values are judgements, within what test_mounting_yaw.py tells: it fails for WINDOW 0.1,
# LEAST_CHANGES 20, MEMORY 10 or LARGEST_ERROR 0.2, not for twice or half of the others.

# Changes of velocity are compared over this time [s], long against delays of 10 or 20 ms and the
# noise of single samples. One that is smaller than this [m/s] tells little of its direction:
# wheels creep and count by 0.02 m/s (`inertial.WHEEL_SPEED`) at either end.
WINDOW = 0.2
LEAST_CHANGE = 0.05
# So many changes tell the angle, whose error of half a radian in each they take below
# LARGEST_ERROR; no more than the last ones count, 5 s of speeding up and slowing down.
LEAST_CHANGES, MEMORY = 8, 25
# A force that, turned by the angle, leaves more than this part of the changes unexplained (in
# squares) is not that of wheels which grip: where they slide sideways, it leaves 0.15.
UNEXPLAINED = 0.1
# An error of the yaw up to this [rad] is not looked for: it could be a floor whose lean changes,
# by 0.4 m/s^2 (`velocity_filter.LEAN_STD`) across a force of 1 m/s^2.
LARGEST_ERROR = math.radians(25.0)


class MountingYaw:
    """
    Compares the directions in which wheels and accelerometer say that the base accelerates.

    Gravity shows roll and pitch of the sensor, but only its force while the base accelerates
    shows the yaw. What is constant in the force, such as a bias, cancels: the covariances of
    both changes count. A verdict stays until the evidence is to the contrary.

    Attributes
    ----------
    error : float
        What is to be added to the yaw of the mounting [rad]; 0 while it seems right.
    proof : MountingProof
        Whether the accelerometer has ever felt what the wheels did.

    """

    def __init__(self) -> None:
        """Start with a mounting that is right."""
        self.error = 0.0
        self.proof = MountingProof()
        self._count = 0
        self._wheels = self._force = self._covariance = 0j  # means, and their covariance
        self._wheel_variance = self._force_variance = 0.0
        self.interrupt()

    def interrupt(self) -> None:
        """Begin a new window."""
        self._time, self._changed, self._gained, self._agree = 0.0, 0j, 0j, True

    def add(self, interval: float, back: complex, changed: complex, gained: complex,
            agree: bool) -> bool:
        """
        Take in a step, and return whether the accelerometer is suspect: it seems to be turned.

        Parameters
        ----------
        interval : float
            Since the step before [s].
        back : complex
            What turns a vector of that step into base axes, which have turned since.
        changed, gained : complex
            Change of the velocity by the wheels and by the force [m/s].
        agree : bool
            Whether the wheels agree with each other: none of them slips then, or all.

        """
        self._time += interval
        self._changed = back * self._changed + changed
        self._gained = back * self._gained + gained
        self._agree &= agree
        if self._time < WINDOW:
            return False
        is_suspect = self._agree and self.proof.is_suspect(self._changed, self._gained)
        if abs(self._changed) >= LEAST_CHANGE:
            self._compare(self._changed, self._gained)
        self.interrupt()
        return is_suspect

    def _compare(self, changed: complex, gained: complex) -> None:
        """Take in a window, and judge."""
        self._count = min(self._count + 1, MEMORY)
        gain = 1.0 / self._count
        changed -= self._wheels
        gained -= self._force
        self._wheels += gain * changed
        self._force += gain * gained
        keep = 1.0 - gain
        self._covariance = keep * (self._covariance + gain * changed * gained.conjugate())
        self._wheel_variance = keep * (self._wheel_variance + gain * abs(changed) ** 2)
        self._force_variance = keep * (self._force_variance + gain * abs(gained) ** 2)
        unexplained = (self._wheel_variance + self._force_variance
                       - 2.0 * abs(self._covariance))
        if self._count < LEAST_CHANGES:
            return
        if unexplained <= UNEXPLAINED * self._wheel_variance:
            error = phase(self._covariance)
            self.error = error if abs(error) > LARGEST_ERROR else 0.0
        elif self._count == MEMORY:
            self._count = 0  # no angle fits them all: begin anew
