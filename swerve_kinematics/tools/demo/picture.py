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

"""The demo's picture: both paths with the modules along them, and the error over time."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.drawing import outline
from swerve_kinematics.core.geometry.se2 import se2_compose
from swerve_kinematics.tools.demo.drive_record import DriveRecord, position_errors, summary

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# How often the base is drawn, evenly spaced along the path.
BASE_COUNT = 14
ARROW_LENGTH = 0.3
# The mark of the front, as a share of the base's extent.
FRONT_SIZE = 0.2
TRUTH, ODOMETRY, BASE, ARROWS, FRONT = '#c3c9d2', '#c8324a', '#8a94a3', '#1f6f9c', '#e08a00'


def spaced_indices(positions: NDArray[np.float64], count: int) -> NDArray[np.intp]:
    """
    Return the samples nearest to the middles of `count` equally long pieces of a path.

    Parameters
    ----------
    positions : ndarray (k, 2)
        [m].
    count : int
        Number of pieces.

    Returns
    -------
    ndarray of int (count,)

    """
    lengths = np.hypot(*np.diff(positions, axis=0).T)
    travelled = np.concatenate(([0.0], np.cumsum(lengths)))
    middles: NDArray[np.float64] = travelled[-1] * (np.arange(count) + 0.5) / count
    return np.searchsorted(travelled, middles)


def module_poses(poses: NDArray[np.float64], module_positions: NDArray[np.float64],
                 directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """
    Return where the modules are and which way they roll.

    Parameters
    ----------
    poses : ndarray (k, 3)
        Of the base [m, m, rad].
    module_positions : ndarray (n, 2)
        From base_link [m].
    directions : ndarray (k, n)
        In the base frame [rad].

    Returns
    -------
    ndarray (k, n, 3)
        `[x, y, direction]` [m, m, rad] in the frame of `poses`.

    """
    positions = np.broadcast_to(module_positions, directions.shape + (2,))
    modules = np.concatenate((positions, directions[..., np.newaxis]), axis=-1)
    return se2_compose(poses[:, np.newaxis, :], modules)


def draw(record: DriveRecord, module_positions: NDArray[np.float64], path: Path) -> None:
    """
    Write the picture of a drive as a PNG.

    Parameters
    ----------
    record : DriveRecord
        The whole drive.
    module_positions : ndarray (n, 2)
        From base_link [m].
    path : pathlib.Path
        The file.

    Raises
    ------
    ImportError
        If matplotlib is not installed.

    """
    # The object interface: it needs no display and leaves matplotlib's global state alone.
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 7.6), layout='constrained')
    paths, errors = figure.subplots(2, 1, height_ratios=[5, 1])
    figure.suptitle(summary(record), fontsize=14)
    draw_paths(paths, record, module_positions)
    draw_errors(errors, record)
    figure.savefig(path, dpi=120)


def draw_paths(axes: 'Axes', record: DriveRecord, module_positions: NDArray[np.float64]) -> None:
    """
    Draw truth, odometry and, at intervals, the modules.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Gets the drawing, in metres.
    record : DriveRecord
        Gives both paths and the directions of the modules.
    module_positions : ndarray (n, 2)
        From base_link [m].

    """
    from matplotlib.collections import PolyCollection

    indices = spaced_indices(record.truth[:, :2], BASE_COUNT)
    modules = module_poses(
        record.truth[indices], module_positions, record.module_direction[indices])
    for corners in modules[..., :2]:
        axes.fill(*outline(corners).T, facecolor='none', edgecolor=BASE, linewidth=0.8)
    fronts = [front(pose, module_positions) for pose in record.truth[indices]]
    axes.add_collection(PolyCollection(fronts, color=FRONT, linewidth=0.0, zorder=3,
                                       label='front of the base'))
    x, y, direction = np.moveaxis(modules, -1, 0)
    axes.plot(*record.truth[:, :2].T, color=TRUTH, linewidth=6.0, label='ground truth')
    axes.plot(*record.odometry[:, :2].T, color=ODOMETRY, linewidth=1.5, label='odometry')
    axes.quiver(x, y, np.cos(direction), np.sin(direction), color=ARROWS, zorder=3,
                angles='xy', scale_units='xy', scale=1.0 / ARROW_LENGTH, width=0.003,
                label='direction of each module')
    axes.plot(*record.truth[0, :2], 'o', color='black', markersize=7, label='start')
    axes.set_aspect('equal')
    axes.margins(0.08)
    axes.grid(alpha=0.3)
    axes.set_xlabel('x [m]')
    axes.set_ylabel('y [m]')
    axes.legend(loc='lower center', ncols=5, frameon=False, bbox_to_anchor=(0.5, 1.0))


def front(pose: NDArray[np.float64], module_positions: NDArray[np.float64],
          ) -> NDArray[np.float64]:
    """
    Return the triangle that marks the front of a base.

    Parameters
    ----------
    pose : ndarray (3,)
        Of the base [m, m, rad].
    module_positions : ndarray (n, 2)
        From base_link [m].

    Returns
    -------
    ndarray (3, 2)
        Its corners [m], the tip first, in the frame of `pose`.

    """
    size = FRONT_SIZE * np.ptp(module_positions, axis=0).max()
    edge, middle = module_positions[:, 0].max(), module_positions[:, 1].mean()
    corners = [(edge + size, middle, 0.0), (edge, middle + size, 0.0), (edge, middle - size, 0.0)]
    return se2_compose(pose, corners)[:, :2]


def draw_errors(axes: 'Axes', record: DriveRecord) -> None:
    """
    Draw the distance between odometry and truth over time.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Gets the drawing, in millimetres over seconds.
    record : DriveRecord
        Gives odometry and truth.

    """
    axes.plot(record.time, 1e3 * position_errors(record), color=ODOMETRY, linewidth=1.2)
    axes.set_xlim(0.0, record.time[-1])
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    axes.set_xlabel('time [s]')
    axes.set_ylabel('error [mm]')
