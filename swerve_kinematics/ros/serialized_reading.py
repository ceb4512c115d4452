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

"""
JointState, Imu, Twist and TwistStamped read where they lie in the serialized message.

To make a JointState in Python takes rclpy longer than everything that the node computes from
it. The layout is that of `serialized`: fields as declared, numbers aligned to their size,
counted from behind the encapsulation; a string is its length with the zero at its end, and its
bytes; a sequence is its length and its entries. A message that claims more than it holds, or
that is encapsulated in another way, is damaged: nothing of it is used.
"""

from dataclasses import dataclass
from struct import error as StructError, Struct, unpack_from
from typing import Sequence

from swerve_kinematics.ros.conversions import StampedNumbers
from swerve_kinematics.ros.serialized import ENCAPSULATION
from swerve_kinematics.ros.stamps import time_of

# How plain data begins whose numbers are big-endian, and little-endian.
ORDERS = {b'\x00\x00': '>', b'\x00\x01': '<'}
IMU_NUMBERS, TWIST_NUMBERS = 37, 6
TWISTS = {mark: Struct(f'{order}{TWIST_NUMBERS}d') for mark, order in ORDERS.items()}
# Where the frame of a std_msgs/Header begins: behind its stamp.
FRAME = ENCAPSULATION + 8


@dataclass(slots=True)
class JointNumbers:
    """
    What a JointState says.

    Attributes
    ----------
    stamp : int
        [ns]; 0 where the sender gave none, IMPOSSIBLE where it is none.
    names : tuple of str (m,)
        The same object while the names stay the same.
    positions, velocities : tuple of float
        [rad], [rad/s]; as many as the sender gave.

    """

    stamp: int
    names: tuple[str, ...]
    positions: tuple[float, ...]
    velocities: tuple[float, ...]


class JointStateReader:
    """Reads JointStates, and recognizes one that is laid out like the last one."""

    def __init__(self) -> None:
        """Start without a message."""
        self._last: _Layout | None = None

    def read(self, data: bytes) -> JointNumbers | None:
        """Return what a serialized JointState says; None if it is damaged."""
        joints = None if self._last is None else self._last.read(data)
        return joints or self._read_anew(data)

    def _read_anew(self, data: bytes) -> JointNumbers | None:
        """Read a message whose layout is not known, and keep its layout."""
        try:
            order, stamp, _, offset = _header(data)
            names, padding, end = _strings(data, order, offset)
            positions, first = _numbers(data, order, end)
            velocities, second = _numbers(data, order, first)
            efforts, third = _numbers(data, order, second)
        except (StructError, KeyError):
            return None
        if self._last is not None and names == self._last.names:
            names = self._last.names  # the same object while they stay the same
        self._last = _Layout(
            data[:end], order, names, [*range(_end_of_frame(data, order), offset), *padding], (
                (len(positions), first), (len(velocities), second), (len(efforts), third)))
        return JointNumbers(stamp, names, positions, velocities)


class _Layout:
    """
    Where a JointState has what: the next one is most likely the same but for its numbers.

    Parameters
    ----------
    head : bytes
        The message up to the end of the names.
    order : str
        Of the bytes in a number.
    names : tuple of str
    padding : list of int
        Places in the head that say nothing.
    sequences : sequence of (int, int)
        Length and end of positions, velocities and efforts.

    """

    def __init__(self, head: bytes, order: str, names: tuple[str, ...], padding: list[int],
                 sequences: Sequence[tuple[int, int]]) -> None:
        """Prepare to recognize it."""
        self._order_mark, self._end, self.names = head[:2], len(head), names
        # Nobody clears the bytes between two strings: they do not count.
        counted = bytearray(b'\xff' * (len(head) - FRAME))
        for place in padding:
            counted[place - FRAME] = 0
        self._told, self._mask = head[FRAME:], int.from_bytes(counted, 'little')
        layout, end = f'{order}iI{len(head) - FRAME}x', len(head)
        for count, next_end in sequences:
            start = _aligned(end, 4)
            layout += f'{start - end}xI{next_end - start - 4 - 8 * count}x{count}d'
            end = next_end
        self._numbers = Struct(layout)
        self._counts = [count for count, _ in sequences]

    def read(self, data: bytes) -> JointNumbers | None:
        """Return what a message says that is laid out like this; None for another one."""
        told = data[FRAME:self._end]
        if (data[:2] != self._order_mark or told != self._told and not self._says_the_same(told)
                or len(data) < ENCAPSULATION + self._numbers.size):
            return None
        numbers = self._numbers.unpack_from(data, ENCAPSULATION)
        of_positions, of_velocities, of_efforts = self._counts
        velocities = 3 + of_positions
        efforts = velocities + 1 + of_velocities
        if (numbers[2] != of_positions or numbers[velocities] != of_velocities
                or numbers[efforts] != of_efforts):
            return None
        return JointNumbers(time_of(numbers[0], numbers[1]), self.names,
                            numbers[3:velocities], numbers[velocities + 1:efforts])

    def _says_the_same(self, told: bytes) -> bool:
        """Return whether the frame and the names are the same, whatever is in the padding."""
        return (int.from_bytes(told, 'little') ^ int.from_bytes(self._told, 'little')
                ) & self._mask == 0


def read_imu(data: bytes) -> StampedNumbers | None:
    """
    Return what a serialized Imu says; None if it is damaged.

    Its numbers are the orientation x, y, z, w and its covariance (9), the angular velocity
    x, y, z [rad/s] and its covariance (9), the linear acceleration x, y, z [m/s^2] and its
    covariance (9).
    """
    return _stamped(data, IMU_NUMBERS)


def read_twist(data: bytes) -> tuple[float, ...] | None:
    """Return the numbers of a serialized Twist, linear and angular; None if it is damaged."""
    try:
        return TWISTS[data[:2]].unpack_from(data, ENCAPSULATION)
    except (StructError, KeyError):
        return None


def read_twist_stamped(data: bytes) -> StampedNumbers | None:
    """Return what a serialized TwistStamped says, linear and angular; None if it is damaged."""
    return _stamped(data, TWIST_NUMBERS)


def _stamped(data: bytes, count: int) -> StampedNumbers | None:
    """Return what a message of a header and so many numbers says; None if it is damaged."""
    try:
        order, stamp, frame, offset = _header(data)
        numbers = unpack_from(f'{order}{count}d', data, _aligned(offset, 8))
    except (StructError, KeyError):
        return None
    return StampedNumbers(stamp, frame, numbers)


def _aligned(offset: int, size: int) -> int:
    """Return the first place from `offset` on for a number of this size."""
    return offset + (ENCAPSULATION - offset) % size


def _header(data: bytes) -> tuple[str, int, str, int]:
    """Return byte order, stamp [ns], frame and end of the std_msgs/Header at the start."""
    order = ORDERS[data[:2]]
    stamp = time_of(*unpack_from(f'{order}iI', data, ENCAPSULATION))
    frame, offset = _string(data, order, FRAME)
    return order, stamp, frame, _aligned(offset, 4)


def _end_of_frame(data: bytes, order: str) -> int:
    """Return the end of the frame of the std_msgs/Header at the start."""
    length: int = unpack_from(f'{order}I', data, FRAME)[0]
    return FRAME + 4 + length


def _string(data: bytes, order: str, offset: int) -> tuple[str, int]:
    """Return the string at an aligned place, and its end."""
    length, = unpack_from(f'{order}I', data, offset)
    end = offset + 4 + length
    if end > len(data):
        raise StructError('the string is cut short')
    text, *_ = data[offset + 4:end].split(b'\0', 1)
    return text.decode(errors='replace'), end


def _strings(data: bytes, order: str, offset: int) -> tuple[tuple[str, ...], list[int], int]:
    """Return the sequence of strings at an aligned place, the places of padding, and its end."""
    count, = unpack_from(f'{order}I', data, offset)
    end = offset + 4
    strings: list[str] = []
    padding: list[int] = []
    for _ in range(count):
        start = _aligned(end, 4)
        padding += range(end, start)
        string, end = _string(data, order, start)
        strings.append(string)
    return tuple(strings), padding, end


def _numbers(data: bytes, order: str, offset: int) -> tuple[tuple[float, ...], int]:
    """Return the sequence of float64 that begins at or after a place, and its end."""
    offset = _aligned(offset, 4)
    count, = unpack_from(f'{order}I', data, offset)
    if not count:
        return (), offset + 4
    offset = _aligned(offset + 4, 8)
    return unpack_from(f'{order}{count}d', data, offset), offset + 8 * count
