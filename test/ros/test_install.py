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

"""The package as users get it: built by colcon, found through the ament index, run."""

import os
from pathlib import Path
import shutil
import signal
import subprocess
import sys

import pytest

REPOSITORY = Path(__file__).parents[2]
# colcon and the scripts it starts belong to the environment that runs the tests.
TOOLS = {**os.environ, 'PATH': f'{Path(sys.executable).parent}:{os.environ["PATH"]}'}


def output_of(*command, env=TOOLS, cwd=None):
    """Run a command that must succeed; return what it prints."""
    done = subprocess.run(command, env=env, cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope='module')
def workspace(tmp_path_factory):
    """Return a workspace with a copy of the package, built by colcon."""
    workspace = tmp_path_factory.mktemp('workspace')
    files = output_of('git', 'ls-files', '-co', '--exclude-standard', cwd=REPOSITORY)
    for name in files.splitlines():
        target = workspace / 'src' / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(REPOSITORY / name, target)
    output_of('colcon', 'build', cwd=workspace)
    return workspace


@pytest.fixture(scope='module')
def sourced(workspace):
    """Return the environment of a shell that has sourced the workspace."""
    script = f'source {workspace}/install/setup.bash && env -0'
    lines = output_of('bash', '-c', script).split('\0')
    return dict(line.split('=', 1) for line in lines if '=' in line)


def test_colcon_knows_an_ament_package(workspace):
    listed = output_of('colcon', 'list', cwd=workspace).split('\t')
    assert listed[0] == 'swerve_kinematics'
    assert listed[2].strip() == '(ros.ament_python)'


@pytest.mark.parametrize('name, topic', [('swerve_node', 'odom'), ('swerve_sim', 'joint_states')])
def test_the_executables_run_from_the_ament_index(
        sourced, tmp_path, client, namespace, name, topic):
    prefix = Path(output_of(
        sys.executable, '-c', 'from ament_index_python import get_package_prefix as prefix;'
        'print(prefix("swerve_kinematics"))', env=sourced).strip())
    executable = prefix / 'lib' / 'swerve_kinematics' / name
    log = tmp_path / 'log'
    with open(log, 'w') as output:
        process = subprocess.Popen(
            [executable, '--ros-args', '-r', f'__ns:={namespace}'], env=sourced, cwd=tmp_path,
            stdout=output, stderr=subprocess.STDOUT)
    try:
        client.wait_until(lambda: client.node.count_publishers(f'{namespace}/{topic}') == 1,
                          f'{topic} of {name}')
    finally:
        process.send_signal(signal.SIGINT)
    assert process.wait(20.0) == 0, log.read_text()


def test_a_bad_parameter_ends_the_executable_with_1(sourced, workspace):
    executable = workspace / 'install/swerve_kinematics/lib/swerve_kinematics/swerve_node'
    done = subprocess.run([executable, '--ros-args', '-p', 'control_rate:=0.0'], env=sourced,
                          capture_output=True, text=True)
    assert done.returncode == 1
    assert 'control_rate' in done.stderr


def test_configuration_and_launch_files_are_installed(workspace):
    share = workspace / 'install/swerve_kinematics/share/swerve_kinematics'
    for folder in ('config', 'launch'):
        sources = {path.name for path in (REPOSITORY / folder).iterdir() if path.is_file()}
        assert {path.name for path in (share / folder).iterdir()} == sources
