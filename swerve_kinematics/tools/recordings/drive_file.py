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

"""A recorded drive from a CSV file or a rosbag2: encoders, gyro and truth at the same stamps."""

from collections.abc import Iterable, Iterator, Mapping
import csv
import math
from pathlib import Path
from typing import Any, NamedTuple

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.ros.stamps import LATEST, NANOSECONDS, nanoseconds
from swerve_kinematics.tools.recordings.collector import Collector
from swerve_kinematics.tools.recordings.messages import (
    KINDS, take_drive_commands, take_imu, take_joint_commands, take_joints,
    take_steering_commands, take_truth, Taker)

STAMP = 'stamp'
TRUTH = ('truth_x', 'truth_y', 'truth_yaw')
# A column with this after the name of a joint has what that was commanded [rad/s, rad].
COMMAND = '_command'
# Bytes behind a message in a bag: rclpy leaves four for each list of numbers that is empty.
SPARE = (0, 4, 8, 12)


class Topics(NamedTuple):
    """
    Names of the topics in a bag.

    `truth` is None where the truth is known otherwise; commands are read where a bag has them.
    """

    joint_states: str
    imu: str
    truth: str | None = None
    drive_commands: str = ''
    steering_commands: str = ''
    joint_commands: str = ''


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
    layout = parameters.layout
    with path.open(newline='', encoding='utf-8-sig') as file:
        # People who write a table by hand put spaces after its commas.
        reader = csv.DictReader(file, skipinitialspace=True)
        columns = reader.fieldnames
        if columns is None:
            raise ValueError(f'{path} is empty')
        joints = [name for name in columns if name in {
            *layout.drive_joints, *layout.steering_joints, layout.gyro_joint}]
        told = [[name + COMMAND for name in names] for names in (
            layout.drive_joints, layout.steering_joints)]
        has_commands = {*told[0], *told[1]} <= set(columns)
        used = [STAMP, *(TRUTH if needs_truth else ())]
        missing = [name for name in used if name not in columns]
        if missing:
            raise ValueError(f"{path} has no column {', '.join(missing)}" + (
                f", but: {', '.join(columns)}" if STAMP in missing else
                ': add what is missing, or give --distance'))
        twice = [name for name in dict.fromkeys((*used, *joints)) if columns.count(name) > 1]
        if twice:
            raise ValueError(f"{path} has more than one column {', '.join(twice)}")
        for row in reader:
            stamp, *truth = (_number(row, name, reader.line_num) for name in used)
            if not 0.0 <= stamp <= LATEST / NANOSECONDS:
                raise ValueError(f"line {reader.line_num}: '{STAMP}' is {row[STAMP]}: "
                                 'it must be in seconds, and not negative')
            positions = [_number(row, name, reader.line_num) for name in joints]
            if has_commands:
                drives, steerings = ([_number(row, name, reader.line_num) for name in names]
                                     for names in told)
                collector.add_drive_commands(drives)
                collector.add_steering_commands(steerings)
            collector.add_joints(nanoseconds(stamp), joints, positions, [])
            if needs_truth:
                collector.add_truth(nanoseconds(stamp), *truth)
    return collector


def _number(row: Mapping[str, str], name: str, line: int) -> float:
    """Return an entry of a row as a finite number."""
    try:
        value = float(row[name])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"line {line}: '{name}' is not a finite number: {row[name] or 'empty'}")
    return value


def read_bag(path: Path, parameters: NodeParameters, topics: Topics) -> Collector:
    """
    Return the drive in a rosbag2, of either storage.

    Parameters
    ----------
    path : pathlib.Path
        The folder.
    parameters : NodeParameters
        With the values so far.
    topics : Topics
        The truth may be Odometry, PoseStamped or PoseWithCovarianceStamped.

    Returns
    -------
    Collector

    Raises
    ------
    ValueError
        If a topic or joint is missing, or the bag cannot be read.
    OSError
        If there is no such folder.
    ModuleNotFoundError
        If rosbags is not installed.

    """
    collector = Collector(parameters, ('joint',))
    takers: dict[str, Taker] = {topics.joint_states: take_joints}
    if topics.truth is not None:
        takers[topics.truth] = take_truth
    if parameters.gyro_source == 'imu':
        takers[topics.imu] = take_imu
    needed = set(takers)
    takers |= {topics.drive_commands: take_drive_commands,
               topics.steering_commands: take_steering_commands,
               topics.joint_commands: take_joint_commands}
    for take, message, received in _messages(path, takers, needed):
        take(collector, message, received)
    return collector


def _messages(path: Path, takers: Mapping[str, Taker],
              needed: Iterable[str]) -> Iterator[tuple[Taker, Any, int]]:
    """Yield the messages in a bag with what takes them, and when each was received [ns]."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import get_typestore, Stores

    path.stat()
    if path.is_dir() and not (path / 'metadata.yaml').exists():
        raise ValueError(f'{path} is no rosbag2, for it has no metadata.yaml; of a recording that '
                         'was killed, `ros2 bag reindex` makes one')
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
            connections = [c for c in reader.connections
                           if c.topic in takers and c.msgtype in KINDS[takers[c.topic]]]
            there = {c.topic for c in connections}
            for topic in sorted(needed):
                if topic not in there:
                    raise ValueError(_absence(path, topic, KINDS[takers[topic]], reader))
            for connection, received, data in reader.messages(connections):
                yield (takers[connection.topic],
                       _deserialized(reader, data, connection.msgtype), received)
    except (OSError, ValueError):
        raise
    except Exception as error:  # of a damaged bag: whatever rosbags, SQLite and others raise
        raise ValueError(f'{path} cannot be read: {error}') from error


def _absence(path: Path, topic: str, kinds: Iterable[str], reader: Any) -> str:
    """Return that a bag lacks a topic of certain types, and what it has."""
    there = ', '.join(sorted(f'{c.topic} ({c.msgtype})' for c in reader.connections))
    return (f"{path} has no topic {topic} of type {' or '.join(kinds)}, but: {there}; options "
            'name the topics, see --help')


def _deserialized(reader: Any, data: bytes, kind: str) -> Any:
    """Return a message; what rclpy has serialized may be longer than it needs to be."""
    from rosbags.highlevel import AnyReaderError
    for spare in SPARE:
        try:
            return reader.deserialize(data[:len(data) - spare], kind)
        except AnyReaderError as error:
            complaint = error
    raise complaint
