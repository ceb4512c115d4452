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

"""Commands that a steering range does not allow: projected, or a stop."""

import numpy as np
import pytest

from swerve_kinematics import SwerveController, SwerveKinematics
from swerve_kinematics.core.control.limits import ControllerLimits

KIN = SwerveKinematics([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
LIMITS = ControllerLimits(max_linear_acceleration=2.0, max_linear_deceleration=2.0,
                          max_steering_rate=6.0)
DT = 0.02


def controller(policy):
    """Return the controller of modules that steer by 60 degrees to either side."""
    return SwerveController(KIN, LIMITS, steering_lower_limits=[-np.radians(60.0)] * 4,
                            steering_upper_limits=[np.radians(60.0)] * 4,
                            unreachable_policy=policy)


def driven(control, twist, periods, angles=None):
    """Return the commands of some periods, the modules following at once."""
    commands = []
    for _ in range(periods):
        angles = commands[-1].angle if commands else np.zeros(4) if angles is None else angles
        commands.append(control.update(twist, angles, DT))
    return commands


@pytest.mark.parametrize('policy, is_moving', [('project', True), ('stop', False)])
def test_a_twist_out_of_reach_is_projected_or_stops_the_base(policy, is_moving):
    control = controller(policy)
    before = driven(control, (1.0, 0.0, 0.0), 60)[-1]
    after = driven(control, (0.3, 1.0, 0.0), 150, before.angle)
    assert np.hypot(*before.twist[:2]) == pytest.approx(1.0)
    assert after[-1].unreachable.all()
    assert bool(np.hypot(*after[-1].twist[:2]) > 0.1) is is_moving
    if not is_moving:
        speeds = np.array([np.hypot(*command.twist[:2]) for command in after])
        assert np.diff(speeds).min() > -2.0 * DT - 1e-9 and not after[-1].speed.any()
        np.testing.assert_allclose(after[-1].angle, before.angle)
    again = driven(control, (0.5, 0.5, 0.0), 100, after[-1].angle)[-1]
    np.testing.assert_allclose(again.twist, (0.5, 0.5, 0.0), atol=1e-6)
    assert not again.unreachable.any()


def test_another_policy_is_refused():
    with pytest.raises(ValueError, match='ask'):
        controller('ask')
