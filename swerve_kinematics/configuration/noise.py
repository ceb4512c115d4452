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

"""What the odometry expects of sensors and wheels, as parameters."""

import math

from swerve_kinematics.configuration.declarations import Declaration, UNBOUNDED, Values
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise

PREFIX = 'odometry.'
_EXPECTED = OdometryNoise()


def _noise(name: str, description: str, unit: str, changeable: bool = True,
           plausible: float = UNBOUNDED, mistake: str = '') -> Declaration:
    """Declare a figure of the noise, with the core's default."""
    return Declaration(PREFIX + name, float(getattr(_EXPECTED, name)), description, unit,
                       minimum=0.0, changeable=changeable, plausible=plausible, mistake=mistake)


NOISE_DECLARATIONS = (
    _noise('distance_noise', "Relative error of a module's distance", ''),
    _noise('steering_noise', "Error of a module's direction of travel", 'rad'),
    _noise('correlation_time', 'Time for which these two errors keep their value', 's', False),
    _noise('distance_resolution', 'Smallest step of a drive encoder at the rim', 'm',
           plausible=0.05, mistake='millimetres'),
    _noise('gyro_noise', "Random walk of the gyro's yaw", 'rad/sqrt(s)'),
    _noise('gyro_bias_std', 'Standard deviation of the gyro bias at the start', 'rad/s',
           False),
    _noise('gyro_bias_drift', 'Random walk of the gyro bias', 'rad/s/sqrt(s)', False),
    _noise('slip_speed', 'Disagreement of the modules that does not yet count as slip', 'm/s'),
    _noise('slip_ratio', 'A module slips if the others agree this many times better without it',
           ''),
    _noise('max_module_speed',
           'Anything faster is taken for a reset of the encoder; 0: no limit', 'm/s'),
)


def noise_from(values: Values) -> OdometryNoise:
    """
    Return the noise that the parameters describe.

    Parameters
    ----------
    values : mapping
        Value by name, of NOISE_DECLARATIONS.

    Returns
    -------
    OdometryNoise

    """
    given = {noise.name.removeprefix(PREFIX): values[noise.name] for noise in NOISE_DECLARATIONS}
    return OdometryNoise(**{**given, 'max_module_speed': given['max_module_speed'] or math.inf})
