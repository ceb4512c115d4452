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

"""Draw the pictures of the pages anew, all or those named: each script draws its own PNG."""

from pathlib import Path
import runpy
import sys

from matplotlib.figure import Figure
from PIL import Image

FOLDER = Path(__file__).resolve().parent
NAMES = ('architecture', 'calibration', 'check', 'conventions', 'demo', 'demo_physics',
         'diagnostics', 'physics', 'slip', 'unreachable', 'visualize')
# Enough for lines and letters, at a third of the size.
COLORS = 256


def shrink(path: Path) -> None:
    """Write a picture anew with few colours."""
    with Image.open(path) as picture:
        small = picture.convert('RGB').quantize(COLORS)
    small.save(path, optimize=True)


def save(figure: Figure, path: Path) -> None:
    """Write a figure as a small PNG."""
    figure.savefig(path, dpi=100)
    shrink(path)


def main() -> None:
    """Run the scripts of the pictures."""
    for name in sys.argv[1:] or NAMES:
        print(f'docs/{name}.png')
        runpy.run_path(str(FOLDER / f'{name}.py'))['main']()


if __name__ == '__main__':
    main()
