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

"""What swerve_calibrate prints of what it found."""

import numpy as np
from swerve_kinematics.configuration.node import NODE_DECLARATIONS, parameters_from
from swerve_kinematics.configuration.values import values_of
from swerve_kinematics.core.calibration.calibration import Calibration
from swerve_kinematics.core.calibration.delay import Delay
from swerve_kinematics.tools.calibrate.report import report


def test_a_correction_that_rounds_to_nothing_has_no_minus_sign():
    parameters = parameters_from({**values_of(NODE_DECLARATIONS, {}), 'gyro_source': 'imu'})
    nothing, std = np.full(4, -1e-9), np.full(4, 1e-3)
    text = report(parameters, Calibration(
        1.0 + nothing, std, nothing, std, True, 1.0, 1e-3, 0.0, False, Delay(-1e-9, 1e-3)))
    assert '-0.0' not in text.replace('+-', '')
    assert 'steering_offsets: [0.000000, 0.000000, 0.000000, 0.000000]' in text
    assert 'imu_delay: 0.0000' in text
