"""Between ROS messages and the arrays of the core. Outgoing messages are built once."""

from array import array
import math

from geometry_msgs.msg import TransformStamped, TwistStamped
from nav_msgs.msg import Odometry
import numpy as np
from rclpy.duration import Duration
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from swerve_kinematics.ros.qos import publisher
from swerve_kinematics.ros.stamps import set_stamp

# Variance of what a planar base does not measure, by the convention of robot_localization.
UNKNOWN_VARIANCE = 1e6
# How long a process that ends waits for a listener that does not answer.
DELIVERY_TIMEOUT = Duration(seconds=0.5)
# Where x, y and yaw stand among x, y, z, roll, pitch, yaw.
PLANAR_AXES = (0, 1, 5)
# The 9 places of the planar block in the row-major 6x6 covariance.
PLANAR_BLOCK = [6 * row + column for row in PLANAR_AXES for column in PLANAR_AXES]


def planar_twist(twist):
    """Return a geometry_msgs/Twist as `(vx, vy, omega)` [m/s, m/s, rad/s]."""
    return twist.linear.x, twist.linear.y, twist.angular.z


def yaw_of(quaternion):
    """Return the yaw [rad] of a geometry_msgs/Quaternion, NaN if it is no rotation."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    if not x * x + y * y + z * z + w * w > 0.0:
        return math.nan
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def set_yaw(quaternion, yaw):
    """Write a rotation about z by `yaw` [rad] to a geometry_msgs/Quaternion."""
    quaternion.z, quaternion.w = math.sin(0.5 * yaw), math.cos(0.5 * yaw)


def imu_yaw_and_rate(imu):
    """
    Return yaw [rad] and yaw rate [rad/s] of a sensor_msgs/Imu, NaN for what it lacks.

    A covariance that begins with -1 says that the quantity is not measured.
    """
    yaw = yaw_of(imu.orientation) if imu.orientation_covariance[0] != -1.0 else math.nan
    rate = imu.angular_velocity.z if imu.angular_velocity_covariance[0] != -1.0 else math.nan
    return yaw, rate


def planar_pose(pose):
    """Return a geometry_msgs/Pose as `[x, y, yaw]` (3,) [m, m, rad], yaw in (-pi, pi]."""
    return np.array([pose.position.x, pose.position.y, yaw_of(pose.orientation)])


def planar_pose_and_covariance(pose):
    """Return a geometry_msgs/PoseWithCovariance as arrays (3,) and (3, 3) [m, m, rad]."""
    return (planar_pose(pose.pose),
            np.asarray(pose.covariance)[PLANAR_BLOCK].reshape(3, 3))


def set_planar_block(covariance, block):
    """Write a planar covariance (9,), row by row [m, m, rad], to that of a message (36,)."""
    for place, value in zip(PLANAR_BLOCK, block):
        covariance[place] = value


class ForwardCommands:
    """
    Commands for two ros2_control forward controllers: a pair of Float64MultiArray.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publishers.
    layout : Layout
        Not used: the controllers know their joints. `JointCommands` needs it.

    """

    def __init__(self, node, layout):
        """Create publishers and messages."""
        self._drive = publisher(node, Float64MultiArray, 'drive_velocity_controller/commands')
        self._steering = publisher(
            node, Float64MultiArray, 'steering_position_controller/commands')
        self._message = Float64MultiArray()

    def publish(self, stamp, wheel_speeds, steering_angles):
        """
        Publish one command.

        Parameters
        ----------
        stamp : int
            Time [ns].
        wheel_speeds : list of float (n,)
            Drive joint velocities [rad/s].
        steering_angles : list of float (n,) or None
            Steering joint positions [rad]; None leaves the steering alone.

        """
        if steering_angles is not None:
            self._message.data = array('d', steering_angles)
            self._steering.publish(self._message)
        self._message.data = array('d', wheel_speeds)
        self._drive.publish(self._message)

    def wait_for_delivery(self):
        """Wait until the listeners have the commands: the end of a process drops the latest."""
        for commands in (self._drive, self._steering):
            commands.wait_for_all_acked(DELIVERY_TIMEOUT)


class JointCommands:
    """
    Commands in one stamped JointState, for topic-based ros2_control or Isaac Sim.

    The velocity of the drive joints and the position of the steering joints count; the other
    entries are 0, for nothing that is not finite is ever published.
    """

    def __init__(self, node, layout):
        """Create the publisher and the message."""
        self._publisher = publisher(node, JointState, 'joint_commands')
        self._drives, self._steerings = list(layout.drive_joints), list(layout.steering_joints)
        self._message = JointState()

    def publish(self, stamp, wheel_speeds, steering_angles):
        """Publish one command, as `ForwardCommands.publish` does."""
        message = self._message
        set_stamp(message.header.stamp, stamp)
        if steering_angles is None:
            message.name, message.position = self._drives, []
            message.velocity = wheel_speeds
        else:
            zeros = [0.0] * len(wheel_speeds)
            message.name = self._drives + self._steerings
            message.position = zeros + steering_angles
            message.velocity = wheel_speeds + zeros
        self._publisher.publish(message)

    def wait_for_delivery(self):
        """Wait as `ForwardCommands.wait_for_delivery` does."""
        self._publisher.wait_for_all_acked(DELIVERY_TIMEOUT)


class OdometryMessages:
    """
    The odometry as a message and, where a broadcaster is given, as a transform.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publisher.
    layout : Layout
        Gives the names of the frames.
    broadcaster : tf2_ros.TransformBroadcaster or None
        Sends odom -> base_link; None for no transform.

    """

    def __init__(self, node, layout, broadcaster):
        """Create the publisher and the messages."""
        self._publisher = publisher(node, Odometry, 'odom')
        self._broadcaster = broadcaster
        self._message = Odometry(child_frame_id=layout.base_frame)
        self._message.header.frame_id = layout.odom_frame
        unknown = np.diag([UNKNOWN_VARIANCE] * 6).ravel()
        self._message.pose.covariance = unknown.copy()
        self._message.twist.covariance = unknown.copy()
        # The same memory: single entries are set ten times as fast this way.
        self._pose_covariance = memoryview(self._message.pose.covariance)
        self._twist_covariance = memoryview(self._message.twist.covariance)
        self._transform = TransformStamped(child_frame_id=layout.base_frame)
        self._transform.header.frame_id = layout.odom_frame

    def publish(self, stamp, estimate):
        """
        Publish the state of the odometry.

        Parameters
        ----------
        stamp : int
            Time [ns] of the measurement it rests on.
        estimate : Estimate
            Pose, twist and their covariances.

        """
        message = self._message
        set_stamp(message.header.stamp, stamp)
        pose, twist = message.pose.pose, message.twist.twist
        pose.position.x, pose.position.y, yaw = estimate.pose
        set_yaw(pose.orientation, yaw)
        twist.linear.x, twist.linear.y, twist.angular.z = estimate.twist
        set_planar_block(self._pose_covariance, estimate.pose_covariance)
        set_planar_block(self._twist_covariance, estimate.twist_covariance)
        self._publisher.publish(message)
        if self._broadcaster is not None:
            self._broadcast(message)

    def _broadcast(self, message):
        """Send the transform that the odometry message describes."""
        transform = self._transform.transform
        self._transform.header.stamp = message.header.stamp
        transform.translation.x = message.pose.pose.position.x
        transform.translation.y = message.pose.pose.position.y
        transform.rotation = message.pose.pose.orientation
        self._broadcaster.sendTransform(self._transform)


class LimitedTwist:
    """
    The twist that is really being executed, in the base frame.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publisher.
    layout : Layout
        Gives the name of the base frame.

    """

    def __init__(self, node, layout):
        """Create the publisher and the message."""
        self._publisher = publisher(node, TwistStamped, '~/cmd_vel_limited')
        self._message = TwistStamped()
        self._message.header.frame_id = layout.base_frame

    def publish(self, stamp, twist):
        """Publish `twist` (3,) [m/s, m/s, rad/s] at `stamp` [ns], if anyone listens."""
        if not self._publisher.get_subscription_count():
            return
        set_stamp(self._message.header.stamp, stamp)
        linear = self._message.twist.linear
        linear.x, linear.y, self._message.twist.angular.z = twist
        self._publisher.publish(self._message)
