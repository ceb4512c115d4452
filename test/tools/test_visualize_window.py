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

"""The window of swerve_visualize: moved by the mouse, and read back."""

from matplotlib.backend_bases import MouseEvent
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.quiver import Quiver
import numpy as np
import pytest
from swerve_kinematics.tools.visualize.main import FOUR_MODULES
from swerve_kinematics.tools.visualize.marks import (
    COMMANDED, INSTANT, REVERSED, TRANSLATION, UNLIMITED)
from swerve_kinematics.tools.visualize.motion import Command
from swerve_kinematics.tools.visualize.picture import ARROW
from swerve_kinematics.tools.visualize.window import DPI, MAX_SPEED, SIZE, Window

REST = Command((0.0, 0.0, 0.0))
SCALE = ARROW * FOUR_MODULES.radius / MAX_SPEED
# What a window has besides the picture: title bar and toolbar [pixels].
AROUND = 100


class Canvas(FigureCanvasAgg):
    """A real canvas that puts off what can wait, like one on a screen: until a test looks."""

    def draw_idle(self):
        """Draw later."""


@pytest.fixture
def figure():
    """Return a figure of the window's size, with a real canvas."""
    figure = Figure(figsize=SIZE, dpi=DPI)
    Canvas(figure)
    return figure


def press(axes, x, y=0.5):
    """Press and release the mouse at a place in a widget, as shares of its width and height."""
    canvas = axes.figure.canvas
    place = axes.transAxes.transform((x, y))
    for name in 'button_press_event', 'button_release_event':
        canvas.callbacks.process(name, MouseEvent(name, canvas, *place, button=1))


def move(window, name, value):
    """Press the mouse on a slider where it has a value."""
    slider = window.sliders[name]
    data = slider.ax.transData.transform((value, 0.5))
    press(slider.ax, *slider.ax.transAxes.inverted().transform(data))


def ink(window, color):
    """Return how many pixels of the drawing, without the key, have a colour."""
    window.axes.figure.canvas.draw()
    pixels = np.asarray(window.axes.figure.canvas.buffer_rgba())[::-1, :, :3] / 255.0
    box = window.axes.get_window_extent()
    inside = pixels[int(box.y0):int(box.y1), int(box.x0):int(box.x1)]
    return int((np.abs(inside - to_rgb(color)).max(axis=-1) < 0.02).sum())


def arrows(window):
    """Return the vectors [m], (k, 2), of all arrows by their label."""
    return {quiver.get_label(): np.stack((quiver.U, quiver.V), axis=-1)
            for quiver in window.axes.collections if isinstance(quiver, Quiver)}


def test_everything_is_on_a_small_screen(figure):
    window = Window(figure, FOUR_MODULES, REST)
    width, height = figure.get_size_inches() * DPI
    assert width <= 1366 and height + AROUND <= 768
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    boxes = [box for slider in window.sliders.values() for box in (
        slider.ax.get_window_extent(), slider.label.get_window_extent(renderer),
        slider.valtext.get_window_extent(renderer))]
    boxes += [window.reset.ax.get_window_extent(), figure.legends[0].get_window_extent(renderer)]
    for box in boxes:
        assert 0.0 <= box.x0 and box.x1 <= width and 0.0 <= box.y0 and box.y1 <= height
        assert not box.overlaps(window.axes.get_window_extent())
    for one, other in zip(window.sliders.values(), list(window.sliders.values())[1:]):
        assert one.ax.get_window_extent().y0 > other.ax.get_window_extent().y1


def test_the_mouse_on_a_slider_changes_the_picture(figure):
    window = Window(figure, FOUR_MODULES, REST)
    assert ink(window, COMMANDED) == ink(window, TRANSLATION) == 0
    move(window, 'vx', 1.0)
    np.testing.assert_allclose(arrows(window)['commanded'], np.tile((SCALE, 0.0), (4, 1)),
                               atol=0.02 * SCALE)
    slow = ink(window, COMMANDED)
    move(window, 'vx', 2.0)
    assert ink(window, COMMANDED) > slow > 100
    assert ink(window, TRANSLATION) > 50
    assert window.sliders['vx'].valtext.get_text() == '2.00'


def test_modules_stay_where_they_were_turned_to(figure):
    window = Window(figure, FOUR_MODULES, REST)
    window.sliders['vx'].set_val(1.0)
    window.sliders['vy'].set_val(1.0)
    # By way of the diagonal the wheels have turned to +90 degrees: right is reversed then.
    window.sliders['vx'].set_val(0.0)
    window.sliders['vy'].set_val(-1.0)
    assert set(arrows(window)) == {'translation', 'commanded, drive reversed'}
    assert ink(window, REVERSED) > 50
    window.sliders['omega'].set_val(1.0)
    window.sliders['centre x'].set_val(0.3)
    window.sliders['centre y'].set_val(0.25)
    assert len(arrows(window)['rotation']) == 3  # the front left module stands at the centre


def test_heading_and_speed_limit_have_their_sliders(figure):
    window = Window(figure, FOUR_MODULES, REST)
    move(window, 'vx', 1.5)
    move(window, 'heading in the field', 90.0)
    np.testing.assert_allclose(arrows(window)['translation'],
                               np.tile((0.0, -1.5 * SCALE), (4, 1)), atol=0.05 * SCALE)
    assert ink(window, UNLIMITED) == 0
    move(window, 'speed limit of a module', 0.5)
    assert np.hypot(*arrows(window)['translation'].T).max() == pytest.approx(
        0.5 * SCALE, abs=0.05 * SCALE)
    assert ink(window, UNLIMITED) > 50
    assert 'slowed to' in window.axes.get_title()


@pytest.mark.parametrize('max_speed, executed', [(np.inf, 8.0), (7.0, 7.0), (0.05, 0.05)])
def test_the_window_starts_with_the_speed_and_the_limit_that_are_given(
        figure, max_speed, executed):
    window = Window(figure, FOUR_MODULES, Command((8.0, 0.0, 0.0), max_speed=max_speed))
    assert window.axes.get_title().startswith(f'vx {executed:.2f} m/s')


@pytest.mark.parametrize('end', ['valmin', 'valmax'])
def test_every_slider_draws_at_both_of_its_ends(figure, end):
    window = Window(figure, FOUR_MODULES, Command((1.0, 0.5, 1.0)))
    for slider in window.sliders.values():
        slider.set_val(getattr(slider, end))
        figure.canvas.draw()
    assert sum(len(vectors) for vectors in arrows(window).values()) >= 4


def test_the_instantaneous_centre_appears_as_soon_as_the_base_turns(figure):
    window = Window(figure, FOUR_MODULES, REST)
    without = ink(window, INSTANT)
    move(window, 'omega', 1.0)
    assert ink(window, INSTANT) > without + 30


def test_reset_takes_everything_back(figure):
    window = Window(figure, FOUR_MODULES, Command((0.5, 0.0, 0.0)))
    figure.canvas.draw()
    before = np.array(figure.canvas.buffer_rgba())
    for name in window.sliders:
        window.sliders[name].set_val(0.3 * window.sliders[name].valmax)
    window.sliders['vy'].set_val(-0.0001)
    assert window.sliders['vy'].valtext.get_text() == '0.00'
    press(window.reset.ax, 0.5)
    figure.canvas.draw()
    changed = np.array(figure.canvas.buffer_rgba()) != before
    # All but the button, which the mouse is on.
    box = window.reset.ax.get_window_extent()
    height = int(figure.bbox.height)
    changed[height - int(box.y1) - 2:height - int(box.y0) + 2] = False
    assert not changed.any()
