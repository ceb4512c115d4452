"""A gyro over a whole recording: read at any stamp from the samples before and after it."""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.ros.gyro_feedback import GyroFeedback, GyroReading
from swerve_kinematics.ros.stamps import NANOSECONDS


class GyroSeries:
    """
    Collects what a gyro says, and understands it as the node does.

    Parameters
    ----------
    timeout : int
        Distance [ns] from the nearest sample beyond which nothing is known.

    """

    def __init__(self, timeout: int) -> None:
        """Start without samples."""
        self._timeout = timeout
        self._gyro = GyroFeedback(timeout)
        self._readings: list[GyroReading] = []

    def add(self, stamp: int, yaw: float, rate: float) -> None:
        """Take a sample [ns], [rad], [rad/s]; NaN for what is missing."""
        if self._gyro.add(stamp, yaw, rate):
            self._readings.append(self._gyro.at(stamp))

    def yaw_at(self, stamps: NDArray[np.int64]) -> NDArray[np.float64] | None:
        """
        Return the yaw (t,) [rad] at stamps [ns], or the integral of the rate; None without both.

        NaN where the gyro was silent.
        """
        yaws = [(reading.stamp, reading.yaw) for reading in self._readings]
        told = [pair for pair in yaws if pair[1] is not None] or [
            (reading.stamp, reading.integral) for reading in self._readings]
        if not told:
            return None
        time, yaw = (np.array(series) for series in zip(*sorted(told)))
        after = np.clip(np.searchsorted(time, stamps), 1, max(len(time) - 1, 1))
        nearest = np.minimum(np.abs(time[after - 1] - stamps),
                             np.abs(time[np.minimum(after, len(time) - 1)] - stamps))
        known = np.interp((stamps - time[0]) / NANOSECONDS, (time - time[0]) / NANOSECONDS, yaw)
        return np.where(nearest <= self._timeout, known, np.nan)
