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

"""What stands in the picture besides the base: centres, scales, the field's axis and the key."""

from typing import Any, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swerve_kinematics.tools.visualize.motion import Base, Motion

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

COMMANDED, REVERSED, TRANSLATION, ROTATION = '#16a34a', '#dc2626', '#3b82f6', '#d2b48c'
REVERSED_FILL, UNLIMITED, GREY, CENTER, INSTANT = (
    '#fee2e2', '#a7d8b8', '#8a94a3', '#c026d3', '#111827')
# Of a round number. Half for those just below a power of ten, whose logarithm is a whole number.
DIGITS = 0.5, 1.0, 2.0, 5.0
# From the middle to the edge of the picture, as a share of the base's radius, and how much of
# that is for what lies farther off.
REACH, RIM = 2.5, 0.95
# Keyword arguments of matplotlib, of many types.
CENTERS: dict[str, dict[str, Any]] = {
    'centre of rotation, commanded': {
        'marker': 'P', 'color': CENTER, 'markersize': 10, 'markeredgecolor': 'white'},
    'instantaneous centre of rotation': {
        'marker': 'o', 'color': INSTANT, 'markersize': 15, 'markerfacecolor': 'none',
        'markeredgewidth': 1.6}}


def plain(value: float, digits: int) -> str:
    """Return a number with so many digits behind the point, and never -0."""
    text = f'{value:.{digits}f}'
    return text.lstrip('-') if float(text) == 0.0 else text


def draw_centers(axes: 'Axes', base: Base, motion: Motion) -> None:
    """Draw the point commanded as the centre of rotation, and the one that stands still."""
    for (label, style), point in zip(CENTERS.items(), (
            motion.command.center, motion.instantaneous_center)):
        if point is not None:
            _draw_point(axes, base, point, label, style)


def _draw_point(axes: 'Axes', base: Base, point: ArrayLike, label: str,
                style: dict[str, Any]) -> None:
    """Draw a point; one that is out of the picture at its rim, with its distance."""
    x, y = within(base, point)
    axes.plot(x, y, **style, linestyle='none', zorder=6, label=label)
    if not np.array_equal((x, y), point):
        axes.annotate(f'{np.hypot(*np.asarray(point)):.1f} m', (x, y), (0, -16),
                      textcoords='offset points', color=style['color'], ha='center', va='center',
                      fontsize=8, zorder=6)


def within(base: Base, point: ArrayLike) -> NDArray[np.float64]:
    """Return a point [m], or where the line to it from the middle leaves the picture."""
    offset = np.asarray(point) - base.middle
    farthest, rim = np.abs(offset).max(), RIM * REACH * base.radius
    return np.asarray(point) if farthest <= rim else base.middle + offset * rim / farthest


def draw_scale(axes: 'Axes', base: Base, arrow_time: float) -> None:
    """Draw how long an arrow of a round speed is, at the lower left."""
    speed = round_speed(0.9 * base.radius / arrow_time)
    x, y = base.middle - 0.92 * REACH * base.radius
    axes.plot((x, x + arrow_time * speed), (y, y), '|-', color=GREY, linewidth=1.5, zorder=6,
              label='scale')
    axes.annotate(f'{speed:g} m/s', (x, y), (0, 5), textcoords='offset points', color=GREY,
                  fontsize=9, zorder=6)


def round_speed(most: float) -> float:
    """Return the largest of ..., 0.5, 1, 2, 5, 10, ... that is not above a speed [m/s]."""
    decade = 10.0 ** np.floor(np.log10(most))
    return float(decade * max(digit for digit in DIGITS if digit * decade <= most))


def draw_field(axes: 'Axes', base: Base, heading: float) -> None:
    """Draw where the x axis of the field points, at the lower right; nothing where it is ours."""
    if heading:
        length = 0.35 * base.radius
        x, y = base.middle + 0.8 * REACH * base.radius * np.array((1.0, -1.0))
        end = (x + length * np.cos(heading), y - length * np.sin(heading))
        axes.annotate('', end, (x, y), arrowprops={'arrowstyle': '->', 'color': GREY})
        axes.annotate('field x', (x, y), (0, -14), textcoords='offset points', color=GREY,
                      ha='center', fontsize=8)


def key() -> list['Artist']:
    """Return what explains every mark: the same key, whatever is drawn."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    return [
        Patch(color=TRANSLATION, label='translation'), Patch(color=ROTATION, label='rotation'),
        Patch(color=COMMANDED, label='commanded: their sum'),
        Patch(facecolor=REVERSED_FILL, edgecolor=REVERSED, linestyle='--',
              label='commanded, drive reversed'),
        Patch(color=UNLIMITED, label='without the speed limit'),
        *(Line2D([], [], linestyle='none', label=label, **{**style, 'markersize': 9})
          for label, style in CENTERS.items())]
