"""The picture of the modules above sliders for the twist and the centre of rotation."""

import numpy as np
from swerve_kinematics.tools.visualize.picture import ARROW, asked_states, draw

# Half the range of the sliders: [m/s], [rad/s], and [1] of the base's radius.
MAX_SPEED, MAX_OMEGA, MAX_CENTER = 2.0, 4.0, 2.0


class Window:
    """
    The picture above sliders that change it.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    base : Base
    twist : list of float (3,)
        Where the sliders start [m/s, m/s, rad/s].
    center : list of float (2,)
        Likewise, from base_link [m].

    Attributes
    ----------
    axes : matplotlib.axes.Axes
        Of the picture.
    sliders : dict of str to matplotlib.widgets.Slider

    """

    def __init__(self, figure, base, twist, center):
        """Build the sliders and draw."""
        from matplotlib.widgets import Slider

        self._base, self._figure = base, figure
        self._angles = np.zeros(len(base.names))
        self.axes = figure.add_axes((0.10, 0.36, 0.85, 0.57))
        span = MAX_CENTER * base.radius
        self.sliders = {}
        for row, (label, limit, value) in enumerate((
                ('vx [m/s]', MAX_SPEED, twist[0]), ('vy [m/s]', MAX_SPEED, twist[1]),
                ('omega [rad/s]', MAX_OMEGA, twist[2]),
                ('centre x [m]', span, center[0]), ('centre y [m]', span, center[1]))):
            limit = max(limit, abs(value))
            slider = Slider(figure.add_axes((0.25, 0.21 - 0.04 * row, 0.55, 0.03)), label,
                            -limit, limit, valinit=value)
            slider.on_changed(self._redraw)
            self.sliders[label.split(' [')[0]] = slider
        self._redraw()

    def _redraw(self, _=None):
        """Draw what the sliders say."""
        vx, vy, omega, x, y = (slider.val for slider in self.sliders.values())
        states = asked_states(self._base.kinematics, (vx, vy, omega), (x, y), self._angles)
        self._angles = states.angle
        # The scale stays, so that arrows grow with the speed.
        draw(self.axes, self._base, (vx, vy, omega), (x, y), states,
             ARROW * self._base.radius / MAX_SPEED)
        self._figure.canvas.draw_idle()
