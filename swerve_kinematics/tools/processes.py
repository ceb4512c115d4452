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

"""Running our own nodes as processes, and ending each of them whatever happens."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
import signal
import subprocess
import sys

from swerve_kinematics.ros.signals import ENDING_SIGNALS

# A node that has not ended this long [s] after SIGTERM is killed.
PATIENCE = 5.0


class ProcessDied(RuntimeError):
    """A process ended that should be running; one line that says which and why."""


class NodeProcess:
    """
    A node of this package, run by this interpreter: from a source tree or installed alike.

    Parameters
    ----------
    name : str
        What to call it; its output goes to `<folder>/<name>.log`.
    module : str
        Python module to run.
    arguments : list of str
        Command line of the module.
    folder : pathlib.Path
        Where the log goes.

    """

    def __init__(self, name: str, module: str, arguments: Sequence[str], folder: Path) -> None:
        """Start it."""
        self.name = name
        self.log = folder / f'{name}.log'
        with self.log.open('w') as output:
            # A session of its own: Ctrl-C in the terminal reaches us alone, and we end it.
            self._process = subprocess.Popen(
                [sys.executable, '-m', module, *arguments], stdin=subprocess.DEVNULL,
                stdout=output, stderr=subprocess.STDOUT, start_new_session=True)

    def check(self) -> None:
        """Raise ProcessDied if it is not running any more."""
        code = self._process.poll()
        if code is not None:
            lines = self.log.read_text(errors='replace').split('\n')
            last = next((line for line in reversed(lines) if line.strip()), 'it said nothing')
            raise ProcessDied(f'{self.name} ended with exit code {code}: {last} ({self.log})')

    def stop(self) -> None:
        """End it, and wait until it has."""
        end(self._process)


def end(process: subprocess.Popen[bytes]) -> None:
    """Ask a process to end, and wait until it has; kill it if that takes too long."""
    # Not SIGINT: what a shell runs in the background ignores it, and so do its children.
    process.terminate()  # nothing happens to one that has ended
    try:
        process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


@contextmanager
def running(starts: Iterable[tuple[str, str, Sequence[str]]],
            folder: Path) -> Iterator[list[NodeProcess]]:
    """
    Run nodes while the block runs.

    Parameters
    ----------
    starts : iterable of (name, module, arguments)
        As NodeProcess takes them; stopped in the reverse order.
    folder : pathlib.Path
        For the logs.

    Yields
    ------
    list of NodeProcess

    """
    processes: list[NodeProcess] = []
    try:
        for name, module, arguments in starts:
            processes.append(NodeProcess(name, module, arguments, folder))
        yield processes
    finally:
        with held_signals():
            for process in reversed(processes):
                process.stop()


@contextmanager
def held_signals() -> Iterator[None]:
    """Keep signals to end waiting while the block runs: a second one must not cut it short."""
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING_SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
