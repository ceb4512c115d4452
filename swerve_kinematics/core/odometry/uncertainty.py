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

"""What errors to expect of the sensors and wheels of a base."""

from dataclasses import dataclass, fields
from functools import cached_property
import math

from swerve_kinematics.core.odometry.readings import FASTEST_RIM, LARGEST_SPEED

# Standard deviations beyond this [m], [rad], [m/s] say no more than "unknown", and their
# squares and products would not fit into a number.
LARGEST = 1e12


@dataclass(frozen=True)
class OdometryNoise:
    """
    The errors to expect of the sensors and wheels of a base.

    The defaults describe an ordinary base with 12-bit encoders, rubber tyres and a MEMS gyro.
    They are a lower bound for the covariances: modules that disagree by more than expected
    raise them. Of three plausible sets of the first three values this one brought the NEES
    nearest to 3, over 22 drives of a physics simulation and simulated noise taken together.

    Attributes
    ----------
    distance_noise : float
        Relative error of a module's distance, along the wheel: tyre creep, uneven floor,
        backlash. A few tenths of a per cent on a calibrated base.
    steering_noise : float
        Error of a module's direction of travel [rad], across the wheel: backlash, side slip.
        A quarter of a degree is usual for a geared steering.
    correlation_time : float
        How long those errors keep their value [s]. Both together make a random walk of the
        module, in x and in y, with a variance that grows by
        `correlation_time (distance_noise^2 + steering_noise^2) speed^2` [m^2/s], at any rate
        of the updates. Fresh errors in each step of dt do the same with a standard deviation
        of `sqrt(2 correlation_time / dt)` times these: 1 % and 0.8 degrees at 50 Hz.
    distance_resolution : float
        Smallest step of a drive encoder at the rim [m]: 2 pi / 4096 (12 bits) of a 50 mm
        wheel is 0.08 mm.
    gyro_noise : float
        Random walk of the gyro's yaw [rad/sqrt(s)]. Data sheets of MEMS gyros say 0.005 to
        0.01 deg/sqrt(s); 0.015 leaves room for vibration.
    gyro_bias_std : float
        Standard deviation of the gyro's constant error at the start [rad/s]. Data sheets of
        MEMS gyros say 0.5 to 1 deg/s.
    gyro_bias_drift : float
        Random walk of that error [rad/s/sqrt(s)]: 0.001 deg/s after a second is 0.06 deg/s
        after an hour, as with a warm gyro.
    slip_speed : float
        Spread of the modules' votes that does not yet count as slip [m/s]: tyre creep makes a
        few mm/s in gentle driving.
    slip_ratio : float
        A module slips if the others agree this many times better without it.
    max_module_speed : float
        Faster than any module can move [m/s], infinity for no limit: such a step is an
        encoder that was reset. The fastest competition bases reach 6 m/s.

    Raises
    ------
    ValueError
        If a value is negative or NaN, or one other than max_module_speed is above 1e12.

    """

    distance_noise: float = 0.003
    steering_noise: float = math.radians(0.25)
    correlation_time: float = 0.1
    distance_resolution: float = 0.08e-3
    gyro_noise: float = math.radians(0.015)
    gyro_bias_std: float = math.radians(0.5)
    gyro_bias_drift: float = math.radians(0.001)
    slip_speed: float = 0.004
    slip_ratio: float = 3.0
    max_module_speed: float = FASTEST_RIM

    def __post_init__(self) -> None:
        """Refuse what is no magnitude."""
        for field in fields(self):
            value = getattr(self, field.name)
            largest = math.inf if field.name == 'max_module_speed' else LARGEST
            if not 0.0 <= value <= largest:
                raise ValueError(
                    f'{field.name} must be from 0 to {largest:g}, got {value}')

    @cached_property
    def gyro_variance(self) -> float:
        """Return the variance of the gyro's yaw after a second [rad^2]."""
        return self.gyro_noise * self.gyro_noise

    @cached_property
    def largest_speed(self) -> float:
        """Return the speed [m/s] beyond which a step or a reading is no motion of a module."""
        speed = self.max_module_speed
        return speed if speed < LARGEST_SPEED else LARGEST_SPEED
