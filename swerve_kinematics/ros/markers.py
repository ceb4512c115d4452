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

"""What the modules are commanded and seen to do, for RViz: `~/markers`."""

from typing import NamedTuple

from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point
import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.core.drawing import (
    covariance_ellipse, dashed_arrow, twist_parts, velocity_vectors)
from swerve_kinematics.core.kinematics.modules import ModuleStates
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.ros.drive import DriveCommand
from swerve_kinematics.ros.messages import set_yaw
from swerve_kinematics.ros.qos import publisher
from swerve_kinematics.ros.sample import Sample
from swerve_kinematics.ros.stamps import nanoseconds, NEVER
from visualization_msgs.msg import Marker, MarkerArray

# An arrow is as long as the way that its module goes in this time [s].
ARROW_TIME = 0.3
# A slower module [m/s] has no arrow.
MIN_SPEED = 1e-3
DASH, DASH_WIDTH, HEAD = 0.03, 0.014, 0.06  # m
CENTER_SIZE = 0.05  # m
# RViz refuses a marker with a side of 0 [m].
MIN_SIZE = 1e-3
# People see no more pictures than one in this time [ns], and RViz need not draw more.
PERIOD = nanoseconds(0.1)
# Markers of a node that has ended fade away [s].
LIFETIME = 1


class Style(NamedTuple):
    """
    The looks of a kind of marker.

    Attributes
    ----------
    color : tuple of float
        Red, green, blue and opacity, in [0, 1].
    width : float
        Of an arrow's shaft [m].
    height : float
        Above the ground [m]: what matters more lies on top.

    """

    color: tuple[float, float, float, float]
    width: float = 0.0
    height: float = 0.0


# One namespace each, so that RViz can show and hide them.
STYLES = {
    'translation': Style((0.25, 0.50, 1.00, 1.0), 0.014, 0.11),
    'rotation': Style((0.82, 0.71, 0.55, 1.0), 0.014, 0.12),
    'commanded': Style((0.10, 0.80, 0.20, 1.0), 0.022, 0.13),
    'measured': Style((1.00, 0.90, 0.10, 1.0), 0.010, 0.15),
    'center_of_rotation': Style((1.00, 0.30, 0.80, 1.0), height=0.13),
    'odometry_covariance': Style((0.70, 0.45, 1.00, 0.4)),
}
VECTORS = ('translation', 'rotation', 'commanded', 'measured')
REVERSED_COLOR = (0.95, 0.15, 0.15, 1.0)


class Markers:
    """
    Publishes the picture of the base while someone looks at it.

    The markers of the modules carry the module's index as their id. They stand in the base
    frame without a stamp and locked to it, so that RViz places them by the newest transform
    and moves them with the base between two pictures.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publisher.
    layout : Layout

    """

    def __init__(self, node: Node, layout: Layout) -> None:
        """Create the publisher and the markers."""
        self._publisher = publisher(node, MarkerArray, '~/markers')
        self._positions = layout.kinematics.module_positions
        self._due_at = NEVER  # when a picture was due last [ns]
        self._vectors = {
            name: [_marker(name, index, layout.base_frame)
                   for index in range(len(self._positions))] for name in VECTORS}
        self._center = _marker('center_of_rotation', 0, layout.base_frame, Marker.SPHERE)
        _set_scale(self._center, CENTER_SIZE, CENTER_SIZE, CENTER_SIZE)
        self._ellipse = _marker('odometry_covariance', 0, layout.odom_frame, Marker.CYLINDER)
        self._message = MarkerArray(
            markers=[*sum(self._vectors.values(), []), self._center, self._ellipse])

    def are_due(self, now: int) -> bool:
        """Tell whether a picture is due at a time [ns], and someone subscribed."""
        # A clock that was set back must not silence the markers.
        if 0 <= now - self._due_at < PERIOD:
            return False
        self._due_at = now
        return self._publisher.get_subscription_count() > 0

    def publish(self, command: DriveCommand, sample: Sample | None, odometry: SwerveOdometry,
                center: NDArray[np.float64]) -> None:
        """
        Publish a picture.

        Parameters
        ----------
        command : DriveCommand
            What is being executed.
        sample : Sample or None
            The newest measurement; None if there is none to be trusted.
        odometry : SwerveOdometry
            Gives the pose and its covariance.
        center : ndarray (2,)
            Centre of rotation from base_link [m], whose velocity the command's twist is.

        """
        self._draw_vectors(command, sample, center)
        _place(self._center, center[0], center[1], STYLES['center_of_rotation'].height)
        draw_ellipse(self._ellipse, odometry.pose, odometry.pose_covariance)
        self._publisher.publish(self._message)

    def _draw_vectors(self, command: DriveCommand, sample: Sample | None,
                      center: NDArray[np.float64]) -> None:
        """Draw all arrows."""
        translation, rotation = twist_parts(self._positions, command.twist, center)
        commanded, measured = _commanded(command), _measured(sample, len(self._positions))
        self._draw('translation', translation)
        self._draw('rotation', rotation)
        self._draw('commanded', velocity_vectors(commanded), commanded.speed < 0.0)
        self._draw('measured', velocity_vectors(measured))

    def _draw(self, name: str, vectors: NDArray[np.float64],
              is_dashed: NDArray[np.bool_] | bool = False) -> None:
        """Draw the arrows of a namespace."""
        for marker, position, vector, dashed in zip(
                self._vectors[name], self._positions, vectors,
                np.broadcast_to(is_dashed, len(vectors))):
            draw_arrow(marker, position, ARROW_TIME * vector, STYLES[name], dashed)


def _commanded(command: DriveCommand) -> ModuleStates:
    """Return the ModuleStates that are commanded, NaN for angles that are not known."""
    angles = np.array(command.angles)
    return ModuleStates(np.array(command.speeds),
                        np.full_like(angles, np.nan) if command.steering_angles is None
                        else angles)


def _measured(sample: Sample | None, count: int) -> ModuleStates:
    """Return the ModuleStates that are measured, NaN where nothing is."""
    if sample is None or sample.velocities is None:
        return ModuleStates(np.full(count, np.nan), np.full(count, np.nan))
    return ModuleStates(np.array(sample.velocities), np.array(sample.angles))


def draw_arrow(marker: Marker, start: NDArray[np.float64], vector: NDArray[np.float64],
               style: Style, is_dashed: bool | np.bool_) -> None:
    """
    Make a marker an arrow: solid, or dashed and red; none if it is too short or not finite.

    Parameters
    ----------
    marker : visualization_msgs.msg.Marker
        Changed in place.
    start, vector : ndarray (2,)
        [m].
    style : Style
        Of the solid arrow.
    is_dashed : bool
        Whether the drive is reversed.

    """
    if not ARROW_TIME * MIN_SPEED < np.hypot(*vector) < np.inf:
        marker.action, marker.points = Marker.DELETE, []
        return
    marker.action = Marker.ADD
    if is_dashed:
        # RViz has no dashed arrows: these are lines.
        marker.type, points = Marker.LINE_LIST, dashed_arrow(start, vector, DASH, HEAD)
        _set_scale(marker, DASH_WIDTH, 0.0, 0.0)
        _set_color(marker, REVERSED_COLOR)
    else:
        marker.type, points = Marker.ARROW, np.stack((start, start + vector))
        _set_scale(marker, style.width, 2.5 * style.width, HEAD)
        _set_color(marker, style.color)
    marker.points = [Point(x=x, y=y, z=style.height) for x, y in points.tolist()]


def draw_ellipse(marker: Marker, pose: NDArray[np.float64],
                 covariance: NDArray[np.float64]) -> None:
    """
    Make a marker the 95 % ellipse of a position.

    Parameters
    ----------
    marker : visualization_msgs.msg.Marker
        Changed in place.
    pose : ndarray (3,)
        [m, m, rad].
    covariance : ndarray (3, 3)
        Of the pose [m^2, m rad, rad^2].

    """
    semi_axes, angle = covariance_ellipse(covariance[:2, :2])
    _place(marker, pose[0], pose[1], 0.0)
    set_yaw(marker.pose.orientation, angle)
    length, width = np.maximum(2.0 * semi_axes, MIN_SIZE).tolist()
    _set_scale(marker, length, width, MIN_SIZE)


def _marker(name: str, index: int, frame: str, kind: int = Marker.ARROW) -> Marker:
    """Return a new marker."""
    marker = Marker(ns=name, id=index, type=kind, frame_locked=True,
                    lifetime=Duration(sec=LIFETIME))
    marker.header.frame_id = frame
    marker.pose.orientation.w = 1.0
    _set_color(marker, STYLES[name].color)
    return marker


def _place(marker: Marker, x: float, y: float, z: float) -> None:
    """Set the position [m] of a marker."""
    position = marker.pose.position
    position.x, position.y, position.z = float(x), float(y), z


def _set_scale(marker: Marker, x: float, y: float, z: float) -> None:
    """Set the sizes [m] of a marker."""
    marker.scale.x, marker.scale.y, marker.scale.z = x, y, z


def _set_color(marker: Marker, color: tuple[float, float, float, float]) -> None:
    """Set the colour of a marker."""
    marker.color.r, marker.color.g, marker.color.b, marker.color.a = color
