"""Draw the picture of `swerve_demo`, by running it: half a minute, with ROS."""

from pathlib import Path
from shutil import copy
from tempfile import TemporaryDirectory

from pictures import shrink

from swerve_kinematics.tools.demo.main import main as run_demo

PICTURE = Path(__file__).with_name('demo.png')


def main(path: Path = PICTURE, *arguments: str) -> None:
    """Run the demo and keep its picture."""
    with TemporaryDirectory() as folder:
        if run_demo(['--output', folder, *arguments]) != 0:
            raise SystemExit(1)
        copy(Path(folder) / 'figure_eight.png', path)
    shrink(path)


if __name__ == '__main__':
    main()
