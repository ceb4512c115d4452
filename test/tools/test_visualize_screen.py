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

"""swerve_visualize on a real screen: moved by the mouse, and read back by a screenshot."""

from importlib.util import find_spec
import os
from pathlib import Path
import shutil
import signal
import subprocess
import sys
import time

from matplotlib.colors import to_rgb
import numpy as np
from PIL import Image, ImageGrab
import pytest

from swerve_kinematics.tools.visualize.marks import COMMANDED

DRIVER = Path(__file__).with_name('drive_window.py')
PATIENCE = 60  # s, on a busy machine

pytestmark = pytest.mark.skipif(
    not (shutil.which('Xvfb') and find_spec('tkinter')),
    reason='a screen needs Xvfb and tkinter, which are not in PyPI')


@pytest.fixture
def screen():
    """Return the environment of a program on a small screen of its own."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ['Xvfb', '-displayfd', str(write), '-screen', '0', '1366x768x24', '-nolisten', 'tcp',
         '-noreset'],  # a reset, after the last client has gone, turns the next one away
        pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as answer:
        display = f':{answer.readline().strip()}'
    yield {**os.environ, 'DISPLAY': display, 'MPLBACKEND': 'TkAgg'}
    server.terminate()
    server.wait(PATIENCE)


def green(path):
    """Return how many pixels have the colour of a commanded velocity, left of the key."""
    pixels = np.asarray(Image.open(path).convert('RGB'))[:, :680] / 255.0
    return int((np.abs(pixels - to_rgb(COMMANDED)).max(axis=-1) < 0.02).sum())


def test_a_slider_moved_by_the_mouse_moves_the_modules_on_a_small_screen(screen, tmp_path):
    before, after = tmp_path / 'before.png', tmp_path / 'after.png'
    run = subprocess.run([sys.executable, str(DRIVER), str(before), str(after)], env=screen,
                         capture_output=True, text=True, timeout=PATIENCE)
    assert run.returncode == 0, run.stderr
    width, height = map(int, run.stdout.split())
    assert width <= 1366 and height <= 768 - 30  # room for the title bar
    assert green(before) == 0
    assert green(after) > 300


def test_ctrl_c_closes_the_window(screen):
    program = subprocess.Popen([sys.executable, '-m', 'swerve_kinematics.tools.visualize.main'],
                               env=screen, stderr=subprocess.PIPE, text=True)
    end = time.monotonic() + PATIENCE
    while not np.asarray(ImageGrab.grab(xdisplay=screen['DISPLAY'])).any():
        assert program.poll() is None and time.monotonic() < end
        time.sleep(0.1)
    program.send_signal(signal.SIGINT)
    _, errors = program.communicate(timeout=PATIENCE)
    assert program.returncode == -signal.SIGINT
    assert 'Traceback' not in errors
