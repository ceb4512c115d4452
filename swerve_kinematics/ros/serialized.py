"""Messages that are serialized once, of which only the numbers change."""

from rclpy.serialization import serialize_message

# Of the serialization that ROS messages have, the Common Data Representation (OMG, DDS-XTypes
# 7.4): it begins with so many bytes of its own, and fields follow each other as declared.
ENCAPSULATION = 4


class SerializedMessage:
    """
    A message that ends in numbers, to be published over and over with other ones.

    rclpy reads a message field by field each time it is published, one call for each; for an
    Odometry that takes as long as all the odometry. The same message in serialized form, with
    its numbers overwritten in place, goes out as it is.

    Parameters
    ----------
    publisher : rclpy.publisher.Publisher
        Of messages of this type.
    message : message
        What does not change, and first values of what does. Its last fields are all float64.
    numbers : sequence of float
        The values of those last fields, in their order; they differ enough to be recognized.

    Attributes
    ----------
    publisher : rclpy.publisher.Publisher
    numbers : memoryview of float
        The last fields, to be written to.
    stamp : memoryview of int
        Seconds and nanoseconds, if the message begins with a header.

    Raises
    ------
    RuntimeError
        If the middleware serializes in another way.

    """

    def __init__(self, publisher, message, numbers):
        """Serialize the message."""
        self.publisher = publisher
        self._data = bytearray(serialize_message(message))
        view = memoryview(self._data)
        self.stamp = view[ENCAPSULATION:ENCAPSULATION + 8].cast('i')
        self.numbers = view[-8 * len(numbers):].cast('d')
        if self.numbers.tolist() != list(numbers):
            raise RuntimeError(
                f'the middleware does not serialize {type(message).__name__} as expected')

    def publish(self):
        """Publish the message with the numbers it has now."""
        self.publisher.publish(bytes(self._data))
