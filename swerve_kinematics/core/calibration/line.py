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

"""Calibration from one drive along a straight line of known length."""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.calibration.calibration import (
    Calibration, calibration_from, ENCODER_STEP)
from swerve_kinematics.core.calibration.module_fit import UNSEEN
from swerve_kinematics.core.calibration.recording import (
    heading_by_gyro, moving_windows, Recording, rolled_tracks, Windows)
from swerve_kinematics.core.calibration.slip import in_words, slipping, spans
from swerve_kinematics.core.calibration.ways import arms_of, fit_ways, known_modules, ways_over
from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.geometry.arrays import check_series
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

# How well a base keeps its heading on a straight line, or a gyro knows it [rad].
HEADING_STD = np.radians(0.3)
# A line whose track is longer by this factor is not straight.
STRAIGHT = 1.02
# A line tells how modules differ, not which of them is wrong. One that points further away from
# their mean than this [degrees] would have the right ones corrected for it.
FURTHEST_ASTRAY = 15.0


def calibrate_by_distance(kin: SwerveKinematics, recording: Recording, distance: float,
                          distance_std: float = 0.002, encoder_step: float = ENCODER_STEP,
                          pushed: bool = False) -> Calibration:
    """
    Return the calibration from one drive along a straight line of known length.

    The direction of the line in the base frame is unknown, and so is the offset that all
    steering angles share. The heading comes from the gyro, less the rate it shows at rest;
    where there is none or it is silent it is taken as constant. Differences between modules
    only show if the wheels roll freely. Wheels that are driven along a line are forced to agree
    by the frame: only their mean radius can be found. Motors that gave way show that in how far
    their wheels rolled, but nothing tells a module that was forced aside from one whose steering
    is held a little off: unless the base was pushed, offsets are as uncertain as they may be.

    Parameters
    ----------
    kin : SwerveKinematics
        The layout.
    recording : Recording
        What the sensors said, with the present values.
    distance : float
        How far base_link moved [m].
    distance_std : float
        How well that is known [m].
    encoder_step : float
        One count of the steering encoders [rad].
    pushed : bool
        As in `calibrate_by_poses`.

    Returns
    -------
    Calibration

    Raises
    ------
    ValueError
        As `calibrate_by_poses`, and if the distance is not positive, the line not straight, a
        module points 15 degrees away from their mean, or a wheel slips, because the distance
        that is missing then is unknown.

    """
    check_series(*recording[:3], kin.module_count)
    if not 0.0 < distance < np.inf:
        raise ValueError(f'distance must be positive and finite, got {distance}')
    heading = heading_by_gyro(recording)
    tracks, arms = rolled_tracks(recording, heading), arms_of(kin, heading)
    windows = moving_windows(recording.stamp, tracks)
    factors = np.ones(kin.module_count, dtype=complex)
    # The modules' mean, stretched to the distance, stands for the truth. It depends on the
    # factors that come of it, but so little that three rounds are plenty.
    for _ in range(3):
        line = (tracks * factors - arms).mean(axis=1, keepdims=True)
        line *= distance / _straight_length(line, windows)
        measured, true = ways_over(windows, heading, tracks, line + arms)
        fit = fit_ways(kin, measured, true, pushed, rounding=encoder_step)
        factors = fit.factors
    left_out = spans(recording.stamp, windows, slipping(measured, true))
    if left_out:
        raise ValueError(f'wheels slipped from {in_words(left_out)}: the line cannot be used')
    calibration = _relative(calibration_from(fit, known_modules(recording), encoder_step),
                            distance_std / distance,
                            HEADING_STD * np.abs(arms[0] - arms[0].mean()) / distance)
    return calibration if pushed else calibration._replace(
        steering_offset_std=np.maximum(calibration.steering_offset_std, UNSEEN))


def _relative(calibration: Calibration, scale_std: float,
              arm_std: NDArray[np.float64]) -> Calibration:
    """Return a calibration by distance, less the common offset and with its own errors."""
    offset, known = calibration.steering_offset, np.isfinite(calibration.steering_offset_std)
    mean = np.angle(np.exp(1j * offset[known]).sum())
    offset = np.where(known, wrap_angle(offset - mean), 0.0)
    furthest = np.degrees(np.abs(offset).max())
    if furthest > FURTHEST_ASTRAY:
        raise ValueError(
            f'a module points {furthest:.0f} degrees away from their mean, and a line does not '
            'tell which one is wrong: run swerve_check first')
    count = len(offset)
    # The modules' mean has 1 / n of their errors in it, which do not show against it.
    unseen = np.sqrt(count / (count - 1))
    return calibration._replace(
        radius_scale_std=np.sqrt(
            (unseen * calibration.radius_scale_std) ** 2 + scale_std ** 2 + arm_std ** 2),
        steering_offset=offset,
        steering_offset_std=np.hypot(unseen * calibration.steering_offset_std, arm_std),
        common_offset_known=False)


def _straight_length(line: NDArray[np.complex128], windows: Windows) -> float:
    """Return how far apart the ends of a track (t, 1) are [m]; ValueError if it is bent."""
    start, end = windows
    length = float(abs(line[-1, 0] - line[0, 0]))
    way = np.abs(line[end] - line[start]).sum()
    if way > STRAIGHT * length:
        raise ValueError(f'the line is not straight: the base rolled {way:.3f} m '
                         f'and ended {length:.3f} m away')
    return length
