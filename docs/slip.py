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

"""Draw what an accelerometer is worth to the odometry where all wheels slip at once."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from pictures import save

from swerve_kinematics import se2_compose, se2_exp, SwerveOdometry
from swerve_kinematics.tools.visualize.main import FOUR_MODULES

PICTURE = Path(__file__).with_name('slip.png')
TRUTH, WITHOUT, WITH, SLIP = '#c3c9d2', '#c8324a', '#1f6f9c', '#fbe3c8'
PERIOD, DURATION = 0.01, 7.0
# When all wheels slip [s], and how many times as fast as the ground they then turn.
SLIPS = ((1.0, 1.5, 1.9), (4.4, 5.0, 0.2))
# Of an ordinary accelerometer [m/s^2].
BIAS, NOISE = np.array((0.1, -0.06)), 0.05


def twist_at(time: float) -> np.ndarray:
    """Return the twist of the base: a hard start, a bend, and hard braking."""
    speed = np.interp(time, (0.9, 1.6, 4.3, 5.1), (0.0, 2.4, 2.4, 0.0))
    return np.array((speed, 0.0, 0.45 * speed * np.sin(1.2 * time)))


def drive(has_accelerometer: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the true and the estimated poses (k, 3)."""
    odometry = SwerveOdometry(FOUR_MODULES.kinematics)
    truth, distances, noise = np.zeros(3), np.zeros(4), np.random.default_rng(1)
    true_poses, poses = [], []
    for step in range(1, round(DURATION / PERIOD) + 1):
        time = step * PERIOD
        twist = twist_at(time - 0.5 * PERIOD)
        rate = (twist_at(time) - twist_at(time - PERIOD)) / PERIOD
        force = (rate[:2] + twist[2] * np.array((-twist[1], twist[0])) + BIAS
                 + noise.normal(0.0, NOISE, 2))
        ratio = next((ratio for start, end, ratio in SLIPS if start < time <= end), 1.0)
        distances = distances + ratio * FOUR_MODULES.kinematics.inverse(twist * PERIOD).speed
        truth = se2_compose(truth, se2_exp(twist * PERIOD))
        imu = {'specific_force': tuple(force), 'tilt_rates': (0.0, 0.0)}
        odometry.update(
            time, distances, FOUR_MODULES.kinematics.inverse(twist_at(time)).angle,
            yaw_rate=float(twist_at(time)[2]), **(imu if has_accelerometer else {}))
        true_poses.append(truth)
        poses.append(odometry.pose)
    return np.array(true_poses), np.array(poses)


def draw_paths(axes: Axes, truth: np.ndarray, estimates: dict[str, tuple]) -> None:
    """Draw all paths from above."""
    axes.plot(*truth[:, :2].T, color=TRUTH, linewidth=7.0, label='ground truth')
    for label, (color, poses) in estimates.items():
        axes.plot(*poses[:, :2].T, color=color, linewidth=1.8, label=label)
        axes.plot(*poses[-1, :2], 'o', color=color, markersize=6)
    axes.set(xlabel='x [m]', ylabel='y [m]')
    axes.set_aspect('equal')
    axes.margins(0.06)


def draw_errors(axes: Axes, truth: np.ndarray, estimates: dict[str, tuple]) -> None:
    """Draw how far off each estimate is over time, and when the wheels slip."""
    time = PERIOD * np.arange(1, len(truth) + 1)
    for (start, end, ratio), what in zip(SLIPS, ('wheels spin', 'wheels lock')):
        axes.axvspan(start, end, color=SLIP)
        axes.text(0.5 * (start + end), 0.97, what, transform=axes.get_xaxis_transform(),
                  ha='center', va='top', fontsize=9)
    for color, poses in estimates.values():
        error = 1e3 * np.hypot(*(poses - truth)[:, :2].T)
        axes.plot(time, error, color=color, linewidth=1.8)
        axes.annotate(f'{error[-1]:.0f} mm', (DURATION, error[-1]), (-4, 4), color=color,
                      textcoords='offset points', ha='right')
    axes.set(xlabel='time [s]', ylabel='error of the position [mm]', xlim=(0.0, DURATION),
             ylim=(0.0, 620.0))


def main(path: Path = PICTURE) -> None:
    """Draw the drive with and without an accelerometer."""
    truth, without = drive(False)
    estimates = {'wheels and gyro': (WITHOUT, without),
                 'with accelerometer': (WITH, drive(True)[1])}
    figure = Figure(figsize=(10.0, 4.2), layout='constrained')
    paths, errors = figure.subplots(1, 2, width_ratios=(1.0, 1.0))
    draw_paths(paths, truth, estimates)
    draw_errors(errors, truth, estimates)
    for axes in (paths, errors):
        axes.grid(alpha=0.3)
    figure.legend(*paths.get_legend_handles_labels(), loc='outside upper center', ncols=3,
                  frameon=False)
    save(figure, path)


if __name__ == '__main__':
    main()
