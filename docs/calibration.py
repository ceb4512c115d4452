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

"""Draw what a calibration finds in a drive, and what it does for the odometry."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from pictures import save

from swerve_kinematics import se2_compose, se2_exp, SwerveOdometry
from swerve_kinematics.core.calibration.calibration import calibrate_by_poses, Calibration
from swerve_kinematics.core.calibration.recording import Recording
from swerve_kinematics.tools.visualize.main import FOUR_MODULES

PICTURE = Path(__file__).with_name('calibration.png')
TRUTH, BEFORE, AFTER = '#c3c9d2', '#c8324a', '#1f6f9c'
PERIOD, DURATION = 0.02, 40.0
START = np.array((0.0, 0.0, -0.5 * np.pi))
# What the description of the base has wrong, by module: factors of the radii, offsets [rad].
RADIUS_SCALE = np.array((1.012, 0.985, 1.008, 0.990))
OFFSET = np.radians((0.9, -0.7, 0.5, 1.1))
RESOLUTION = 2.0 * np.pi / 4096.0


def recorded_drive() -> tuple[Recording, np.ndarray]:
    """Return what the encoders say of a mixed drive, and the true poses, measured to 2 mm."""
    kinematics, noise = FOUR_MODULES.kinematics, np.random.default_rng(1)
    stamp = np.arange(0.0, DURATION, PERIOD)
    twists = np.column_stack((0.5 + 0.3 * np.sin(0.5 * stamp), 0.3 * np.cos(0.4 * stamp),
                              0.35 + 0.5 * np.sin(0.3 * stamp)))
    poses = np.tile(START, (len(stamp), 1))
    for step in range(1, len(stamp)):
        middle = 0.5 * (twists[step - 1] + twists[step])
        poses[step] = se2_compose(poses[step - 1], se2_exp(middle * PERIOD))
    distances = np.vstack((np.zeros(4), np.cumsum(kinematics.inverse(
        0.5 * (twists[1:] + twists[:-1]) * PERIOD).speed, axis=0)))
    angles = np.floor((kinematics.inverse(twists).angle + OFFSET) / RESOLUTION) * RESOLUTION
    measured = poses + noise.normal(0.0, 0.002, poses.shape)
    return Recording(stamp, distances / RADIUS_SCALE, angles), measured


def dead_reckoned(recording: Recording, scale: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """Return the poses (k, 3) that the wheels alone tell, with some corrections."""
    odometry, poses = SwerveOdometry(FOUR_MODULES.kinematics, START), []
    for stamp, distances, angles in zip(*recording[:3]):
        odometry.update(stamp, distances * scale, angles - offset)
        poses.append(odometry.pose)
    return np.array(poses)


def draw_values(axes: Axes, label: str, true: np.ndarray, found: np.ndarray,
                std: np.ndarray) -> None:
    """Draw by how much each module's value is wrong, before and after."""
    index = np.arange(len(true))
    axes.axhline(0.0, color='#8a94a3', linewidth=1.0)
    axes.plot(index - 0.12, -true, 'o', color=BEFORE)
    axes.errorbar(index + 0.12, found - true, 2.0 * std, fmt='o', color=AFTER, capsize=3)
    axes.set(ylabel=label, xticks=index, xlim=(-0.5, len(true) - 0.5))
    axes.set_xticklabels([name.replace('_', '\n') for name in FOUR_MODULES.names])
    axes.grid(alpha=0.3, axis='y')


def draw_paths(axes: Axes, recording: Recording, poses: np.ndarray, result: Calibration) -> None:
    """Draw the drive by the wheels alone, before and after."""
    axes.plot(*poses[:, :2].T, color=TRUTH, linewidth=7.0, label='ground truth')
    for label, color, path in (
            ('before', BEFORE, dead_reckoned(recording, np.ones(4), np.zeros(4))),
            ('after', AFTER, dead_reckoned(recording, result.radius_scale,
                                           result.steering_offset))):
        error = 1e3 * np.hypot(*(path[-1] - poses[-1])[:2])
        axes.plot(*path[:, :2].T, color=color, linewidth=1.8,
                  label=f'wheels alone, {label}: {error:.0f} mm off at the end')
        axes.plot(*path[-1, :2], 'o', color=color, markersize=6)
    axes.set(xlabel='x [m]', ylabel='y [m]')
    axes.set_aspect('equal', adjustable='datalim')
    axes.margins(0.05)
    axes.grid(alpha=0.3)


def main(path: Path = PICTURE) -> None:
    """Drive, calibrate and draw."""
    recording, poses = recorded_drive()
    result = calibrate_by_poses(FOUR_MODULES.kinematics, recording, poses, pushed=True)
    figure = Figure(figsize=(10.0, 6.4), layout='constrained')
    mosaic = figure.subplot_mosaic([['paths', 'paths'], ['radii', 'offsets']],
                                   height_ratios=(2.0, 1.0))
    draw_paths(mosaic['paths'], recording, poses, result)
    draw_values(mosaic['radii'], 'radius wrong by [%]', 100.0 * (RADIUS_SCALE - 1.0),
                100.0 * (result.radius_scale - 1.0), 100.0 * result.radius_scale_std)
    draw_values(mosaic['offsets'], 'offset wrong by [deg]', np.degrees(OFFSET),
                np.degrees(result.steering_offset), np.degrees(result.steering_offset_std))
    figure.legend(*mosaic['paths'].get_legend_handles_labels(), loc='outside upper center',
                  ncols=3, frameon=False)
    save(figure, path)


if __name__ == '__main__':
    main()
