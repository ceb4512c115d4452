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
Find out what is wrong with a base, and which parameters correct it.

Uses a recorded drive (CSV or rosbag2), a live one that you drive by hand (--live SECONDS, while
swerve_node runs), motions of one joint at a time with the wheels off the floor (--on-blocks,
without swerve_node), or small motions on the floor (--on-floor, with swerve_node). A CSV file has
a column `stamp` [s], one for each joint [rad], and if possible `JOINT_command` with the command
of each [rad/s, rad]. Exit code: 0 all is well, 1 something is wrong, 2 it could not decide.
"""

import argparse
from pathlib import Path
import sys

from swerve_kinematics.configuration.answers import in_words
from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.configuration.options import add_version
from swerve_kinematics.configuration.program import read_parameters
from swerve_kinematics.configuration.summary import REMARK, summary
from swerve_kinematics.core.checking.check import check
from swerve_kinematics.core.checking.eye import as_seen
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.tools.check.questions import Questions, said
from swerve_kinematics.tools.check.report import exit_code, report, UNKNOWN
from swerve_kinematics.tools.recordings.bag import read_bag, Topics
from swerve_kinematics.tools.recordings.collector import Collector
from swerve_kinematics.tools.recordings.table import is_table, read_csv

# For how long each joint, or axis, is moved [s].
ON_BLOCKS, ON_FLOOR = 1.5, 2.5
SHORTEST_STEP, LONGEST_STEP = 0.3, 10.0


def verdict_of(collector: Collector, parameters: NodeParameters) -> Verdict:
    """Return what a collected drive tells; ValueError if joints are missing."""
    return check(parameters.layout.kinematics.module_positions, collector.data(),
                 expects_gyro=parameters.gyro_source != 'none')


def collected(options: argparse.Namespace, parameters: NodeParameters,
              ros_arguments: list[str]) -> Collector:
    """
    Return the drive that the command line asks for.

    Parameters
    ----------
    options : argparse.Namespace
        From `parse`.
    parameters : NodeParameters
        The description to be checked.
    ros_arguments : list of str
        For a node.

    Returns
    -------
    Collector

    """
    if options.recording is not None and is_table(options.recording):
        return read_csv(options.recording, parameters, needs_truth=False)
    if options.recording is not None:
        return read_bag(options.recording, parameters, Topics(
            options.joint_states_topic, options.imu_topic, None,
            options.drive_commands_topic, options.steering_commands_topic,
            options.joint_commands_topic))
    # Files need no graph.
    from swerve_kinematics.tools.check.live import driven_by_hand
    return driven_by_hand(parameters, options.live, ros_arguments)


def parse(args: list[str]) -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(
        prog='swerve_check', description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    _add_options(parser)
    for name, default in (('joint-states', '/joint_states'), ('imu', '/imu'),
                          ('drive-commands', '/drive_velocity_controller/commands'),
                          ('steering-commands', '/steering_position_controller/commands'),
                          ('joint-commands', '/joint_commands')):
        parser.add_argument(f'--{name}-topic', default=default, metavar='TOPIC',
                            help='its name in a bag (default: %(default)s)')
    add_version(parser)
    options = parser.parse_args(args)
    complaint = _complaint(options)
    if complaint is not None:
        parser.error(complaint)
    return options


def _add_options(parser: argparse.ArgumentParser) -> None:
    """Give a command line what there is to check, and how."""
    parser.add_argument('recording', type=Path, nargs='?', help='CSV file or rosbag2 folder')
    parser.add_argument('--params', type=Path, required=True, metavar='YAML',
                        help='parameter file of swerve_node')
    parser.add_argument('--live', type=float, metavar='SECONDS',
                        help='watch for this time while you drive')
    parser.add_argument('--on-blocks', action='store_true',
                        help='move one joint at a time, with the wheels off the floor')
    parser.add_argument('--on-floor', action='store_true',
                        help='move the base along one axis at a time; needs 2 m of space on '
                        'every side, more with a longer --step')
    parser.add_argument('--step', type=float, metavar='SECONDS',
                        help='how long to move each joint, or along each axis (default: '
                        f'{ON_BLOCKS:g} on blocks, {ON_FLOOR:g} on the floor)')
    parser.add_argument('--yes', action='store_true',
                        help='answer every question with yes; for a simulated base')
    parser.add_argument('--save', type=Path, metavar='PICTURE',
                        help="draw each module's expected and measured motion")


def _complaint(options: argparse.Namespace) -> str | None:
    """Return what is wrong with the options taken together, None if nothing is."""
    sources = (options.recording is not None, options.live is not None, options.on_blocks,
               options.on_floor)
    if sum(sources) != 1:
        return 'give one of: a recording, --live, --on-blocks, --on-floor'
    if options.live is not None and not 0.0 < options.live < 3600.0:
        return '--live must be more than 0 s and less than 3600 s'
    if options.step is not None and not (options.on_blocks or options.on_floor):
        return '--step needs --on-blocks or --on-floor'
    if options.step is not None and not SHORTEST_STEP <= options.step <= LONGEST_STEP:
        return f'--step must be from {SHORTEST_STEP:g} to {LONGEST_STEP:g} s'
    if options.save is not None and options.on_blocks:
        return '--save draws a drive, and on blocks there is none'
    return None


def _checked(options: argparse.Namespace, ros_arguments: list[str]) -> int:
    """Check as the options say, print the result, and return the exit code."""
    parameters = read_parameters(options.params)
    if REMARK in (understood := summary(parameters)):
        # What a drive makes of it, such as a layout in inches, looks like something else.
        said(f'{options.params}: {understood}\n', sys.stderr)
    questions = Questions(options.yes)
    if options.on_blocks:
        from swerve_kinematics.tools.check.blocks import checked_on_blocks
        verdict = checked_on_blocks(
            parameters, questions, options.step or ON_BLOCKS, ros_arguments)
        said(report(parameters, verdict, is_still=True))
        return exit_code(verdict)
    answers: list[bool] = []
    if options.on_floor:
        from swerve_kinematics.tools.check.floor import driven_on_the_floor
        collector, answers = driven_on_the_floor(
            parameters, questions, options.step or ON_FLOOR, ros_arguments)
    else:
        collector = collected(options, parameters, ros_arguments)
    verdict = verdict_of(collector, parameters)
    if answers:
        verdict = as_seen(verdict, parameters.layout.kinematics.module_positions,
                          collector.data(), answers)
    said(report(parameters, verdict, collector.found_period))
    if options.save is not None:
        from swerve_kinematics.tools.check.picture import save
        save(options.save, parameters, collector.data(), verdict)
    return exit_code(verdict)


def main(args: list[str] | None = None) -> int:
    """Check and print the result; return the exit code."""
    args = sys.argv[1:] if args is None else args
    split = args.index('--ros-args') if '--ros-args' in args else len(args)
    options = parse(args[:split])
    try:
        return _checked(options, args[split:])
    except (OSError, ValueError) as error:
        said(f'swerve_check: {in_words(error)}', sys.stderr)
        return UNKNOWN
    except KeyboardInterrupt:
        said('swerve_check: interrupted', sys.stderr)
        return UNKNOWN


if __name__ == '__main__':
    sys.exit(main())
