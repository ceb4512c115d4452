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

"""Every program says what it is, and what is missing, in one line."""

from pathlib import Path
import re
import signal
import subprocess
import sys

import pytest
import swerve_kinematics

ROOT = Path(__file__).resolve().parents[1]
CONFIG = ROOT / 'config' / 'four_modules.yaml'
ENTRY_POINTS = dict(re.findall(
    r"f'(\w+) = {NAME}\.([\w.]+:\w+)'", (ROOT / 'setup.py').read_text()))
# What no program needs to say what it is: ROS, and what the extras bring.
OPTIONAL = ('(rcl|rosidl|rpyutils|ament_|tf2_).*|.*_(msgs|srvs|interfaces)|'
            'matplotlib|rosbags|mujoco')
# Calls an entry point as its script does, where packages whose names match an expression cannot
# be imported; for 'interrupted' Ctrl-C is pressed while its program is being imported.
SCRIPT = """
import os, re, signal, sys
from importlib import import_module

class Missing:
    def find_spec(self, name, path=None, target=None):
        if re.fullmatch(missing, name.partition('.')[0]):
            raise ModuleNotFoundError(f'No module named {name!r}', name=name)
        if missing == 'interrupted' and name == 'yaml':
            os.kill(os.getpid(), signal.SIGINT)

program, missing = sys.argv[1:3]
sys.argv = ['program', *sys.argv[3:]]
module, _, function = program.partition(':')
entry_point = getattr(import_module('swerve_kinematics.' + module), function)
sys.meta_path.insert(0, Missing())
sys.exit(entry_point())
"""


def run(name: str, *arguments: object, missing: str = '-') -> 'subprocess.CompletedProcess[str]':
    """Run a program without some packages."""
    return subprocess.run(
        [sys.executable, '-c', SCRIPT, ENTRY_POINTS[name], missing, *map(str, arguments)],
        capture_output=True, text=True, timeout=60.0)


def complaint(done: 'subprocess.CompletedProcess[str]') -> str:
    """Return the one line that a program ends with."""
    assert done.returncode not in (0, -signal.SIGINT), done.stdout
    assert done.stderr.count('\n') == 1, done.stderr
    return done.stderr


def test_these_are_all_programs() -> None:
    assert len(ENTRY_POINTS) == 6
    assert all(target == f'programs:{name}' for name, target in ENTRY_POINTS.items())


@pytest.mark.parametrize('name', ENTRY_POINTS)
def test_every_program_tells_its_version_and_what_it_does_without_ros(name: str) -> None:
    version = run(name, '--version', missing=OPTIONAL)
    assert (version.returncode, version.stderr) == (0, '')
    assert version.stdout == f'{name} {swerve_kinematics.__version__}\n'
    help_ = run(name, '--help', missing=OPTIONAL)
    assert (help_.returncode, help_.stderr) == (0, '')
    assert help_.stdout.startswith(f'usage: {name}')
    assert '--version' in help_.stdout


@pytest.mark.parametrize('name, arguments, missing, remedy', [
    ('swerve_node', [], 'rclpy', 'setup.bash'),
    ('swerve_sim', [], 'rclpy', 'ros-jazzy-rclpy'),
    ('swerve_demo', [], 'rclpy', 'ros-jazzy-rclpy'),
    ('swerve_check', ['--params', CONFIG, '--live', 1], 'rclpy', 'ros-jazzy-rclpy'),
    ('swerve_check', ['--params', CONFIG, '--on-blocks'], 'rclpy', 'ros-jazzy-rclpy'),
    ('swerve_node', [], 'nav_msgs', 'ros-jazzy-common-interfaces'),
    ('swerve_visualize', ['--save', 'x.png'], 'matplotlib', 'python3-matplotlib'),
    ('swerve_calibrate', ['x', '--distance', 1, '--params', CONFIG], 'rosbags', 'rosbags'),
    ('swerve_check', ['x', '--params', CONFIG], 'rosbags', 'rosbags'),
    ('swerve_sim', ['--ros-args', '-p', 'physics:=mujoco'], 'mujoco', 'pip install mujoco'),
    *((name, [], 'yaml', 'python3-yaml') for name in ENTRY_POINTS)])
def test_what_is_not_installed_is_said_in_one_line(
        name: str, arguments: list[object], missing: str, remedy: str) -> None:
    done = run(name, *arguments, missing=missing)
    line = complaint(done)
    assert missing in line and remedy in line
    assert done.returncode == (1 if missing == 'mujoco' else 2)  # a parameter's choice is refused


@pytest.mark.parametrize('name', ['swerve_node', 'swerve_sim'])
def test_a_parameter_file_is_checked_without_ros(name: str) -> None:
    good = run(name, '--check', CONFIG, missing=OPTIONAL)
    assert (good.returncode, good.stderr) == (0, '')
    assert str(CONFIG) in good.stdout
    assert 'setup.cfg' in complaint(run(name, '--check', ROOT / 'setup.cfg', missing=OPTIONAL))
    assert 'stray' in complaint(run(name, 'stray'))


def test_a_part_of_the_package_itself_that_is_missing_is_no_question_of_installing() -> None:
    assert 'Traceback' in run('swerve_node', missing='swerve_kinematics').stderr


@pytest.mark.parametrize('name', ['swerve_node', 'swerve_calibrate'])
def test_ctrl_c_while_a_program_still_starts_is_one_line(name: str) -> None:
    assert complaint(run(name, missing='interrupted')) == f'{name}: interrupted\n'


def test_standard_streams_that_are_closed_are_empty() -> None:
    script = """
import sys
from swerve_kinematics import programs
programs.call = lambda _: len(sys.stdin.read()) + sys.stdout.isatty() + sys.stderr.isatty()
sys.exit(programs.run('program', 'module:function'))
"""
    command = ['sh', '-c', 'exec "$0" -c "$1" <&- >&- 2>&-', sys.executable, script]
    assert subprocess.run(command, timeout=60.0).returncode == 0


def test_the_version_is_the_same_everywhere() -> None:
    version = swerve_kinematics.__version__
    assert f'<version>{version}</version>' in (ROOT / 'package.xml').read_text()
    assert f'\n{version} (' in (ROOT / 'CHANGELOG.rst').read_text()
