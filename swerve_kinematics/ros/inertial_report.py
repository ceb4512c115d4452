"""What the accelerometer says of the wheels, of the floor and of itself, for people."""

import math

from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.core.odometry.tilt import STANDARD_GRAVITY
from swerve_kinematics.ros.accelerometer import AccelerometerFeedback


def accelerometer_fault(accelerometer: AccelerometerFeedback) -> str | None:
    """Return what is wrong with the accelerometer, None if nothing is."""
    fault = accelerometer.fault
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
    ahead, left = (math.degrees(math.asin(max(-1.0, min(leak / STANDARD_GRAVITY, 1.0))))
                   for leak in odometry.lean.tolist())
    return {
        'accelerometer': accelerometer.fault or state,
        'doubted wheels': ', '.join(doubted) or 'none',
        'coasting on the accelerometer [s]': odometry.coasting,
        'floor rises ahead, to the left [deg]': f'{ahead:.1f}, {left:.1f}',
    }
