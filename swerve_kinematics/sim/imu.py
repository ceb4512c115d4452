"""What an IMU on the simulated base measures in its own frame, however it is mounted."""

from typing import Sequence

from sensor_msgs.msg import Imu

from swerve_kinematics.core.geometry.rotations import from_roll_pitch_yaw, product, up

FRAME = 'imu_link'


class SimulatedImu:
    """
    An IMU on a level base.

    Parameters
    ----------
    orientation : sequence of float (3,)
        Roll, pitch and yaw of the sensor in the frame of the base [rad]; empty: along its axes.

    """

    def __init__(self, orientation: Sequence[float]) -> None:
        """Mount the sensor."""
        self._mounting = from_roll_pitch_yaw(*(orientation or (0.0, 0.0, 0.0)))
        self.message = Imu()
        self.message.header.frame_id = FRAME
        # Accelerations are not measured.
        self.message.linear_acceleration_covariance[0] = -1.0

    def measure(self, yaw: float, rate: float) -> Imu:
        """Return the message for a yaw [rad] and a yaw rate [rad/s] of the base."""
        orientation, velocity = self.message.orientation, self.message.angular_velocity
        rotation = product(from_roll_pitch_yaw(0.0, 0.0, yaw), self._mounting)
        orientation.x, orientation.y, orientation.z, orientation.w = rotation
        velocity.x, velocity.y, velocity.z = (rate * share for share in up(self._mounting))
        return self.message
