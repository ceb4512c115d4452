"""Draw what `swerve_visualize --save` draws of a base that translates while it turns."""

from pathlib import Path

from pictures import shrink

from swerve_kinematics.tools.visualize.main import main as visualize

PICTURE = Path(__file__).with_name('visualize.png')


def main(path: Path = PICTURE) -> None:
    """Draw the picture of the example on the page."""
    visualize(['--vx', '1', '--vy', '0.4', '--omega', '2', '--max-speed', '1.5',
               '--save', str(path)])
    shrink(path)


if __name__ == '__main__':
    main()
