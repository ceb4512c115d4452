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
Show what a twist does to every module of a swerve base.

Opens a window with sliders for the twist, the centre of rotation, the heading in the field and
the speed limit, or writes the picture to a file. The modules start straight ahead; in the
window, each twist continues from where the previous one left them.
"""

import argparse
import math
from pathlib import Path
import re
import signal
import sys

import numpy as np

from swerve_kinematics.configuration.answers import in_words
from swerve_kinematics.configuration.layout import default_layout, LAYOUT_DECLARATIONS
from swerve_kinematics.configuration.options import add_version
from swerve_kinematics.configuration.program import read_parameters
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.tools.visualize.marks import key
from swerve_kinematics.tools.visualize.motion import Base, base_of, Command, motion_of
from swerve_kinematics.tools.visualize.picture import ARROW, draw, MIN_SPEED
from swerve_kinematics.tools.visualize.window import DPI, SIZE, Window

FOUR_MODULES = base_of(default_layout())
# A number that is larger [m/s, rad/s, m, degrees] is a slip of the finger, and may overflow.
LARGEST = 1e6
PLACES = [known for known in LAYOUT_DECLARATIONS if known.name in ('module_x', 'module_y')]


class Unusable(RuntimeError):
    """The picture cannot be made; one line that says why."""


def save(base: Base, command: Command, path: Path) -> None:
    """
    Write the picture to a file.

    Parameters
    ----------
    base : Base
        Layout and names of the modules.
    command : Command
        What is drawn.
    path : pathlib.Path
        The file.

    Raises
    ------
    Unusable
        If it cannot be written.

    """
    # The object interface: it needs no display and leaves matplotlib's global state alone.
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 9.0), layout='compressed')
    motion = motion_of(base.kinematics, command, np.zeros(len(base.names)))
    fastest = np.abs(motion.states.speed).max() / motion.share
    draw(figure.subplots(), base, motion,
         ARROW * base.radius / fastest if fastest >= MIN_SPEED else 1.0)
    figure.legend(handles=key(), loc='outside lower center', ncols=3, frameon=False, fontsize=9)
    try:
        figure.savefig(path, dpi=120)
    except (OSError, ValueError) as error:
        raise Unusable(f'--save cannot be written: {in_words(error)}') from None


def show(base: Base, command: Command) -> None:
    """
    Open the window and wait until it is closed.

    Parameters
    ----------
    base : Base
        Layout and names of the modules.
    command : Command
        What is drawn.

    Raises
    ------
    Unusable
        If there is no display.

    """
    from matplotlib import pyplot

    figure = pyplot.figure('swerve_visualize', figsize=SIZE, dpi=DPI)
    if figure.canvas.required_interactive_framework is None:
        raise Unusable('there is no display for a window; write a file with --save FILE.png')
    window = Window(figure, base, command)
    # Toolkits swallow a KeyboardInterrupt in a callback: let Ctrl-C end the process itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    pyplot.show()
    del window  # matplotlib keeps only weak references to sliders: until here they are needed


def base_from_parameters(path: Path) -> Base:
    """
    Return the base that a parameter file of swerve_node describes.

    Parameters
    ----------
    path : pathlib.Path
        YAML as for `--params-file`.

    Returns
    -------
    Base

    Raises
    ------
    Unusable
        If it describes none.

    """
    try:
        return base_of(read_parameters(path).layout)
    except (OSError, ValueError) as error:
        raise Unusable(in_words(error)) from None


def base_from_positions(positions: list[tuple[float, float]]) -> Base:
    """
    Return the base with modules at some positions.

    Parameters
    ----------
    positions : list of (float, float)
        From base_link [m].

    Returns
    -------
    Base

    Raises
    ------
    Unusable
        If a base cannot have such modules.

    """
    try:
        for place, values in zip(PLACES, zip(*positions)):
            place.check(list(values))
        return Base(tuple(f'module {index}' for index in range(len(positions))),
                    SwerveKinematics(positions))
    except ValueError as error:
        raise Unusable(f'--modules: {error}') from None


def number(text: str) -> float:
    """Return a number that can be drawn; argparse names this function where there is none."""
    value = float(text)
    if not abs(value) <= LARGEST:  # not for NaN either
        raise ValueError
    return value


def speed(text: str) -> float:
    """Return a number above 0, likewise."""
    value = number(text)
    if value < 1.0 / LARGEST:
        raise ValueError
    return value


def position(text: str) -> tuple[float, float]:
    """Return the numbers of 'x,y', likewise."""
    x, y = map(number, text.split(','))
    return x, y


def parse(args: list[str] | None) -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(prog='swerve_visualize', description=__doc__)
    for name, unit in (('vx', 'm/s'), ('vy', 'm/s'), ('omega', 'rad/s')):
        parser.add_argument(f'--{name}', type=number, default=0.0, metavar=unit.upper())
    parser.add_argument('--center', type=number, nargs=2, default=(0.0, 0.0),
                        metavar=('X', 'Y'), help='centre of rotation from base_link [m]')
    parser.add_argument('--heading', type=number, default=0.0, metavar='DEG',
                        help='heading of the base in the field; the twist is given in the field')
    parser.add_argument('--max-speed', type=speed, default=math.inf, metavar='M/S',
                        help='speed limit of a module; if one would be faster, all slow down')
    base = parser.add_mutually_exclusive_group()
    base.add_argument('--params', type=Path, metavar='FILE.yaml',
                      help='take the base from a parameter file of swerve_node')
    base.add_argument('--modules', type=position, nargs='+', metavar='X,Y',
                      help='module positions from base_link [m]')
    parser.add_argument('--save', type=Path, metavar='FILE.png',
                        help='write the picture to a file instead of opening a window')
    add_version(parser)
    # argparse takes '-0.3,0.25' for an option; what contains a space never is one.
    return parser.parse_args([re.sub(r'^-(?=[\d.])', ' -', arg)
                              for arg in (sys.argv[1:] if args is None else args)])


def main(args: list[str] | None = None) -> int:
    """Show or save the picture; return the exit code."""
    options = parse(args)
    command = Command((options.vx, options.vy, options.omega), tuple(options.center),
                      math.radians(options.heading), options.max_speed)
    try:
        base = FOUR_MODULES
        if options.params:
            base = base_from_parameters(options.params)
        elif options.modules:
            base = base_from_positions(options.modules)
        if options.save:
            save(base, command, options.save)
        else:
            show(base, command)
    except Unusable as error:
        print(f'swerve_visualize: {error}', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
