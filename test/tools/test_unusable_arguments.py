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

"""What a tool says of what it cannot use: one line, with the name, and no Python."""

from pathlib import Path
import subprocess
import sys

import pytest
from swerve_kinematics.tools.calibrate.main import main as swerve_calibrate
from swerve_kinematics.tools.check.main import main as swerve_check
from swerve_kinematics.tools.visualize.main import main as swerve_visualize

PARAMS = str(Path(__file__).parents[2] / 'config' / 'four_modules.yaml')


@pytest.mark.parametrize('program, arguments', [
    (swerve_calibrate, ['drive.csv', '--params', 'missing']),
    (swerve_calibrate, ['missing', '--params', PARAMS, '--truth-topic', '/truth']),
    (swerve_calibrate, ['missing.csv', '--params', PARAMS]),
    (swerve_check, ['drive.csv', '--params', 'missing']),
    (swerve_check, ['missing', '--params', PARAMS]),
    (swerve_check, ['missing.csv', '--params', PARAMS]),
    (swerve_visualize, ['--params', 'missing']),
    (swerve_visualize, ['--save', 'missing/x.png'])])
def test_a_missing_file_is_named_in_plain_words(
        capsys, monkeypatch, tmp_path, program, arguments):
    monkeypatch.chdir(tmp_path)
    assert program(arguments) != 0
    complaint = capsys.readouterr().err
    assert complaint.count('\n') == 1 and complaint.endswith(': No such file or directory\n')
    assert 'missing' in complaint and 'Errno' not in complaint and 'Path(' not in complaint


@pytest.mark.parametrize('content', [
    b'stamp,truth_x,truth_y,truth_yaw\n0,' + b'1' * 200_000, b'\xff\xfe\x00'])
@pytest.mark.parametrize('program', [swerve_calibrate, swerve_check])
def test_a_file_that_is_no_table_is_named_in_plain_words(capsys, tmp_path, program, content):
    file = tmp_path / 'drive.csv'
    file.write_bytes(content)
    assert program([str(file), '--params', PARAMS]) != 0
    complaint = capsys.readouterr().err
    assert complaint.count('\n') == 1 and f'{file} is not a CSV file' in complaint


@pytest.mark.parametrize('program', [swerve_calibrate, swerve_check])
def test_a_table_without_a_word_is_called_empty(capsys, tmp_path, program):
    file = tmp_path / 'drive.csv'
    file.touch()
    assert program([str(file), '--params', PARAMS]) != 0
    assert capsys.readouterr().err.endswith(f': {file} is empty\n')


@pytest.mark.parametrize('arguments, word', [(['--foo'], '--foo'), (['-r', '__node:=a-b'], 'a-b')])
def test_arguments_that_ros_does_not_take_are_named_in_plain_words(arguments, word):
    # In a process of its own: this one may have joined ROS.
    check = subprocess.run(
        [sys.executable, '-m', 'swerve_kinematics.tools.check.main', '--params', PARAMS,
         '--live', '1', '--ros-args', *arguments], stderr=subprocess.PIPE, text=True)
    complaint, = [line for line in check.stderr.splitlines() if '[rcl]' not in line]
    assert check.returncode == 2 and complaint.startswith('swerve_check: ') and word in complaint
