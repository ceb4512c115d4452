"""A recorded drive from a CSV file or a rosbag2: encoders, gyro and truth at the same stamps."""

import csv
import math
from typing import NamedTuple, Optional

import numpy as np

from swerve_kinematics.core.calibration.recording import LONGEST_STEP, Recording
from swerve_kinematics.ros.conversions import imu_yaw_and_rate, planar_pose
from swerve_kinematics.ros.feedback import JointFeedback
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds, nanoseconds_of

STAMP = 'stamp'
TRUTH = ('truth_x', 'truth_y', 'truth_yaw')


class Topics(NamedTuple):
    """Names of the topics in a bag; `truth` is None where the truth is known otherwise."""

    joint_states: str
    imu: str
    truth: Optional[str]


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
    poses: Optional[np.ndarray]


class _Collector:
    """Puts joint states, gyro samples and true poses together, as the node does."""

    def __init__(self, parameters, gyro_sources):
        """Start empty; the gyro joint counts where the parameters name one of the sources."""
        self._layout = parameters.layout
        has_joint = parameters.gyro_source in gyro_sources
        self._feedback = JointFeedback(
            parameters.layout, parameters.layout.gyro_joint if has_joint else None,
            nanoseconds(parameters.feedback_timeout), nanoseconds(parameters.gyro_timeout))
        self._names, self._samples, self._truth = set(), [], []

    def add_joints(self, stamp, names, positions, velocities):
        """Take a JointState at `stamp` [ns]."""
        self._names.update(names)
        sample = self._feedback.read(stamp, names, positions, velocities)
        if sample is not None:
            self._samples.append(sample)

    def add_gyro(self, stamp, yaw, rate):
        """Take a gyro sample [ns], [rad], [rad/s]."""
        self._feedback.read_gyro(stamp, yaw, rate)

    def add_truth(self, stamp, x, y, yaw):
        """Take a true pose [ns], [m], [m], [rad]; one that is not finite was not seen."""
        if math.isfinite(x + y + yaw):
            self._truth.append((stamp, x, y, yaw))

    def drive(self, needs_truth):
        """Return the Drive; ValueError if joints or the truth are missing."""
        joints = (*self._layout.drive_joints, *self._layout.steering_joints)
        missing = [joint for joint in joints if joint not in self._names]
        if missing:
            raise ValueError(f"no joint state of {', '.join(missing)}")
        if len(self._samples) < 2:
            raise ValueError('no two joint states in which all modules have positions')
        stamps = np.array([sample.stamp for sample in self._samples])
        recording = Recording(
            (stamps - stamps[0]) / NANOSECONDS,
            np.array([sample.distances for sample in self._samples]),
            np.array([sample.angles for sample in self._samples]), _yaw(self._samples))
        if not needs_truth:
            return Drive(recording, None)
        if len(self._truth) < 2:
            raise ValueError('no true poses in the recording')
        return _with_truth(recording, np.array(sorted(self._truth)), stamps[0])


def _yaw(samples):
    """Return the gyro's yaw (t,) [rad], integrated where it gives rates only, or None."""
    yaw = np.array([np.nan if sample.yaw is None else sample.yaw for sample in samples])
    if np.isfinite(yaw).any():
        return yaw
    rate = np.array([np.nan if sample.yaw_rate is None else sample.yaw_rate
                     for sample in samples])
    if not np.isfinite(rate).all():
        return None
    time = np.diff([sample.stamp for sample in samples]) / NANOSECONDS
    return np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * time)))


def _with_truth(recording, truth, zero):
    """Return the Drive where the truth (m, 4) was seen; `zero` [ns] is the recording's 0 s."""
    time = (truth[:, 0] - zero) / NANOSECONDS
    after = np.searchsorted(time, recording.stamp)
    inside = (recording.stamp >= time[0]) & (after < len(time))
    after = np.clip(after, 1, len(time) - 1)
    seen = inside & (time[after] - time[after - 1] <= LONGEST_STEP)
    if np.count_nonzero(seen) < 2:
        raise ValueError('the true poses and the joint states are of different times')
    stamp, distances, angles, yaw = recording
    series = truth[:, 1], truth[:, 2], np.unwrap(truth[:, 3])
    poses = np.column_stack([np.interp(stamp[seen], time, values) for values in series])
    return Drive(Recording(stamp[seen], distances[seen], angles[seen],
                           None if yaw is None else yaw[seen]), poses)


def read_csv(path, parameters, needs_truth):
    """
    Return the Drive in a CSV file.

    The first row names the columns: `stamp` [s], joints (positions [rad]) and, if there is a
    truth, `truth_x`, `truth_y` [m], `truth_yaw` [rad]. Other columns do not matter.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    parameters : NodeParameters
        With the values so far.
    needs_truth : bool
        Whether the true poses are of interest.

    Returns
    -------
    Drive

    Raises
    ------
    ValueError
        If a column is missing or an entry is not a finite number.

    """
    # A table has no IMU: what it has of a gyro stands in the column of the joint.
    collector = _Collector(parameters, ('joint', 'imu'))
    layout = parameters.layout
    with path.open(newline='') as file:
        reader = csv.DictReader(file)
        columns = reader.fieldnames or []
        joints = [name for name in columns if name in {
            *layout.drive_joints, *layout.steering_joints, layout.gyro_joint}]
        used = [STAMP, *(TRUTH if needs_truth else ())]
        missing = [name for name in used if name not in columns]
        if missing:
            raise ValueError(f"{path} has no column {', '.join(missing)}")
        for row in reader:
            stamp, *truth = (_number(row, name, reader.line_num) for name in used)
            positions = [_number(row, name, reader.line_num) for name in joints]
            collector.add_joints(nanoseconds(stamp), joints, positions, [])
            if needs_truth:
                collector.add_truth(nanoseconds(stamp), *truth)
    return collector.drive(needs_truth)


def _number(row, name, line):
    """Return an entry of a row as a finite number."""
    try:
        value = float(row[name])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"line {line}: '{name}' is not a finite number: {row[name]}")
    return value


def read_bag(path, parameters, topics):
    """
    Return the Drive in a rosbag2, of either storage.

    Parameters
    ----------
    path : pathlib.Path
        The folder.
    parameters : NodeParameters
        With the values so far.
    topics : Topics
        The truth may be Odometry, PoseStamped or PoseWithCovarianceStamped.

    Returns
    -------
    Drive

    Raises
    ------
    ValueError
        If a topic, joint or the library for bags is missing, or the bag cannot be read.

    """
    try:
        from rosbags.highlevel import AnyReader, AnyReaderError
        from rosbags.typesys import get_typestore, Stores
    except ImportError:
        raise ValueError("bags need the package 'rosbags': pip install rosbags") from None
    collector = _Collector(parameters, ('joint',))
    takers = {topics.joint_states: _take_joints}
    if topics.truth is not None:
        takers[topics.truth] = _take_truth
    if parameters.gyro_source == 'imu':
        takers[topics.imu] = _take_imu
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
            connections = [c for c in reader.connections if c.topic in takers]
            missing = sorted(set(takers) - {c.topic for c in connections})
            if missing:
                there = ', '.join(sorted(c.topic for c in reader.connections))
                raise ValueError(f"{path} has no topic {', '.join(missing)}, but: {there}")
            for connection, received, data in reader.messages(connections):
                message = reader.deserialize(data, connection.msgtype)
                takers[connection.topic](collector, message, received)
    except (AnyReaderError, AttributeError) as error:
        raise ValueError(f'{path} cannot be read: {error}') from None
    return collector.drive(topics.truth is not None)


def _stamp(message, received):
    """Return the stamp of a message [ns], or when it was received if it has none."""
    return nanoseconds_of(message.header.stamp) or received


def _take_joints(collector, message, received):
    """Hand a sensor_msgs/JointState to the collector."""
    collector.add_joints(
        _stamp(message, received), message.name, message.position, message.velocity)


def _take_imu(collector, message, received):
    """Hand a sensor_msgs/Imu to the collector."""
    collector.add_gyro(_stamp(message, received), *imu_yaw_and_rate(message))


def _take_truth(collector, message, received):
    """Hand a pose, with or without covariance and twist, to the collector."""
    pose = getattr(message.pose, 'pose', message.pose)
    collector.add_truth(_stamp(message, received), *planar_pose(pose))
