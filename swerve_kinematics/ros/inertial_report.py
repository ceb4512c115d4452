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

"""What the accelerometer says of the wheels, of the floor and of itself, for people."""

import math

from swerve_kinematics.core.geometry.clamping import clamped
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.tilt import STANDARD_GRAVITY
from swerve_kinematics.ros.accelerometer import AccelerometerFeedback


def accelerometer_fault(
        accelerometer: AccelerometerFeedback, odometry: SwerveOdometry) -> str | None:
    """Return why the accelerometer is not used, None if it is."""
    fault = accelerometer.fault
    if fault is None and odometry.stamp_scatter is not None:
        fault = (f'the stamps of joint_states scatter by {1e3 * odometry.stamp_scatter:.0f} ms '
                 'about the times of the readings')
    if fault is None and odometry.imu_yaw_error:
        fault = (f'by the wheels, the yaw of its imu_orientation is wrong by '
                 f'{math.degrees(odometry.imu_yaw_error):.0f} degrees')
    if fault is None and odometry.distrust:
        fault = ('it contradicted wheels that agree with one another for too long; it has another '
                 f'chance in {math.ceil(odometry.distrust)} s')
    return None if fault is None else f'the accelerometer of the IMU is not used: {fault}'


def inertial_values(names: tuple[str, ...], odometry: SwerveOdometry,
                    accelerometer: AccelerometerFeedback) -> dict[str, float | str]:
    """
    Return what the accelerometer tells, for the diagnostics.

    Parameters
    ----------
    names : tuple of str (n,)
        Of the modules.
    odometry : SwerveOdometry
        Judges the wheels by the accelerometer.
    accelerometer : AccelerometerFeedback
        Tells what is wrong with it.

    """
    if not accelerometer.heard:
        return {'accelerometer': 'none'}
    state = 'trusted' if odometry.accelerometer_believed else 'not trusted'
    doubted = [f'{name} for {doubt:.2g} s' for name, doubt in zip(names, odometry.doubt.tolist())
               if doubt]
    ahead, left = (math.degrees(math.asin(clamped(leak / STANDARD_GRAVITY, 1.0)))
                   for leak in odometry.lean.tolist())
    return {
        'accelerometer': accelerometer.fault or state,
        'doubted wheels': ', '.join(doubted) or 'none',
        'coasting on the accelerometer [s]': odometry.coasting,
        'floor rises ahead, to the left [deg]': f'{ahead:.1f}, {left:.1f}',
    }
