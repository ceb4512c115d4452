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
from swerve_kinematics.core.calibration.module_fit import (
    BLOCKS, covariance, fit_modules, ModuleFit, UNSEEN)
from swerve_kinematics.core.calibration.recording import (
    heading_by_gyro, moving_windows, Recording, rolled_tracks, Windows)
from swerve_kinematics.core.calibration.slip import CAUSES, in_words, slipping, Span, spans
from swerve_kinematics.core.geometry.angles import TURN, wrap_angle
from swerve_kinematics.core.geometry.arrays import check_series
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

# One count of a 12-bit encoder on the steering axis [rad].
ENCODER_STEP = TURN / 4096
# What a module must roll for its values to be known [m], and a base turn for the gyro's [rad].
LEAST_WAY = 1.0
LEAST_TURN = np.pi
# How well a base keeps its heading on a straight line, or a gyro knows it [rad].
HEADING_STD = np.radians(0.3)
# Modules that contradict each other by more than this share of their ways were slipping.
MOST_CONTRADICTION = 0.03
# No wheel is measured wrongly by this factor, even where a gear was left out: the truth is.
MOST_SCALE = 20.0
# A line whose track is longer by this factor is not straight.
STRAIGHT = 1.02
# A line tells how modules differ, not which of them is wrong. One that points further away from
# their mean than this [degrees] would have the right ones corrected for it.
FURTHEST_ASTRAY = 15.0


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
    true_tracks = poses[:, :1] + 1j * poses[:, 1:2] + _arms(kin, heading)
    measured, true = _ways(heading, windows, tracks, true_tracks)
    slips = slipping(measured, true)
    clean = ~slips.any(axis=1)
    fit = _fit(kin, measured[clean], true[clean], pushed)
    left_out = spans(recording.stamp, windows, slips)
    scale, scale_std = _gyro_scale(recording, windows, heading)
    return _calibration(fit, _known(recording), encoder_step)._replace(
        gyro_scale=scale, gyro_scale_std=scale_std, left_out=left_out,
        gyro_delay=gyro_delay(kin, recording, fit.factors, left_out))


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
    tracks, arms = rolled_tracks(recording, heading), _arms(kin, heading)
    windows = moving_windows(recording.stamp, tracks)
    factors = np.ones(kin.module_count, dtype=complex)
    # The modules' mean, stretched to the distance, stands for the truth. It depends on the
    # factors that come of it, but so little that three rounds are plenty.
    for _ in range(3):
        line = (tracks * factors - arms).mean(axis=1, keepdims=True)
        line *= distance / _straight_length(line, windows)
        measured, true = _ways(heading, windows, tracks, line + arms)
        fit = _fit(kin, measured, true, pushed, rounding=encoder_step)
        factors = fit.factors
    left_out = spans(recording.stamp, windows, slipping(measured, true))
    if left_out:
        raise ValueError(f'wheels slipped from {in_words(left_out)}: the line cannot be used')
    calibration = _relative(_calibration(fit, _known(recording), encoder_step),
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


def _ways(heading: NDArray[np.float64], windows: Windows, tracks: NDArray[np.complex128],
          true_tracks: NDArray[np.complex128]) -> tuple[
              NDArray[np.complex128], NDArray[np.complex128]]:
    """Return measured and true ways (k, n) over the windows, seen in the base frame."""
    start, end = windows
    to_base = np.exp(-0.5j * (heading[start] + heading[end]))[:, np.newaxis]
    measured, true = (to_base * (track[end] - track[start]) for track in (tracks, true_tracks))
    scale = np.linalg.norm(true) / np.linalg.norm(measured)
    if not 1.0 / MOST_SCALE < scale < MOST_SCALE:
        raise ValueError(f'by the ground truth the wheels rolled {scale:.2g} times as far as by '
                         'their encoders: is it in metres, are the joints in rad, and does it '
                         'move?')
    return measured, true


def _fit(kin: SwerveKinematics, measured: NDArray[np.complex128], true: NDArray[np.complex128],
         pushed: bool, rounding: float = 0.0) -> ModuleFit:
    """Return the ModuleFit of the ways, ValueError if the modules contradict each other."""
    fit = fit_modules(kin, measured, true, pushed, rounding)
    if fit.contradiction > MOST_CONTRADICTION:
        raise ValueError(
            f'the modules contradict each other by {100 * fit.contradiction:.0f} %: {CAUSES}')
    return fit


def _calibration(fit: ModuleFit, known: NDArray[np.bool_],
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


def _gyro_scale(recording: Recording, windows: Windows,
                heading: NDArray[np.float64]) -> tuple[float, float]:
    """Return the scale of the gyro and its deviation from the true headings; 1, infinite: none."""
    if recording.yaw is None:
        return 1.0, np.inf
    steps = wrap_angle(np.diff(recording.yaw))
    silent = np.isnan(steps)
    turn, silences = (np.concatenate(([0], np.cumsum(series)))
                      for series in (np.where(silent, 0.0, steps), silent))
    start, end = (edge[silences[windows[1]] == silences[windows[0]]] for edge in windows)
    true = heading[end] - heading[start]
    if len(true) < BLOCKS or np.abs(true).sum() < LEAST_TURN:
        return 1.0, np.inf
    # What the gyro tells is the turn divided by the scale, and the time times its bias.
    told = turn[end] - turn[start]
    jacobian = np.column_stack((true, recording.stamp[end] - recording.stamp[start]))
    solution = np.linalg.lstsq(jacobian, told, rcond=None)[0]
    if not solution[0]:
        return 1.0, np.inf
    residual = told - jacobian @ solution
    spread = covariance(jacobian.T @ jacobian, jacobian * residual[:, np.newaxis])
    return 1.0 / solution[0], np.sqrt(spread[0, 0]) / solution[0] ** 2


def _straight_length(line: NDArray[np.complex128], windows: Windows) -> float:
    """Return how far apart the ends of a track (t, 1) are [m]; ValueError if it is bent."""
    start, end = windows
    length = float(abs(line[-1, 0] - line[0, 0]))
    way = np.abs(line[end] - line[start]).sum()
    if way > STRAIGHT * length:
        raise ValueError(f'the line is not straight: the base rolled {way:.3f} m '
                         f'and ended {length:.3f} m away')
    return length


def _arms(kin: SwerveKinematics, heading: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return where the modules are from base_link, in the world frame, complex (t, n) [m]."""
    arms: NDArray[np.complex128] = (
        np.exp(1j * heading)[:, np.newaxis] * (kin.module_positions @ (1.0, 1j)))
    return arms


def _known(recording: Recording) -> NDArray[np.bool_]:
    """Return which modules (n,) rolled far enough to be known."""
    way = np.abs(np.diff(recording.distances, axis=0)).sum(axis=0)
    if way.max() < LEAST_WAY:
        raise ValueError(f'the drive is too short: no wheel rolled {LEAST_WAY:g} m or more')
    known: NDArray[np.bool_] = way >= LEAST_WAY
    return known
