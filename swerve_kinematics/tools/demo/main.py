"""
swerve_demo: the real node and a simulated base drive a figure of eight.

Shows what the odometry makes of imperfect sensors: live in the terminal, then as one line
and a picture.
"""

import argparse
from collections.abc import Iterator, Sequence
import os
from pathlib import Path
import signal
import sys
from time import monotonic

import numpy as np
from numpy.typing import NDArray
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from swerve_kinematics.configuration.command_line import add_version
from swerve_kinematics.tools.demo import picture
from swerve_kinematics.tools.demo.drive_record import DriveRecord, error_ratio, summary
from swerve_kinematics.tools.demo.driver import DemoDriver
from swerve_kinematics.tools.demo.figure_eight import FigureEight
from swerve_kinematics.tools.demo.progress import Progress
from swerve_kinematics.tools.processes import NodeProcess, ProcessDied, running

FIGURE = FigureEight(length=6.0, width=3.0, turns=2, duration=24.0, ramp=2.0)
# An ordinary robot: 12-bit encoders, a cheap gyro, a sample lost now and then.
FAULTS = {
    'encoder_resolution': 4096,
    'gyro_bias': round(np.radians(0.5), 6),
    'gyro_noise_density': 2.5e-4,
    'dropped_sample_probability': 0.02,
    'seed': 1,
}
IMPERFECTIONS = (
    'simulated imperfections: encoders of {encoder_resolution} counts a turn, a gyro with a bias '
    'of {bias:.1f} deg/s and noise, {lost:.0%} of the samples lost').format(
        **FAULTS, bias=np.degrees(FAULTS['gyro_bias']), lost=FAULTS['dropped_sample_probability'])
# What swerve_sim's parameter of that name takes.
PHYSICS = 'rolling', 'mujoco'
ALLOWED_ERROR_RATIO = 0.01
# How long [s] to wait for the nodes to find each other, for the next odometry, and for the
# base to stand after the figure.
START_TIMEOUT, SILENCE_TIMEOUT, STOP_TIMEOUT = 30.0, 2.0, 5.0


class DemoFailed(RuntimeError):
    """The demo cannot go on; one line that says why."""


def spin(driver: DemoDriver, processes: Sequence[NodeProcess]) -> Iterator[float]:
    """
    Spin a node while processes live.

    Parameters
    ----------
    driver : DemoDriver
        The node.
    processes : list of NodeProcess
        Checked before each turn of the executor.

    Yields
    ------
    float
        Time since the first turn [s], after each turn of the executor.

    Raises
    ------
    ProcessDied

    """
    executor = SingleThreadedExecutor()
    executor.add_node(driver)
    start = monotonic()
    while True:
        for process in processes:
            process.check()
        executor.spin_once(timeout_sec=0.1)
        yield monotonic() - start


def drive(driver: DemoDriver, processes: Sequence[NodeProcess], progress: Progress) -> None:
    """
    Drive the figure from the first sign of life to standstill.

    Parameters
    ----------
    driver : DemoDriver
        Sends the commands and notes what comes back.
    processes : list of NodeProcess
        Must live until the end.
    progress : Progress
        Shows the drive while it lasts.

    Raises
    ------
    DemoFailed, ProcessDied

    """
    turns = spin(driver, processes)
    for elapsed in turns:
        if not driver.missing():
            break
        if elapsed > START_TIMEOUT:
            raise DemoFailed(f'after {START_TIMEOUT:g} s there is no ' + ', no '.join(
                driver.missing()))
    driver.start()
    for _ in turns:
        if latest := driver.latest():
            progress.show(driver.elapsed(), driver.command, *latest)
        if driver.arrived():
            return
        if driver.silence() > SILENCE_TIMEOUT:
            raise DemoFailed(f'no odometry for {SILENCE_TIMEOUT:g} s')
        if driver.elapsed() > FIGURE.duration + STOP_TIMEOUT:
            raise DemoFailed(f'the base still moves {STOP_TIMEOUT:g} s after the stop')


def run_demo(folder: Path, physics: str) -> tuple[DriveRecord, NDArray[np.float64]]:
    """
    Start node and simulated base, drive, and end them.

    Parameters
    ----------
    folder : pathlib.Path
        For their logs.
    physics : str
        One of PHYSICS.

    Returns
    -------
    record : DriveRecord
    module_positions : ndarray (n, 2)
        [m].

    Raises
    ------
    DemoFailed, ProcessDied

    """
    values = {**FAULTS, 'physics': physics}
    parameters = [word for name, value in values.items() for word in ('-p', f'{name}:={value}')]
    nodes: list[tuple[str, str, list[str]]] = [
        ('swerve_node', 'swerve_kinematics.ros.node', []),
        ('swerve_sim', 'swerve_kinematics.sim.node', ['--ros-args', *parameters])]
    progress = Progress(sys.stdout)
    # Our own signals end the processes first: rclpy must not end the context before.
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    try:
        with running(nodes, folder) as processes:
            driver = DemoDriver(FIGURE)
            drive(driver, processes, progress)
    finally:
        progress.finish()
        rclpy.try_shutdown()
    try:
        return driver.record(), driver.module_positions
    except ValueError as error:
        raise DemoFailed(str(error)) from None


def report(record: DriveRecord, module_positions: NDArray[np.float64], folder: Path) -> int:
    """
    Print the summary, draw the picture, and return the exit code.

    Parameters
    ----------
    record : DriveRecord
        The whole drive.
    module_positions : ndarray (n, 2)
        [m].
    folder : pathlib.Path
        For the picture.

    Returns
    -------
    int
        0 only if the odometry stayed within 1 % of the path.

    """
    path = folder / 'figure_eight.png'
    try:
        picture.draw(record, module_positions, path)
        print(f'picture: {path}')
    except ImportError:
        print('no picture: matplotlib is not installed')
    print(summary(record))
    return 0 if error_ratio(record) <= ALLOWED_ERROR_RATIO else 1


def parse(args: list[str] | None) -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(prog='swerve_demo', description=__doc__)
    parser.add_argument('--physics', choices=PHYSICS, default=PHYSICS[0],
                        help='how the base moves: wheels that only roll, or tyres that slip in '
                        'MuJoCo (default: %(default)s)')
    parser.add_argument('--output', type=Path, default=Path('demo-output'), metavar='FOLDER',
                        help='for the picture and the logs (default: %(default)s)')
    # Domains up to 101 are safe on every platform; 0 is where robots live.
    parser.add_argument('--domain-id', type=int, default=1 + os.getpid() % 100, metavar='ID',
                        help='ROS_DOMAIN_ID of the demo (default: one of its own)')
    add_version(parser)
    return parser.parse_args(args)


def main(args: list[str] | None = None) -> int:
    """Run the demo; return its exit code."""
    options = parse(args)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    os.environ['ROS_DOMAIN_ID'] = str(options.domain_id)
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        print(f'swerve_node and swerve_sim start, ROS_DOMAIN_ID={options.domain_id}')
        print(IMPERFECTIONS)
        return report(*run_demo(options.output, options.physics), options.output)
    except KeyboardInterrupt:
        print('swerve_demo: interrupted', file=sys.stderr)
        return 130
    except OSError as error:
        print(f'swerve_demo: --output cannot be written: {error}', file=sys.stderr)
        return 1
    except (DemoFailed, ProcessDied) as error:
        print(f'swerve_demo: {error}', file=sys.stderr)
        return 1


if __name__ == '__main__':
    sys.exit(main())
