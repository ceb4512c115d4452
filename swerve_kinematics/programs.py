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
The entry points of the programs.

Each imports its program only when it is called: what is not installed, and a Ctrl-C that comes
while Python still imports, end it in one line instead of a traceback.
"""

from functools import partial
from importlib import import_module
import os
import sys

CANNOT_RUN, INTERRUPTED = 2, 130
ROS = ('source the setup script of ROS 2 (such as /opt/ros/jazzy/setup.bash), or '
       'pip install ros-jazzy-rclpy ros-jazzy-rmw-fastrtps-cpp ros-jazzy-common-interfaces')
# How to install a package, where that is not `pip install` and its name.
REMEDIES = {
    'matplotlib': 'sudo apt install python3-matplotlib, or pip install matplotlib',
    'numpy': 'sudo apt install python3-numpy, or pip install numpy',
    'yaml': 'sudo apt install python3-yaml, or pip install pyyaml',
}
ROS_SUFFIXES = ('_msgs', '_srvs', '_interfaces')


def run(name: str, *functions: str) -> int:
    """
    Import a program and run it with the command line of the process.

    Parameters
    ----------
    name : str
        Of the program.
    functions : str
        `module:function` of this package; each returns an exit code, or None to let the next one
        go on, which may need more packages.

    Returns
    -------
    int
        Its exit code, or 2 if a package is missing and 130 if it was interrupted.

    Raises
    ------
    ModuleNotFoundError
        If a module of this package itself is missing.

    """
    open_closed_streams()
    try:
        codes = map(call, functions)
        return next(code for code in codes if code is not None)
    except ModuleNotFoundError as error:
        package = (error.name or '').partition('.')[0]
        if package in ('', 'swerve_kinematics'):
            raise
        print(f'{name}: {package} is not installed for this Python: {remedy(package)}',
              file=sys.stderr)
        return CANNOT_RUN
    except KeyboardInterrupt:
        print(f'{name}: interrupted', file=sys.stderr)
        return INTERRUPTED


def open_closed_streams() -> None:
    """
    Read nothing from a standard stream that is closed, and write to it in vain.

    Python has None in its place, and whatever is opened next, such as a recording, gets its
    number, under which the middleware writes to it.
    """
    for name, mode in (('stdin', 'r'), ('stdout', 'w'), ('stderr', 'w')):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode))


def call(path: str) -> int | None:
    """Import and call a function of this package; return what it returns."""
    module, _, function = path.partition(':')
    code: int | None = getattr(import_module(f'swerve_kinematics.{module}'), function)()
    return code


def remedy(package: str) -> str:
    """Return what to do to have a package."""
    if package.startswith(('rcl', 'ament_')) or package.endswith(ROS_SUFFIXES):
        return ROS
    return REMEDIES.get(package, f'pip install {package}')


swerve_node = partial(
    run, 'swerve_node', 'configuration.answers:answer_for_node', 'ros.node:main')
swerve_sim = partial(
    run, 'swerve_sim', 'configuration.answers:answer_for_simulator', 'sim.node:main')
swerve_demo = partial(run, 'swerve_demo', 'tools.demo.main:main')
swerve_visualize = partial(run, 'swerve_visualize', 'tools.visualize.main:main')
swerve_calibrate = partial(run, 'swerve_calibrate', 'tools.calibrate.main:main')
swerve_check = partial(run, 'swerve_check', 'tools.check.main:main')
