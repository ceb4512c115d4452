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

"""Joint states, gyro samples, commands and true poses put together, as the node does."""

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.calibration.recording import Recording
from swerve_kinematics.core.checking.drive_data import DriveData, with_gaps
from swerve_kinematics.core.geometry.windows import LONGEST_STEP
from swerve_kinematics.ros.conversions import Imu, imu_numbers
from swerve_kinematics.ros.feedback import JointFeedback
from swerve_kinematics.ros.mounted_imu import MountedImu
from swerve_kinematics.ros.sample import Sample
from swerve_kinematics.ros.sender_clock import SenderClock
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds
from swerve_kinematics.tools.recordings.gyro_series import GyroSeries

# Joint states that are usually further apart than this [s] tell nothing of a drive.
LONGEST_PERIOD = 1.0


class Drive(NamedTuple):
    """
    A recording and, where the file has it, the truth.

    Attributes
    ----------
    recording : Recording
        With the radii and offsets of the parameters.
    poses : ndarray (t, 3) or None
        True `[x, y, heading]` [m, m, rad] at the stamps of the recording.

    """

    recording: Recording
    poses: NDArray[np.float64] | None


class Collector:
    """
    Puts joint states, gyro samples, commands and true poses together, as the node does.

    Parameters
    ----------
    parameters : NodeParameters
        With the values so far.
    gyro_sources : sequence of str
        The gyro joint counts where the parameters name one of these sources.

    Attributes
    ----------
    joint_clock, imu_clock : SenderClock
        By which the senders of messages stamp them.
    restamps : bool
        Whether the node translates such stamps to its own clock.

    """

    def __init__(self, parameters: NodeParameters, gyro_sources: Sequence[str]) -> None:
        """Start empty."""
        self._layout, self.restamps = parameters.layout, parameters.restamp_feedback
        self.joint_clock, self.imu_clock = SenderClock(), SenderClock()
        # A table has the samples of an IMU in the column of the gyro joint.
        self._delay = nanoseconds(parameters.imu_delay) if parameters.gyro_source == 'imu' else 0
        self._imu = MountedImu(parameters.imu_orientation, parameters.imu_use)
        self._feedback = JointFeedback(
            parameters.layout, None, nanoseconds(parameters.feedback_timeout),
            nanoseconds(parameters.gyro_timeout))
        self._gyro_joint = (
            parameters.layout.gyro_joint if parameters.gyro_source in gyro_sources else None)
        self._gyro = GyroSeries(nanoseconds(parameters.gyro_timeout))
        self._names: set[str] = set()
        self._samples: list[Sample] = []
        self._truth: list[tuple[float, float, float, float]] = []
        unknown = [math.nan] * len(self._layout.module_names)
        self._speeds, self._angles = unknown, unknown
        self._commanded: list[tuple[list[float], list[float]]] = []

    @property
    def latest(self) -> Sample | None:
        """Return the latest complete sample."""
        return self._samples[-1] if self._samples else None

    @property
    def found_period(self) -> float:
        """Return the period [rad] at which drive joints were found to wrap; 0 if they do not."""
        unwrapper = self._feedback.unwrapper
        return float(unwrapper.period) if unwrapper.is_found else 0.0

    def lack(self) -> str:
        """Return why there is no complete sample yet, in words."""
        if not self._names:
            return 'no joint_states arrive: are the drivers running?'
        return self._feedback.missing or 'joint_states fell silent'

    def add_joints(self, stamp: int, names: Sequence[str], positions: Sequence[float],
                   velocities: Sequence[float]) -> None:
        """Take a JointState at `stamp` [ns]."""
        self._names.update(names)
        if names.count(self._gyro_joint) == 1:  # of one listed twice nobody knows which holds
            place = names.index(self._gyro_joint)
            yaw, rate = (series[place] if place < len(series) else math.nan
                         for series in (positions, velocities))
            self.add_gyro(stamp - self._delay, yaw, rate)
        sample = self._feedback.read(stamp, names, positions, velocities)
        if sample is not None:
            self._samples.append(sample)
            self._commanded.append((self._speeds, self._angles))

    def add_drive_commands(self, velocities: Sequence[float]) -> None:
        """Take velocities commanded to the drive joints [rad/s], in module order."""
        if len(velocities) == len(self._speeds):
            self._speeds = self._layout.joints.travel(velocities, [0.0] * len(velocities))

    def add_steering_commands(self, positions: Sequence[float]) -> None:
        """Take positions commanded to the steering joints [rad], in module order."""
        if len(positions) == len(self._angles):
            self._angles = self._layout.joints.module_angles(positions)

    def add_joint_commands(self, names: Sequence[str], velocities: Sequence[float],
                           positions: Sequence[float]) -> None:
        """Take a JointState of commands: velocities of drives, positions of steering joints."""
        speeds, angles = dict(zip(names, velocities)), dict(zip(names, positions))
        layout = self._layout
        if speeds.keys() >= set(layout.drive_joints):
            self.add_drive_commands([speeds[name] for name in layout.drive_joints])
        if angles.keys() >= set(layout.steering_joints):
            self.add_steering_commands([angles[name] for name in layout.steering_joints])

    def add_gyro(self, stamp: int, yaw: float, rate: float) -> None:
        """Take a gyro sample [ns], [rad], [rad/s]."""
        self._feedback.read_gyro(stamp, yaw, rate)
        self._gyro.add(stamp, yaw, rate)

    def add_imu(self, stamp: int, imu: Imu) -> None:
        """Take a sensor_msgs/Imu at `stamp` [ns], mounted as the parameters say."""
        self.add_gyro(stamp - self._delay, *self._imu.yaw_and_rate(imu_numbers(imu)))

    def add_truth(self, stamp: int, x: float, y: float, yaw: float) -> None:
        """Take a true pose [ns], [m], [m], [rad]; one that is not finite was not seen."""
        if math.isfinite(x + y + yaw):
            self._truth.append((stamp, x, y, yaw))

    def data(self) -> DriveData:
        """Return the DriveData of all; ValueError if joints are missing."""
        stamp, distances, angles = self._joints()
        yaw, rate = (with_gaps(column) for column in zip(*(
            (sample.yaw, sample.yaw_rate) for sample in self._samples)))
        speeds, commanded = (np.array(series) for series in zip(*self._commanded))
        known = bool(np.isfinite(speeds + commanded).any())
        return DriveData(stamp, distances, angles, yaw, rate,
                         speeds if known else None, commanded if known else None)

    def _joints(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return stamps [s], distances [m] and angles [rad]; ValueError if joints are missing."""
        joints = (*self._layout.drive_joints, *self._layout.steering_joints)
        missing = [joint for joint in joints if joint not in self._names]
        if missing:
            raise ValueError(f"no joint states of {', '.join(missing)}")
        if len(self._samples) < 2:
            raise ValueError('fewer than two joint states with different stamps and positions of '
                             'all modules')
        stamps = np.array([sample.stamp for sample in self._samples])
        steps = np.diff(stamps) / NANOSECONDS
        first = int(np.argmin(steps > 0.0))
        if steps[first] <= 0.0:
            raise ValueError(
                f'the stamps of the joint states jump back by {-steps[first]:.3g} s after '
                f'{(stamps[first] - stamps[0]) / NANOSECONDS:.1f} s: the clock was set, or two '
                'drives follow each other: use a recording without that')
        period = np.median(steps)
        if period > LONGEST_PERIOD:
            raise ValueError(f'joint states are {period:.3g} s apart: are the stamps in seconds?')
        return ((stamps - stamps[0]) / NANOSECONDS,
                np.array([sample.distances for sample in self._samples]),
                np.array([sample.angles for sample in self._samples]))

    def drive(self, needs_truth: bool) -> Drive:
        """Return the Drive; ValueError if joints or the truth are missing."""
        stamps = np.array([sample.stamp for sample in self._samples])
        recording = Recording(*self._joints(), self._gyro.yaw_at(stamps))
        if not needs_truth:
            return Drive(recording, None)
        if len(self._truth) < 2:
            raise ValueError('no true poses in the recording')
        return _with_truth(recording, np.array(sorted(self._truth)), self._samples[0].stamp)


def _with_truth(recording: Recording, truth: NDArray[np.float64], zero: int) -> Drive:
    """Return the Drive where the truth (m, 4) was seen; `zero` [ns] is the recording's 0 s."""
    time = (truth[:, 0] - zero) / NANOSECONDS
    after = np.searchsorted(time, recording.stamp)
    inside = (recording.stamp >= time[0]) & (after < len(time))
    after = np.clip(after, 1, len(time) - 1)
    seen = inside & (time[after] - time[after - 1] <= LONGEST_STEP)
    if np.count_nonzero(seen) < 2:
        raise ValueError('the true poses and the joint states do not overlap in time, or the '
                         f'poses are more than {LONGEST_STEP:g} s apart')
    stamp, distances, angles, yaw = recording
    series = truth[:, 1], truth[:, 2], np.unwrap(truth[:, 3])
    poses = np.column_stack([np.interp(stamp[seen], time, values) for values in series])
    return Drive(Recording(stamp[seen], distances[seen], angles[seen],
                           None if yaw is None else yaw[seen]), poses)
