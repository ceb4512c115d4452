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
Messages kept in their serialized form, their numbers written where they are.

rclpy writes a message field by field, one Python call for each, which takes as long as the
kinematics. ROS messages are serialized in the Common Data Representation (OMG, DDS-XTypes
7.4): 4 bytes of its own, the first two of which tell the order of the bytes in a number, and then
the fields as declared.
"""

from array import array
import struct
from typing import Any, Sequence

from rclpy.publisher import Publisher
from rclpy.serialization import serialize_message

from swerve_kinematics.ros.stamps import seconds_and_nanoseconds

ENCAPSULATION = 4


class SerializedMessage:
    """
    A message with a block of numbers, to be published over and over with other ones.

    Parameters
    ----------
    publisher : rclpy.publisher.Publisher
        Of messages of this type.
    message : message
        What does not change, and first values of what does: successive fields that are float64.
    numbers : sequence of float
        Those first values, in their order; they differ enough to be recognized.

    Attributes
    ----------
    publisher : rclpy.publisher.Publisher
        It is not destroyed before this message.
    numbers : memoryview of float
        The block, to be written to.
    stamp : memoryview of int
        Seconds and nanoseconds, if the message begins with a header.

    Raises
    ------
    RuntimeError
        If the middleware serializes in another way.

    """

    def __init__(self, publisher: Publisher, message: Any, numbers: Sequence[float]) -> None:
        """Serialize the message."""
        self.publisher = publisher
        self._data = bytearray(serialize_message(message))
        view = memoryview(self._data)
        self.stamp = view[ENCAPSULATION:ENCAPSULATION + 8].cast('i')
        block = struct.pack(f'{len(numbers)}d', *numbers)
        start = self._data.find(block, ENCAPSULATION)
        if start < 0:
            raise RuntimeError(
                f'the middleware does not serialize {type(message).__name__} as expected')
        self.numbers = view[start:start + len(block)].cast('d')
        # What `Publisher.publish` ends up in, without its checks of what it is given.
        self._send = getattr(publisher.handle, 'publish_raw', publisher.publish)

    def publish(self) -> None:
        """Publish the message with the numbers it has now."""
        self._send(bytes(self._data))

    def publish_at(self, stamp: int, numbers: Sequence[float]) -> None:
        """Publish the message, which begins with a header, with a stamp [ns] and new numbers."""
        self.stamp[0], self.stamp[1] = seconds_and_nanoseconds(stamp)
        self.numbers[:] = array('d', numbers)
        self.publish()
