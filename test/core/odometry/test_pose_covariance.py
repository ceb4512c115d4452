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

"""Tests of the covariance of the pose, against the matrices that it stands for."""

from hypothesis import given
import numpy as np
from strategies import seeds

from swerve_kinematics.core.odometry.pose_covariance import PoseCovariance


def propagated(covariance, displacement, lever, position_variance, turn_variance, bias_time):
    """Return `F P F' + Q` of [x, y, yaw, bias] as the textbook has it."""
    turn = np.array([lever.real, lever.imag, 1.0, 0.0])
    by_yaw = np.array([-displacement.imag, displacement.real, 0.0, 0.0])
    transition = np.eye(4)
    transition[:, 2] += by_yaw
    transition[:, 3] -= bias_time * turn
    noise = turn_variance * np.outer(turn, turn)
    noise[[0, 1], [0, 1]] += position_variance
    return transition @ covariance @ transition.T + noise


@given(seed=seeds)
def test_steps_add_up_as_matrices_do(seed):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(3, 3))
    expected = np.zeros((4, 4))
    expected[:3, :3] = root @ root.T
    expected[3, 3] = rng.uniform(0.0, 0.1)
    covariance = PoseCovariance(expected[:3, :3], expected[3, 3])
    for _ in range(20):
        step = (complex(*rng.normal(size=2)), complex(*rng.normal(size=2)),
                *rng.uniform(0.0, 0.1, 3))
        covariance.propagate(*step)
        expected = propagated(expected, *step)
        gain, wandered = rng.uniform(0.0, 0.5), rng.uniform(0.0, 0.1)
        covariance.correct_bias(gain)
        expected[:, 3] *= 1.0 - gain
        expected[3, :3] *= 1.0 - gain
        covariance.bias_variance += wandered
        expected[3, 3] += wandered
    np.testing.assert_allclose(np.reshape(covariance.pose, (3, 3)), expected[:3, :3],
                               rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_a_covariance_that_is_not_symmetric_is_made_so():
    given = np.array([[1.0, 0.2, 0.0], [0.0, 1.0, 0.0], [0.4, 0.0, 1.0]])
    np.testing.assert_array_equal(
        np.reshape(PoseCovariance(given, 0.0).pose, (3, 3)), 0.5 * (given + given.T))
