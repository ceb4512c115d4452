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

"""JointState and Imu out of their bytes: as rclpy reads them, or not at all."""

import math
import random
import struct

from geometry_msgs.msg import TwistStamped
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import Imu, JointState

from swerve_kinematics.ros.serialized_reading import (
    JointNumbers, JointStateReader, read_imu, read_twist_stamped)
from swerve_kinematics.ros.stamps import nanoseconds_of

FLOATS = st.lists(st.floats(), max_size=5)
NAMES = st.lists(st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=9),
                 max_size=5)
SECONDS, FRACTIONS = st.integers(-2 ** 31, 2 ** 31 - 1), st.integers(0, 2 ** 32 - 1)


def joint_state(names, positions, velocities, efforts=(), frame='', sec=0, nanosec=0):
    """Return a JointState."""
    message = JointState(name=names, position=positions, velocity=velocities, effort=efforts)
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = sec, nanosec
    return message


def assert_same(read, message):
    """Check that what was read is what the message says, bit by bit."""
    assert read.stamp == nanoseconds_of(message.header.stamp)
    assert list(read.names) == message.name
    np.testing.assert_array_equal(read.positions, message.position)
    np.testing.assert_array_equal(read.velocities, message.velocity)


@given(NAMES, FLOATS, FLOATS, FLOATS, st.text('abc', max_size=9), SECONDS, FRACTIONS)
def test_any_joint_state_reads_as_it_was_written(
        names, positions, velocities, efforts, frame, sec, nanosec):
    message = joint_state(names, positions, velocities, efforts, frame, sec, nanosec)
    reader, data = JointStateReader(), serialize_message(message)
    for _ in range(2):  # the second time the names are those of the last one
        assert_same(reader.read(data), message)


def test_names_are_compared_anew_in_each_message():
    reader = JointStateReader()
    first = joint_state(['a', 'b'], [1.0, 2.0], [])
    swapped = joint_state(['b', 'a'], [1.0, 2.0], [])
    longer = joint_state(['a', 'b', 'c'], [1.0, 2.0, 3.0], [], frame='odd')
    for message in (first, swapped, first, longer, longer, first):
        assert_same(reader.read(serialize_message(message)), message)
    same = reader.read(serialize_message(first)).names
    assert reader.read(serialize_message(joint_state(['a', 'b'], [], []))).names is same


def big_endian(names, positions):
    """Return a JointState as a machine with the other byte order writes it."""
    data = b'\0\0\0\0' + struct.pack('>iII', 5, 6, 1) + b'\0'
    for block in (struct.pack('>I', len(names)), *(
            struct.pack('>I', len(name) + 1) + name.encode() + b'\0' for name in names)):
        data += b'\0' * (-len(data) % 4) + block
    data += b'\0' * (-len(data) % 4) + struct.pack('>I', len(positions))
    data += b'\0' * ((4 - len(data)) % 8) + struct.pack(f'>{len(positions)}d', *positions)
    return data + struct.pack('>II', 0, 0)


def test_the_other_byte_order_is_understood():
    read = JointStateReader().read(big_endian(['wheel', 'a'], [1.5, math.pi]))
    assert read == JointNumbers(5_000_000_006, ('wheel', 'a'), (1.5, math.pi), ())


def mutated(data, generator):
    """Return a message with some of it changed, lost, repeated or made up."""
    data = bytearray(data)
    for _ in range(generator.randint(1, 4)):
        place, kind = generator.randrange(len(data) + 1), generator.randrange(5)
        if kind == 0 and place < len(data):
            data[place] = generator.randrange(256)
        elif kind == 1:
            del data[place:]
        elif kind == 2:
            del data[place:place + generator.randint(1, 9)]
        elif kind == 3:
            data[place:place] = generator.randbytes(generator.randint(1, 9))
        else:
            data[place & ~3:(place & ~3) + 4] = generator.choice(
                (b'\xff\xff\xff\xff', b'\0\0\0\0', b'\0\0\0\x80', b'\x07\0\0\0'))
    return bytes(data)


def test_damaged_joint_states_are_not_read_or_as_rclpy_reads_them():
    generator, reader = random.Random(1), JointStateReader()
    whole = serialize_message(joint_state(
        ['front_left', 'rear', 'gyro'], [1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0], 'base', 1, 2))
    understood = 0
    for _ in range(30_000):
        data = mutated(whole, generator)
        read = reader.read(data)
        if read is None:
            continue
        understood += 1
        try:
            message = deserialize_message(data, JointState)
        except Exception:
            continue  # rclpy is stricter: about text that is not UTF-8, say
        assert_same(read, message)
    assert 1_000 < understood < 25_000
    assert_same(reader.read(whole), deserialize_message(whole, JointState))


def test_imus_and_twists_read_as_they_were_written_and_not_when_damaged():
    message = Imu()
    message.header.frame_id, message.header.stamp.sec = 'imu_link', 7
    message.orientation.y, message.orientation.w = 0.6, 0.8
    message.orientation_covariance[0] = -1.0
    message.angular_velocity.z, message.linear_acceleration.x = 0.25, 9.81
    data = serialize_message(message)
    read = read_imu(data)
    assert (read.stamp, read.frame) == (7_000_000_000, 'imu_link')
    assert read.numbers[:5] == (0.0, 0.6, 0.0, 0.8, -1.0)
    assert read.numbers[15] == 0.25 and read.numbers[25] == 9.81
    twist = TwistStamped()
    twist.header.frame_id, twist.twist.linear.x, twist.twist.angular.z = 'odom', 1.0, -2.0
    read = read_twist_stamped(serialize_message(twist))
    assert read == (0, 'odom', (1.0, 0.0, 0.0, 0.0, 0.0, -2.0))
    generator = random.Random(2)
    for _ in range(10_000):
        read = read_imu(mutated(data, generator))
        assert read is None or len(read.numbers) == 37
    for length in range(len(data)):
        assert read_imu(data[:length]) is None
