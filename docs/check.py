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

"""Draw what `swerve_check --save` draws where a steering joint counts clockwise."""

from pathlib import Path

import numpy as np
from pictures import shrink

from swerve_kinematics.configuration.program import NODE, read_settings
from swerve_kinematics.core.checking.check import check
from swerve_kinematics.core.checking.drive_data import DriveData
from swerve_kinematics.tools.check.picture import save

PICTURE = Path(__file__).with_name('check.png')
PERIOD, DURATION = 0.02, 20.0
# The rear right joint reads the mirror image of its module's angle.
MIRRORED = (1.0, 1.0, 1.0, -1.0)


def main(path: Path = PICTURE) -> None:
    """Push a base around, check what its joints read, and draw it."""
    parameters = read_settings(NODE, '/swerve_node', []).parameters
    kinematics = parameters.layout.kinematics
    time = np.arange(0.0, DURATION, PERIOD)
    twist = np.column_stack((
        0.3 * np.sin(0.6 * time), 0.25 * np.cos(0.5 * time), 0.4 * np.sin(0.9 * time)))
    states = kinematics.inverse(twist)
    data = DriveData(time, PERIOD * np.cumsum(states.speed, axis=0), states.angle * MIRRORED,
                     yaw=PERIOD * np.cumsum(twist[:, 2]))
    save(path, parameters, data, check(kinematics.module_positions, data, pairs=False))
    shrink(path)


if __name__ == '__main__':
    main()
