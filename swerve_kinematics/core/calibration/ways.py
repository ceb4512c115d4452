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
What modules measured and how far they really went, and the factors that lie between.

Vectors are complex numbers here, x + iy.
"""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.calibration.module_fit import fit_modules, ModuleFit
from swerve_kinematics.core.calibration.recording import Recording, Windows
from swerve_kinematics.core.calibration.slip import CAUSES
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

# What a module must roll for its values to be known [m].
LEAST_WAY = 1.0
# Modules that contradict each other by more than this share of their ways were slipping.
MOST_CONTRADICTION = 0.03
# No wheel is measured wrongly by this factor, even where a gear was left out: the truth is.
MOST_SCALE = 20.0


def arms_of(kin: SwerveKinematics, heading: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return where the modules are from base_link, in the world frame, complex (t, n) [m]."""
    arms: NDArray[np.complex128] = (
        np.exp(1j * heading)[:, np.newaxis] * (kin.module_positions @ (1.0, 1j)))
    return arms


def ways_over(windows: Windows, heading: NDArray[np.float64], tracks: NDArray[np.complex128],
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


def fit_ways(kin: SwerveKinematics, measured: NDArray[np.complex128],
             true: NDArray[np.complex128], pushed: bool, rounding: float = 0.0) -> ModuleFit:
    """Return the ModuleFit of the ways, ValueError if the modules contradict each other."""
    fit = fit_modules(kin, measured, true, pushed, rounding)
    if fit.contradiction > MOST_CONTRADICTION:
        raise ValueError(
            f'the modules contradict each other by {100 * fit.contradiction:.0f} %: {CAUSES}')
    return fit


def known_modules(recording: Recording) -> NDArray[np.bool_]:
    """Return which modules (n,) rolled far enough to be known."""
    way = np.abs(np.diff(recording.distances, axis=0)).sum(axis=0)
    if way.max() < LEAST_WAY:
        raise ValueError(f'the drive is too short: no wheel rolled {LEAST_WAY:g} m or more')
    known: NDArray[np.bool_] = way >= LEAST_WAY
    return known
