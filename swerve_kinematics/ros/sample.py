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

"""What the joints and the gyro say at one time."""

from dataclasses import dataclass


@dataclass(slots=True)
class Sample:
    """
    One complete measurement of the base.

    Attributes
    ----------
    stamp : int
        Time [ns] of the newest part.
    distances : list of float (n,)
        Cumulative rim distances [m].
    angles : list of float (n,)
        Steering angles [rad], as many turns as the joints count.
    velocities : list of float (n,) or None
        Rim speeds [m/s], where the joints report them and the distances bear them out.
    yaw, yaw_rate, rate_integral : float or None
        Of the gyro at `stamp` [rad, rad/s, rad].
    continuous : bool
        False for the first sample and after a gap or a jump of the clock: what moved since
        the sample before is not known.
    gyro_went_on : bool
        Whether the gyro was heard all the time since the sample before, without a break.

    """

    stamp: int
    distances: list[float]
    angles: list[float]
    velocities: list[float] | None
    yaw: float | None
    yaw_rate: float | None
    rate_integral: float | None
    continuous: bool
    gyro_went_on: bool = False
