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

"""The picture of the modules beside sliders for what is commanded."""

from typing import TYPE_CHECKING

import numpy as np

from swerve_kinematics.tools.visualize.marks import key, plain
from swerve_kinematics.tools.visualize.motion import Base, Command, motion_of
from swerve_kinematics.tools.visualize.picture import ARROW, draw

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.widgets import Slider

# With title bar and toolbar the window fits a screen of 1366 x 768 [inch, at 100 dots each].
SIZE, DPI = (12.8, 6.4), 100
# Half the range of the sliders: [m/s], [rad/s], and [1] of the base's radius; and the ends
# of the slider for the speed limit of the modules [m/s]. A command beyond them extends them.
MAX_SPEED, MAX_OMEGA, MAX_CENTER, SPEED_LIMITS = 2.0, 4.0, 2.0, (0.1, 5.0)


class Window:
    """
    The picture beside sliders that change it.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    base : Base
    command : Command
        Where the sliders start, and go back to.

    Attributes
    ----------
    axes : matplotlib.axes.Axes
        Of the picture.
    sliders : dict of str to matplotlib.widgets.Slider
    reset : matplotlib.widgets.Button

    """

    def __init__(self, figure: 'Figure', base: Base, command: Command) -> None:
        """Build the sliders and draw."""
        from matplotlib.widgets import Button

        self._base, self._figure = base, figure
        self.axes = figure.add_axes((0.05, 0.09, 0.48, 0.83))
        self.sliders: dict[str, 'Slider'] = {}
        span = MAX_CENTER * base.radius
        for label, limit, value in (
                ('vx [m/s]', MAX_SPEED, command.twist[0]),
                ('vy [m/s]', MAX_SPEED, command.twist[1]),
                ('omega [rad/s]', MAX_OMEGA, command.twist[2]),
                ('centre x [m]', span, command.center[0]),
                ('centre y [m]', span, command.center[1]),
                ('heading in the field [deg]', 180.0, np.degrees(command.heading))):
            self._add_slider(label, -max(limit, abs(value)), max(limit, abs(value)), value)
        slowest, fastest = SPEED_LIMITS
        limit = command.max_speed
        if np.isinf(limit):  # a slider has an end: as fast as the command needs
            limit = max(fastest, _fastest(base, command))
        self._add_slider('speed limit of a module [m/s]', min(slowest, limit),
                         max(fastest, limit), limit)
        self.reset = Button(figure.add_axes((0.74, 0.40, 0.16, 0.06)), 'Reset')
        self.reset.on_clicked(self._reset)
        figure.legend(handles=key(), loc='upper left', bbox_to_anchor=(0.70, 0.37),
                      frameon=False, fontsize=9)
        self._angles = np.zeros(len(base.names))
        self._redraw()

    def _add_slider(self, label: str, low: float, high: float, value: float) -> None:
        """Add a slider below the others."""
        from matplotlib.widgets import Slider

        place = (0.74, 0.90 - 0.065 * len(self.sliders), 0.19, 0.035)
        slider = Slider(self._figure.add_axes(place), label, low, high, valinit=value)
        slider.valtext.set_x(1.05)  # beside the handle at its right end, not under it
        slider.on_changed(self._redraw)
        self.sliders[label.split(' [')[0]] = slider

    def _reset(self, _: object = None) -> None:
        """Put the sliders where they started, and the modules straight ahead."""
        for slider in self.sliders.values():
            slider.eventson = False
            slider.reset()
            slider.eventson = True
        self._angles = np.zeros(len(self._base.names))
        self._redraw()

    def _redraw(self, _: object = None) -> None:
        """Draw what the sliders say."""
        for slider in self.sliders.values():
            slider.valtext.set_text(plain(slider.val, 2))
        vx, vy, omega, x, y, heading, max_speed = (
            float(slider.val) for slider in self.sliders.values())
        motion = motion_of(self._base.kinematics, Command(
            (vx, vy, omega), (x, y), float(np.radians(heading)), max_speed), self._angles)
        self._angles = motion.states.angle
        # The scale stays, so that arrows grow with the speed.
        draw(self.axes, self._base, motion, ARROW * self._base.radius / MAX_SPEED)
        self._figure.canvas.draw_idle()


def _fastest(base: Base, command: Command) -> float:
    """Return the speed [m/s] of the fastest module."""
    speeds = motion_of(base.kinematics, command, np.zeros(len(base.names))).states.speed
    return float(np.abs(speeds).max())
