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

"""How a sensor is mounted, by the static transforms of the robot's description."""

from collections import Counter
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.geometry.rotations import (
    IDENTITY, inverse, is_rotation, product, Rotation)
from swerve_kinematics.ros.conversions import rotation_of, StampedNumbers
from swerve_kinematics.ros.mounted_imu import MountedImu


class SelfMountingImu(MountedImu):
    """
    An IMU that is mounted as the static transforms say, as soon as they and its frame are known.

    Until then, and where tf2's messages are not installed, along the axes of the base.

    Parameters
    ----------
    node : rclpy.node.Node
        Subscribes to /tf_static.
    base_frame : str
        Frame of the base.
    use : str
        As of a MountedImu.
    ignored : collections.Counter
        Counts the transforms that are of no use.

    """

    def __init__(self, node: Node, base_frame: str, use: str, ignored: Counter[str]) -> None:
        """Subscribe, and begin without a transform."""
        super().__init__((), use)
        self._base, self._frame, self._ignored = base_frame, '', ignored
        self._parents: dict[str, tuple[str, Rotation]] = {}
        try:
            from tf2_msgs.msg import TFMessage
        except ImportError:
            return
        node.create_subscription(TFMessage, '/tf_static', self.take, QoSProfile(
            depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def take(self, message: Any) -> None:
        """Take a tf2_msgs/TFMessage of static transforms."""
        for stamped in message.transforms:
            rotation = rotation_of(stamped.transform.rotation)
            if is_rotation(rotation):
                self._parents[stamped.child_frame_id] = stamped.header.frame_id, rotation
            else:
                self._ignored['static transforms that are no rotation'] += 1
        self._mount()

    def yaw_and_rate(self, imu: StampedNumbers) -> tuple[float, float]:
        """Return what a MountedImu does, in the frame that the message names."""
        if imu.frame != self._frame:
            self._frame = imu.frame
            self._mount()
        return super().yaw_and_rate(imu)

    def _mount(self) -> None:
        """Take the orientation of the sensor, if both frames hang together."""
        sensor, base = self._ancestors(self._frame), self._ancestors(self._base)
        common = next((frame for frame in sensor if frame in base), None)
        if common is not None:
            self.mount(product(inverse(base[common]), sensor[common]))

    def _ancestors(self, frame: str) -> dict[str, Rotation]:
        """Return the orientation of a frame in itself and in all frames that carry it."""
        found, rotation = {frame: IDENTITY}, IDENTITY
        while frame in self._parents:
            frame, step = self._parents[frame]
            if frame in found:
                break  # a loop is no tree
            found[frame] = rotation = product(step, rotation)
        return found


def imu_of(node: Node, parameters: NodeParameters, ignored: Counter[str]) -> MountedImu:
    """Return the IMU that the parameters describe, mounted by them or by the transforms."""
    p = parameters
    if p.gyro_source == 'imu' and not p.imu_orientation:
        return SelfMountingImu(node, p.layout.base_frame, p.imu_use, ignored)
    return MountedImu(p.imu_orientation, p.imu_use)
