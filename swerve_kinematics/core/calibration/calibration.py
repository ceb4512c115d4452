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

"""
Wheel radii, steering offsets and the scale of the gyro from a recorded drive.

Vectors are complex numbers here, x + iy. A wheel whose radius is wrong by a factor and whose
steering angle is wrong by an offset measures its way wrong by one constant complex factor: the
true way is `c` times the measured one, with `c = radius_scale * exp(-1j * steering_offset)`.
That is linear, however large the errors are: each window of the drive gives one equation for
each module, and least squares gives the factors.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.calibration.delay import Delay, gyro_delay, UNKNOWN
from swerve_kinematics.core.calibration.gyro_scale import gyro_scale
from swerve_kinematics.core.calibration.module_fit import ModuleFit
from swerve_kinematics.core.calibration.recording import moving_windows, Recording, rolled_tracks
from swerve_kinematics.core.calibration.slip import slipping, Span, spans
from swerve_kinematics.core.calibration.ways import arms_of, fit_ways, known_modules, ways_over
from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.geometry.arrays import check_series
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

# One count of a 12-bit encoder on the steering axis [rad].
ENCODER_STEP = TURN / 4096


class Calibration(NamedTuple):
    """
    Corrections and their standard deviations, infinite for what the drive does not show.

    Attributes
    ----------
    radius_scale, radius_scale_std : ndarray (n,)
        True radius / present radius; 1 where unknown.
    steering_offset, steering_offset_std : ndarray (n,)
        To be added to the present offsets [rad]: the reading less the offset is the true
        angle. 0 where unknown.
    common_offset_known : bool
        False if only differences between modules are known. The mean of the offsets is then
        left as it was, and the deviations are those of the differences to it.
    gyro_scale, gyro_scale_std : float
        True turn / turn by the gyro; 1 where unknown.
    contradiction : float
        By how much the modules contradict each other whatever their factors are, relative to
        the distances they rolled: noise, slip, or wheels that fight each other.
    driven : bool
        Whether nothing shows that the wheels rolled freely. Where driven wheels are wrong in a
        way that cancels in every motion, neither the base nor the encoders show it; the
        deviations of the single modules say how wrong they may be.
    gyro_delay : Delay
        How much later the gyro is stamped than the wheels.
    left_out : tuple of Span
        When wheels slipped, by the stamps of the recording: these spans were not used.

    """

    radius_scale: NDArray[np.float64]
    radius_scale_std: NDArray[np.float64]
    steering_offset: NDArray[np.float64]
    steering_offset_std: NDArray[np.float64]
    common_offset_known: bool
    gyro_scale: float
    gyro_scale_std: float
    contradiction: float
    driven: bool
    gyro_delay: Delay = UNKNOWN
    left_out: tuple[Span, ...] = ()


def calibrate_by_poses(kin: SwerveKinematics, recording: Recording, poses: ArrayLike,
                       encoder_step: float = ENCODER_STEP, pushed: bool = False) -> Calibration:
    """
    Return the calibration from a drive on which every pose is known.

    Parameters
    ----------
    kin : SwerveKinematics
        The layout.
    recording : Recording
        What the sensors said, with the present values.
    poses : array_like (t, 3)
        True `[x, y, heading]` [m, m, rad] of base_link at the stamps of the recording.
    encoder_step : float
        One count of the steering encoders [rad]: it limits how well an offset can be known.
    pushed : bool
        Whether the base was pushed with its motors off, so that each wheel rolled freely.

    Returns
    -------
    Calibration

    Raises
    ------
    ValueError
        If a shape is wrong, an entry is not finite, the stamps do not increase, the base
        moved for less than 5 s, no module rolled 1 m, the poses stand still or are not in
        metres, or the modules contradict each other in most of the drive.

    """
    check_series(*recording[:3], kin.module_count)
    poses = np.asarray(poses, dtype=float)
    if poses.shape != (len(recording.stamp), 3) or not np.isfinite(poses).all():
        raise ValueError(f'poses must be finite and of shape ({len(recording.stamp)}, 3), '
                         f'got shape {poses.shape}')
    heading = np.unwrap(poses[:, 2])
    tracks = rolled_tracks(recording, heading)
    windows = moving_windows(recording.stamp, tracks)
    true_tracks = poses[:, :1] + 1j * poses[:, 1:2] + arms_of(kin, heading)
    measured, true = ways_over(windows, heading, tracks, true_tracks)
    slips = slipping(measured, true)
    clean = ~slips.any(axis=1)
    fit = fit_ways(kin, measured[clean], true[clean], pushed)
    left_out = spans(recording.stamp, windows, slips)
    scale, scale_std = gyro_scale(recording, windows, heading)
    return calibration_from(fit, known_modules(recording), encoder_step)._replace(
        gyro_scale=scale, gyro_scale_std=scale_std, left_out=left_out,
        gyro_delay=gyro_delay(kin, recording, fit.factors, left_out))


def calibration_from(fit: ModuleFit, known: NDArray[np.bool_],
                     encoder_step: float) -> Calibration:
    """Return the factors as radius scales and steering offsets; the gyro is left unknown."""
    count = len(known)
    size = np.abs(fit.factors)
    along = fit.factors / size
    # Standard deviations of the factors along themselves and across, relative to their size.
    parts = np.array((along.real, along.imag)), np.array((-along.imag, along.real))
    blocks = fit.covariance.reshape(2, count, 2, count)[:, range(count), :, range(count)]
    along_std, across_std = (
        np.sqrt(np.einsum('pn,npq,qn->n', part, blocks, part)) / size for part in parts)
    # A circle is no line: a large error of the offset changes the scale too, by its cosine.
    along_std = np.hypot(along_std, across_std ** 2)
    # Encoders that round down lag by half a count, and one that never moves by up to a whole:
    # in the root mean square about 1 / sqrt(3) of it.
    across_std = np.hypot(across_std, encoder_step / np.sqrt(3.0))
    return Calibration(
        np.where(known, size, 1.0), np.where(known, size * along_std, np.inf),
        np.where(known, -np.angle(fit.factors), 0.0), np.where(known, across_std, np.inf),
        True, 1.0, np.inf, fit.contradiction, fit.driven)
