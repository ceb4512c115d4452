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

"""What the launch files name exists: told from their text, where launch_ros is not installed."""

import ast
from collections.abc import Iterator
from pathlib import Path
import re

import pytest
from swerve_kinematics.configuration.physics import KINDS

ROOT = Path(__file__).parents[1]
FILES = sorted((ROOT / 'launch').glob('*.launch.py'))
PROGRAMS = set(re.findall(r"'(\w+) = {NAME}", (ROOT / 'setup.py').read_text()))


def calls(path: Path, name: str) -> Iterator[dict[str, ast.expr]]:
    """Yield the arguments of each call of a function in a file: by name, or by place."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Call) and getattr(node.func, 'id', None) == name:
            yield {**{str(place): argument for place, argument in enumerate(node.args)},
                   **{keyword.arg or '': keyword.value for keyword in node.keywords}}


@pytest.mark.parametrize('file', FILES, ids=lambda file: file.name)
def test_the_programs_and_files_exist(file: Path) -> None:
    own = [call for call in calls(file, 'Node')
           if ast.literal_eval(call['package']) == 'swerve_kinematics']
    assert own
    assert {ast.literal_eval(call['executable']) for call in own} <= PROGRAMS
    joined = list(calls(file, 'PathJoinSubstitution'))
    assert joined
    for call in joined:
        _, *parts = call['0'].elts
        assert ROOT.joinpath(*map(ast.literal_eval, parts)).is_file()


@pytest.mark.parametrize('file', FILES, ids=lambda file: file.name)
def test_every_argument_that_is_used_is_declared(file: Path) -> None:
    declared = [call['0'] for call in calls(file, 'DeclareLaunchArgument')]
    names = {ast.literal_eval(name) for name in declared if isinstance(name, ast.Constant)}
    used = {ast.literal_eval(call['0']) for call in calls(file, 'LaunchConfiguration')
            if isinstance(call['0'], ast.Constant)}
    assert used <= names


def test_both_launch_files_check_what_they_need_before_they_start_anything() -> None:
    for file in FILES:
        functions = [ast.unparse(call['function']) for call in calls(file, 'OpaqueFunction')]
        text = file.read_text()
        assert functions and text.index('OpaqueFunction(') < text.index('Node(')
        assert 'is_file()' in text.split(f'def {functions[0]}')[1]


def test_the_demo_takes_every_physics_that_the_simulator_knows() -> None:
    choices, = (ast.literal_eval(call['choices'])
                for call in calls(ROOT / 'launch/demo.launch.py', 'DeclareLaunchArgument')
                if ast.literal_eval(call['0']) == 'physics')
    assert tuple(choices) == KINDS
