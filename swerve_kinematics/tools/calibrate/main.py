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
Estimate wheel radii, steering offsets, and scale and delay of the gyro from a recorded drive.

The ground truth is a topic with the pose of base_link (Odometry, PoseStamped or
PoseWithCovarianceStamped), the columns truth_x, truth_y, truth_yaw of a CSV file, or the
length of a straight line. A CSV file has a column `stamp` [s] and one for each joint [rad].
"""

import argparse
from pathlib import Path
import sys

from swerve_kinematics.configuration.answers import in_words
from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.configuration.options import add_version
from swerve_kinematics.configuration.program import read_parameters
from swerve_kinematics.core.calibration.calibration import calibrate_by_poses, Calibration
from swerve_kinematics.core.calibration.line import calibrate_by_distance
from swerve_kinematics.core.checking.drive_data import DriveData
from swerve_kinematics.core.checking.joints import still_joints
from swerve_kinematics.core.checking.wording import fault_in_words
from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.tools.calibrate.report import report
from swerve_kinematics.tools.recordings.bag import read_bag, Topics
from swerve_kinematics.tools.recordings.collector import Drive
from swerve_kinematics.tools.recordings.table import is_table, read_csv, TRUTH


def calibration_of(options: argparse.Namespace, parameters: NodeParameters) -> Calibration:
    """
    Return the calibration that the command line asks for.

    Parameters
    ----------
    options : argparse.Namespace
        From `parse`.
    parameters : NodeParameters
        With the values so far.

    Returns
    -------
    Calibration

    Raises
    ------
    ValueError
        If the recording is of no use, with one line that says why.

    """
    by_poses = options.distance is None
    if is_table(options.recording):
        drive = read_csv(options.recording, parameters, by_poses).drive(by_poses)
    elif by_poses and options.truth_topic is None:
        raise ValueError('name the ground truth of the bag: --truth-topic or --distance')
    else:
        drive = read_bag(options.recording, parameters, Topics(
            options.joint_states_topic, options.imu_topic,
            options.truth_topic if by_poses else None)).drive(by_poses)
    try:
        return _calibrated(options, parameters, drive)
    except ValueError as error:
        still = [fault_in_words(fault, parameters.layout.module_names)[0]
                 for fault in still_joints(DriveData(*drive.recording[:3]))]
        if not still:
            raise
        raise ValueError(f'{"; ".join(still)}: run swerve_check first ({error})') from error


def _calibrated(options: argparse.Namespace, parameters: NodeParameters,
                drive: Drive) -> Calibration:
    """Return the calibration from a drive, with or without poses."""
    kinematics, count = parameters.layout.kinematics, TURN / options.encoder_counts
    if drive.poses is not None:
        return calibrate_by_poses(kinematics, drive.recording, drive.poses, count, options.pushed)
    return calibrate_by_distance(kinematics, drive.recording, options.distance,
                                 options.distance_std, count, options.pushed)


def parse(args: list[str] | None) -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(
        prog='swerve_calibrate', description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('recording', type=Path, help='CSV file or rosbag2 folder')
    parser.add_argument('--params', type=Path, required=True, metavar='YAML',
                        help='parameter file of swerve_node, with the present values')
    truth = parser.add_mutually_exclusive_group()
    truth.add_argument('--truth-topic', metavar='TOPIC',
                       help='topic of the true poses of base_link in the bag')
    truth.add_argument('--distance', type=float, metavar='METRES',
                       help='length of the drive, which is a straight line')
    parser.add_argument('--distance-std', type=float, default=0.002, metavar='METRES',
                        help='standard deviation of that length (default: %(default)s)')
    parser.add_argument('--pushed', action='store_true',
                        help='the base was pushed with its motors off: the wheels rolled freely')
    parser.add_argument('--encoder-counts', type=int, default=4096, metavar='COUNTS',
                        help='counts per turn of a steering encoder (default: %(default)s)')
    parser.add_argument('--joint-states-topic', default='/joint_states', metavar='TOPIC',
                        help='joint states in the bag (default: %(default)s)')
    parser.add_argument('--imu-topic', default='/imu', metavar='TOPIC',
                        help='IMU in the bag, read if gyro_source is imu (default: %(default)s)')
    add_version(parser)
    options = parser.parse_args(args)
    if options.encoder_counts < 1 or not options.distance_std >= 0.0:
        parser.error('--encoder-counts must be 1 or more, --distance-std 0 or more')
    if options.truth_topic is not None and is_table(options.recording):
        parser.error(f"a CSV file has no topics: its truth is {', '.join(TRUTH)}")
    return options


def main(args: list[str] | None = None) -> int:
    """Calibrate and print the result; return the exit code."""
    options = parse(args)
    try:
        parameters = read_parameters(options.params)
        print(report(parameters, calibration_of(options, parameters)))
    except (OSError, ValueError) as error:
        print(f'swerve_calibrate: {in_words(error)}', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
