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

"""The parts of the node between its sensors and its odometry, in this process."""

from rclpy.serialization import serialize_message
from sensor_msgs.msg import Imu

from swerve_kinematics import SwerveOdometry
from swerve_kinematics.configuration.node import NODE_DECLARATIONS, parameters_from
from swerve_kinematics.ros.feedback import JointFeedback
from swerve_kinematics.ros.imu_feedback import ImuFeedback
from swerve_kinematics.ros.stamps import NANOSECONDS, nanoseconds, set_stamp


def values(declarations, given):
    """Return the values of parameters that are given, and the defaults of the others."""
    return {declaration.name: given.get(declaration.name, declaration.initial)
            for declaration in declarations}


class OdometryParts:
    """
    Hears joint states and an IMU, as the node does, and keeps the odometry.

    Parameters
    ----------
    given : dict
        Parameters of swerve_node that differ from their defaults and from an IMU mounted straight.

    """

    def __init__(self, **given):
        """Wait for messages."""
        p = self.parameters = parameters_from(values(NODE_DECLARATIONS, {
            'gyro_source': 'imu', 'imu_orientation': [0.0, 0.0, 0.0], **given}))
        self.names = [*p.layout.drive_joints, *p.layout.steering_joints]
        self.feedback = JointFeedback(
            p.layout, p.layout.gyro_joint if p.gyro_source == 'joint' else None,
            nanoseconds(p.feedback_timeout), nanoseconds(p.gyro_timeout))
        self.imu = ImuFeedback(None, p, self.feedback)
        self.odometry = SwerveOdometry(
            p.layout.kinematics, estimate_gyro_bias=p.estimate_gyro_bias, noise=p.noise,
            imu_position=p.imu_position)

    def hear_imu(self, stamp, orientation, rates, force):
        """Take what an IMU says at a time [s]; None for a force that is not measured."""
        message = Imu()
        set_stamp(message.header.stamp, nanoseconds(stamp))
        q, w, a = message.orientation, message.angular_velocity, message.linear_acceleration
        q.x, q.y, q.z, q.w = orientation
        w.x, w.y, w.z = rates
        if force is None:
            message.linear_acceleration_covariance[0] = -1.0
        else:
            a.x, a.y, a.z = force
        imu = self.imu.read(serialize_message(message))
        self.imu.take(imu.stamp, imu)

    def hear_joints(self, stamp, positions):
        """Take positions of all joints [rad] at a time [s]; return the pose (3,)."""
        self.tell(self.feedback.read(nanoseconds(stamp), self.names, positions, []))
        return self.odometry.pose

    def tell(self, sample):
        """Hand a sample, if it is one, to the odometry; tell whether that moved on."""
        if sample is None:
            return False
        if not sample.continuous:
            self.odometry.reprime(sample.gyro_went_on)
        means = self.imu.means(sample)
        return self.odometry.update(
            sample.stamp / NANOSECONDS, sample.distances, sample.angles, sample.yaw,
            sample.yaw_rate, sample.velocities, means.force, means.rates, sample.rate_integral)
