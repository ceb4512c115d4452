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

"""Bags as robots record them, written without ROS."""

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import get_typestore, Stores

TYPES = get_typestore(Stores.ROS2_JAZZY)
START = 1_700_000_000.0  # s, at which a drive begins


def message(kind, /, **fields):
    """Return a message of a type, with the defaults of its other fields."""
    return TYPES.types[kind](**fields)


def header(stamp):
    """Return a Header at a time [s] from the start."""
    nanoseconds = round((START + stamp) * 1e9)
    return message('std_msgs/msg/Header', frame_id='odom', stamp=message(
        'builtin_interfaces/msg/Time', sec=nanoseconds // 10 ** 9, nanosec=nanoseconds % 10 ** 9))


def quaternion(yaw):
    """Return a Quaternion that turns by a yaw [rad]."""
    return message('geometry_msgs/msg/Quaternion', x=0.0, y=0.0,
                   z=float(np.sin(0.5 * yaw)), w=float(np.cos(0.5 * yaw)))


def vector(x=0.0, y=0.0, z=0.0):
    """Return a Vector3."""
    return message('geometry_msgs/msg/Vector3', x=x, y=y, z=z)


def joint_state(stamp, names, positions=(), velocities=()):
    """Return a JointState at a time [s] from the start."""
    return message('sensor_msgs/msg/JointState', header=header(stamp), name=names,
                   position=np.array(positions, dtype=float),
                   velocity=np.array(velocities, dtype=float), effort=np.zeros(0))


def numbers(values):
    """Return a Float64MultiArray."""
    layout = message('std_msgs/msg/MultiArrayLayout', dim=[], data_offset=0)
    return message('std_msgs/msg/Float64MultiArray', layout=layout, data=np.array(values))


def write_bag(path, storage=StoragePlugin.SQLITE3, tail=b'', **streams):
    """Write a rosbag2 with one topic for each stream of messages, and a tail after each."""
    with Writer(path, version=9, storage_plugin=storage) as writer:
        for topic, stream in streams.items():
            connection = None
            for stamp, content in stream:
                connection = connection or writer.add_connection(
                    f'/{topic}', content.__msgtype__, typestore=TYPES)
                writer.write(connection, round((START + stamp) * 1e9),
                             bytes(TYPES.serialize_cdr(content, content.__msgtype__)) + tail)
    return path
