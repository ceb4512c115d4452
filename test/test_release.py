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

"""What a release is made of: package.xml and change log, as rosdep and catkin read them."""

import ast
from pathlib import Path
import re
import sys

from catkin_pkg.changelog import get_changelog_from_path
from catkin_pkg.package import parse_package
import swerve_kinematics

ROOT = Path(__file__).resolve().parents[1]
# Where the name of the package that rosdep knows is not that of its module.
KEYS = {'numpy': 'python3-numpy', 'yaml': 'python3-yaml', 'tf2_ros': 'tf2_ros_py'}
# Python packages that programs work without, and say so where one is needed.
OPTIONAL = {'matplotlib', 'mujoco', 'rosbags'}


def imported(*folders: str) -> set[str]:
    """Return the packages that the files in some folders import, without Python's own."""
    names: set[str] = set()
    for path in (path for folder in folders for path in (ROOT / folder).rglob('*.py')):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                names |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                names.add(node.module or '')
    return ({name.partition('.')[0] for name in names}
            - sys.stdlib_module_names - {'swerve_kinematics'})


def test_package_xml_is_valid_and_names_what_is_imported_and_nothing_else() -> None:
    warnings: list[str] = []
    package = parse_package(str(ROOT / 'package.xml'), warnings=warnings)
    package.validate(warnings=warnings)
    assert warnings == []
    assert package.version == swerve_kinematics.__version__
    assert {dependency.name for dependency in package.exec_depends} == {
        KEYS.get(name, name) for name in imported('swerve_kinematics', 'launch') - OPTIONAL}


def test_package_xml_names_what_the_tests_need_of_debian() -> None:
    wanted = set(re.findall(r"'(flake8[\w-]*|hypothesis|mypy|pytest[\w-]*|colcon[\w-]*)'",
                            (ROOT / 'setup.py').read_text()))
    package = parse_package(str(ROOT / 'package.xml'))
    assert wanted
    assert {f'python3-{name}' for name in wanted} <= {
        dependency.name for dependency in package.test_depends}


def test_the_change_log_is_one_that_catkin_prepare_release_takes() -> None:
    log = get_changelog_from_path(str(ROOT / 'CHANGELOG.rst'), 'swerve_kinematics')
    version, _, (changes,) = next(log.foreach_version())
    assert version == swerve_kinematics.__version__
    assert len(changes.bullets) > 10


def test_every_file_has_the_license_header_that_ament_copyright_looks_for() -> None:
    header = Path(__file__).read_text().partition('\n\n')[0]
    assert 'Apache License, Version 2.0' in header
    files = [ROOT / 'setup.py', *(
        path for folder in ('docs', 'launch', 'swerve_kinematics', 'test')
        for path in (ROOT / folder).rglob('*.py'))]
    assert len(files) > 100
    assert [path for path in files if header not in path.read_text()] == []


def test_no_recipe_of_the_makefile_needs_a_variable_that_may_be_unset() -> None:
    """The shell of the recipes ends at an unset variable; `${NAME:-...}` and the like never do."""
    makefile = (ROOT / 'Makefile').read_text()
    assert '-eu' in makefile
    assert re.findall(r'\$\$([A-Z]\w*)', makefile) == []
