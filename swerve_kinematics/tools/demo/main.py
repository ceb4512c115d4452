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
Drive a figure of eight with the real node and a simulated base.

Shows how accurate the odometry is with imperfect sensors: live in the terminal, then in one line
and a picture.
"""

import argparse
import os
from pathlib import Path
import signal
import sys

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.configuration.answers import in_words
from swerve_kinematics.configuration.options import add_version
from swerve_kinematics.configuration.physics import KINDS
from swerve_kinematics.ros.signals import heed
from swerve_kinematics.tools.demo import picture
from swerve_kinematics.tools.demo.drive_record import DriveRecord, error_ratio, summary
from swerve_kinematics.tools.demo.imperfections import IMPERFECTIONS
from swerve_kinematics.tools.processes import ProcessDied

ALLOWED_ERROR_RATIO = 0.01
# The highest ROS_DOMAIN_ID: beyond it, the ports of DDS do not suffice.
LAST_DOMAIN = 232


def report(record: DriveRecord, module_positions: NDArray[np.float64], folder: Path) -> int:
    """
    Print the summary, draw the picture, and return the exit code.

    Parameters
    ----------
    record : DriveRecord
        The whole drive.
    module_positions : ndarray (n, 2)
        [m].
    folder : pathlib.Path
        For the picture.

    Returns
    -------
    int
        0 only if the odometry stayed within 1 % of the path.

    """
    path = folder / 'figure_eight.png'
    try:
        picture.draw(record, module_positions, path)
        print(f'picture: {path}')
    except ImportError:
        print('no picture: matplotlib is not installed')
    print(summary(record))
    return 0 if error_ratio(record) <= ALLOWED_ERROR_RATIO else 1


def parse(args: list[str] | None) -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(prog='swerve_demo', description=__doc__)
    parser.add_argument('--physics', choices=KINDS, default=KINDS[0],
                        help='how the base moves: on wheels that only roll, or on tyres that '
                        'slip, in MuJoCo (default: %(default)s)')
    parser.add_argument('--output', type=Path, default=Path('demo-output'), metavar='FOLDER',
                        help='where to put the picture and the logs (default: %(default)s)')
    # Domains up to 101 are safe on every platform; 0 is where robots live.
    parser.add_argument('--domain-id', type=int, default=1 + os.getpid() % 100, metavar='ID',
                        help='ROS_DOMAIN_ID of the demo (default: derived from the process id)')
    add_version(parser)
    options = parser.parse_args(args)
    if not 0 <= options.domain_id <= LAST_DOMAIN:
        parser.error(f'--domain-id must be from 0 to {LAST_DOMAIN}')
    return options


def main(args: list[str] | None = None) -> int:
    """Run the demo; return its exit code."""
    options = parse(args)
    # --help needs no ROS.
    from swerve_kinematics.tools.demo.run import DemoFailed, run_demo
    # An exception, so that what it has started ends with it.
    heed(signal.default_int_handler)
    os.environ['ROS_DOMAIN_ID'] = str(options.domain_id)
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        print(f'starting swerve_node and swerve_sim, ROS_DOMAIN_ID={options.domain_id}')
        print(IMPERFECTIONS)
        return report(*run_demo(options.output, options.physics), options.output)
    except KeyboardInterrupt:
        print('swerve_demo: interrupted', file=sys.stderr)
        return 130
    except (DemoFailed, OSError, ProcessDied) as error:
        print(f'swerve_demo: {in_words(error)}', file=sys.stderr)
        return 1


if __name__ == '__main__':
    sys.exit(main())
