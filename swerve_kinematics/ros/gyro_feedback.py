"""What the gyro says at the stamp of the encoders."""

import math

from swerve_kinematics.ros.stamps import is_valid, NANOSECONDS, NEVER
from swerve_kinematics.ros.usable import is_usable

NOTHING = (None, None)


class GyroFeedback:
    """
    Keeps the latest gyro sample and carries it over to another stamp.

    Parameters
    ----------
    timeout : int
        Age [ns] beyond which a sample is of no use.

    """

    def __init__(self, timeout):
        """Start without a sample."""
        self.timeout = timeout
        self.clear()

    def clear(self):
        """Forget all samples."""
        self._stamp, self._yaw, self._rate = NEVER, None, None
        self._previous = NEVER, None

    def add(self, stamp, yaw, rate):
        """
        Take a sample; one older than the timeout means that the clock was set back.

        Parameters
        ----------
        stamp : int
            Time [ns].
        yaw, rate : float
            Yaw [rad], wrapped or continuous, and yaw rate [rad/s]; NaN for what is missing.

        Returns
        -------
        bool
            False if the sample says nothing, or nothing new.

        """
        if not is_valid(stamp):
            return False
        yaw = yaw if is_usable(yaw) else None
        rate = rate if is_usable(rate) else None
        if stamp < self._stamp - self.timeout:
            self.clear()
        if stamp <= self._stamp or (yaw is None and rate is None):
            return False
        self._previous = self._stamp, self._yaw
        if yaw is not None and self._yaw is not None:
            yaw = self._yaw + math.remainder(yaw - self._yaw, math.tau)
        self._stamp, self._yaw, self._rate = stamp, yaw, rate
        return True

    def at(self, stamp):
        """
        Return yaw and yaw rate at a stamp.

        Between the two latest samples the yaw is interpolated, after them it is carried on
        with the rate.

        Parameters
        ----------
        stamp : int
            Time [ns].

        Returns
        -------
        yaw, rate : float or None
            Continuous yaw [rad] and yaw rate [rad/s]; None for what is not known.

        """
        age = stamp - self._stamp
        if age == 0:
            return self._yaw, self._rate
        if abs(age) > self.timeout:
            return NOTHING
        if self._yaw is None:
            return None, self._rate
        return self._yaw + self._slope(age) * age / NANOSECONDS, self._rate

    def _slope(self, age):
        """Return the yaw rate [rad/s] that leads from the latest sample to the stamp asked."""
        stamp, yaw = self._previous
        known = yaw is not None and self._stamp - stamp <= self.timeout
        if known and (age < 0 or self._rate is None):
            return (self._yaw - yaw) / (self._stamp - stamp) * NANOSECONDS
        return self._rate or 0.0
