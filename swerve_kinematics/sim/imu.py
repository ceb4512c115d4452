"""What an IMU on the simulated base measures in its own frame, however it is mounted."""

from typing import NamedTuple, Sequence

from swerve_kinematics.core.geometry.rotations import from_roll_pitch_yaw, product, Rotation, up


class Measurement(NamedTuple):
    """Orientation in the world, and angular velocity in the frame of the sensor [rad/s]."""

    orientation: Rotation
    angular_velocity: tuple[float, float, float]


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

    def measure(self, yaw: float, rate: float) -> Measurement:
        """Return what it measures for a yaw [rad] and a yaw rate [rad/s] of the base."""
        x, y, z = up(self._mounting)
        return Measurement(product(from_roll_pitch_yaw(0.0, 0.0, yaw), self._mounting),
                           (rate * x, rate * y, rate * z))
