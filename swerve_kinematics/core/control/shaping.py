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

"""The next twist on the way to the wanted one, or to rest, within the limits of the base."""

import math

from swerve_kinematics.core.control.grip import gripping, slowest_factor
from swerve_kinematics.core.control.jerk import smoothed
from swerve_kinematics.core.control.limits import can_change, ControllerLimits, ratio
from swerve_kinematics.core.control.offsets import Offsets
from swerve_kinematics.core.control.passing import passing
from swerve_kinematics.core.control.ramp import ramped
from swerve_kinematics.core.geometry.planar import PlanarTwist, product


def shaped(wanted: PlanarTwist, previous: PlanarTwist, executed: PlanarTwist,
           acceleration: PlanarTwist, offsets: Offsets, limits: ControllerLimits,
           dt: float) -> PlanarTwist:
    """
    Return the twist to make for in this period: the wanted one, where no limit is in the way.

    Parameters
    ----------
    wanted : PlanarTwist
        Where to go in the end, within the limits of speed.
    previous, acceleration : PlanarTwist
        Twist and acceleration of the last period, as the limits shall see them.
    executed : PlanarTwist
        What the base did in the last period.
    offsets : Offsets
        Module positions from the centre of rotation [m].
    limits : ControllerLimits
        Those of acceleration, grip and jerk; stages without one are left out.
    dt : float
        Positive [s].

    """
    twist = wanted
    if limits.has_jerk or not can_change(previous, wanted, offsets, limits, dt):
        aim = passing(wanted, previous, offsets, limits, dt)
        twist = ramped(aim, previous, offsets, limits, dt)
    if limits.max_grip_acceleration < math.inf:
        twist = gripping(twist, previous, executed, offsets, limits.max_grip_acceleration, dt)
    if limits.has_jerk:
        twist = smoothed(twist, previous, acceleration, offsets, limits, dt)
    return twist


def stopping_factor(slower: PlanarTwist, present: PlanarTwist, offsets: Offsets,
                    peak_speed: float, limits: ControllerLimits, dt: float) -> float:
    """
    Return the factor on the present twist that makes it a slower one, with all angles held.

    It is greater than the ramp's where the floor cannot hold that. With a jerk limit a base that
    speeds up goes on to do so for a while: then no module exceeds its limit, and none that
    is beyond one that was lowered gets any faster.

    Parameters
    ----------
    slower : PlanarTwist
        What the ramp to rest allows for this period, on the same curve.
    present : PlanarTwist
        What the base does.
    offsets : Offsets
        Module positions from the centre of rotation [m].
    peak_speed : float
        Of the fastest module [m/s].
    limits : ControllerLimits
        Those of grip and of module speed count.
    dt : float
        Positive [s].

    """
    square = product(present, present)
    factor = product(slower, present) / square if square > 0.0 else 0.0
    factor = max(factor, slowest_factor(present, offsets, limits.max_grip_acceleration, dt))
    return min(factor, max(1.0, ratio(limits.max_module_speed, peak_speed)))
