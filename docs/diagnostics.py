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

"""Draw how a finding comes and goes on /diagnostics while a base drives."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np
from pictures import save

from swerve_kinematics.ros.stamps import nanoseconds
from swerve_kinematics.ros.watch import Watch
from swerve_kinematics.tools.visualize.main import FOUR_MODULES

PICTURE = Path(__file__).with_name('diagnostics.png')
COMMANDED, MEASURED = '#16a34a', '#c8324a'
LEVELS = {'OK': '#cdebd5', 'WARN': '#fde7b0', 'ERROR': '#f6c6c6'}
PERIOD, DURATION = 0.02, 32.0
# The module whose drive stands still, and from when to when [s].
MODULE, FAULT = 2, (8.0, 18.0)


def drive() -> tuple[np.ndarray, np.ndarray, np.ndarray, list[list[tuple[bool, str]]]]:
    """Return times, commanded and measured speeds of the module, and findings at each time."""
    kinematics = FOUR_MODULES.kinematics
    watch = Watch(FOUR_MODULES.names, FOUR_MODULES.positions, expects_gyro=True)
    distances, yaw, findings = np.zeros(4), 0.0, []
    time = np.arange(0.0, DURATION, PERIOD)
    states = kinematics.inverse(np.column_stack((
        0.4 + 0.1 * np.sin(0.6 * time), 0.25 * np.cos(0.5 * time), 0.4 * np.sin(0.9 * time))))
    measured = states.speed.copy()
    measured[(time >= FAULT[0]) & (time < FAULT[1]), MODULE] = 0.0
    for step, now in enumerate(time):
        distances = distances + PERIOD * measured[step]
        omega = 0.4 * np.sin(0.9 * now)
        yaw += PERIOD * omega
        watch.add(nanoseconds(now), distances.tolist(), states.angle[step].tolist(), yaw, omega)
        watch.commanded(states.speed[step].tolist(), states.angle[step].tolist())
        findings.append(watch.findings())
    return time, states.speed[:, MODULE], measured[:, MODULE], findings


def draw_levels(axes: Axes, time: np.ndarray, findings: list[list[tuple[bool, str]]]) -> None:
    """Draw the level over time, with the words in the middle of each."""
    levels = [('ERROR' if any(grave for grave, _ in found) else 'WARN') if found else 'OK'
              for found in findings]
    edges = [0, *(i for i in range(1, len(levels)) if levels[i] != levels[i - 1]), len(levels) - 1]
    for start, end in zip(edges, edges[1:]):
        axes.axvspan(time[start], time[end], color=LEVELS[levels[start]])
        axes.text(0.5 * (time[start] + time[end]), 0.5, levels[start], weight='bold',
                  ha='center', va='center')
    message = findings[np.searchsorted(time, FAULT[1]) - 1][0][1]
    axes.set(yticks=(), ylim=(0.0, 1.0), xlabel='time [s]')
    axes.set_title(message, fontsize=10)


def main(path: Path = PICTURE) -> None:
    """Draw the speeds of the module, and the level below."""
    time, commanded, measured, findings = drive()
    figure = Figure(figsize=(10.0, 3.6), layout='constrained')
    speeds, level = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 1.0))
    speeds.plot(time, commanded, color=COMMANDED, linewidth=4.0, alpha=0.4, label='commanded')
    speeds.plot(time, measured, color=MEASURED, linewidth=1.6, label='measured')
    speeds.set(ylabel=f'{FOUR_MODULES.names[MODULE]}\ndrive [m/s]', xlim=(0.0, DURATION))
    speeds.grid(alpha=0.3)
    figure.legend(*speeds.get_legend_handles_labels(), loc='outside upper center', ncols=2,
                  frameon=False)
    draw_levels(level, time, findings)
    save(figure, path)


if __name__ == '__main__':
    main()
