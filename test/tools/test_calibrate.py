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

"""swerve_calibrate reads recordings as robots make them, and says what it found."""

import csv

from calibration_drives import driven, Errors, straight, varied
import numpy as np
import pytest
from recorded_bags import header, joint_state, message, quaternion, START, vector, write_bag
from rosbags.rosbag2 import StoragePlugin
from swerve_kinematics.tools.calibrate.main import main
from swerve_kinematics.tools.recordings.collector import Collector
import yaml

MODULES = ('fl', 'fr', 'rl', 'rr')
JOINTS = ([f'{module}_drive_joint' for module in MODULES]
          + [f'{module}_steering_joint' for module in MODULES])
OFFSETS_SO_FAR = np.array([0.5, -0.5, 0.0, 3.0])
DEGREE = np.radians(1.0)
ERRORS = Errors(np.array([1.02, 0.98, 1.0, 1.01]), DEGREE * np.array([1.0, -1.0, 0.5, 0.0]), 1.01)
PARAMETERS = """
/**:
  ros__parameters:
    module_names: [fl, fr, rl, rr]
    module_x: [0.3, 0.3, -0.3, -0.3]
    module_y: [0.25, -0.25, 0.25, -0.25]
    wheel_radii: [5e-2]
    steering_offsets: [0.5, -0.5, 0, 3]
    gyro_source: joint
    odometry: {slip_ratio: 3}
other_node:
  ros__parameters: {module_x: [1.0]}
"""


@pytest.fixture(scope='module')
def drive():
    """Return a drive whose steering joints read beyond the offsets so far."""
    log = varied(ERRORS, np.random.default_rng(1), duration=20.0)
    return log._replace(steering_angle=log.steering_angle + OFFSETS_SO_FAR)


@pytest.fixture
def params(tmp_path):
    path = tmp_path / 'robot.yaml'
    path.write_text(PARAMETERS)
    return path


def rows_of(log):
    """Return the columns and rows of a CSV file with everything a drive has."""
    columns = ['stamp', *JOINTS, 'gyro_joint', 'truth_x', 'truth_y', 'truth_yaw']
    return columns, np.column_stack((
        START + log.stamp, log.wheel_angle, log.steering_angle, log.yaw, log.poses)).tolist()


def write_csv(path, columns, rows):
    with path.open('w', newline='') as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(rows)
    return path


def joint_states(log, gyro):
    """Yield time and JointState; drive and steering joints come in messages of their own."""
    for k, stamp in enumerate(log.stamp):
        yaw = [log.yaw[k]] if gyro else []
        for names, positions in (
                (JOINTS[:4] + ['gyro_joint'][:len(yaw)], [*log.wheel_angle[k], *yaw]),
                (JOINTS[4:], log.steering_angle[k])):
            yield stamp, joint_state(stamp, names, positions)


def truth(log):
    """Yield time and Odometry, a little before the joint states."""
    covariance = np.zeros(36)
    for k in range(len(log.stamp) - 1):
        x, y, yaw = (0.75 * log.poses[k] + 0.25 * log.poses[k + 1]).tolist()
        stamp = 0.75 * log.stamp[k] + 0.25 * log.stamp[k + 1]
        pose = message('geometry_msgs/msg/Pose', orientation=quaternion(yaw),
                       position=message('geometry_msgs/msg/Point', x=x, y=y, z=0.0))
        twist = message('geometry_msgs/msg/Twist', linear=vector(), angular=vector())
        yield stamp, message(
            'nav_msgs/msg/Odometry', header=header(stamp), child_frame_id='base_link',
            pose=message('geometry_msgs/msg/PoseWithCovariance', pose=pose,
                         covariance=covariance),
            twist=message('geometry_msgs/msg/TwistWithCovariance', twist=twist,
                          covariance=covariance))


def imu(log, delay=0.0):
    """Yield time and Imu with the yaw as its orientation, stamped `delay` after the joints."""
    unknown = np.array([-1.0, *np.zeros(8)])
    for k, stamp in enumerate(log.stamp + delay):
        yield stamp, message(
            'sensor_msgs/msg/Imu', header=header(stamp), orientation=quaternion(log.yaw[k]),
            orientation_covariance=np.zeros(9), angular_velocity=vector(),
            angular_velocity_covariance=unknown, linear_acceleration=vector(),
            linear_acceleration_covariance=unknown)


def run(capsys, *args):
    """Return the exit code, the report and the parameters in it."""
    code = main([str(arg) for arg in args])
    output, errors = capsys.readouterr()
    assert code == 0, errors
    return output, yaml.safe_load(output.split('# for the parameter file:')[1])


def assert_recovered(found):
    np.testing.assert_allclose(found['wheel_radii'], 0.05 * ERRORS.radius_scale, rtol=0.001)
    np.testing.assert_allclose(found['steering_offsets'],
                               OFFSETS_SO_FAR + ERRORS.steering_offset, atol=0.1 * DEGREE)


def gyro_scale(output):
    return float(output.split('  scale')[1].split()[0])


def test_csv_with_poses(capsys, tmp_path, params, drive):
    recording = write_csv(tmp_path / 'drive.csv', *rows_of(drive))
    output, found = run(capsys, recording, '--params', params)
    assert_recovered(found)
    assert gyro_scale(output) == pytest.approx(1.01, abs=0.001)
    assert 'contradict' not in output


def test_the_change_of_an_offset_is_that_of_its_reading(capsys, tmp_path, params, drive):
    params.write_text(PARAMETERS.replace(
        'gyro_source', 'steering_directions: [1, 1, 1, -1]\n'
        '    steering_ratios: [1, 1, 2, 1]\n    gyro_source'))
    readings = (drive.steering_angle - OFFSETS_SO_FAR) * [1, 1, 2, -1] + OFFSETS_SO_FAR
    recording = write_csv(tmp_path / 'drive.csv', *rows_of(
        drive._replace(steering_angle=readings)))
    output, found = run(capsys, recording, '--params', params)
    changes = [float(line.split('rad')[1].split()[0]) for line in output.splitlines()
               if 'steering offset' in line]
    np.testing.assert_allclose(
        np.subtract(found['steering_offsets'], OFFSETS_SO_FAR), np.radians(changes), atol=1e-4)


def test_the_node_takes_every_offset_that_is_found(capsys, tmp_path, params, drive):
    # Encoders that count from 0 to 2 pi; the first one is wrong by more than it has left.
    so_far = np.array([6.28, -6.28, 12.56, 0.0])
    content = yaml.safe_load(PARAMETERS)
    own = content['/**']['ros__parameters']
    own |= {'steering_offsets': so_far.tolist(), 'steering_ratios': [1.0, 1.0, 2.0, 1.0]}
    params.write_text(yaml.safe_dump(content))
    readings = (drive.steering_angle - OFFSETS_SO_FAR) * [1.0, 1.0, 2.0, 1.0] + so_far
    recording = write_csv(tmp_path / 'drive.csv', *rows_of(
        drive._replace(steering_angle=readings)))
    _, found = run(capsys, recording, '--params', params)
    own |= found
    params.write_text(yaml.safe_dump(content))
    again, _ = run(capsys, recording, '--params', params)
    changes = [float(line.split('rad')[1].split()[0]) for line in again.splitlines()
               if 'steering offset' in line]
    np.testing.assert_allclose(changes, 0.0, atol=0.002)


@pytest.mark.parametrize('storage, tail', [
    *((storage, b'') for storage in StoragePlugin), (StoragePlugin.MCAP, bytes(8))])
def test_bag_with_poses(capsys, tmp_path, params, drive, storage, tail):
    bag = write_bag(tmp_path / 'bag', storage, tail, ground_truth=truth(drive),
                    joint_states=joint_states(drive, gyro=True))
    output, found = run(capsys, bag, '--params', params, '--truth-topic', '/ground_truth')
    assert_recovered(found)
    assert gyro_scale(output) == pytest.approx(1.01, abs=0.001)


def test_bag_with_an_imu_and_other_topics(capsys, tmp_path, params, drive):
    params.write_text(PARAMETERS.replace('gyro_source: joint', 'gyro_source: imu'))
    bag = write_bag(tmp_path / 'bag', StoragePlugin.MCAP, tracker=truth(drive),
                    imu_data=imu(drive), joints=joint_states(drive, gyro=False))
    output, found = run(
        capsys, bag, '--params', params, '--truth-topic', '/tracker',
        '--joint-states-topic', '/joints', '--imu-topic', '/imu_data')
    assert_recovered(found)
    assert gyro_scale(output) == pytest.approx(1.01, abs=0.001)


@pytest.mark.parametrize('so_far', [0.0, 0.01])
def test_the_delay_of_an_imu_is_found_and_printed(
        capsys, tmp_path, params, drive, so_far):
    params.write_text(PARAMETERS.replace(
        'gyro_source: joint', f'gyro_source: imu\n    imu_delay: {so_far}'))
    bag = write_bag(tmp_path / 'bag', StoragePlugin.MCAP, truth=truth(drive),
                    imu=imu(drive, delay=0.013), joint_states=joint_states(drive, gyro=False))
    output, found = run(capsys, bag, '--params', params, '--truth-topic', '/truth')
    # It is the whole one, whatever the values so far have of it.
    assert float(output.split('  delay')[1].split()[0]) == pytest.approx(0.013, abs=0.001)
    assert found['imu_delay'] == pytest.approx(0.013, abs=0.001)


def test_no_delay_is_printed_that_the_node_would_refuse(capsys, tmp_path, params, drive):
    params.write_text(PARAMETERS.replace('gyro_source: joint',
                                         'gyro_source: imu\n    imu_delay: 0.195'))
    bag = write_bag(tmp_path / 'bag', StoragePlugin.MCAP, truth=truth(drive),
                    imu=imu(drive, delay=0.213), joint_states=joint_states(drive, gyro=False))
    output, found = run(capsys, bag, '--params', params, '--truth-topic', '/truth')
    assert float(output.split('  delay')[1].split()[0]) == pytest.approx(0.213, abs=0.001)
    assert 'more than imu_delay takes' in output and 'imu_delay' not in found


def test_spans_of_slip_are_named_with_their_wheels(capsys, tmp_path, params, drive):
    slow = np.where(drive.stamp[:, np.newaxis] < 8.0, 0.0, 0.7) * (0, 1, 0, 0)
    since = drive.wheel_angle - drive.wheel_angle[np.searchsorted(drive.stamp, 8.0)]
    spun = drive._replace(wheel_angle=drive.wheel_angle + slow * np.where(
        drive.stamp[:, np.newaxis] > 10.0, since[np.searchsorted(drive.stamp, 10.0)], since))
    recording = write_csv(tmp_path / 'drive.csv', *rows_of(spun))
    output, found = run(capsys, recording, '--params', params)
    assert 'Left out because wheels slipped:\n  8.0 s to 10.0 s: fr\n' in output
    assert_recovered(found)


def test_what_driven_wheels_hide_is_said_unless_the_base_was_pushed(
        capsys, tmp_path, params):
    calibrated = driven(Errors(np.ones(4), np.zeros(4), 1.0), np.random.default_rng(3))
    recording = write_csv(tmp_path / 'drive.csv', *rows_of(calibrated._replace(
        steering_angle=calibrated.steering_angle + OFFSETS_SO_FAR)))
    assert 'push the base' in run(capsys, recording, '--params', params)[0]
    assert 'push the base' not in run(capsys, recording, '--params', params, '--pushed')[0]


def test_a_gyro_joint_beside_the_imu_is_left_alone(capsys, tmp_path, params, drive):
    params.write_text(PARAMETERS.replace('gyro_source: joint', 'gyro_source: imu'))
    wrong = drive._replace(yaw=-drive.yaw)
    # A little before the joint states: of two samples with one stamp only one would count.
    early = drive._replace(stamp=drive.stamp - 0.001)
    bag = write_bag(tmp_path / 'bag', StoragePlugin.MCAP, ground_truth=truth(drive),
                    imu=imu(early), joint_states=joint_states(wrong, gyro=True))
    output, found = run(capsys, bag, '--params', params, '--truth-topic', '/ground_truth')
    assert_recovered(found)
    assert gyro_scale(output) == pytest.approx(1.01, abs=0.001)


def test_a_line_of_known_length(capsys, tmp_path, params):
    log, length = straight(ERRORS, np.random.default_rng(2))
    columns, rows = rows_of(log._replace(steering_angle=log.steering_angle + OFFSETS_SO_FAR))
    recording = write_csv(tmp_path / 'line.csv', columns[:-3], [row[:-3] for row in rows])
    output, found = run(capsys, recording, '--params', params, '--distance', length)
    np.testing.assert_allclose(found['wheel_radii'], 0.05 * ERRORS.radius_scale, rtol=0.001)
    relative = ERRORS.steering_offset - ERRORS.steering_offset.mean()
    np.testing.assert_allclose(
        found['steering_offsets'], OFFSETS_SO_FAR + relative, atol=0.1 * DEGREE)
    assert 'their mean is kept' in output
    assert 'unknown from this drive' in output  # the gyro's scale


def test_the_result_pasted_in_needs_no_further_change(capsys, tmp_path, params, drive):
    recording = write_csv(tmp_path / 'drive.csv', *rows_of(drive))
    _, first = run(capsys, recording, '--params', params)
    content = yaml.safe_load(PARAMETERS)
    content['/**']['ros__parameters'].update(first)
    params.write_text(yaml.safe_dump(content))
    _, second = run(capsys, recording, '--params', params)
    np.testing.assert_allclose(second['wheel_radii'], first['wheel_radii'], atol=2e-6)
    # Wheels that agree may have been driven: there noise counts by other weights.
    np.testing.assert_allclose(second['steering_offsets'], first['steering_offsets'], atol=2e-5)


def refused(capsys, *args):
    """Return the one line with which the tool ends."""
    code = main([str(arg) for arg in args])
    output, errors = capsys.readouterr()
    assert code == 1
    assert output == ''
    assert errors.count('\n') == 1
    return errors


@pytest.mark.parametrize('reason, changed', [
    ('no column stamp, but: time, ', lambda columns, rows: (['time', *columns[1:]], rows)),
    ('joint states are 20 s apart', lambda columns, rows: (
        columns, [[1e3 * (row[0] - START), *row[1:]] for row in rows])),
    ("'stamp' is 1.7e+18: it must be in seconds", lambda columns, rows: (
        columns, [['1.7e+18', *row[1:]] for row in rows])),
    ("'stamp' is 1e+300: it must be in seconds", lambda columns, rows: (
        columns, [['1e+300', *row[1:]] for row in rows])),
    ("line 2: 'stamp' is -3.0: it must be in seconds, and not negative", lambda columns, rows: (
        columns, [[row[0] - rows[0][0] - 3.0, *row[1:]] for row in rows])),
    ('no column truth_x, truth_y, truth_yaw: add what is missing, or give --distance',
     lambda columns, rows: (columns[:-3], [row[:-3] for row in rows])),
    ('no joint states of fl_drive_joint', lambda columns, rows: (
        [columns[0], 'wheel', *columns[2:]], rows)),
    ("line 5: 'fr_drive_joint' is not a finite number: nan", lambda columns, rows: (
        columns, [*rows[:3], [*rows[3][:2], 'nan', *rows[3][3:]], *rows[4:]])),
    ("line 3: 'truth_yaw' is not a finite number: empty", lambda columns, rows: (
        columns, [rows[0], rows[1][:-1]])),
    ("line 2: 'fl_drive_joint' is not a finite number: empty", lambda columns, rows: (
        columns, [[rows[0][0], '', *rows[0][2:]]])),
    ('more than one column stamp, fl_drive_joint', lambda columns, rows: (
        [*columns, *columns[:2]], [[*row, *row[:2]] for row in rows])),
    ('stamps of the joint states jump back by 7.98 s after 8.0 s', lambda columns, rows: (
        columns, rows[:400] + rows)),
    ('too short', lambda columns, rows: (columns, rows[:100])),
    ('the poses are more than 0.25 s apart', lambda columns, rows: (columns, rows[::15])),
    ('fewer than two joint states', lambda columns, rows: (columns, rows[:1])),
    ('no joint states of fl_drive_joint, fr', lambda columns, rows: (columns, []))])
def test_a_csv_of_no_use(capsys, tmp_path, params, drive, reason, changed):
    recording = write_csv(tmp_path / 'drive.csv', *changed(*rows_of(drive)))
    assert reason in refused(capsys, recording, '--params', params)


@pytest.mark.parametrize('joint, words', [
    ('rl_drive_joint', 'rl: drive stands still'), ('fr_steering_joint', 'fr: steering stands')])
def test_an_encoder_that_is_dead_is_named(capsys, tmp_path, params, drive, joint, words):
    columns, rows = rows_of(drive)
    dead = columns.index(joint)
    recording = write_csv(tmp_path / 'drive.csv', columns, [
        [*row[:dead], rows[0][dead], *row[dead + 1:]] for row in rows])
    line = refused(capsys, recording, '--params', params)
    assert words in line and 'swerve_check first' in line


def test_a_bag_of_no_use(capsys, tmp_path, params, drive):
    bag = write_bag(tmp_path / 'bag', StoragePlugin.MCAP, ground_truth=truth(drive),
                    joint_states=joint_states(drive, gyro=True))
    named = bag, '--params', params, '--truth-topic', '/ground_truth'
    assert '--truth-topic or --distance' in refused(capsys, bag, '--params', params)
    assert 'no topic /nothing' in refused(capsys, *named[:-1], '/nothing')
    assert 'no topic /joints' in refused(capsys, *named, '--joint-states-topic', '/joints')
    assert ('no topic /joint_states of type nav_msgs/msg/Odometry or geometry_msgs/'
            in refused(capsys, *named[:-1], '/joint_states'))
    file, = bag.glob('*.mcap')
    for length in 1000, 8:  # rosbags calls the second no error of its own
        file.write_bytes(file.read_bytes()[:length])
        assert f'{bag} cannot be read' in refused(capsys, *named)
    (bag / 'metadata.yaml').unlink()
    assert f'{bag} is not a rosbag2: it has no metadata.yaml' in refused(capsys, *named)
    assert 'nowhere' in refused(capsys, tmp_path / 'nowhere', *named[1:])


def test_a_fault_of_ours_is_no_damage_to_the_bag(monkeypatch, tmp_path, params, drive):
    bag = write_bag(tmp_path / 'bag', StoragePlugin.MCAP, ground_truth=truth(drive),
                    joint_states=joint_states(drive, gyro=True))
    monkeypatch.delattr(Collector, 'add_truth')
    with pytest.raises(AttributeError):
        main([str(bag), '--params', str(params), '--truth-topic', '/ground_truth'])


def test_a_table_may_be_named_in_capitals(capsys, tmp_path, params, drive):
    recording = write_csv(tmp_path / 'DRIVE.CSV', *rows_of(drive))
    assert_recovered(run(capsys, recording, '--params', params)[1])


@pytest.mark.parametrize('reason, content', [
    ('not YAML', '/**: ['),
    ('is for /swerve_node', 'other_node: {ros__parameters: {module_x: [0.3]}}'),
    ("'module_x'", PARAMETERS.replace('module_x: [0.3, 0.3, -0.3, -0.3]', 'module_x: [0.3]')),
    ("'wheel_radii'", PARAMETERS.replace('[5e-2]', '[-1.0]')),
    ("'wheel_radii'", PARAMETERS.replace('[5e-2]', '[small]'))])
def test_a_parameter_file_of_no_use(capsys, tmp_path, params, drive, reason, content):
    recording = write_csv(tmp_path / 'drive.csv', *rows_of(drive))
    params.write_text(content)
    assert reason in refused(capsys, recording, '--params', params)


def test_files_that_are_not_there(capsys, tmp_path, params):
    assert 'drive.csv' in refused(capsys, tmp_path / 'drive.csv', '--params', params)
    assert 'no.yaml' in refused(capsys, tmp_path / 'drive.csv', '--params', tmp_path / 'no.yaml')


@pytest.mark.parametrize('args', [
    [], ['x.csv'], ['x.csv', '--params', 'p', '--distance', '5', '--truth-topic', 't'],
    ['x.csv', '--params', 'p', '--encoder-counts', '0'],
    ['x.csv', '--params', 'p', '--truth-topic', 't'],
    ['x.csv', '--params', 'p', '--distance-std', 'nan']])
def test_a_wrong_command_line(capsys, args):
    with pytest.raises(SystemExit) as ended:
        main(args)
    assert ended.value.code == 2
