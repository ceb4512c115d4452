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

"""swerve_check reads a drive, says what is wrong, and prints parameters that mend it."""

from contextlib import suppress
import csv
import pty
import sys

from checking_drives import all_slightly_off, driven, POSITIONS, RADIUS, Truth
from checking_faults import DESCRIBED_WRONGLY, OUT_OF_ORDER
import numpy as np
import pytest
from recorded_bags import joint_state, numbers, write_bag
from swerve_kinematics.configuration.program import read_parameters
from swerve_kinematics.core.checking.changes import (
    Change, CROSSED, DRIVE_REVERSED, DRIVES_EXCHANGED, EXCHANGED, ORDER, STEERING_REVERSED)
from swerve_kinematics.core.checking.hypothesis import Hypothesis
from swerve_kinematics.core.checking.joints import AGAINST, DRIVE, JointFault
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.tools.check.main import main
from swerve_kinematics.tools.check.questions import progress
from swerve_kinematics.tools.check.report import exit_code, report
import yaml

MODULES = 'front_left', 'front_right', 'rear_left', 'rear_right'
JOINTS = [f'{module}_{kind}_joint' for kind in ('drive', 'steering') for module in MODULES]
PARAMETERS = {'module_names': list(MODULES), 'module_x': POSITIONS[:, 0].tolist(),
              'module_y': POSITIONS[:, 1].tolist(), 'wheel_radii': [RADIUS]}


def checked(folder, data, capsys, *options, **parameters):
    """Return exit code, output and the parameters to paste for a drive in a CSV file."""
    params, drive = folder / 'robot.yaml', folder / 'drive.csv'
    params.write_text(yaml.safe_dump(
        {'swerve_node': {'ros__parameters': {**PARAMETERS, **parameters}}}))
    columns = [*JOINTS, 'gyro_joint', *(f'{joint}_command' for joint in JOINTS)]
    with drive.open('w', newline='') as file:
        writer = csv.writer(file)
        writer.writerow(['stamp', *columns])
        writer.writerows(np.column_stack((
            data.stamp, data.distances / RADIUS, data.angles, data.yaw,
            data.commanded_speeds / RADIUS, data.commanded_angles)).tolist())
    code = main([str(drive), '--params', str(params), *options])
    output = capsys.readouterr().out
    return code, output, yaml.safe_load(output.partition('# for the parameter file:')[2]) or {}


def test_a_healthy_base_is_well(tmp_path, capsys):
    code, output, mends = checked(tmp_path, driven(seed=1), capsys)
    assert code == 0 and mends == {}
    assert output.count(' ok\n') + output.count(' ok') >= len(JOINTS) + 2


@pytest.mark.parametrize('inch, is_odd', [(1.0, False), (0.0254, True)])
def test_what_is_odd_about_the_file_is_said_too(tmp_path, capsys, inch, is_odd):
    """For a layout in inches, a drive blames something else."""
    params = tmp_path / 'robot.yaml'
    params.write_text(yaml.safe_dump({'/**': {'ros__parameters': {
        **PARAMETERS, **{f'module_{axis}': (places / inch).tolist()
                         for axis, places in zip('xy', POSITIONS.T)}}}}))
    main([str(tmp_path / 'drive.csv'), '--params', str(params)])
    assert ('CHECK: small for the base' in capsys.readouterr().err) is is_odd


def test_a_base_that_needs_calibration_is_well_and_is_told_so(tmp_path, capsys):
    code, output, mends = checked(tmp_path, driven(all_slightly_off(1), seed=1), capsys)
    assert code == 0 and mends == {}
    assert 'swerve_calibrate measures them' in output
    assert 'swerve_calibrate' not in checked(tmp_path, driven(seed=1), capsys)[1]


@pytest.mark.parametrize('options, first', [
    ((), 'front_left_drive_joint'), (('--params', 'missing.yaml'), 'swerve_check: ')], ids=str)
def test_what_it_says_takes_the_place_of_the_progress(tmp_path, capsys, monkeypatch, options,
                                                      first):
    screen, terminal = pty.openpty()
    with open(terminal, 'w') as stream, monkeypatch.context() as patch:
        patch.setattr(sys, 'stdout', stream)
        patch.setattr(sys, 'stderr', stream)
        progress('in curves: 0 s left')
        checked(tmp_path, driven(seed=1, duration=3.0), capsys, *options)
    with open(screen, 'rb', buffering=0) as stream:
        # Whoever reads on when all was read and nobody writes any more gets an error.
        shown = ''
        with suppress(OSError):
            while chunk := stream.read(4096):
                shown += chunk.decode()
    assert shown.rpartition('\r' + ' ' * 76 + '\r')[2].startswith(first), shown


@pytest.mark.parametrize('name, expected', [
    ('front left drive reversed', {'drive_directions': [-1.0, 1.0, 1.0, 1.0]}),
    ('rear right steering clockwise', {'steering_directions': [1.0, 1.0, 1.0, -1.0]}),
    ('front left and right swapped', {
        'module_y': [-0.25, 0.25, 0.25, -0.25]}),
    ('offset wrong by 90 degrees', {'steering_offsets': [0.0, 0.0, 1.570796, 0.0]}),
    ('x and y swapped', {'module_x': POSITIONS[:, 1].tolist(),
                         'module_y': POSITIONS[:, 0].tolist()})])
def test_the_right_mend_is_printed_as_yaml(tmp_path, capsys, name, expected):
    code, output, mends = checked(tmp_path, driven(DESCRIBED_WRONGLY[name][0], seed=1), capsys)
    assert code == 1
    assert mends == expected


def test_a_radius_is_mended_within_a_percent(tmp_path, capsys):
    truth = DESCRIBED_WRONGLY['front left radius'][0]
    _, _, mends = checked(tmp_path, driven(truth, seed=1), capsys)
    assert mends['wheel_radii'] == pytest.approx([1.2 * RADIUS, RADIUS, RADIUS, RADIUS], rel=0.01)


@pytest.mark.parametrize('gear', [{}, {'drive_directions': [-1.0], 'drive_ratios': [6.75]}])
def test_a_coupling_that_is_not_described_is_printed(tmp_path, capsys, gear):
    # With a radius that is larger by the gear, the readings remain those of joints without one.
    parameters = {'wheel_radii': [RADIUS * gear.get('drive_ratios', [1.0])[0]], **gear}
    data = driven(Truth(rolls=dict.fromkeys(range(4), -0.53)), seed=1)
    if gear:
        data = data._replace(distances=-data.distances, commanded_speeds=-data.commanded_speeds)
    code, output, mends = checked(tmp_path, data, capsys, **parameters)
    assert code == 1 and 'drive_coupling_ratio         all modules: wheel rolls' in output
    ratio = 0.53 * (-1.0 if gear else 1.0)
    assert mends == {'drive_coupling_ratio': pytest.approx([ratio] * 4, abs=0.02)}, output


def test_what_only_a_tape_tells_apart_is_to_be_measured_first(tmp_path, capsys):
    _, output, _ = checked(tmp_path, driven(DESCRIBED_WRONGLY['all radii'][0], seed=1), capsys)
    assert 'measure a wheel and the layout before you paste' in output


@pytest.mark.parametrize('name, words', [
    ('emergency stop', 'emergency stop engaged'), ('dead steering', 'steering stands still'),
    ('drive motor reversed', 'drive reads the opposite of its command')])
def test_what_no_parameter_mends_is_said_without_one(tmp_path, capsys, name, words):
    code, output, mends = checked(tmp_path, driven(OUT_OF_ORDER[name][0], seed=1), capsys)
    assert code == 1 and mends == {}
    assert words in output


def test_it_says_which_motion_would_tell_more(tmp_path, capsys):
    straight = driven(twist_at=lambda time: (0.5 * (time > 0.5), 0.0, 0.0))
    code, output, _ = checked(tmp_path, straight, capsys)
    assert code == 2 and 'sideways, turning' in output
    assert 'not ruled out: ' in output and 'steering reversed' in output


def test_a_base_that_stands_tells_nothing(tmp_path, capsys):
    code, output, _ = checked(tmp_path, driven(twist_at=lambda time: (0.0, 0.0, 0.0)), capsys)
    assert code == 2 and 'did not move' in output


@pytest.mark.parametrize('arguments', [
    [], ['a.csv', '--on-floor'], ['--live', '-1'], ['a.csv', '--step', '1'],
    ['--on-blocks', '--save', 'a.png']])
def test_the_command_line_names_what_is_missing_or_of_no_use(arguments, capsys):
    with pytest.raises(SystemExit) as end:
        main([*arguments, '--params', 'x.yaml'])
    assert end.value.code == 2 and 'error:' in capsys.readouterr().err


def test_a_file_of_no_use_is_one_line(tmp_path, capsys):
    assert main([str(tmp_path / 'nothing.csv'), '--params', str(tmp_path / 'no.yaml')]) == 2
    assert capsys.readouterr().err.startswith('swerve_check: ')


def test_a_picture_shows_expected_and_measured_motion(tmp_path, capsys):
    pytest.importorskip('matplotlib')
    picture = tmp_path / 'check.png'
    drive = driven(DESCRIBED_WRONGLY['front left steering clockwise'][0], seed=1)
    checked(tmp_path, drive, capsys, '--save', str(picture))
    assert picture.read_bytes().startswith(b'\x89PNG')


def recorded(path, data, by_name):
    """Write a drive to a bag, its commands by name or as two lists."""
    drives, steerings, stamps = JOINTS[:4], JOINTS[4:], data.stamp
    # Commands come before the joint states that answer to them.
    commands = [(stamp - 0.001, speeds / RADIUS, angles) for stamp, speeds, angles in zip(
        stamps, data.commanded_speeds, data.commanded_angles)]
    if by_name:
        told = {'joint_commands': [
            *((stamp, joint_state(stamp, drives, velocities=speeds))
              for stamp, speeds, _ in commands),
            *((stamp, joint_state(stamp, steerings, angles)) for stamp, _, angles in commands)]}
    else:
        told = {'drive_velocity_controller/commands': [
                    (stamp, numbers(speeds)) for stamp, speeds, _ in commands],
                'steering_position_controller/commands': [
                    (stamp, numbers(angles)) for stamp, _, angles in commands]}
    write_bag(path, **told, joint_states=[
        (stamp, joint_state(stamp, [*JOINTS, 'gyro_joint'], [*distances / RADIUS, *angles, yaw]))
        for stamp, distances, angles, yaw in zip(stamps, data.distances, data.angles, data.yaw)])


@pytest.mark.parametrize('by_name', [True, False])
def test_a_bag_tells_what_was_commanded(tmp_path, capsys, by_name):
    drive = driven(OUT_OF_ORDER['drive motor reversed'][0], seed=1, duration=8.0)
    recorded(tmp_path / 'drive', drive, by_name)
    params = tmp_path / 'robot.yaml'
    params.write_text(yaml.safe_dump({'swerve_node': {'ros__parameters': PARAMETERS}}))
    assert main([str(tmp_path / 'drive'), '--params', str(params)]) == 1
    output = capsys.readouterr().out
    assert 'rear_left_drive_joint        drive reads the opposite of its command' in output
    assert 'rear_left: the motion of the base shows that its drive motor must' in output


def test_no_direction_is_blamed_where_motor_and_encoder_contradict_each_other(tmp_path):
    path = tmp_path / 'robot.yaml'
    path.write_text(yaml.safe_dump({'swerve_node': {'ros__parameters': PARAMETERS}}))
    output = report(read_parameters(path), Verdict(
        joints=(JointFault(DRIVE, AGAINST, (1,)),),
        changes=(Change(DRIVE_REVERSED, (1,)), Change(STEERING_REVERSED, (1,)))), is_still=True)
    assert 'front_right_drive_joint      drive reads the opposite of its command' in output
    assert 'drive_directions' not in output
    assert 'steering_directions: [1.0, -1.0, 1.0, 1.0]' in output


@pytest.mark.parametrize('interface, change, is_said', [
    ('forward_command', Change(EXCHANGED, (0, 1)), True),
    ('forward_command', Change(CROSSED, (2, 3)), True),
    ('forward_command', Change(ORDER, (0, 2, 3, 1), 1), True),
    ('forward_command', Change(DRIVES_EXCHANGED, (0, 1)), False),
    ('joint_state', Change(EXCHANGED, (0, 1)), False)], ids=str)
def test_it_is_said_where_modules_move_and_their_names_stay(tmp_path, interface, change, is_said):
    path = tmp_path / 'robot.yaml'
    path.write_text(yaml.safe_dump({'swerve_node': {'ros__parameters': {
        **PARAMETERS, 'command_interface': interface}}}))
    output = report(read_parameters(path), Verdict(changes=(change,)), is_still=True)
    said, _, mends = output.partition('# for the parameter file:')
    assert ('or swap the cables, not both' in said) is is_said, output
    assert ('module_y' in mends) is is_said


def test_what_is_not_ruled_out_by_any_motion_is_sent_to_the_blocks(tmp_path):
    path = tmp_path / 'robot.yaml'
    path.write_text(yaml.safe_dump({'swerve_node': {'ros__parameters': PARAMETERS}}))
    verdict = Verdict(is_moving=True, untold=(Change(DRIVES_EXCHANGED, (1, 2)),))
    assert exit_code(verdict) == 2
    output = report(read_parameters(path), verdict)
    assert 'not ruled out: drive joints swapped' in output and 'check on blocks' in output


def test_no_certainty_is_claimed_where_others_may_explain_it(tmp_path):
    path = tmp_path / 'robot.yaml'
    path.write_text(yaml.safe_dump({'swerve_node': {'ros__parameters': PARAMETERS}}))
    changes, other = (Change(DRIVE_REVERSED, (1,)),), (Change(DRIVE_REVERSED, (2,)),)
    output = report(read_parameters(path), Verdict(
        changes=changes, hypothesis=Hypothesis(changes, (), (), 0.0), confidence=0.9976,
        alternatives=(other,)))
    assert 'with a probability of 99 %. Others that may explain it:' in output


@pytest.mark.parametrize('gyro, advice', [
    ('joint', 'drive longer, or check on blocks'), ('none', 'driving does not decide')])
def test_nobody_is_told_to_drive_on_where_there_is_no_gyro_to_tell_more(tmp_path, gyro, advice):
    path = tmp_path / 'robot.yaml'
    path.write_text(yaml.safe_dump({'swerve_node': {'ros__parameters': {
        **PARAMETERS, 'gyro_source': gyro}}}))
    verdict = Verdict(is_moving=True, untold=(Change(DRIVE_REVERSED, (1,)),))
    assert advice in report(read_parameters(path), verdict)
