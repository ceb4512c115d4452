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

"""The drive of the demo: starts node and simulated base, drives the figure, and ends them."""

from collections.abc import Iterator, Sequence
from pathlib import Path
import sys
from time import monotonic

import numpy as np
from numpy.typing import NDArray
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from swerve_kinematics.ros.process import leaving
from swerve_kinematics.tools.demo.drive_record import DriveRecord
from swerve_kinematics.tools.demo.driver import DemoDriver
from swerve_kinematics.tools.demo.figure_eight import FigureEight
from swerve_kinematics.tools.demo.imperfections import FAULTS
from swerve_kinematics.tools.demo.progress import Progress
from swerve_kinematics.tools.processes import NodeProcess, running

FIGURE = FigureEight(length=6.0, width=3.0, turns=2, duration=24.0, ramp=2.0)
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
            raise DemoFailed(f'after {START_TIMEOUT:g} s there is still no ' + ', no '.join(
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
            raise DemoFailed(f'the base is still moving {STOP_TIMEOUT:g} s after the stop')


def run_demo(folder: Path, physics: str) -> tuple[DriveRecord, NDArray[np.float64]]:
    """
    Start node and simulated base, drive, and end them.

    Parameters
    ----------
    folder : pathlib.Path
        For their logs.
    physics : str
        What swerve_sim's parameter of that name takes.

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
        with leaving():
            rclpy.try_shutdown()
    try:
        return driver.record(), driver.module_positions
    except ValueError as error:
        raise DemoFailed(str(error)) from None
