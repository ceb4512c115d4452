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

"""How sure the pose is: what the errors of all steps add up to."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.odometry.uncertainty import LARGEST

# No pose is known better than this [m], [rad]: a covariance without an inverse is of no use.
FINEST = 1e-6
# Rounding may put an eigenvalue of a covariance this far below zero, by its largest entry.
ROUNDING = 1e-9

Matrix = tuple[float, float, float, float, float, float, float, float, float]


def is_covariance(matrix: NDArray[np.float64]) -> bool:
    """Tell whether a finite matrix (n, n) is symmetric and has no negative variance."""
    tolerance = ROUNDING * np.abs(matrix).max()
    return bool(np.abs(matrix - matrix.T).max() <= tolerance
                and np.linalg.eigvalsh(matrix).min() >= -tolerance)


class LastingError:
    """
    The error of a sum of steps whose own errors keep their value for a while.

    Fresh errors add up by their variances. One that stays adds up by its standard deviation:
    after a spell of slip the pose is off by the sum, not by the root of the sum of squares.

    Parameters
    ----------
    time : float
        How long an error keeps its value [s].

    """

    def __init__(self, time: float) -> None:
        """Start without any."""
        self._time = time
        self._sum = 0.0

    def grow(self, dt: float, std: float) -> float:
        """
        Return by how much a step makes the variance of the sum grow.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        std : float
            Standard deviation of the error, per second: [m/s] for a sum in metres.

        """
        kept, added = self._sum / (1.0 + dt / self._time), std * dt
        self._sum = kept + added
        return added * (2.0 * kept + added)


class PoseCovariance:
    """
    Covariance of pose and gyro bias together, `[x, y, yaw, bias]`.

    The bias is a state here for its error turns the heading steadily, step after step, which
    no noise that is fresh in every step can describe.

    Parameters
    ----------
    pose_covariance : array_like (3, 3)
        [m^2, m rad, rad^2]. Standard deviations above 1e12 are taken for that.
    bias_variance : float
        [(rad/s)^2].

    Attributes
    ----------
    scale_variance : float
        Of the part by which all of the way is too short, or askew. It makes the position as
        wrong as the base is far from where it began, however long it took.
    bias_variance : float
        Of the gyro's bias [(rad/s)^2]; it grows while the bias wanders.

    """

    def __init__(self, pose_covariance: ArrayLike, bias_variance: float) -> None:
        """Start without correlation between pose and bias."""
        covariance = np.asarray(pose_covariance, dtype=float)
        # Rows and columns of the same factor keep it positive, and the correlations.
        scale = np.minimum(1.0, LARGEST / np.sqrt(np.maximum(np.diag(covariance), 1.0)))
        covariance = scale[:, np.newaxis] * covariance * scale
        np.fill_diagonal(covariance, np.maximum(np.diag(covariance), FINEST ** 2))
        (xx, xy, x_yaw), (yx, yy, y_yaw), (yaw_x, yaw_y, yaw) = covariance.tolist()
        self._xx, self._xy, self._yy = xx, 0.5 * (xy + yx), yy
        self._x_yaw, self._y_yaw = 0.5 * (x_yaw + yaw_x), 0.5 * (y_yaw + yaw_y)
        self._x_bias = self._y_bias = 0.0
        self._yaw, self._yaw_bias, self.bias_variance = yaw, 0.0, bias_variance
        self._way, self.scale_variance = 0j, 0.0

    @property
    def pose(self) -> Matrix:
        """Return the covariance of the pose, row by row: 9 floats."""
        way = self._way
        scale = self.scale_variance * (way.real * way.real + way.imag * way.imag)
        return (self._xx + scale, self._xy, self._x_yaw,
                self._xy, self._yy + scale, self._y_yaw,
                self._x_yaw, self._y_yaw, self._yaw)

    def propagate(self, displacement: complex, lever: complex, position_variance: float,
                  turn_variance: float, bias_time: float) -> None:
        """
        Add the noise of one step: `P <- F P F' + Q`.

        Parameters
        ----------
        displacement : complex
            Of base_link in the odom frame [m]: what an error of the heading turns.
        lever : complex
            How an error of the step's turn moves base_link [m/rad].
        position_variance : float
            Of the displacement of the modules' centroid, in x and in y [m^2].
        turn_variance : float
            Of the step's turn, without the bias [rad^2].
        bias_time : float
            How long the bias turned the heading in this step [s].

        """
        # An error of the yaw moves the position by (x, y), one of the turn by the lever, one of
        # the bias by the lever and the yaw by 1, both times -bias_time. Floats cost less here
        # than complex numbers; the plurals are sums of before and after.
        self._way += displacement
        x, y, lever_x, lever_y = -displacement.imag, displacement.real, lever.real, lever.imag
        drift_x, drift_y = bias_time * lever_x, bias_time * lever_y
        spread_x, spread_y = turn_variance * lever_x, turn_variance * lever_y
        yaw, yaw_bias, bias = self._yaw, self._yaw_bias, self.bias_variance
        x_yaw = self._x_yaw + x * yaw - drift_x * yaw_bias
        y_yaw = self._y_yaw + y * yaw - drift_y * yaw_bias
        x_bias = self._x_bias + x * yaw_bias - drift_x * bias
        y_bias = self._y_bias + y * yaw_bias - drift_y * bias
        x_yaws, y_yaws = self._x_yaw + x_yaw, self._y_yaw + y_yaw
        x_biases, y_biases = self._x_bias + x_bias, self._y_bias + y_bias
        self._xx += x * x_yaws - drift_x * x_biases + spread_x * lever_x + position_variance
        self._yy += y * y_yaws - drift_y * y_biases + spread_y * lever_y + position_variance
        self._xy += (0.5 * (x * y_yaws + y * x_yaws - (drift_x * y_biases + drift_y * x_biases))
                     + spread_x * lever_y)
        self._yaw_bias = yaw_bias - bias_time * bias
        self._yaw += turn_variance - bias_time * (yaw_bias + self._yaw_bias)
        self._x_yaw, self._y_yaw = (x_yaw - bias_time * x_bias + spread_x,
                                    y_yaw - bias_time * y_bias + spread_y)
        self._x_bias, self._y_bias = x_bias, y_bias

    def correct_bias(self, gain: float) -> None:
        """Follow a correction of the bias estimate with this gain."""
        self._x_bias *= 1.0 - gain
        self._y_bias *= 1.0 - gain
        self._yaw_bias *= 1.0 - gain
        self.bias_variance *= 1.0 - gain

    def grow(self, position_variance: float, turn_variance: float) -> None:
        """Add independent errors of the position, in x and in y [m^2], and the heading [rad^2]."""
        self._xx += position_variance
        self._yy += position_variance
        self._yaw += turn_variance
