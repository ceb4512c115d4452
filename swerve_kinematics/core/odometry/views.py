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

"""What can be read of the odometry: copies, so that nobody changes it from outside."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.odometry.gyro import GyroBiasFilter
from swerve_kinematics.core.odometry.pose_covariance import Matrix, PoseCovariance
from swerve_kinematics.core.odometry.repeats import Repeats
from swerve_kinematics.core.odometry.solver import StepSolver
from swerve_kinematics.core.odometry.step_noise import StepNoise
from swerve_kinematics.core.odometry.twist import TwistMeter


class Estimate(NamedTuple):
    """
    What the odometry knows, as Python's own numbers.

    For a caller that passes single numbers on, at every step: to make and to read arrays of
    them takes as long as to compute them.

    Attributes
    ----------
    pose : tuple of float (3,)
        `(x, y, yaw)` [m, m, rad] in the odom frame; the yaw counts whole turns.
    twist : tuple of float (3,)
        `(vx, vy, omega)` [m/s, m/s, rad/s] at the stamp, in the base frame.
    pose_covariance : tuple of float (9,)
        Row by row [m^2, m rad, rad^2].
    twist_covariance : tuple of float (9,)
        Row by row [m^2/s^2, m rad/s^2, rad^2/s^2].

    """

    pose: tuple[float, float, float]
    twist: tuple[float, float, float]
    pose_covariance: Matrix
    twist_covariance: Matrix


class OdometryViews:
    """The state of SwerveOdometry as it is read: the estimate, and the sensors in its eyes."""

    _position: complex
    _yaw: float
    _covariance: PoseCovariance
    _twist_meter: TwistMeter
    _repeats: Repeats
    _solver: StepSolver
    _bias: GyroBiasFilter
    _step_noise: StepNoise

    @property
    def estimate(self) -> Estimate:
        """Return pose, twist and their covariances as an Estimate."""
        return Estimate(
            (self._position.real, self._position.imag, self._yaw), self._twist_meter.twist,
            self._covariance.pose, self._twist_meter.covariance)

    @property
    def yaw(self) -> float:
        """Return the yaw of the pose [rad]; it counts whole turns."""
        return self._yaw

    @property
    def pose(self) -> NDArray[np.float64]:
        """Return `[x, y, yaw]` (3,) [m, m, rad] in the odom frame; the yaw counts whole turns."""
        return np.array(self.estimate.pose)

    @property
    def twist(self) -> NDArray[np.float64]:
        """Return `[vx, vy, omega]` (3,) [m/s, m/s, rad/s] at the stamp, in the base frame."""
        return np.array(self.estimate.twist)

    @property
    def pose_covariance(self) -> NDArray[np.float64]:
        """Return the covariance (3, 3) of the pose [m^2, m rad, rad^2]."""
        return np.array(self.estimate.pose_covariance).reshape(3, 3)

    @property
    def twist_covariance(self) -> NDArray[np.float64]:
        """Return the covariance (3, 3) of the twist [m^2/s^2, m rad/s^2, rad^2/s^2]."""
        return np.array(self.estimate.twist_covariance).reshape(3, 3)

    @property
    def is_waiting(self) -> bool:
        """Return whether the last sample told nothing new: the pose is older than its stamp."""
        return self._repeats.is_waiting

    @property
    def slipping(self) -> NDArray[np.bool_]:
        """Return which modules (n,) the last step left out as wrong: slip, or a jump."""
        return np.array(self._solver.slipping)

    @property
    def gyro_bias(self) -> float:
        """Return the estimated constant error of the gyro's rate [rad/s]."""
        return float(self._bias.bias)

    @property
    def yaw_jumps(self) -> int:
        """Return how many jumps of the yaw were no turns: its sensor was reset."""
        return self._solver.gyro.jumps

    @property
    def gyro_trusted(self) -> tuple[bool, bool]:
        """
        Return whether the yaw and the rate of the gyro are believed.

        One that the other and the wheels contradict for a second is not, until they agree.
        """
        return self._solver.gyro.trusted

    @property
    def residual(self) -> float:
        """Return the root mean square disagreement of the modules in the last step [m/s]."""
        return self._step_noise.residual

    @property
    def doubt(self) -> NDArray[np.float64]:
        """Return for how long (n,) [s] the accelerometer has contradicted each module."""
        return np.array(self._solver.doubt)

    @property
    def coasting(self) -> float:
        """Return for how long [s] the base has been coasting on its accelerometer alone."""
        return self._solver.inertial.coasting.time

    @property
    def distrust(self) -> float:
        """
        Return for how long [s] the accelerometer will not be believed.

        0 unless it has contradicted wheels that agree with one another for too long.
        """
        return self._solver.inertial.coasting.distrust

    @property
    def lean(self) -> NDArray[np.float64]:
        """Return the gravity (2,) that leaks into x and y on a sloping floor [m/s^2]."""
        return np.array((self._solver.inertial.lean.real, self._solver.inertial.lean.imag))

    @property
    def stamp_scatter(self) -> float | None:
        """
        Return by how much (standard deviation) stamps are off the readings of the wheels [s].

        None while it is little enough for an accelerometer to judge the wheels.
        """
        return self._solver.inertial.stamp_scatter

    @property
    def imu_yaw_error(self) -> float:
        """
        Return what is to be added to the yaw at which the accelerometer is mounted [rad].

        0 while wheels and accelerometer agree on where the base accelerates, within 25 degrees.
        """
        return self._solver.inertial.yaw_error

    @property
    def accelerometer_believed(self) -> bool:
        """Return whether an accelerometer had a say in the last step."""
        return self._solver.inertial.believed
