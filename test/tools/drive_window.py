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

"""Opens swerve_visualize on the screen, moves a slider with the mouse, and saves what is seen."""

import os
import sys

from matplotlib import pyplot
from PIL import ImageGrab

from swerve_kinematics.tools.visualize import main

SHARE = 0.9  # of the slider's length


def moved(before, after):
    """Return a show() that drags the first slider, saves the screen twice and ends."""
    show = pyplot.show

    def look(path):
        pyplot.gcf().canvas.draw()
        pyplot.gcf().canvas.get_tk_widget().update()
        ImageGrab.grab(xdisplay=os.environ['DISPLAY']).save(path)

    def drag():
        figure = pyplot.gcf()
        look(before)
        widget, slider = figure.canvas.get_tk_widget(), figure.axes[1]
        x, y = slider.transAxes.transform((SHARE, 0.5))
        place = {'x': round(x), 'y': round(widget.winfo_height() - y)}
        for event in '<ButtonPress-1>', '<ButtonRelease-1>':
            widget.event_generate(event, **place)
        look(after)
        top = widget.winfo_toplevel()
        print(top.winfo_width(), top.winfo_height())
        pyplot.close(figure)

    def show_and_drag():
        pyplot.gcf().canvas.get_tk_widget().after(200, drag)
        show()
    return show_and_drag


if __name__ == '__main__':
    pyplot.show = moved(*sys.argv[1:])
    sys.exit(main.main([]))
