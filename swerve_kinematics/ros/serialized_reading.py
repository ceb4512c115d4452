"""
JointState, Imu and TwistStamped read where they lie in the serialized message.

To make a JointState in Python takes rclpy longer than everything that the node computes from
it. The layout is that of `serialized`: fields as declared, numbers aligned to their size,
counted from behind the encapsulation; a string is its length with the zero at its end, and its
bytes; a sequence is its length and its entries. A message that claims more than it holds, or
that is encapsulated in another way, is damaged: nothing of it is used.
"""

from struct import error as StructError, unpack_from
from typing import NamedTuple

from swerve_kinematics.ros.conversions import StampedNumbers
from swerve_kinematics.ros.serialized import ENCAPSULATION
from swerve_kinematics.ros.stamps import NANOSECONDS

# The encapsulation of plain data, for big-endian and little-endian numbers.
ORDERS = {b'\x00\x00': '>', b'\x00\x01': '<'}
IMU_NUMBERS, TWIST_NUMBERS = 37, 6


class JointNumbers(NamedTuple):
    """
    What a JointState says.

    Attributes
    ----------
    stamp : int
        [ns]; 0 where the sender gave none.
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
    """Reads JointStates, and recognizes the names of the last one by a comparison of bytes."""

    def __init__(self) -> None:
        """Start without names."""
        self._names: tuple[str, ...] = ()
        self._order, self._length, self._mask, self._masked = '', 0, 0, 0

    def read(self, data: bytes) -> JointNumbers | None:
        """Return what a serialized JointState says; None if it is damaged."""
        try:
            order, stamp, _, offset = _header(data)
            end = offset + self._length
            block = int.from_bytes(data[offset:end], 'little')
            if order != self._order or block & self._mask != self._masked:
                end = self._read_names(data, order, offset)
            positions, end = _numbers(data, order, end)
            velocities, end = _numbers(data, order, end)
            _numbers(data, order, end)  # the efforts, to see that they are all there
        except (StructError, KeyError):
            return None
        return JointNumbers(stamp, self._names, positions, velocities)

    def _read_names(self, data: bytes, order: str, offset: int) -> int:
        """Read the names, keep them to be recognized, and return their end."""
        names, padding, end = _strings(data, order, offset)
        # Nobody clears the bytes between two strings: they do not count.
        counted = bytearray(b'\xff' * (end - offset))
        for place in padding:
            counted[place - offset] = 0
        self._names, self._order, self._length = names, order, end - offset
        self._mask = int.from_bytes(counted, 'little')
        self._masked = int.from_bytes(data[offset:end], 'little') & self._mask
        return end


def read_imu(data: bytes) -> StampedNumbers | None:
    """
    Return what a serialized Imu says; None if it is damaged.

    Its numbers are the orientation x, y, z, w and its covariance (9), the angular velocity
    x, y, z [rad/s] and its covariance (9), the linear acceleration x, y, z [m/s^2] and its
    covariance (9).
    """
    return _stamped(data, IMU_NUMBERS)


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
    seconds, nanoseconds = unpack_from(f'{order}iI', data, ENCAPSULATION)
    frame, offset = _string(data, order, ENCAPSULATION + 8)
    return order, seconds * NANOSECONDS + nanoseconds, frame, _aligned(offset, 4)


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
