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

"""The fit of a rigid motion to the ways of points, next to the kinematics of the base."""

import numpy as np
import pytest

from swerve_kinematics.core.kinematics.rigid_fit import RigidFit
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics


@pytest.mark.parametrize('count', [2, 3, 4, 9])
def test_it_is_the_fit_of_the_kinematics(count):
    rng = np.random.default_rng(count)
    positions = rng.uniform(-1.0, 1.0, (count, 2)) + (3.0, -2.0)
    kin, fit = SwerveKinematics(positions), RigidFit(positions @ (1.0, 1j))
    ways = rng.standard_normal((50, count)) + 1j * rng.standard_normal((50, count))
    states = np.abs(ways), np.angle(ways)
    way, turn = fit.motion(ways)
    np.testing.assert_allclose(np.stack((way.real, way.imag, turn), axis=-1), kin.forward(states),
                               atol=1e-12)
    np.testing.assert_allclose(np.abs(ways - fit.fitted(ways)), kin.residuals(states), atol=1e-12)
    np.testing.assert_array_equal(fit.turn(ways), turn)
    parts = np.concatenate((ways.real, ways.imag), axis=1)
    x, y = np.split(parts @ fit.projection(), 2, axis=1)
    np.testing.assert_allclose(x + 1j * y, fit.fitted(ways), atol=1e-12)


def test_a_rigid_motion_is_fitted_by_itself():
    positions = np.array((0.3 + 0.25j, 0.3 - 0.25j, -0.3 + 0.25j))
    ways = (0.2 - 0.1j) + 0.05 * 1j * positions
    way, turn = RigidFit(positions).motion(ways)
    assert way == pytest.approx(0.2 - 0.1j)
    assert turn == pytest.approx(0.05)
    np.testing.assert_allclose(RigidFit(positions).fitted(ways), ways)
