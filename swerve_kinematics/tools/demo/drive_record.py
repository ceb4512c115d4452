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

"""What was seen during a drive: odometry beside the truth, and how far they were apart."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray


class DriveRecord(NamedTuple):
    """
    Odometry, truth and module directions of the same moments.

    Attributes
    ----------
    time : ndarray (k,)
        From the first sample [s].
    odometry, truth : ndarray (k, 3)
        `[x, y, heading]` [m, m, rad].
    module_direction : ndarray (k, n)
        The way each wheel rolls, in the base frame [rad].

    """

    time: NDArray[np.float64]
    odometry: NDArray[np.float64]
    truth: NDArray[np.float64]
    module_direction: NDArray[np.float64]


def matched(odometry: Mapping[int, ArrayLike], truth: Mapping[int, ArrayLike],
            directions: Mapping[int, ArrayLike]) -> DriveRecord:
    """
    Return the samples whose stamps are in all three streams.

    The simulated base publishes its truth and its joint states with one stamp, and the node
    stamps the odometry with that of the joint states, so that nothing needs to be
    interpolated.

    Parameters
    ----------
    odometry, truth, directions : mapping
        Row `[x, y, heading]`, or module directions, by stamp [ns].

    Returns
    -------
    DriveRecord

    Raises
    ------
    ValueError
        If they have no stamp in common.

    """
    stamps = sorted(odometry.keys() & truth.keys() & directions.keys())
    if not stamps:
        raise ValueError('odometry, truth and joint states have no stamp in common')
    columns = (np.array([rows[stamp] for stamp in stamps])
               for rows in (odometry, truth, directions))
    return DriveRecord((np.array(stamps) - stamps[0]) * 1e-9, *columns)


def position_errors(record: DriveRecord) -> NDArray[np.float64]:
    """
    Return how far the odometry is from the truth at each moment.

    Parameters
    ----------
    record : DriveRecord
        Gives odometry and truth.

    Returns
    -------
    ndarray (k,)
        [m].

    """
    errors: NDArray[np.float64] = np.hypot(*(record.odometry - record.truth)[:, :2].T)
    return errors


def path_length(record: DriveRecord) -> float:
    """
    Return the length of the true path.

    Parameters
    ----------
    record : DriveRecord
        Gives the truth.

    Returns
    -------
    float
        [m].

    """
    return float(np.hypot(*np.diff(record.truth[:, :2], axis=0).T).sum())


def error_ratio(record: DriveRecord) -> float:
    """
    Return the greatest error over the drive, as a fraction of the path's length.

    Parameters
    ----------
    record : DriveRecord
        Gives odometry and truth.

    Returns
    -------
    float
        Infinite if the base did not move at all.

    """
    length = path_length(record)
    return float(position_errors(record).max()) / length if length > 0.0 else np.inf


def summary(record: DriveRecord) -> str:
    """
    Return the line that sums the drive up, with the largest error along the way.

    Parameters
    ----------
    record : DriveRecord
        The whole drive.

    Returns
    -------
    str

    """
    return ('largest odometry error: '
            f'{1e3 * position_errors(record).max():.1f} mm '
            f'over {path_length(record):.1f} m ({100.0 * error_ratio(record):.2f} %)')
