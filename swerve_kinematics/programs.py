"""
The entry points of the programs.

Each imports its program only when it is called: what is not installed, and a Ctrl-C that comes
while Python still imports, end it in one line instead of a traceback.
"""

from functools import partial
from importlib import import_module
import sys

CANNOT_RUN, INTERRUPTED = 2, 130
ROS = ('source the setup script of ROS 2 (/opt/ros/jazzy/setup.bash, say), or '
       'pip install ros-jazzy-rclpy ros-jazzy-rmw-fastrtps-cpp ros-jazzy-common-interfaces')
# How to install a package, where that is not `pip install` and its name.
REMEDIES = {
    'matplotlib': 'sudo apt install python3-matplotlib, or pip install matplotlib',
    'numpy': 'sudo apt install python3-numpy, or pip install numpy',
    'yaml': 'sudo apt install python3-yaml, or pip install pyyaml',
}
ROS_SUFFIXES = ('_msgs', '_srvs', '_interfaces')


def run(name: str, module: str) -> int:
    """
    Import a program and run it with the command line of the process.

    Parameters
    ----------
    name : str
        Of the program.
    module : str
        Of this package, with a function `main()` that returns an exit code.

    Returns
    -------
    int
        Its exit code, or 2 if a package is missing and 130 if it was interrupted.

    Raises
    ------
    ModuleNotFoundError
        If a module of this package itself is missing.

    """
    try:
        return int(import_module(f'swerve_kinematics.{module}').main())
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


def remedy(package: str) -> str:
    """Return what to do to have a package."""
    if package.startswith(('rcl', 'ament_')) or package.endswith(ROS_SUFFIXES):
        return ROS
    return REMEDIES.get(package, f'pip install {package}')


swerve_node = partial(run, 'swerve_node', 'ros.node')
swerve_sim = partial(run, 'swerve_sim', 'sim.node')
swerve_demo = partial(run, 'swerve_demo', 'tools.demo.main')
swerve_visualize = partial(run, 'swerve_visualize', 'tools.visualize.main')
swerve_calibrate = partial(run, 'swerve_calibrate', 'tools.calibrate.main')
swerve_check = partial(run, 'swerve_check', 'tools.check.main')
