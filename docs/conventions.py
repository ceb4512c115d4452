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

"""Draw the conventions: axes, signs, the order of the modules, and the frames."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc
import numpy as np
from numpy.typing import ArrayLike
from pictures import save

from swerve_kinematics import se2_compose
from swerve_kinematics.core.drawing import outline
from swerve_kinematics.tools.visualize.main import FOUR_MODULES
from swerve_kinematics.tools.visualize.picture import draw_base

PICTURE = Path(__file__).with_name('conventions.png')
# The axes in the colours of RViz, what a module does, and measures.
X, Y, MODULE, MEASURE = '#c23b22', '#2e8b57', '#1f6f9c', '#6b7280'
STEERING = np.radians(35.0)
POSE = np.array((0.95, 0.62, np.radians(30.0)))


def arrow(axes: Axes, start: ArrayLike, end: ArrayLike, color: str, width: float = 2.2,
          style: str = '-|>') -> None:
    """Draw an arrow between two points."""
    axes.annotate('', end, start, zorder=5, arrowprops={
        'arrowstyle': style, 'color': color, 'linewidth': width, 'mutation_scale': 14,
        'shrinkA': 0.0, 'shrinkB': 0.0})


def turn(axes: Axes, center: ArrayLike, radius: float, start: float, end: float,
         color: str) -> None:
    """Draw an arc from one angle to another [rad], with an arrow at its end."""
    axes.add_patch(Arc(center, 2.0 * radius, 2.0 * radius, theta1=np.degrees(start),
                       theta2=np.degrees(end), color=color, linewidth=2.0, zorder=5))
    before, tip = (np.add(center, radius * np.array((np.cos(angle), np.sin(angle))))
                   for angle in (end - 0.15, end))
    arrow(axes, before, tip, color, 2.0)


def draw_frame(axes: Axes, pose: ArrayLike, length: float) -> None:
    """Draw the axes of a frame."""
    origin = np.asarray(pose)[:2]
    for offset, color in (((length, 0.0, 0.0), X), ((0.0, length, 0.0), Y)):
        arrow(axes, origin, se2_compose(pose, offset)[:2], color)
    axes.plot(*origin, 'o', color='black', markersize=4, zorder=6)


def draw_module(axes: Axes, corner: np.ndarray) -> None:
    """Draw the signs of a module's joints, and where it is."""
    x, y = corner
    along = np.array((np.cos(STEERING), np.sin(STEERING)))
    arrow(axes, corner, corner + 0.26 * along, MODULE, 2.6)
    axes.text(*(corner + 0.27 * along), 'drive speed > 0:\nrolls this way', color=MODULE,
              va='bottom', ha='center')
    axes.plot((x, x + 0.22), (y, y), '--', color=MODULE, linewidth=1.2)
    axes.text(x + 0.23, y, 'angle 0: along +x', color=MODULE, va='center')
    turn(axes, corner, 0.15, 0.0, STEERING, MODULE)
    axes.text(x + 0.165, y + 0.045, 'steering angle > 0', color=MODULE, va='center')
    arrow(axes, (0.0, -0.15), (x, -0.15), MEASURE, 1.2, '<|-|>')
    axes.plot((0.0, 0.0), (0.0, -0.17), ':', color=MEASURE)
    axes.text(0.5 * x, -0.16, f'module_x {x} m', color=MEASURE, ha='center', va='top')
    arrow(axes, (0.43, 0.0), (0.43, y), MEASURE, 1.2, '<|-|>')
    axes.plot((0.17, 0.45), (0.0, 0.0), ':', color=MEASURE)
    axes.text(0.44, 0.5 * y, f'module_y {y} m', color=MEASURE, va='center')


def draw_modules(axes: Axes) -> None:
    """Draw the base from above, with every sign."""
    base = FOUR_MODULES
    draw_base(axes, base, (STEERING, 0.0, 0.0, 0.0))
    draw_frame(axes, np.zeros(3), 0.18)
    axes.text(0.10, -0.015, 'x: forward', color=X, va='top', ha='center')
    axes.text(0.0, 0.19, 'y: left', color=Y, ha='center')
    turn(axes, (0.0, 0.0), 0.09, 0.15, 1.45, 'black')
    axes.text(0.085, 0.06, 'yaw and\nomega > 0')
    for index, (name, (x, y)) in enumerate(zip(base.names, base.positions)):
        axes.text(x - (0.10 if index == 0 else 0.0), 1.3 * y, f'{index}: {name}', weight='bold',
                  va='center', ha='right' if index == 0 else 'center')
    draw_module(axes, base.positions[0])
    axes.set_title('The base from above: signs, and the order of the modules', pad=10)
    axes.set(xlim=(-0.45, 0.81), ylim=(-0.42, 0.56))


def draw_frames(axes: Axes) -> None:
    """Draw the pose of the base in the frame of the odometry."""
    x, y, yaw = POSE
    corners = np.column_stack((outline(FOUR_MODULES.positions), np.zeros(4)))
    axes.fill(*se2_compose(POSE, corners)[:, :2].T, facecolor='#f3f4f6', edgecolor='#8a94a3')
    draw_frame(axes, np.zeros(3), 0.3)
    draw_frame(axes, POSE, 0.3)
    for point, label, color, ha, va in (
            ((-0.03, -0.03), 'odom: where the\nodometry started', 'black', 'left', 'top'),
            ((0.32, 0.0), 'x', X, 'left', 'center'), ((0.0, 0.32), 'y', Y, 'center', 'bottom'),
            ((x, y - 0.04), 'base_link', 'black', 'left', 'top'),
            (se2_compose(POSE, (0.32, 0.0, 0.0))[:2], 'linear.x of cmd_vel', X, 'left', 'center'),
            (se2_compose(POSE, (0.0, 0.32, 0.0))[:2], 'linear.y', Y, 'right', 'bottom'),
            ((x + 0.2, y + 0.04), 'yaw', 'black', 'left', 'center')):
        axes.text(*point, label, color=color, ha=ha, va=va)
    axes.plot((x, x + 0.3), (y, y), '--', color='black', linewidth=1.2)
    turn(axes, (x, y), 0.18, 0.0, yaw, 'black')
    arrow(axes, (0.0, 0.0), (x, y), MEASURE, 1.2, '-|>')
    axes.text(0.5 * x, 0.5 * y + 0.04, 'pose in odom: x, y', color=MEASURE, ha='center',
              va='bottom', rotation=np.degrees(np.arctan2(y, x)), rotation_mode='anchor')
    axes.set_title('The frames: the odometry tells where base_link is in odom', pad=10)
    axes.set(xlim=(-0.15, 1.75), ylim=(-0.28, 1.2))


def main(path: Path = PICTURE) -> None:
    """Draw the picture."""
    figure = Figure(figsize=(12.0, 5.0), layout='compressed')
    modules, frames = figure.subplots(1, 2)
    draw_modules(modules)
    draw_frames(frames)
    for axes in (modules, frames):
        axes.set_aspect('equal')
        axes.set(xticks=(), yticks=())
        axes.spines[:].set_visible(False)
    save(figure, path)


if __name__ == '__main__':
    main()
