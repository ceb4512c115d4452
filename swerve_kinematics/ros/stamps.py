"""
Time in the ROS shell: whole nanoseconds, so that a stamp that comes in goes out unchanged.

Seconds in a float64 resolve the time since 1970 to 0.2 microseconds only.
"""

NANOSECONDS = 1_000_000_000
# Before every stamp, and far enough from the ends of int64 to subtract from any.
NEVER = -(1 << 62)


def nanoseconds(seconds):
    """Return a duration [s] in whole nanoseconds."""
    return round(seconds * NANOSECONDS)


def nanoseconds_of(stamp):
    """Return a builtin_interfaces/Time in nanoseconds."""
    return stamp.sec * NANOSECONDS + stamp.nanosec


def set_stamp(stamp, time):
    """Write a time [ns] to a builtin_interfaces/Time."""
    stamp.sec, stamp.nanosec = divmod(time, NANOSECONDS)
