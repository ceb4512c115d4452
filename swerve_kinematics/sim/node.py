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

"""swerve_sim: the simulated base as a ROS node, in the place of a robot's drivers."""

from array import array
from dataclasses import replace
import sys
from typing import Mapping, Sequence

from builtin_interfaces.msg import Time
from nav_msgs.msg import Odometry
import numpy as np
from numpy.typing import NDArray
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Float64MultiArray

from swerve_kinematics.configuration.program import Settings, SIMULATOR
from swerve_kinematics.configuration.simulator import SIMULATOR_DECLARATIONS, SimulatorParameters
from swerve_kinematics.ros.declare import declare, overrides
from swerve_kinematics.ros.messages import set_planar_twist, set_yaw
from swerve_kinematics.ros.start import start
from swerve_kinematics.ros.valid_time import ValidTimeNode
from swerve_kinematics.sim import base, sensors
from swerve_kinematics.sim.bodies import body_from
from swerve_kinematics.sim.imu import Measurement, SimulatedImu
from swerve_kinematics.sim.miswiring import miswired_command, miswired_reading
from swerve_kinematics.sim.parameters import faults_from

# A clock that goes on by more than this [s] was set, or began: nobody drove in between.
CLOCK_JUMP = 5.0
# A machine that is too busy to simulate in real time falls behind, and catches up later: so many
# periods of publishing are simulated at once. More would look like a driver that skips readings,
# and would take a slow machine longer each time.
CATCH_UP = 5


class SwerveSim(ValidTimeNode):
    """
    Moves as it is commanded, and publishes what its sensors see and where it really is.

    Like a real drive it keeps the last setpoint when commands stop: stopping is the task of
    whoever commands it.
    """

    def __init__(self, settings: Settings[SimulatorParameters]) -> None:
        """Join the graph with what the parameters describe."""
        super().__init__(SIMULATOR.name, parameter_overrides=overrides(settings.of_rclpy))
        declare(self, SIMULATOR_DECLARATIONS, settings.values)
        p = settings.parameters
        self._body, self._miswiring, self._faults = body_from(p), p.miswiring, faults_from(p)
        self._imu = SimulatedImu(p.imu_orientation, p.accelerometer_bias,
                                 p.accelerometer_noise_density, p.seed)
        self._first_reading: sensors.Reading | None = None
        self._gyro_drift = 0.0
        self._generator = np.random.default_rng(p.seed)
        self._command = base.hold(self._body.config, self._body.state)
        self._ignored = 0
        self._simulated = self.get_clock().now()  # up to this time
        self._longest_step = Duration(seconds=CATCH_UP / p.publish_rate)
        self._create_outputs(p)
        self._create_inputs(p)
        self.get_logger().info(settings.summary)

    def _create_outputs(self, parameters: SimulatorParameters) -> None:
        """Create what goes out, in messages that are filled over and over."""
        layout, self._imu_frame = parameters.layout, parameters.imu_frame
        self._joint_states = JointState(
            name=[*layout.drive_joints, *layout.steering_joints, layout.gyro_joint])
        self._ground_truth = Odometry(child_frame_id=layout.base_frame)
        self._ground_truth.header.frame_id = layout.odom_frame
        self._imu_publisher = self.create_publisher(Imu, 'imu', 10)
        self._joint_publisher = self.create_publisher(JointState, 'joint_states', 10)
        self._truth_publisher = self.create_publisher(Odometry, 'ground_truth', 10)

    def _create_inputs(self, parameters: SimulatorParameters) -> None:
        """Create everything that comes in, and the timer."""
        layout = parameters.layout
        self._drive_index = {name: i for i, name in enumerate(layout.drive_joints)}
        self._steering_index = {name: i for i, name in enumerate(layout.steering_joints)}
        self.create_subscription(
            Float64MultiArray, 'drive_velocity_controller/commands', self._on_drive, 10)
        self.create_subscription(
            Float64MultiArray, 'steering_position_controller/commands', self._on_steering, 10)
        self.create_subscription(JointState, 'joint_commands', self._on_joints, 10)
        # Wall time wakes the node, its own clock says how much to simulate.
        self.create_timer(1.0 / parameters.publish_rate, self._on_timer,
                          clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _on_drive(self, message: Float64MultiArray) -> None:
        """Take drive joint velocities in module order."""
        self._take(replace(self._command, drive_velocity=np.array(message.data)))

    def _on_steering(self, message: Float64MultiArray) -> None:
        """Take steering joint positions in module order."""
        self._take(replace(self._command, steering_position=np.array(message.data)))

    def _on_joints(self, message: JointState) -> None:
        """Take velocities of drive and positions of steering joints by their names."""
        self._take(base.BaseCommand(
            _updated(self._command.drive_velocity, self._drive_index,
                     message.name, message.velocity),
            _updated(self._command.steering_position, self._steering_index,
                     message.name, message.position)))

    def _take(self, command: base.BaseCommand) -> None:
        """Take a command if it is complete and finite; else count it, and say so once."""
        count = len(self._body.state.wheel_speed)
        setpoints = command.drive_velocity, command.steering_position
        if all(s.shape == (count,) and np.isfinite(s).all() for s in setpoints):
            self._command = command
            return
        self._ignored += 1
        self.get_logger().warning(
            f'ignored a command: needs {count} finite setpoints, got drive velocities '
            f'{setpoints[0].tolist()}, steering positions {setpoints[1].tolist()}', once=True)

    def _on_timer(self) -> None:
        """Simulate up to now, and publish."""
        dt = self._step()
        if not dt > 0.0:
            return
        body = self._body
        held = base.hold(body.config, body.state)
        body.step(miswired_command(self._miswiring, self._command, held), dt)
        reading, self._gyro_drift = sensors.sense(
            body.config, self._faults, body.state, self._gyro_drift, dt, self._generator)
        self._first_reading = self._first_reading or reading
        reading = miswired_reading(self._miswiring, reading, self._first_reading)
        stamp = self._simulated.to_msg()
        if not reading.dropped:
            _fill_joint_states(self._joint_states, stamp, reading)
            self._joint_publisher.publish(self._joint_states)
            if self._imu_publisher.get_subscription_count():
                force, (roll_rate, pitch_rate, _) = body.inertial
                self._imu_publisher.publish(_imu_message(
                    stamp, self._imu_frame, self._imu.measure(
                        reading.yaw, (roll_rate, pitch_rate, reading.yaw_rate), force, dt)))
        _fill_odometry(self._ground_truth, stamp, body.state.pose, body.state.twist)
        self._truth_publisher.publish(self._ground_truth)

    def _step(self) -> float:
        """Return how much is to be simulated at once [s]; nothing if the clock was set."""
        clock, before = self.get_clock(), self._simulated
        self._simulated = now = clock.now()
        elapsed = now - before
        if not 0.0 < elapsed.nanoseconds * 1e-9 < CLOCK_JUMP:
            return 0.0
        is_real_time = not clock.handle.get_ros_time_override_is_enabled()
        if is_real_time and elapsed > self._longest_step:
            elapsed, self._simulated = self._longest_step, before + self._longest_step
        return float(elapsed.nanoseconds * 1e-9)

    def stop(self) -> None:
        """Say how many commands were of no use."""
        if self._ignored:
            self.get_logger().info(f'ignored {self._ignored} commands in all')


def _updated(setpoints: NDArray[np.float64], index: Mapping[str, int], names: Sequence[str],
             values: Sequence[float]) -> NDArray[np.float64]:
    """
    Return setpoints with those replaced that `names` and `values` give.

    A joint whose value is missing gets NaN: it makes the command unusable.
    """
    setpoints = setpoints.copy()
    for position, name in enumerate(names):
        if name in index:
            setpoints[index[name]] = values[position] if position < len(values) else np.nan
    return setpoints


def _fill_joint_states(message: JointState, stamp: Time, reading: sensors.Reading) -> None:
    """Write a reading into a JointState: drive joints, steering joints, gyro."""
    message.header.stamp = stamp
    message.position = array(
        'd', (*reading.drive_position, *reading.steering_position, reading.yaw))
    message.velocity = array(
        'd', (*reading.drive_velocity, *reading.steering_velocity, reading.yaw_rate))


def _imu_message(stamp: Time, frame: str, measured: Measurement) -> Imu:
    """Return a measurement as an Imu."""
    message = Imu()
    message.header.stamp, message.header.frame_id = stamp, frame
    orientation, velocity = message.orientation, message.angular_velocity
    force = message.linear_acceleration
    orientation.x, orientation.y, orientation.z, orientation.w = measured.orientation
    velocity.x, velocity.y, velocity.z = measured.angular_velocity
    force.x, force.y, force.z = measured.specific_force
    return message


def _fill_odometry(message: Odometry, stamp: Time, pose: NDArray[np.float64],
                   twist: NDArray[np.float64]) -> None:
    """Write a pose [m, m, rad] and a twist [m/s, m/s, rad/s] into an Odometry."""
    message.header.stamp = stamp
    position = message.pose.pose.position
    position.x, position.y, yaw = pose.tolist()
    set_yaw(message.pose.pose.orientation, yaw)
    set_planar_twist(message.twist.twist, twist.tolist())


def main(args: Sequence[str] | None = None) -> int:
    """Run the simulated base until it is interrupted; return its exit code."""
    return start(SIMULATOR, SwerveSim, args)


if __name__ == '__main__':
    sys.exit(main())
