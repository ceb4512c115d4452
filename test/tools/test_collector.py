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

"""Joint states are collected, and what they lack is said in words that tell what to look at."""

from dataclasses import replace
import math
from types import SimpleNamespace

import numpy as np
import pytest
from recorded_bags import header, quaternion, vector

from swerve_kinematics.configuration.program import read_parameters
from swerve_kinematics.tools.recordings.collector import Collector
from swerve_kinematics.tools.recordings.messages import take_imu, take_joints
from swerve_kinematics.tools.recordings.table import read_csv


@pytest.fixture
def parameters(tmp_path):
    """Return those of a base with the default names of four modules."""
    path = tmp_path / 'robot.yaml'
    path.write_text('/**: {ros__parameters: {wheel_radii: 0.05}}')
    return read_parameters(path)


@pytest.fixture
def collector(parameters):
    """Return one for that base."""
    return Collector(parameters, ('joint',))


JOINTS = [f'{module}_{joint}_joint' for joint in ('drive', 'steering')
          for module in ('front_left', 'front_right', 'rear_left', 'rear_right')]


@pytest.mark.parametrize('names, position, words', [
    ([], 0.0, 'no joint_states arrive'),
    (['fl_drive_joint', *JOINTS[1:]], 0.0,
     'joint_states lack front_left_drive_joint; there is fl_drive_joint'),
    (JOINTS, math.nan, f'joint_states have no usable position of {", ".join(JOINTS)}')])
def test_it_says_why_there_is_no_complete_sample(collector, names, position, words):
    if names:
        collector.add_joints(1, names, [position] * len(names), [])
    assert collector.latest is None
    assert words in collector.lack()


def test_the_mark_that_spreadsheets_put_first_is_no_part_of_a_column(parameters, tmp_path):
    table = tmp_path / 'drive.csv'
    table.write_text(f'stamp,{",".join(JOINTS)}\n1.5{",0.25" * 8}\n', encoding='utf-8-sig')
    assert read_csv(table, parameters, needs_truth=False).latest.angles == [0.25] * 4


def test_spaces_after_commas_are_no_part_of_a_column(parameters, tmp_path):
    table = tmp_path / 'drive.csv'
    table.write_text(f'stamp, {", ".join(JOINTS)}\n1.5{", 0.25" * 8}\n')
    assert read_csv(table, parameters, needs_truth=False).latest.angles == [0.25] * 4


@pytest.mark.parametrize('restamps', [False, True])
def test_stamps_by_two_clocks_are_put_together_as_by_the_node(parameters, restamps):
    collector = Collector(replace(
        parameters, gyro_source='imu', restamp_feedback=restamps), ('joint',))
    for at in range(50):
        time, received = 0.02 * at, round((1_800_000_000.0 + 0.02 * at) * 1e9)
        take_imu(collector, SimpleNamespace(
            header=header(time - 7.0), orientation=quaternion(0.1 * time),
            orientation_covariance=[0.0] * 9, angular_velocity=vector(z=0.1),
            angular_velocity_covariance=[0.0] * 9, linear_acceleration=vector(z=9.8),
            linear_acceleration_covariance=[0.0] * 9), received)
        take_joints(collector, SimpleNamespace(
            header=header(time + 30.0), name=JOINTS, position=[0.0] * 8, velocity=[]), received)
    drive = collector.drive(needs_truth=False)
    assert np.isfinite(collector.data().yaw).all() == restamps
    assert np.isfinite(drive.recording.yaw).all() == restamps


def test_the_gyro_in_a_table_is_as_late_as_the_parameters_say(parameters, tmp_path):
    table, delay = tmp_path / 'drive.csv', 0.1
    rows = [(0.02 * at, *[0.0] * 8, 0.5 * (0.02 * at - delay)) for at in range(50)]
    table.write_text('\n'.join([f'stamp,{",".join(JOINTS)},gyro_joint', *(
        ','.join(map(str, row)) for row in rows)]))
    collector = read_csv(
        table, replace(parameters, gyro_source='imu', imu_delay=delay), needs_truth=False)
    data, drive = collector.data(), collector.drive(needs_truth=False)
    for stamp, yaw in ((data.stamp, data.yaw), (drive.recording.stamp, drive.recording.yaw)):
        np.testing.assert_allclose(yaw[10:40], 0.5 * stamp[10:40], atol=1e-9)


def test_a_gyro_that_is_listed_twice_tells_nothing(collector):
    for at in range(3):
        collector.add_joints(
            1 + at * 20_000_000, [*JOINTS, 'gyro_joint', 'gyro_joint'], [*[0.0] * 8, 0.1, 0.2], [])
    assert np.isnan(collector.data().yaw).all()
    assert collector.drive(needs_truth=False).recording.yaw is None
