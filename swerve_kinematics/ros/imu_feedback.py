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

"""What the messages of an IMU say about the base: its yaw, and what judges the wheels."""

from rclpy.node import Node

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.ros.accelerometer import AccelerometerFeedback, InertialMeans
from swerve_kinematics.ros.conversions import StampedNumbers
from swerve_kinematics.ros.feedback import JointFeedback
from swerve_kinematics.ros.sample import Sample
from swerve_kinematics.ros.serialized_reading import read_imu
from swerve_kinematics.ros.stamps import nanoseconds
from swerve_kinematics.ros.static_mounting import imu_of

# What a step is told of a force that is out of range: a collision perhaps, and not just unknown.
OUT_OF_RANGE = InertialMeans((1e6, 0.0), None)


class ImuFeedback:
    """
    Hands what an IMU measures to the gyro of the feedback and to the accelerometer.

    Parameters
    ----------
    node : rclpy.node.Node
        Hears how the IMU is mounted.
    parameters : NodeParameters
        Of swerve_node.
    feedback : JointFeedback
        Has the gyro, and counts what is of no use.

    Attributes
    ----------
    accelerometer : AccelerometerFeedback

    """

    def __init__(self, node: Node, parameters: NodeParameters, feedback: JointFeedback) -> None:
        """Start without a message."""
        self._mounted, self._feedback = imu_of(node, parameters, feedback.ignored), feedback
        self._delay = nanoseconds(parameters.imu_delay)
        self.accelerometer = AccelerometerFeedback()

    def read(self, data: bytes) -> StampedNumbers | None:
        """Return what a serialized sensor_msgs/Imu says; None, and counted, if it is damaged."""
        imu = read_imu(data)
        if imu is None:
            self._feedback.ignored['damaged imu'] += 1
        return imu

    def take(self, stamp: int, imu: StampedNumbers) -> None:
        """Take what an IMU says that is stamped by a clock like that of the joints [ns]."""
        stamp -= self._delay
        self._feedback.read_gyro(stamp, *self._mounted.yaw_and_rate(imu))
        self.accelerometer.add(stamp, self._mounted.inertial(imu))

    def means(self, sample: Sample) -> InertialMeans:
        """Return the means of force and rates since the sample before."""
        means = self.accelerometer.means(sample.stamp, sample.distances)
        return OUT_OF_RANGE if self.accelerometer.is_out_of_range else means
