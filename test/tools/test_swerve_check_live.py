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

"""swerve_check moves a base itself, slowly, and stops whatever happens."""

import os
import signal
import time

from geometry_msgs.msg import Twist
from graph import DRIVES, MODULES, Program, STEERINGS
from nav_msgs.msg import Odometry
import numpy as np
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from swerve_kinematics.configuration.node import NODE_DECLARATIONS, parameters_from
from swerve_kinematics.ros.conversions import planar_pose
from swerve_kinematics.ros.stamps import nanoseconds_of
from swerve_kinematics.tools.check.floor import turning_speed
import yaml

SENSORS = {'encoder_resolution': 4096, 'gyro_bias': 0.0087}
TWO = {'module_names': ['front_left', 'front_right'], 'module_x': [0.3, 0.3],
       'module_y': [0.25, -0.25]}
ENOUGH = 8  # stops, of which a best-effort listener may lose all but one


class Check(Program):
    """swerve_check in a process of its own, and whoever sits before it."""

    def __init__(self, folder, namespace, options):
        """Start it, its files in a new folder."""
        folder.mkdir()
        os.mkfifo(folder / 'typed')
        self._typed = open(folder / 'typed', 'r+b', buffering=0)
        super().__init__('swerve_kinematics.tools.check.main', namespace, (), {},
                         folder / 'check.log', options, folder / 'typed')

    def has_ended(self):
        """Tell whether it has ended."""
        return not self.is_running()

    def answer(self, line):
        """Type a line."""
        self._typed.write(f'{line}\n'.encode())

    def close(self):
        """End it at once if it has not ended, and type no more."""
        self.end(signal.SIGKILL)
        self._typed.close()


def written(folder, parameters):
    """Return the path of a parameter file."""
    path = folder / 'robot.yaml'
    path.write_text(yaml.safe_dump({'/**': {'ros__parameters': parameters}}))
    return str(path)


@pytest.fixture
def start_check(namespace, tmp_path):
    """Return a function that starts swerve_check with options; it is ended with the test."""
    checks = []

    def start(*options, parameters=TWO):
        checks.append(Check(
            tmp_path / f'check_{len(checks)}', namespace,
            ['--params', written(tmp_path, parameters), *options]))
        return checks[-1]

    yield start
    for check in checks:
        check.close()
        print(check.output)


def ended(client, check, action=bool):
    """Return exit code and output of a check that ends by itself, while something goes on."""
    client.repeat_until(action, check.has_ended, 'the end of the check')
    return check.wait(), check.output


@pytest.fixture
def send(client):
    """Return a function that sends the joints of a base of which at most one drive moves."""
    publisher = client.node.create_publisher(JointState, 'joint_states', 10)

    def send_joints(reading=0.0, late=0):
        message = JointState(name=DRIVES + STEERINGS, position=[reading, *[0.0] * 7])
        message.header.stamp = client.node.get_clock().now().to_msg()
        message.header.stamp.sec -= late
        publisher.publish(message)
    return send_joints


def is_moving(commands):
    """Tell whether a wheel was commanded to turn."""
    return any(any(command.data) for command in commands)


def test_a_wheel_that_rolls_because_its_module_turns_is_no_stray(start_check, start_sim, client):
    coupled = {**TWO, 'wheel_radii': [0.15], 'drive_coupling_ratio': [1.0]}
    start_sim(**coupled)
    check = start_check('--on-blocks', '--yes', '--step', '0.4', parameters=coupled)
    code, output = ended(client, check)
    assert code == 0, output


def test_each_joint_is_moved_alone_and_a_dead_one_named(start_check, start_sim, client):
    start_sim(**TWO, **SENSORS, **{'miswired.dead_drives': ['front_right']})
    check = start_check('--on-blocks', '--yes', '--step', '0.4')
    code, output = ended(client, check)
    assert code == 1, output
    assert 'front_right_drive_joint      drive stands still' in output
    assert output.count(' ok') == 3
    assert all(max(map(abs, command.data)) < 2.01 and sum(map(bool, command.data)) <= 1
               for command in client.drive)
    assert {command.data.index(max(command.data)) for command in client.drive if any(
        command.data)} == {0, 1}
    client.wait_until(lambda: not any(client.drive[-1].data), 'the stop')


def test_what_no_sensor_knows_is_asked_and_may_take_its_time(start_check, start_sim, client):
    start_sim(**TWO, **SENSORS)
    check = start_check('--on-blocks', '--step', '0.4')
    for question, answer in enumerate(('y', 'y', 'n', 'what?', 'front_right', 'y')):
        client.wait_until(lambda: check.output.count('] ') > question, 'a question')
        begun = time.monotonic()
        # Longer than silence of the joints may last.
        client.wait_until(lambda: question > 1 or time.monotonic() > begun + 0.7, 'a thought')
        check.answer(answer)
    code, output = ended(client, check)
    assert code == 1, output
    assert 'front_right_steering_joint   steering joint counts clockwise' in output
    assert 'drive joints swapped - swap their cables' in output
    # Commands go by index: other names would part the readings from them.
    assert output.endswith('# for the parameter file:\nsteering_directions: [1.0, -1.0]\n')


def test_on_blocks_a_motion_that_only_the_joint_reads_is_not_taken_for_the_wrong_way_round(
        start_check, start_sim, client):
    start_sim(**TWO, **SENSORS)
    check = start_check('--on-blocks', '--step', '0.3')
    for question, answer in enumerate(('y', 'y', 'hardly', 'hardly', 'y')):
        client.wait_until(lambda: check.output.count('] ') > question, 'a question')
        check.answer(answer)
    code, output = ended(client, check)
    assert code == 1 and output.count(' ok') == 2, output
    for joint in 'front_left_drive', 'front_right_steering':
        assert f'{joint}_joint'.ljust(29) + f'{joint.rpartition("_")[2]} hardly moves' in output
    assert '# for the parameter file:' not in output


def test_on_the_floor_a_motion_that_only_the_joints_read_ends_the_check(
        start_check, start_sim, start_node, client):
    start_sim(**TWO, **SENSORS)
    start_node(**TWO)
    client.wait_until(lambda: client.odom, 'odometry')
    check = start_check('--on-floor', '--step', '0.4')
    for question, answer in enumerate(('y', 'hardly')):
        client.wait_until(lambda: check.output.count('] ') > question, 'a question')
        check.answer(answer)
    code, output = ended(client, check)
    assert code == 2 and 'hardly moves although its joints say so' in output, output


def test_a_module_may_be_called_what_is_an_answer(start_check, start_sim, client):
    compass = {**TWO, 'module_names': ['n', 's']}
    start_sim(**compass)
    check = start_check('--on-blocks', '--step', '0.3', parameters=compass)
    for question, answer in enumerate(('y', 'y', 'n', 'y', 'yes')):
        client.wait_until(lambda: check.output.count('] ') > question, 'a question')
        check.answer(answer)
    code, output = ended(client, check)
    assert code == 1 and output.count('steering joints swapped') == 2, output
    assert 'counts clockwise' not in output


def test_no_module_is_turned_beyond_its_end_stops(start_check, start_sim, client):
    start_sim(**TWO, **SENSORS)
    lower, upper = [-1.9, -0.2], [0.1, 0.3]
    check = start_check('--on-blocks', '--step', '0.3', parameters={
        **TWO, 'steering_lower_limits': lower, 'steering_upper_limits': upper})
    for question, answer in enumerate(('y',) * 5 + ('none',)):
        client.wait_until(lambda: check.output.count('] ') > question, 'a question')
        check.answer(answer)
    code, output = ended(client, check)
    assert code == 0 and 'front_left turn clockwise' in output, output
    assert 'front_right turn counter-clockwise' in output, output
    angles = np.array([command.data for command in client.steering])
    assert (angles >= lower).all() and (angles <= upper).all()


def test_wheels_are_shown_straight_ahead_and_an_offset_that_is_wrong_is_seen(
        start_check, start_sim, client):
    # The base begins with its wheels straight ahead, where the description says otherwise.
    start_sim(**TWO, **SENSORS, steering_offsets=[0.9, 5.5])
    check = start_check('--on-blocks', '--step', '0.3', parameters={
        **TWO, 'steering_offsets': [0.9, -0.2]})
    for question, answer in enumerate(('y',) * 5 + ('front_right', 'none')):
        client.wait_until(lambda: check.output.count('] ') > question, 'a question')
        check.answer(answer)
    angles = np.array([command.data for command in client.steering])
    code, output = ended(client, check)
    assert code == 1 and output.count(' ok') == 3, output
    assert 'front_right_steering_joint   wheel does not point straight ahead' in output, output
    assert '# for the parameter file:' not in output
    # By the nearest way and slowly: one was there, and the other had 0.58 rad to go.
    np.testing.assert_allclose(angles[-1], [0.9, -0.2 + 2.0 * np.pi], atol=0.01)
    last = angles[(np.abs(np.diff(angles, axis=0)) > 0.2).any(axis=1).nonzero()[0].max() + 1:]
    assert np.abs(np.diff(last, axis=0)).max() < 0.15 and len(np.unique(last[:, 1])) > 10


def test_modules_that_sit_in_each_others_places_get_each_others_positions(
        start_check, start_sim, client):
    start_sim(**TWO, **SENSORS)
    check = start_check('--on-blocks', '--step', '0.3')
    for question, answer in enumerate(('y', *('front_right', 'front_left') * 2)):
        client.wait_until(lambda: check.output.count('] ') > question, 'a question')
        check.answer(answer)
    code, output = ended(client, check)
    assert code == 1 and output.endswith(
        '# for the parameter file:\nmodule_y: [-0.25, 0.25]\n'), output


def test_modules_that_sit_in_a_ring_of_each_others_places_get_their_positions(
        start_check, start_sim, client):
    three = {'module_names': ['a', 'b', 'c'], 'module_x': [0.3, -0.2, -0.1],
             'module_y': [0.0, 0.2, -0.3]}
    start_sim(**three, **SENSORS)
    check = start_check('--on-blocks', '--step', '0.3', parameters=three)
    for question, answer in enumerate(('y', *'bca' * 2)):
        client.wait_until(lambda: check.output.count('] ') > question, 'a question')
        check.answer(answer)
    code, output = ended(client, check)
    assert code == 1 and output.count(' joints in a different order') == 6, output
    # Where a is described the joints of c sit, and so on.
    assert output.endswith('# for the parameter file:\nmodule_x: [-0.2, -0.1, 0.3]\n'
                           'module_y: [0.2, -0.3, 0.0]\n'), output


def test_commands_in_another_order_than_the_readings_get_the_names_in_that_order(
        start_check, start_sim, client):
    # Told to stay where they are, modules turn to the angles of others before any is judged.
    start_sim(**SENSORS, steering_offsets=[0.3, -0.3, 0.0, 0.5])
    check = start_check('--on-blocks', '--yes', '--step', '0.4', parameters={
        'module_names': [MODULES[at] for at in (0, 2, 3, 1)], 'module_x': [0.3, -0.3, -0.3, 0.3],
        'module_y': [0.25, 0.25, -0.25, -0.25], 'steering_offsets': [0.3, 0.0, 0.5, -0.3]})
    code, output = ended(client, check)
    assert code == 1 and output.count(' ok') == 2, output
    assert yaml.safe_load(output.partition('# for the parameter file:')[2]) == {
        'drive_joint_names': DRIVES, 'steering_joint_names': STEERINGS,
        'steering_offsets': [0.3, -0.3, 0.0, 0.5]}, output


@pytest.mark.parametrize('by', [signal.SIGINT, signal.SIGHUP, None],
                         ids=['interrupted', 'hung up', 'silent'])
def test_it_stops_the_wheels_whatever_ends_it(start_check, client, send, by):
    check = start_check('--on-blocks', '--yes', '--step', '0.3')
    client.repeat_until(send, lambda: is_moving(client.drive), 'a wheel to turn')
    moving = len(client.drive)
    if by:
        check.send(by)
    code, output = ended(client, check)
    assert code == 2 and ('interrupted' if by else 'fell silent') in output
    client.wait_until(lambda: sum(not any(command.data) for command in client.drive[moving:])
                      >= ENOUGH and not any(client.drive[-1].data), 'the last stops')


def test_it_leaves_joints_alone_that_another_node_commands(start_check, client, send):
    client.node.create_publisher(Float64MultiArray, 'drive_velocity_controller/commands', 10)
    check = start_check('--on-blocks', '--yes')
    code, output = ended(client, check, send)
    assert code == 2 and 'stop it first' in output and not is_moving(client.drive)


def test_a_drive_by_hand_names_the_joint_that_does_not_obey(start_check, start_sim, start_node,
                                                            client):
    start_sim(**TWO, **SENSORS, **{'miswired.dead_drives': ['front_right']})
    start_node(**TWO, command_interface='joint_state')
    client.wait_until(lambda: client.odom, 'odometry')
    check = start_check('--live', '3.5')
    code, output = ended(client, check, lambda: client.send_twist(vx=0.3, vy=0.1))
    assert code == 1, output
    assert 'front_right_drive_joint      drive stands still' in output


def test_a_check_names_the_two_that_publish_the_same_joints(start_check, start_sim, client, send):
    # They tell different positions: together, joints that run to and fro.
    start_sim(**TWO, **SENSORS, steering_offsets=[1.0, -1.0])
    check = start_check('--live', '10')
    code, output = ended(client, check, send)
    assert code == 2
    assert ('the same joints are published by NS/client and NS/swerve_sim: stop one of them'
            ).replace('NS', client.node.get_namespace()) in output, output


def test_a_check_takes_drives_and_steerings_from_two_publishers(start_check, client):
    publishers = [client.node.create_publisher(JointState, 'joint_states', 10) for _ in range(2)]

    def send_halves():
        stamp = client.node.get_clock().now().to_msg()
        for publisher, names in zip(publishers, (DRIVES, STEERINGS)):
            message = JointState(name=names, position=[0.1 * time.monotonic()] * 4)
            message.header.stamp = stamp
            publisher.publish(message)
    check = start_check('--live', '1')
    output = ended(client, check, send_halves)[1]
    assert 'published by' not in output and 'front_left_drive_joint' in output, output


@pytest.mark.parametrize('what, words', [
    ('is interrupted', 'interrupted'), ('falls silent', 'fell silent'),
    ('rolls by itself', 'front_left_drive_joint does not stand still'),
    ('runs away', 'front_left_drive_joint runs away'),
    ('runs away and its clock is set', 'the stamps of joint_states jump back')])
def test_on_the_floor_it_stops_the_base_whatever_happens(start_check, client, send, what, words):
    twists = client.listen(Twist, 'cmd_vel')
    check = start_check('--on-floor', '--yes', '--step', '0.3')
    begun = [0.0]

    def moves():
        # By itself from the start, or fast as soon as the base is moved.
        runs_away = what.startswith('runs away') and bool(begun[0])
        speed = 1.0 if what == 'rolls by itself' else 20.0 * runs_away
        send(speed * (time.monotonic() - begun[0]), 30 if runs_away and 'clock' in what else 0)
    client.repeat_until(moves, lambda: any(twist != Twist() for twist in twists)
                        or check.has_ended(), 'the base to be moved')
    begun[0] = time.monotonic()
    if what == 'is interrupted':
        check.send(signal.SIGTERM)
    code, output = ended(client, check, bool if what == 'falls silent' else moves)
    assert code == 2 and words in output, output
    client.wait_until(lambda: all(twist == Twist() for twist in twists[-ENOUGH:]),
                      'the last stops')
    assert max(abs(twist.linear.x) for twist in twists) <= 0.2


@pytest.mark.parametrize('size, center, speed', [
    (0.3, 0.0, 0.5), (3.0, 0.0, 0.133), (12.0, 0.0, 0.0333), (0.3, 4.0, 0.093)])
def test_a_base_turns_more_slowly_the_farther_its_wheels_are_from_the_center(size, center, speed):
    values = {each.name: each.initial for each in NODE_DECLARATIONS}
    values |= {'module_x': [size, size, -size, -size], 'center_of_rotation': [center, 0.0]}
    assert turning_speed(parameters_from(values)) == pytest.approx(speed, rel=0.01)


def test_the_printed_parameters_mend_the_base(start_check, start_sim, start_node, client,
                                              tmp_path):
    # By the gyro alone, drives that all count backwards are a gyro that does: the eye decides.
    wrong = {f'miswired.{joint}_{part}s': modules for part in ('motor', 'encoder')
             for joint, modules in (('drive', list(MODULES)), ('steering', ['rear_right']))}
    parameters = {'max_linear_acceleration': 2.0, 'max_angular_acceleration': 5.0}
    twists, truth = client.listen(Twist, 'cmd_vel'), client.listen(Odometry, 'ground_truth')

    def checked(step, *answers):
        path, begun = written(tmp_path, parameters), time.time_ns()
        sim, node = start_sim(**SENSORS, **wrong), start_node('--params-file', path)
        # Of this node: the last words of the one before may still be on their way.
        client.wait_until(lambda: client.odom and nanoseconds_of(
            client.odom[-1].header.stamp) > begun, 'odometry')
        check = start_check('--on-floor', '--step', step, parameters=parameters)
        for question, answer in enumerate(answers):
            client.wait_until(lambda: check.output.count('] ') > question, 'a question')
            check.answer(answer)
        result = ended(client, check)
        node.end()
        sim.end()
        return result

    code, output = checked('0.4', 'y', 'n', 'n', 'n')
    assert code == 1, output
    mends = yaml.safe_load(output.partition('# for the parameter file:')[2])
    assert mends == {'drive_directions': [-1.0] * 4,
                     'steering_directions': [1.0, 1.0, 1.0, -1.0]}, output
    parameters.update(mends)
    client.odom.clear()
    truth.clear()
    code, output = checked('0.7', 'y', 'y', 'y', 'y')
    assert code == 0 and output.count(' ok') == 10, output
    moved = planar_pose(truth[-1].pose.pose)
    assert planar_pose(client.odom[-1].pose.pose) == pytest.approx(moved, abs=0.01)
    assert all(abs(twist.linear.x) <= 0.2 and abs(twist.linear.y) <= 0.2
               and abs(twist.angular.z) <= 0.5 for twist in twists)
    assert np.ptp([planar_pose(each.pose.pose)[:2] for each in truth], axis=0).min() > 0.02
