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

"""The picture of a swerve base and of what a twist makes of its modules."""

from typing import Any, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.core.drawing import outline, twist_parts, velocity_vectors
from swerve_kinematics.core.kinematics.modules import ModuleStates
from swerve_kinematics.tools.visualize.marks import (
    COMMANDED, draw_centers, draw_field, draw_scale, GREY, plain, REACH, REVERSED, REVERSED_FILL,
    ROTATION, TRANSLATION, UNLIMITED)
from swerve_kinematics.tools.visualize.motion import Base, Motion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WHEEL = '#374151'
# Width of an arrow's shaft as a share of the picture's. The parts lie on their sum: where they
# coincide, it shows on both sides of them.
THICK, THIN = 0.009, 0.0035
# Shares of the base's radius: sides of a wheel, the arrow of the fastest module, and from the
# middle to the labels, which it does not reach.
WHEEL_LENGTH, WHEEL_WIDTH, ARROW, LABEL = 0.28, 0.10, 0.8, 2.05
# A slower module [m/s] has no arrow.
MIN_SPEED = 1e-3
# Below this share of the commanded speed the title says so.
SLOWED = 0.9995


def draw(axes: 'Axes', base: Base, motion: Motion, arrow_time: float) -> None:
    """
    Draw a base with the vectors of its modules.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Cleared first.
    base : Base
        Layout and names of the modules.
    motion : Motion
        What they do.
    arrow_time : float
        An arrow is as long as the way [s] its module goes in this time.

    """
    axes.clear()
    states, center = motion.states, motion.command.center
    draw_base(axes, base, states.angle)
    translation, rotation = twist_parts(base.positions, motion.twist, center)
    commanded = velocity_vectors(states)
    _draw_parallelograms(axes, base.positions, arrow_time * translation, arrow_time * commanded)
    if motion.share < SLOWED:
        _draw_arrows(axes, 'without the speed limit', base.positions,
                     arrow_time / motion.share * commanded, arrow_time * MIN_SPEED,
                     {'color': UNLIMITED, 'width': THIN, 'zorder': 2})
    is_reversed = states.speed < 0.0
    for label, chosen, vectors, style in (
            ('commanded', ~is_reversed, commanded,
             {'color': COMMANDED, 'width': THICK, 'zorder': 3}),
            ('commanded, drive reversed', is_reversed, commanded,
             {'facecolor': REVERSED_FILL, 'edgecolor': REVERSED, 'width': THICK,
              'linewidth': 1.5, 'linestyle': (0, (3.0, 1.5)), 'zorder': 3}),
            ('translation', slice(None), translation,
             {'color': TRANSLATION, 'width': THIN, 'zorder': 4}),
            ('rotation', slice(None), rotation,
             {'color': ROTATION, 'width': THIN, 'zorder': 4})):
        _draw_arrows(axes, label, base.positions[chosen], arrow_time * vectors[chosen],
                     arrow_time * MIN_SPEED, style)
    _label_modules(axes, base, states)
    draw_centers(axes, base, motion)
    draw_scale(axes, base, arrow_time)
    draw_field(axes, base, motion.command.heading)
    _frame(axes, base, motion)


def draw_base(axes: 'Axes', base: Base, angles: ArrayLike) -> None:
    """
    Draw the outline, the wheels and the axes of base_link.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Gets the drawing, in metres.
    base : Base
        Layout of the modules.
    angles : array_like (n,)
        Which way the wheels point [rad].

    """
    axes.fill(*outline(base.positions).T, facecolor='#f3f4f6', edgecolor=GREY, linewidth=1.2,
              zorder=0)
    half_length, half_width = 0.5 * WHEEL_LENGTH * base.radius, 0.5 * WHEEL_WIDTH * base.radius
    corners = np.array([(1, 1), (1, -1), (-1, -1), (-1, 1)]) * (half_length, half_width)
    for position, angle in zip(base.positions, np.asarray(angles)):
        along = np.array((np.cos(angle), np.sin(angle)))
        turned = corners @ np.stack((along, (-along[1], along[0])))
        axes.fill(*(position + turned).T, color=WHEEL, zorder=2)
    nose = 0.15 * base.radius
    axes.plot([0.0, nose, np.nan, 0.0, 0.0], [0.0, 0.0, np.nan, 0.0, nose], color=GREY,
              linewidth=1.5, zorder=1)
    axes.annotate('base_link', (0.0, 0.0), (-4, -4), textcoords='offset points', color=GREY,
                  ha='right', va='top', fontsize=8)


def _draw_parallelograms(axes: 'Axes', positions: NDArray[np.float64],
                         translation: NDArray[np.float64],
                         commanded: NDArray[np.float64]) -> None:
    """Draw that the two parts add up."""
    for position, part, whole in zip(positions, translation, commanded):
        corners = position + np.stack((part, whole, whole - part))
        axes.plot(*corners.T, ':', color=GREY, linewidth=0.9, zorder=1)


def _draw_arrows(axes: 'Axes', label: str, positions: NDArray[np.float64],
                 vectors: NDArray[np.float64], shortest: float, style: dict[str, Any]) -> None:
    """Draw arrows [m] from the modules, none for those that are shorter than `shortest` [m]."""
    is_drawn = np.hypot(*vectors.T) > shortest
    if is_drawn.any():
        axes.quiver(*positions[is_drawn].T, *vectors[is_drawn].T, angles='xy',
                    scale_units='xy', scale=1.0, label=label, minlength=0.0, **style)


def _label_modules(axes: 'Axes', base: Base, states: ModuleStates) -> None:
    """Write name, speed and angle of each module, outside of the base."""
    for name, position, speed, angle in zip(base.names, base.positions, *states):
        x, y = base.middle + LABEL * (position - base.middle)
        axes.text(x, y,
                  f'{name}\n{plain(speed, 2)} m/s @ {plain(np.degrees(angle), 0)}°',
                  fontsize=9, ha='center', va='center', zorder=3)


def _frame(axes: 'Axes', base: Base, motion: Motion) -> None:
    """Set title, limits and grid."""
    vx, vy, omega = (plain(value, 2) for value in motion.twist)
    slowed = f'   slowed to {100.0 * motion.share:.0f} %' if motion.share < SLOWED else ''
    axes.set_title(f'vx {vx} m/s   vy {vy} m/s   omega {omega} rad/s{slowed}', pad=12)
    reach = REACH * base.radius
    for set_limits, middle in ((axes.set_xlim, base.middle[0]), (axes.set_ylim, base.middle[1])):
        set_limits(middle - reach, middle + reach)
    axes.set_aspect('equal')
    axes.grid(alpha=0.25)
    axes.set_axisbelow(True)
    axes.set_xlabel('x [m], forward')
    axes.set_ylabel('y [m], left')
