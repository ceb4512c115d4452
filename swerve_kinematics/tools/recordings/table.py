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

"""A recorded drive from a CSV file: encoders, gyro, commands and truth at the same stamps."""

from collections.abc import Iterable, Mapping, Sequence
import csv
import math
from pathlib import Path

from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.ros.stamps import LATEST, NANOSECONDS, nanoseconds
from swerve_kinematics.tools.recordings.collector import Collector

STAMP = 'stamp'
TRUTH = ('truth_x', 'truth_y', 'truth_yaw')
# A column with this after the name of a joint has what that was commanded [rad/s, rad].
COMMAND = '_command'


def is_table(path: Path) -> bool:
    """Tell whether a recording is a CSV file; anything else is a bag."""
    return path.suffix.lower() == '.csv'


def read_csv(path: Path, parameters: NodeParameters, needs_truth: bool) -> Collector:
    """
    Return the drive in a CSV file.

    The first row names the columns: `stamp` [s], joints (positions [rad]) and, if there is a
    truth, `truth_x`, `truth_y` [m], `truth_yaw` [rad]; `JOINT_command` [rad/s, rad] is what a
    joint was commanded. Other columns do not matter.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    parameters : NodeParameters
        With the values so far.
    needs_truth : bool
        Whether the true poses are of interest.

    Returns
    -------
    Collector

    Raises
    ------
    ValueError
        If it is no such table, a column is missing or an entry is not a finite number.

    """
    try:
        return _read_table(path, parameters, needs_truth)
    except (csv.Error, UnicodeDecodeError) as error:
        raise ValueError(f'{path} is not a CSV file: {error}') from None


def _read_table(path: Path, parameters: NodeParameters, needs_truth: bool) -> Collector:
    """Return the drive in a CSV file, as `read_csv` does."""
    # A table has no IMU: what it has of a gyro stands in the column of the joint.
    collector = Collector(parameters, ('joint', 'imu'))
    truth = TRUTH if needs_truth else ()
    with path.open(newline='', encoding='utf-8-sig') as file:
        # People who write a table by hand put spaces after its commas.
        reader = csv.DictReader(file, skipinitialspace=True)
        columns = reader.fieldnames
        if columns is None:
            raise ValueError(f'{path} is empty')
        joints, commands = _joints_in(columns, parameters.layout)
        _refuse_unusable(path, columns, (STAMP, *truth), joints)
        for row in reader:
            stamp = _stamp(row, reader.line_num)
            positions = _numbers(row, joints, reader.line_num)
            drives, steerings = (_numbers(row, names, reader.line_num) for names in commands)
            collector.add_drive_commands(drives)
            collector.add_steering_commands(steerings)
            collector.add_joints(stamp, joints, positions, [])
            if truth:
                collector.add_truth(stamp, *_numbers(row, truth, reader.line_num))
    return collector


def _joints_in(columns: Sequence[str],
               layout: Layout) -> tuple[list[str], tuple[list[str], list[str]]]:
    """Return the columns of the joints; and of the commands to drives and steerings, or none."""
    joints = [name for name in columns if name in {
        *layout.drive_joints, *layout.steering_joints, layout.gyro_joint}]
    drives, steerings = ([name + COMMAND for name in names] for names in (
        layout.drive_joints, layout.steering_joints))
    has_commands = {*drives, *steerings} <= set(columns)
    return joints, (drives, steerings) if has_commands else ([], [])


def _refuse_unusable(path: Path, columns: Sequence[str], needed: Sequence[str],
                     joints: Sequence[str]) -> None:
    """Raise ValueError if a column that is needed is missing, or one that is used stands twice."""
    missing = [name for name in needed if name not in columns]
    if missing:
        raise ValueError(f"{path} has no column {', '.join(missing)}" + (
            f", but: {', '.join(columns)}" if STAMP in missing else
            ': add what is missing, or give --distance'))
    twice = [name for name in dict.fromkeys((*needed, *joints)) if columns.count(name) > 1]
    if twice:
        raise ValueError(f"{path} has more than one column {', '.join(twice)}")


def _stamp(row: Mapping[str, str], line: int) -> int:
    """Return the stamp of a row [ns]."""
    stamp = _number(row, STAMP, line)
    if not 0.0 <= stamp <= LATEST / NANOSECONDS:
        raise ValueError(f"line {line}: '{STAMP}' is {row[STAMP]}: it must be in seconds, and not "
                         'negative')
    return nanoseconds(stamp)


def _numbers(row: Mapping[str, str], names: Iterable[str], line: int) -> list[float]:
    """Return some entries of a row as finite numbers."""
    return [_number(row, name, line) for name in names]


def _number(row: Mapping[str, str], name: str, line: int) -> float:
    """Return an entry of a row as a finite number."""
    try:
        value = float(row[name])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"line {line}: '{name}' is not a finite number: {row[name] or 'empty'}")
    return value
