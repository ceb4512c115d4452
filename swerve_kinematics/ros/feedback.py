"""From joint states, as they come, to complete sets of module measurements."""

from collections import Counter
from typing import NamedTuple, Optional

import numpy as np

from swerve_kinematics.ros.gyro_feedback import GyroFeedback
from swerve_kinematics.ros.stamps import NANOSECONDS, NEVER

# Name lists remembered at once; a publisher that invents new ones must not fill the memory.
REMEMBERED_NAME_LISTS = 64


class Sample(NamedTuple):
    """
    One complete measurement of the base.

    Attributes
    ----------
    stamp : int
        Time [ns] of the newest part.
    distances : ndarray (n,)
        Cumulative rim distances [m].
    angles : ndarray (n,)
        Steering angles [rad], as many turns as the joints count.
    velocities : ndarray (n,) or None
        Rim speeds [m/s], where the joints report them.
    yaw, yaw_rate : float or None
        Of the gyro at `stamp` [rad, rad/s].
    continuous : bool
        False for the first sample and after a gap or a jump of the clock: what moved since
        the sample before is not known.

    """

    stamp: int
    distances: np.ndarray
    angles: np.ndarray
    velocities: Optional[np.ndarray]
    yaw: Optional[float]
    yaw_rate: Optional[float]
    continuous: bool


class JointFeedback:
    """
    Collects joint states by name until every module joint has a new value.

    A joint that is absent, listed twice, short of data or not finite is not updated. A drive
    joint without a position is carried on by its velocity. A message slightly older than what
    is known is dropped; one older than the timeout means that the clock was set back.

    Parameters
    ----------
    layout : Layout
        Gives the names of the module joints and the wheel radii [m].
    gyro_joint : str or None
        Joint that stands for the gyro; None if there is none.
    steering_offsets : array_like (n,)
        What a steering joint reads when its wheel points along +x [rad].
    drive_coupling_ratio : float
        Turns the drive joint reads for one turn of the steering.
    timeout, gyro_timeout : int
        Gap [ns] that breaks the continuity of module measurements, and age [ns] beyond which a
        gyro sample is of no use.

    Attributes
    ----------
    gyro : GyroFeedback
        The latest sample, from the gyro joint or an IMU.
    ignored : collections.Counter
        How often input was ignored, by reason.

    """

    def __init__(self, layout, gyro_joint, steering_offsets, drive_coupling_ratio, timeout,
                 gyro_timeout):
        """Start with nothing measured."""
        self._joints = layout.drive_joints + layout.steering_joints
        self._gyro_joint = gyro_joint
        self._radii = layout.wheel_radii
        self._offsets = np.asarray(steering_offsets, dtype=float)
        self._coupling = drive_coupling_ratio
        self._slots_by_names = {}
        self.timeout = timeout
        self.gyro = GyroFeedback(gyro_timeout)
        self.ignored = Counter()
        self.clear()

    def clear(self):
        """Forget all measurements, as after a jump of the clock."""
        count = len(self._joints)
        self._positions = np.zeros(count)
        self._velocities = np.full(count, np.nan)
        self._stamps = np.full(count, NEVER)
        self._fresh = np.zeros(count, dtype=bool)
        self._complete_at = NEVER
        self.gyro.clear()

    def read(self, stamp, names, positions, velocities):
        """
        Take one JointState.

        Parameters
        ----------
        stamp : int
            Its time [ns].
        names : list of str
            Joints in the order of the message, foreign ones among them.
        positions, velocities : array_like (m,)
            Per name [rad, rad/s]; both may be shorter than `names`.

        Returns
        -------
        Sample or None
            A sample when this message completed a set.

        """
        slots, gyro_slot = self._slots(names)
        positions, velocities = np.asarray(positions), np.asarray(velocities)
        if stamp < self._complete_at - self.timeout and slots.max() >= 0:
            self.clear()
        if gyro_slot >= 0:
            self.gyro.add(stamp, *_entries(positions, velocities, gyro_slot))
        if slots.max() < 0:
            self._count('joint states of no module', gyro_slot < 0)
            return None
        self._update(stamp, slots, _taken(positions, slots), _taken(velocities, slots))
        return self._sample() if self._fresh.all() else None

    def _slots(self, names):
        """Return where in a message with these names each joint stands, and the gyro; or -1."""
        key = tuple(names)
        slots = self._slots_by_names.get(key)
        if slots is None:
            place = {name: -1 if key.count(name) > 1 else index
                     for index, name in enumerate(key)}
            slots = (np.array([place.get(joint, -1) for joint in self._joints]),
                     place.get(self._gyro_joint, -1))
            if len(self._slots_by_names) >= REMEMBERED_NAME_LISTS:
                self._slots_by_names.clear()
            self._slots_by_names[key] = slots
        return slots

    def _update(self, stamp, slots, positions, velocities):
        """Store what is new among the joints' values (2n,), and count what is not."""
        usable = np.isfinite(positions)
        if not usable.all():
            self._carry_on(stamp, positions, velocities)
            usable = np.isfinite(positions)
            self._count('unusable joint values', np.count_nonzero(~usable & (slots >= 0)))
        updated = usable & (stamp > self._stamps)
        if not updated.any():
            self._count('repeated or old joint states', usable.any())
            return
        np.copyto(self._positions, positions, where=updated)
        np.copyto(self._velocities, velocities, where=updated)
        self._stamps[updated] = stamp
        self._fresh |= updated

    def _count(self, reason, times):
        """Count input that is ignored."""
        if times:
            self.ignored[reason] += int(times)

    def _carry_on(self, stamp, positions, velocities):
        """Fill in the missing drive positions with the integral of the velocities."""
        drives = slice(len(self._radii))
        since = self._stamps[drives]
        elapsed = np.where(since == NEVER, 0, stamp - since) / NANOSECONDS
        now, before = velocities[drives], self._velocities[drives]
        mean = np.where(np.isnan(before), now, 0.5 * (before + now))
        carried = self._positions[drives] + mean * elapsed
        missing = ~np.isfinite(positions[drives])
        positions[drives][missing] = carried[missing]

    def _sample(self):
        """Return the complete set in the units of the base."""
        count = len(self._radii)
        steering, speeds = self._positions[count:], self._velocities[:count]
        turns = self._positions[:count] - self._coupling * steering
        if self._coupling:
            speeds = speeds - self._coupling * self._velocities[count:]
        stamp = int(self._stamps.max())
        continuous = stamp - self._complete_at <= self.timeout
        self._complete_at = stamp
        self._fresh[:] = False
        return Sample(stamp, self._radii * turns, steering - self._offsets,
                      self._radii * speeds if np.isfinite(speeds).all() else None,
                      *self.gyro.at(stamp), continuous)


def _taken(values, slots):
    """Return the values at the slots, NaN where a slot is -1 or beyond the values' end."""
    if not len(values):
        return np.full(len(slots), np.nan)
    present = (slots >= 0) & (slots < len(values))
    return np.where(present, values[np.where(present, slots, 0)], np.nan)


def _entries(positions, velocities, slot):
    """Return position and velocity at a slot, NaN for what is missing."""
    return (float(positions[slot]) if slot < len(positions) else np.nan,
            float(velocities[slot]) if slot < len(velocities) else np.nan)
