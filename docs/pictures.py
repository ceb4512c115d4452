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
