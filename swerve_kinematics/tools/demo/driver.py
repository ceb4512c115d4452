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

"""The node that drives the demo through `cmd_vel` and notes what comes back."""

import math
from time import monotonic

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from sensor_msgs.msg import JointState

from swerve_kinematics.configuration.layout import default_layout
from swerve_kinematics.core.geometry.angles import nearest_equivalent
from swerve_kinematics.ros.conversions import planar_pose
from swerve_kinematics.ros.messages import planar_twist, set_planar_twist
from swerve_kinematics.ros.stamps import nanoseconds_of
from swerve_kinematics.tools.demo.drive_record import DriveRecord, matched
from swerve_kinematics.tools.demo.figure_eight import FigureEight, follow, plan

COMMAND_RATE = 50.0
# Share of the deviation from the plan that is taken back in a second [1/s].
GAIN = 1.0
# Below this [m/s, rad/s] the base counts as standing.
STANDSTILL = 1e-3
# How long [s] the base stands first, as every robot does between being switched on and being
# driven: the odometry learns the bias of its gyro then.
REST = 1.0


class DemoDriver(Node):
    """
    Drives a figure of eight by the odometry, and records odometry, truth and modules.

    Parameters
    ----------
    figure : FigureEight
        What to drive, in the odom frame.

    Attributes
    ----------
    module_positions : ndarray (n, 2)
        [m].
    command : ndarray (3,)
        The last twist sent [m/s, m/s, rad/s].

    """

    def __init__(self, figure: FigureEight) -> None:
        """Subscribe; the base stays where it is until `start`."""
        super().__init__('swerve_demo')
        self._layout = default_layout()
        self.module_positions = self._layout.kinematics.module_positions
        self.command = np.zeros(3)
        self._figure = figure
        # When the figure starts, by the clock of `monotonic` [s]; nothing is sent before `start`.
        self._start = math.inf
        self._last_arrival = monotonic()
        self._odometry: dict[int, NDArray[np.float64]] = {}
        self._truth: dict[int, NDArray[np.float64]] = {}
        self._directions: dict[int, list[float]] = {}
        self._pose = np.zeros(3)
        self._true_twist = np.zeros(3)
        self._publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self._on_odometry, 100)
        self.create_subscription(Odometry, 'ground_truth', self._on_truth, 100)
        self.create_subscription(JointState, 'joint_states', self._on_joint_states, 100)
        self.create_timer(1.0 / COMMAND_RATE, self._on_timer)

    def missing(self) -> list[str]:
        """Return what has not been heard of yet, each as words that follow a no."""
        streams = {'odom': self._odometry, 'ground_truth': self._truth,
                   'joint_states': self._directions}
        missing = [name for name, rows in streams.items() if not rows]
        if self._publisher.get_subscription_count() == 0:
            missing.append('listener on cmd_vel')
        return missing

    def start(self) -> None:
        """Begin the figure, after a rest."""
        self._start = monotonic() + REST

    def elapsed(self) -> float:
        """Return the time since the start of the figure [s], negative while it rests."""
        return monotonic() - self._start

    def silence(self) -> float:
        """Return the time since the last odometry [s]."""
        return monotonic() - self._last_arrival

    def arrived(self) -> bool:
        """Tell whether the figure is done and the base stands."""
        return (self.elapsed() > self._figure.duration
                and bool((np.abs(self._true_twist) < STANDSTILL).all()))

    def record(self) -> DriveRecord:
        """Return the DriveRecord so far; ValueError if nothing fits together."""
        return matched(self._odometry, self._truth, self._directions)

    def latest(self) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        """Return the newest odometry and truth (3,) of one moment, or None."""
        for stamp in reversed(self._odometry):
            if stamp in self._truth:
                return self._odometry[stamp], self._truth[stamp]
        return None

    def _on_timer(self) -> None:
        """Send the twist that the figure asks for now, zero before and after it."""
        if self._start == math.inf:
            return
        time = self.elapsed()
        self.command = np.zeros(3)
        if 0.0 <= time < self._figure.duration:
            self.command = follow(*plan(self._figure, time), self._pose, GAIN)
        message = Twist()
        set_planar_twist(message, self.command.tolist())
        self._publisher.publish(message)

    def _on_odometry(self, message: Odometry) -> None:
        """Note where the base believes to be."""
        self._last_arrival = monotonic()
        pose = planar_pose(message.pose.pose)
        self._odometry[nanoseconds_of(message.header.stamp)] = pose
        # The figure counts turns, the message does not.
        self._pose = np.append(pose[:2], nearest_equivalent(pose[2], self._pose[2]))

    def _on_truth(self, message: Odometry) -> None:
        """Note where the base is."""
        self._true_twist = np.array(planar_twist(message.twist.twist))
        self._truth[nanoseconds_of(message.header.stamp)] = planar_pose(message.pose.pose)

    def _on_joint_states(self, message: JointState) -> None:
        """Note which way each wheel rolls."""
        index = {name: i for i, name in enumerate(message.name)}
        drives = [index[name] for name in self._layout.drive_joints]
        steerings = [index[name] for name in self._layout.steering_joints]
        joints = self._layout.joints
        speeds = joints.travel(
            [message.velocity[place] for place in drives],
            joints.module_rates([message.velocity[place] for place in steerings]))
        angles = joints.module_angles([message.position[place] for place in steerings])
        self._directions[nanoseconds_of(message.header.stamp)] = [
            angle + math.pi * (speed < 0.0) for speed, angle in zip(speeds, angles)]
