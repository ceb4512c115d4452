"""Draw the picture of `swerve_demo --physics mujoco`, by running it: half a minute, with ROS."""

from pathlib import Path

from demo import main as draw_demo

PICTURE = Path(__file__).with_name('demo_physics.png')


def main(path: Path = PICTURE) -> None:
    """Run the demo on tyres and keep its picture."""
    draw_demo(path, '--physics', 'mujoco')


if __name__ == '__main__':
    main()
