"""The house rules: no ROS in the core, imports point downwards, and the style of the code."""

import ast
from pathlib import Path
import subprocess
import sys

import pytest
import swerve_kinematics

ROOT = Path(__file__).resolve().parent.parent
CORE = sorted((ROOT / 'swerve_kinematics' / 'core').glob('*.py'))
ALLOWED_IN_CORE = sys.stdlib_module_names | {'numpy', 'swerve_kinematics.core'}


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


def is_allowed(name):
    """Tell whether the core may import a module: itself, numpy and the standard library."""
    parts = name.split('.')
    return any('.'.join(parts[:count]) in ALLOWED_IN_CORE for count in range(1, len(parts) + 1))


def test_importing_the_package_leaves_ros_unloaded():
    code = 'import sys, swerve_kinematics; print(*sys.modules)'
    loaded = subprocess.run([sys.executable, '-c', code], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split()
    assert 'swerve_kinematics.core.swerve' in loaded
    assert not {name for name in loaded if name.startswith(('rclpy', 'swerve_kinematics.ros'))}


@pytest.mark.parametrize('path', CORE, ids=lambda path: path.stem)
def test_the_core_imports_nothing_above_it(path):
    assert {name for name in imported_modules(path) if not is_allowed(name)} == set()


@pytest.mark.parametrize('name, allowed', [
    ('numpy.linalg', True), ('math', True), ('swerve_kinematics.core.se2', True),
    ('swerve_kinematics.ros.node', False), ('swerve_kinematics', False), ('rclpy', False),
    ('swerve_kinematics.sim.base', False), ('std_msgs.msg', False)])
def test_the_rule_for_imports_can_fail(name, allowed):
    assert is_allowed(name) == allowed


def test_every_public_name_exists_and_is_documented():
    assert sorted(swerve_kinematics.__all__) == swerve_kinematics.__all__
    for name in swerve_kinematics.__all__:
        assert getattr(swerve_kinematics, name).__doc__, name


def test_style():
    result = subprocess.run([sys.executable, '-m', 'flake8', 'swerve_kinematics', 'test'],
                            cwd=ROOT, capture_output=True, text=True)
    assert result.stdout + result.stderr == ''
    assert result.returncode == 0
