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

"""Draw the path of a command and of a measurement through the subpackages."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch
from pictures import save

PICTURE = Path(__file__).with_name('architecture.png')
# Subpackage, height of its lane, and its colours.
LANES = (('ros', 2.0, '#e3eefb', '#2f6fb0'), ('configuration', 1.0, '#fbf1d5', '#b08422'),
         ('core', 0.0, '#e2f3e7', '#2f8a55'))
HEIGHTS = {room: height for room, height, _, _ in LANES}
EDGES = {room: edge for room, _, _, edge in LANES}
# Subpackage, files, and what happens there.
COMMAND = (
    ('ros', 'command_input', 'refuse what is\nold or not finite'),
    ('ros', 'drive, pacing', 'at each command\nand control_rate'),
    ('core', 'target', 'from the field\nto the base'),
    ('core', 'limits, pace', 'speed limits,\none factor'),
    ('core', 'ramp, grip, jerk', 'acceleration\nlimits'),
    ('core', 'module_group,\nsteering', 'kinematics, flips,\nend stops'),
    ('core', 'setpoints', 'as far as every\nmodule can go'),
    ('configuration', 'joints', 'directions, ratios,\noffsets, coupling'),
    ('ros', 'messages', 'fill and publish\nthe messages'),
)
MEASUREMENT = (
    ('ros', 'joint_names', 'find the joints\nin the message'),
    ('ros', 'joint_sources,\ntimeline', 'one publisher,\nstamps in order'),
    ('ros', 'feedback,\ngyro_feedback', 'complete sets of\nmodules and gyro'),
    ('configuration', 'joints', 'the same, from\njoints to modules'),
    ('core', 'yaw, gyro', 'which part of the\ngyro to believe'),
    ('core', 'chord, solver', 'one step, without\nwheels that slip'),
    ('core', 'inertial', 'wheels against\naccelerometer'),
    ('core', 'twist, pose_\ncovariance', 'pose, twist and\ntheir errors'),
    ('ros', 'messages', 'fill and publish\nthe messages'),
)
WIDTH, HALF = 0.87, 0.37


def draw_lanes(axes: Axes, count: int) -> None:
    """Draw the subpackages as lanes, each above what it imports."""
    for room, height, color, edge in LANES:
        axes.axhspan(height - 0.46, height + 0.46, color=color, zorder=0)
        axes.text(-1.25, height, room, color=edge, weight='bold', fontsize=10, va='center')
    axes.set(xlim=(-1.3, count - 0.45), ylim=(-0.5, 2.5), xticks=(), yticks=())
    axes.spines[:].set_visible(False)


def draw_step(axes: Axes, column: int, step: tuple[str, str, str]) -> None:
    """Draw one step as a box."""
    room, files, what = step
    height = HEIGHTS[room]
    axes.add_patch(FancyBboxPatch(
        (column - 0.5 * WIDTH, height - HALF), WIDTH, 2.0 * HALF, facecolor='white',
        edgecolor=EDGES[room], linewidth=1.4, boxstyle='round,pad=0,rounding_size=0.06',
        zorder=2))
    axes.text(column, height + 0.86 * HALF, files, fontsize=8, weight='bold', ha='center',
              va='top', zorder=3)
    axes.text(column, height - 0.84 * HALF, what, fontsize=8, ha='center', va='bottom',
              color='#374151', zorder=3)


def arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float],
          bend: str = 'arc3') -> None:
    """Draw an arrow from one step to the next."""
    axes.annotate('', end, start, zorder=4, arrowprops={
        'arrowstyle': '-|>', 'color': '#111827', 'linewidth': 1.4, 'mutation_scale': 11,
        'shrinkA': 0.0, 'shrinkB': 0.0, 'connectionstyle': bend})


def draw_path(axes: Axes, title: str, steps: tuple[tuple[str, str, str], ...], source: str,
              result: str) -> None:
    """Draw the steps of a path, from left to right."""
    draw_lanes(axes, len(steps))
    for column, step in enumerate(steps):
        draw_step(axes, column, step)
    for column, (first, second) in enumerate(zip(steps, steps[1:])):
        start, end = HEIGHTS[first[0]], HEIGHTS[second[0]]
        if start == end:
            arrow(axes, (column + 0.5 * WIDTH, start), (column + 1 - 0.5 * WIDTH, end))
        elif start > end:  # down, then in from above
            arrow(axes, (column + 0.5 * WIDTH, start), (column + 1, end + HALF),
                  'angle,angleA=0,angleB=90,rad=6')
        else:
            arrow(axes, (column + 0.5 * WIDTH, start), (column + 1, end - HALF),
                  'angle,angleA=0,angleB=90,rad=6')
    last = len(steps) - 1
    for text, x, y, end in ((source, 0.0, 2.62, 2.0 + HALF), (result, last, 2.0 + HALF, 2.62)):
        arrow(axes, (x, y), (x, end))
        axes.text(x, 2.66, text, ha='center', va='bottom', fontsize=9, family='monospace')
    axes.set_ylim(-0.5, 2.95)
    axes.set_title(title, fontsize=11, weight='bold', loc='center')


def main(path: Path = PICTURE) -> None:
    """Draw both paths."""
    figure = Figure(figsize=(13.6, 7.2), layout='constrained')
    command, measurement = figure.subplots(2, 1)
    draw_path(command, 'The path of a command', COMMAND, 'cmd_vel', 'commands')
    draw_path(measurement, 'The path of a measurement', MEASUREMENT, 'joint_states, imu',
              'odom, /tf')
    save(figure, path)


if __name__ == '__main__':
    main()
