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

"""From joint states, as they come, to complete sets of module measurements."""

from collections import Counter
from collections.abc import Sequence
import math

from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.core.geometry.angles import scalar_nearest_equivalent
from swerve_kinematics.core.odometry.speeds import SpeedCheck
from swerve_kinematics.core.odometry.wrapping import DriveUnwrapper
from swerve_kinematics.ros.gyro_feedback import GyroFeedback
from swerve_kinematics.ros.joint_names import JointNames
from swerve_kinematics.ros.late_messages import LateMessages
from swerve_kinematics.ros.sample import Sample
from swerve_kinematics.ros.stamps import is_valid, NANOSECONDS, NEVER
from swerve_kinematics.ros.usable import are_usable, is_usable


class JointFeedback:
    """
    Collects joint states by name until every module joint has a new value.

    A joint that is absent, listed twice, short of data or not finite is not updated. A drive
    joint without a position is carried on by its velocity. A message slightly older than what
    is known is dropped; two in a row that none overtook, or one older than the timeout, mean that
    the clock was set back.

    Parameters
    ----------
    layout : Layout
        Gives the names of the module joints, and what they mean.
    gyro_joint : str or None
        Joint that stands for the gyro; None if there is none.
    timeout, gyro_timeout : int
        Gap [ns] that breaks the continuity of module measurements, and age [ns] beyond which a
        gyro sample is of no use.

    Attributes
    ----------
    gyro : GyroFeedback
        The latest samples, from the gyro joint or an IMU.
    speeds : SpeedCheck
        Tells which drive joints report velocities that are not theirs.
    unwrapper : DriveUnwrapper
        Makes drive joints that wrap continuous; tells if they were found to wrap.
    ignored : collections.Counter
        How often input was ignored, by reason.
    merged : int
        How many samples came together from several messages.
    without_gyro : int
        How many samples there were of which no gyro told anything.
    foreign : int
        How many messages had other joints only, as those of an arm.

    """

    def __init__(self, layout: Layout, gyro_joint: str | None, timeout: int,
                 gyro_timeout: int) -> None:
        """Start with nothing measured."""
        joints = layout.drive_joints + layout.steering_joints
        self._all = frozenset(range(len(joints)))
        self._module_count, self._modules = len(layout.drive_joints), layout.joints
        self.unwrapper = DriveUnwrapper(
            layout.joints.distance_per_drive, layout.joints.drive_period)
        self._joint_names = JointNames(joints, gyro_joint)
        self._names: tuple[str, ...] = ()
        self._slots = self._joint_names.slots(self._names)
        self.timeout, self._late = timeout, LateMessages()
        self.gyro = GyroFeedback(gyro_timeout)
        self.speeds, self._speeds_hold = SpeedCheck(self._modules.distance_per_drive), True
        self.ignored: Counter[str] = Counter()
        self.merged = self.without_gyro = self.foreign = 0
        self.clear()

    @property
    def missing(self) -> str | None:
        """Return in words which joints do not come or have no position, None if all is silent."""
        is_silent = not self._fresh and self._complete_at != NEVER
        return self._joint_names.missing or (
            None if is_silent else self._joint_names.without_position(self._fresh))

    def clear(self) -> None:
        """Forget all measurements, as after a jump of the clock."""
        count = len(self._all)
        self._positions = [0.0] * count
        self._velocities = [math.nan] * count
        self._stamps, self._stamps_before = [NEVER] * count, [NEVER] * count
        self._fresh: frozenset[int] = frozenset()
        self._parts = 0
        self._turns: list[float] = []  # of the modules [rad], where drives turn along
        self._complete_at = self._newest = self._drives_at = self._rate_at = NEVER
        self._gyro_breaks = -1
        self.gyro.clear()

    def read(self, stamp: int, names: Sequence[str], positions: Sequence[float],
             velocities: Sequence[float]) -> Sample | None:
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
        names = tuple(names)
        if names is not self._names:  # most often they are the very same
            self._names, self._slots = names, self._joint_names.slots(names)
        slots, gyro_slot, pick = self._slots
        count = len(names)
        if len(positions) < count or len(velocities) < count:
            positions, velocities = _padded(positions, count), _padded(velocities, count)
        if not is_valid(stamp):
            self._count('joint states with an impossible stamp', 1)
            return None
        if slots and stamp < self._newest and self._is_set_back(stamp, names, slots):
            self.clear()
        if gyro_slot is not None:
            self.read_gyro(stamp, positions[gyro_slot], velocities[gyro_slot])
        if pick is not None and stamp > self._newest and are_usable(new := pick(positions)):
            self._replace(stamp, new, pick(velocities))
        elif slots:
            self._update(stamp, slots, positions, velocities)
        else:
            self.foreign += gyro_slot is None
        return self._sample() if len(self._fresh) == len(self._all) else None

    def read_gyro(self, stamp: int, yaw: float, rate: float) -> None:
        """Take a gyro sample, as `GyroFeedback.add` does, and count one of no use."""
        self._count('unusable gyro samples', not self.gyro.add(stamp, yaw, rate))

    def _is_set_back(self, stamp: int, names: tuple[str, ...],
                     slots: list[tuple[int, int]]) -> bool:
        """Return whether the clock was set back before a message, and it is not just late."""
        known = min([self._stamps[joint] for joint, _ in slots])
        before = min([self._stamps_before[joint] for joint, _ in slots])
        return self._late.tell_of_set_clock(
            stamp, known, before, self._complete_at - self.timeout, names)

    def _replace(self, stamp: int, positions: tuple[float, ...],
                 velocities: tuple[float, ...]) -> None:
        """Store new values of all joints: `_update` where nothing needs a closer look."""
        self._positions, self._velocities = list(positions), list(velocities)
        self._stamps_before, self._stamps = self._stamps, [stamp] * len(positions)
        self._newest = stamp
        self._fresh = self._all
        self._parts += 1

    def _update(self, stamp: int, slots: list[tuple[int, int]], positions: Sequence[float],
                velocities: Sequence[float]) -> None:
        """Store what is new among the joints' values, and count what is not."""
        usable = updated = 0
        for joint, slot in slots:
            position, velocity = positions[slot], velocities[slot]
            if not is_usable(position):
                position = self._carried_on(joint, stamp, velocity)
                if not is_usable(position):
                    continue
            usable += 1
            if stamp > self._stamps[joint]:
                updated += 1
                self._positions[joint], self._velocities[joint] = position, velocity
                self._stamps_before[joint], self._stamps[joint] = self._stamps[joint], stamp
                self._fresh = self._fresh | {joint}
                self._newest = max(self._newest, stamp)
        self._parts += updated > 0
        self._count('unusable joint values', len(slots) - usable)
        self._count('repeated or old joint states', usable > 0 and updated == 0)

    def _count(self, reason: str, times: int) -> None:
        """Count input that is ignored."""
        if times:
            self.ignored[reason] += int(times)

    def _carried_on(self, joint: int, stamp: int, velocity: float) -> float:
        """Return the position of a drive joint by the integral of its velocity."""
        if joint >= self._module_count:
            return math.nan
        since, before = self._stamps[joint], self._velocities[joint]
        elapsed = (stamp - since) / NANOSECONDS if since != NEVER else 0.0
        mean = 0.5 * (before + velocity) if is_usable(before) else velocity
        return self._positions[joint] + mean * elapsed

    def _sample(self) -> Sample:
        """Return the complete set in the units of the base."""
        count, modules = self._module_count, self._modules
        angles = modules.module_angles(self._positions[count:])
        stamp = self._newest
        elapsed, self._complete_at = stamp - self._complete_at, stamp
        continuous = elapsed <= self.timeout
        distances = modules.travel(
            self._counted(continuous), self._turned(angles, continuous))
        velocities = self._speeds()
        if velocities is None or not continuous:
            self.speeds.restart()
        if velocities is not None:
            self._speeds_hold = self.speeds.holds(elapsed / NANOSECONDS, distances, velocities)
            if not self._speeds_hold:
                velocities = None
        gyro, breaks = self.gyro.at(stamp), self.gyro.breaks
        gyro_went_on = breaks == self._gyro_breaks
        self._gyro_breaks = breaks
        # The integral cannot tell a step, or several, in which the gyro was silent for long.
        integral = gyro.integral if self.gyro.silent_until <= self._rate_at else None
        if gyro.rate is not None:
            self._rate_at = stamp
        elif gyro.yaw is None:
            self.without_gyro += 1
        self.merged += self._parts > 1
        self._fresh, self._parts = frozenset(), 0
        return Sample(stamp, distances, angles, velocities, gyro.yaw, gyro.rate, integral,
                      continuous, gyro_went_on)

    def _turned(self, angles: list[float], continuous: bool) -> list[float]:
        """Return how far the modules have turned [rad]: by angles that may wrap at a turn."""
        if self._modules.is_coupled:
            if continuous:
                angles = list(map(scalar_nearest_equivalent, angles, self._turns))
            self._turns = angles
        return angles

    def _counted(self, continuous: bool) -> list[float]:
        """Return the positions of the drive joints [rad], continuous where they wrap."""
        if not continuous:
            self.unwrapper.clear()
        count = self._module_count
        # By their own stamps: after a stall they may be much older than the rest of the set.
        newest = max(self._stamps[:count])
        elapsed, self._drives_at = newest - self._drives_at, newest
        return self.unwrapper.counted(
            elapsed / NANOSECONDS, self._positions[:count],
            self._velocities[:count] if self._speeds_hold else [math.nan] * count)

    def _speeds(self) -> list[float] | None:
        """Return the rim speeds [m/s], or None where a joint does not report its velocity."""
        count, modules = self._module_count, self._modules
        drives, steerings = self._velocities[:count], self._velocities[count:]
        speeds = modules.travel(
            drives, modules.module_rates(steerings) if modules.is_coupled else steerings)
        return speeds if are_usable(speeds) else None


def _padded(values: Sequence[float], count: int) -> Sequence[float]:
    """Return values of which there are at least `count`, NaN at the end."""
    missing = count - len(values)
    return [*values, *[math.nan] * missing] if missing > 0 else values
