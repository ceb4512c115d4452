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

"""The house rules: no ROS in the core, imports point downwards, and the style of the code."""

import ast
from functools import cache
from pathlib import Path
import re
import subprocess
import sys

import pytest
from rclpy.parameter import Parameter
import swerve_kinematics

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / 'swerve_kinematics'
FILES = sorted(PACKAGE.rglob('*.py'))

# What each room may import besides itself, and what else from outside the package the core's
# rooms may; '' is the package itself, with the core's public names and the version. A room that
# is not listed here has no place in the house yet.
BELOW = {
    'core.geometry': set(),
    'core.kinematics': {'core.geometry'},
    'core.odometry': {'core.geometry', 'core.kinematics'},
    'core.control': {'core.geometry', 'core.kinematics'},
    'core.calibration': {'core.geometry', 'core.kinematics', 'core.odometry', 'core.control'},
    'core.checking': {'core.geometry', 'core.kinematics'},
    'core.drawing': {'core.geometry', 'core.kinematics'},
    'configuration': {'', 'core'},
    'ros': {'', 'core', 'configuration'},
    'sim': {'', 'core', 'configuration', 'ros'},
    'tools': {'', 'core', 'configuration', 'ros', 'sim'},
}
IN_CORE = sys.stdlib_module_names | {'numpy'}
# Where ROS processes live, or what starts them; everything else runs without ROS. Files of `ros`
# that need none themselves may be imported from there too.
ROS_PROCESSES = ('ros.', 'sim.node', 'tools.demo.driver', 'tools.demo.main', 'tools.demo.run',
                 'tools.check.main', 'tools.check.live', 'tools.check.blocks', 'tools.check.floor',
                 'tools.check.lifted_base', 'tools.check.robot', 'tools.check.straight_ahead')
FROM_ROS = re.compile(r'(rcl|rosidl|tf2_)|.*(_msgs|_srvs|_interfaces)$')


@cache
def imported_modules(path):
    """Return the full names of all modules that a file imports."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f'{path}: a relative import hides where it points'
            names.add(node.module)
    return names


def room_of(module):
    """Return the room of a module of the package, or None for one outside it."""
    parts = module.split('.')
    if parts[0] != 'swerve_kinematics':
        return None
    return '.'.join(parts[1:3] if parts[1:2] == ['core'] else parts[1:2])


def is_allowed(room, name):
    """Tell whether a file in a room may import a module."""
    target = room_of(name)
    if target is None:
        return not room.startswith('core') or name.split('.')[0] in IN_CORE
    return target == room or any(
        target == below or below and target.startswith(below + '.') for below in BELOW[room])


def test_importing_the_package_leaves_ros_unloaded():
    code = 'import sys, swerve_kinematics; print(*sys.modules)'
    loaded = subprocess.run([sys.executable, '-c', code], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split()
    assert 'swerve_kinematics.core.kinematics.swerve' in loaded
    assert not {name for name in loaded if name.startswith(('rclpy', 'swerve_kinematics.ros'))}


def test_a_start_loads_nothing_that_only_options_and_mistakes_need():
    code = ('import sys, swerve_kinematics.ros.joint_names; '
            'from swerve_kinematics.configuration.answers import answer_for_node; '
            "assert answer_for_node(['--ros-args', '-p', 'control_rate:=20.0']) is None; "
            'print(*sys.modules)')
    loaded = subprocess.run([sys.executable, '-c', code], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split()
    assert 'swerve_kinematics.configuration.values' in loaded
    assert {'argparse', 'difflib'}.isdisjoint(loaded)


@pytest.mark.parametrize(
    'path', [path for path in FILES if path.parent != PACKAGE and path.stem != '__init__'],
    ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_point_downwards(path):
    room = room_of('.'.join(path.relative_to(ROOT).with_suffix('').parts))
    assert {name for name in imported_modules(path) if not is_allowed(room, name)} == set()


@cache
def files_imported(path):
    """Return the files of the package that a file imports itself."""
    files = {ROOT / (name.replace('.', '/') + '.py') for name in imported_modules(path)}
    return {file for file in files if file.exists()}


def needs_ros(path):
    """Tell whether importing a file imports anything of ROS, by whatever way."""
    reached, left = {path}, [path]
    while left:
        new = files_imported(left.pop()) - reached
        reached |= new
        left += new
    return any(FROM_ROS.match(name.split('.')[0])
               for file in reached for name in imported_modules(file))


def test_only_ros_processes_need_ros():
    needing = {'.'.join(path.relative_to(PACKAGE).with_suffix('').parts)
               for path in FILES if needs_ros(path)}
    assert {name for name in needing if not name.startswith(ROS_PROCESSES)} == set()
    assert {'ros.node', 'sim.node', 'tools.demo.driver', 'tools.demo.main'} <= needing


@pytest.mark.parametrize('path', sorted(PACKAGE.rglob('__init__.py')),
                         ids=lambda path: str(path.relative_to(PACKAGE)))
def test_a_room_says_what_it_is_for(path):
    assert ast.get_docstring(ast.parse(path.read_text()))


@pytest.mark.parametrize('room, name, allowed', [
    ('core.odometry', 'numpy.linalg', True), ('core.odometry', 'math', True),
    ('core.odometry', 'swerve_kinematics.core.geometry.se2', True),
    ('core.geometry', 'swerve_kinematics.core.kinematics.swerve', False),
    ('core.odometry', 'swerve_kinematics.core.control.limits', False),
    ('core.control', 'swerve_kinematics.core.odometry.gyro', False),
    ('core.control', 'swerve_kinematics.configuration.layout', False),
    ('core.geometry', 'swerve_kinematics', False), ('core.odometry', 'rclpy', False),
    ('core.odometry', 'std_msgs.msg', False),
    ('configuration', 'swerve_kinematics.core.geometry.se2', True),
    ('configuration', 'swerve_kinematics.ros.node', False),
    ('ros', 'swerve_kinematics.sim.base', False), ('ros', 'rclpy', True),
    ('sim', 'swerve_kinematics.ros.process', True)])
def test_the_rule_for_imports_can_fail(room, name, allowed):
    assert is_allowed(room, name) == allowed


def test_every_public_name_exists_and_is_documented():
    assert sorted(swerve_kinematics.__all__) == swerve_kinematics.__all__
    for name in swerve_kinematics.__all__:
        assert getattr(swerve_kinematics, name).__doc__, name


def test_style():
    result = subprocess.run([sys.executable, '-m', 'flake8', 'swerve_kinematics', 'test', 'docs',
                             'launch', 'setup.py'],
                            cwd=ROOT, capture_output=True, text=True)
    assert result.stdout + result.stderr == ''
    assert result.returncode == 0


def test_types():
    # Kilted's parameters, publishers and subscriptions take a type each, those of Jazzy cannot.
    own = ['--allow-any-generics'] if hasattr(Parameter, '__class_getitem__') else []
    result = subprocess.run([sys.executable, '-m', 'mypy', *own], cwd=ROOT, capture_output=True,
                            text=True)
    assert result.stderr == ''
    assert result.returncode == 0, result.stdout


def set_up(*arguments):
    """Run setup.py where numpy cannot be imported, and return what it prints."""
    code = ("import runpy, sys; sys.modules['numpy'] = None; sys.argv[0] = 'setup.py'; "
            "runpy.run_path('setup.py', run_name='__main__')")
    return subprocess.run([sys.executable, '-c', code, *arguments], cwd=ROOT, check=True,
                          capture_output=True, text=True).stdout


def test_there_is_one_version():
    version = swerve_kinematics.__version__
    assert set_up('--version').split()[-1] == version
    assert f'<version>{version}</version>' in (ROOT / 'package.xml').read_text()
    # The newest release, once there is one: what is forthcoming has no number yet.
    releases = re.findall(r'^(\d+\.\d+\.\d+)\b.*\n-+$', (ROOT / 'CHANGELOG.rst').read_text(),
                          re.MULTILINE)
    assert releases[:1] in ([], [version])


def test_type_checkers_find_the_annotations_of_an_installed_package(tmp_path):
    set_up('--quiet', 'build_py', '--build-lib', str(tmp_path))
    assert (tmp_path / 'swerve_kinematics' / 'py.typed').exists()
