"""swerve_check moves a simulated base itself, slowly, and stops whatever happens."""

import os
import signal
import subprocess
import sys

from geometry_msgs.msg import Twist
import pytest
from std_msgs.msg import Float64MultiArray

SENSORS = {'encoder_resolution': 4096, 'gyro_bias': 0.0087}
PARAMETERS = """
swerve_node:
  ros__parameters:
    module_names: [front_left, front_right]
    module_x: [0.3, 0.3]
    module_y: [0.25, -0.25]
"""
TWO = {'module_names': ['front_left', 'front_right'], 'module_x': [0.3, 0.3],
       'module_y': [0.25, -0.25]}


@pytest.fixture
def start_check(namespace, tmp_path):
    """Return a function that starts swerve_check with options; it is ended with the test."""
    params, processes = tmp_path / 'robot.yaml', []
    params.write_text(PARAMETERS)

    def start(*options, answers=''):
        process = subprocess.Popen(
            [sys.executable, '-m', 'swerve_kinematics.tools.check.main', '--params', str(params),
             *options, '--ros-args', '-r', f'__ns:={namespace}'],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            env=os.environ)
        if answers:
            process.stdin.write(answers)
            process.stdin.flush()
        processes.append(process)
        return process

    yield start
    for process in processes:
        process.kill()
        process.communicate()


def test_each_joint_is_moved_alone_and_a_dead_one_named(start_check, start_sim, client):
    start_sim(**TWO, **SENSORS, **{'miswired.dead_drives': ['front_right']})
    speeds = client.listen(Float64MultiArray, 'drive_velocity_controller/commands')
    check = start_check('--on-blocks', '--yes')
    client.wait_until(lambda: check.poll() is not None, 'the end of the check')
    output = check.communicate()[0]
    assert check.returncode == 1, output
    assert 'front_right_drive_joint      drive stands still' in output
    assert output.count(' ok') == 3
    assert all(max(map(abs, command.data)) < 2.01 and sum(map(bool, command.data)) <= 1
               for command in speeds)
    assert speeds[-1].data.tolist() == [0.0, 0.0]


def test_what_no_sensor_knows_is_asked(start_check, start_sim, client):
    start_sim(**TWO, **SENSORS)
    check = start_check('--on-blocks', answers='y\ny\nn\nfront_right\ny\n')
    client.wait_until(lambda: check.poll() is not None, 'the end of the check')
    output = check.communicate()[0]
    assert check.returncode == 1, output
    assert 'front_right_steering_joint   steering joint counts clockwise' in output
    assert 'drive_joint_names: [front_right_drive_joint, front_left_drive_joint]' in output
    assert 'steering_directions: [1.0, -1.0]' in output


def test_it_stops_the_wheels_when_it_is_interrupted(start_check, start_sim, client):
    start_sim(**TWO, **SENSORS)
    speeds = client.listen(Float64MultiArray, 'drive_velocity_controller/commands')
    check = start_check('--on-blocks', '--yes')
    client.wait_until(lambda: any(any(command.data) for command in speeds), 'a wheel to turn')
    check.send_signal(signal.SIGINT)
    client.wait_until(lambda: check.poll() is not None, 'the end of the check')
    assert check.returncode == 2
    assert speeds[-1].data.tolist() == [0.0, 0.0]


def test_it_stops_the_wheels_when_the_joints_fall_silent(start_check, start_sim, client):
    sim = start_sim(**TWO, **SENSORS)
    speeds = client.listen(Float64MultiArray, 'drive_velocity_controller/commands')
    check = start_check('--on-blocks', '--yes')
    client.wait_until(lambda: any(any(command.data) for command in speeds), 'a wheel to turn')
    sim.end()
    client.wait_until(lambda: check.poll() is not None, 'the end of the check')
    assert check.returncode == 2 and 'fell silent' in check.communicate()[0]
    assert speeds[-1].data.tolist() == [0.0, 0.0]


def test_it_leaves_joints_alone_that_another_node_commands(start_check, start_sim, start_node,
                                                           client):
    start_sim(**TWO, **SENSORS)
    start_node(**TWO)
    client.wait_until(lambda: client.drive, 'commands of the node')
    check = start_check('--on-blocks', '--yes')
    client.wait_until(lambda: check.poll() is not None, 'the end of the check')
    assert check.returncode == 2 and 'stop it first' in check.communicate()[0]


def test_a_drive_by_hand_names_the_joint_that_does_not_obey(start_check, start_sim, start_node,
                                                            client):
    start_sim(**TWO, **SENSORS, **{'miswired.dead_drives': ['front_right']})
    start_node(**TWO, command_interface='joint_state')
    client.wait_until(lambda: client.odom, 'odometry')
    check = start_check('--live', '4')
    client.repeat_until(lambda: client.send_twist(vx=0.3, vy=0.1),
                        lambda: check.poll() is not None, 'the end of the check')
    output = check.communicate()[0]
    assert check.returncode == 1, output
    assert 'front_right_drive_joint      drive stands still' in output


def test_on_the_floor_it_stops_when_the_joints_fall_silent(start_check, start_sim, start_node,
                                                           client):
    sim = start_sim(**TWO, **SENSORS)
    start_node(**TWO)
    client.wait_until(lambda: client.odom, 'odometry')
    twists = client.listen(Twist, 'cmd_vel')
    check = start_check('--on-floor', '--yes')
    client.wait_until(lambda: any(twist.linear.x for twist in twists), 'the base to be moved')
    sim.end()
    client.wait_until(lambda: check.poll() is not None, 'the end of the check')
    assert check.returncode == 2 and 'fell silent' in check.communicate()[0]
    assert max(abs(twist.linear.x) for twist in twists) <= 0.2
    client.wait_until(lambda: twists[-1] == Twist(), 'the command to stop')
