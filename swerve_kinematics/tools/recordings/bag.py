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

"""A recorded drive from a rosbag2."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.tools.recordings.collector import Collector
from swerve_kinematics.tools.recordings.messages import (
    KINDS, take_drive_commands, take_imu, take_joint_commands, take_joints,
    take_steering_commands, take_truth, Taker)

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
        raise ValueError(f'{path} is not a rosbag2: it has no metadata.yaml (`ros2 bag reindex` '
                         'makes one for a recording that was killed)')
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
