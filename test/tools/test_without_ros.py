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

"""The tools that talk to no graph run where there is no ROS: numpy, pyyaml, matplotlib."""

from pathlib import Path
import subprocess
import sys

from calibration_drives import Errors, varied
import numpy as np
import pytest
import yaml

CONFIG = Path(__file__).parents[2] / 'config'
# Runs a module of the package where nothing of ROS can be imported.
WITHOUT_ROS = """
import re, runpy, sys

class NoRos:
    def find_spec(self, name, path=None, target=None):
        if re.match(r'(rcl|rosidl|rpyutils|ament_|tf2_)|.*(_msgs|_srvs|_interfaces)$',
                    name.partition('.')[0]):
            raise ModuleNotFoundError(f'No module named {name!r}', name=name)

sys.meta_path.insert(0, NoRos())
sys.argv = sys.argv[1:]
runpy.run_module(sys.argv[0], run_name='__main__', alter_sys=True)
"""


def run(module, *arguments):
    """Run a module of the package without ROS; return the finished process."""
    return subprocess.run(
        [sys.executable, '-c', WITHOUT_ROS, module, *map(str, arguments)],
        capture_output=True, text=True)


def test_there_really_is_no_ros_here():
    done = run('swerve_kinematics.ros.node')
    assert done.returncode != 0
    assert 'ModuleNotFoundError' in done.stderr


@pytest.fixture
def drive(tmp_path):
    """Return a CSV file of a drive of the base in four_modules.yaml."""
    log = varied(Errors(np.ones(4), np.zeros(4), 1.0), np.random.default_rng(1), duration=20.0)
    modules = 'front_left', 'front_right', 'rear_left', 'rear_right'
    columns = ['stamp', *(f'{module}_{kind}_joint' for kind in ('drive', 'steering')
                          for module in modules), 'gyro_joint', 'truth_x', 'truth_y', 'truth_yaw']
    path = tmp_path / 'drive.csv'
    np.savetxt(path, np.column_stack((
        log.stamp, log.wheel_angle, log.steering_angle, log.yaw, log.poses)),
        delimiter=',', header=','.join(columns), comments='')
    return path


def test_swerve_calibrate(drive):
    done = run('swerve_kinematics.tools.calibrate.main', drive,
               '--params', CONFIG / 'four_modules.yaml')
    assert done.returncode == 0, done.stderr
    radii = yaml.safe_load(done.stdout.splitlines()[-2])['wheel_radii']
    np.testing.assert_allclose(radii, 0.05, rtol=0.001)


def test_swerve_visualize(tmp_path):
    picture = tmp_path / 'picture.png'
    done = run('swerve_kinematics.tools.visualize.main', '--vx', 1, '--save', picture,
               '--params', CONFIG / 'three_modules.yaml')
    assert done.returncode == 0, done.stderr
    assert picture.exists()


def test_swerve_check_of_a_file(drive):
    done = run('swerve_kinematics.tools.check.main', drive,
               '--params', CONFIG / 'four_modules.yaml')
    assert done.returncode == 0, done.stdout + done.stderr
