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

"""The markers for RViz: right shapes in right places, and only for who looks."""

import math
from pathlib import Path

import numpy as np
from odometry_parts import values
import pytest
from swerve_kinematics import SwerveOdometry
from swerve_kinematics.configuration.layout import LAYOUT_DECLARATIONS, layout_from
from swerve_kinematics.ros.drive import DriveCommand
from swerve_kinematics.ros.markers import ARROW_TIME, Markers, REVERSED_COLOR, STYLES
from swerve_kinematics.ros.sample import Sample
from visualization_msgs.msg import Marker, MarkerArray
import yaml

LAYOUT = layout_from(values(LAYOUT_DECLARATIONS, {
    'wheel_radii': [0.05, 0.06, 0.07, 0.08], 'steering_offsets': [0.1, 0.2, 0.3, 0.4]}))
POSITIONS = LAYOUT.kinematics.module_positions
TWIST, CENTER = np.array([0.5, -0.2, 1.5]), np.array([0.1, 0.05])
MILLISECOND = 1_000_000


class Audience:
    """Stands in for the node and for its publisher."""

    def __init__(self):
        self.count, self.pictures = 1, []

    def create_publisher(self, kind, topic, qos, **_):
        assert (kind, topic) == (MarkerArray, '~/markers')
        return self

    def get_subscription_count(self):
        return self.count

    def publish(self, message):
        self.pictures.append(message)


@pytest.fixture
def audience():
    """Return who looks."""
    return Audience()


@pytest.fixture
def markers(audience):
    """Return the markers that they look at."""
    return Markers(audience, LAYOUT)


def command(flipped=(False,) * 4):
    """Return the command for TWIST, with the drives of some modules reversed."""
    states = LAYOUT.kinematics.inverse(TWIST, CENTER)
    flipped = np.array(flipped)
    speeds = np.where(flipped, -states.speed, states.speed).tolist()
    angles = (states.angle + np.where(flipped, math.pi, 0.0)).tolist()
    return DriveCommand(LAYOUT.joints.drives(speeds, angles),
                        LAYOUT.joints.steering_positions(angles), TWIST, speeds, angles)


def sample(velocities=np.full(4, 0.4), angles=np.full(4, 0.7)):
    """Return a measurement."""
    return Sample(0, np.zeros(4), angles, velocities, None, None, None, True)


def odometry(pose=(0.0, 0.0, 0.0), covariance=np.zeros((3, 3))):
    """Return an odometry with this pose."""
    odometry = SwerveOdometry(LAYOUT.kinematics)
    odometry.reset(pose, covariance)
    return odometry


def publish(markers, now, *picture):
    """Publish a picture if one is due at a time [ns], as the node does."""
    if markers.are_due(now):
        markers.publish(*picture)


def shown(audience):
    """Return the markers of the latest picture by namespace and id, without what is deleted."""
    return {(marker.ns, marker.id): marker for marker in audience.pictures[-1].markers
            if marker.action == Marker.ADD}


def points(marker):
    """Return the points of a marker (k, 3)."""
    return np.array([(point.x, point.y, point.z) for point in marker.points])


def color(marker):
    """Return the colour of a marker."""
    return marker.color.r, marker.color.g, marker.color.b, marker.color.a


def arrows(audience, namespace):
    """Return starts and vectors (n, 2) of the solid arrows of a namespace."""
    of_namespace = [shown(audience)[namespace, index] for index in range(4)]
    assert {marker.type for marker in of_namespace} == {Marker.ARROW}
    for marker in of_namespace:
        assert color(marker) == pytest.approx(STYLES[namespace].color)
    ends = np.array([points(marker) for marker in of_namespace])[..., :2]
    return ends[:, 0], ends[:, 1] - ends[:, 0]


def test_the_arrows_stand_at_the_modules_and_show_their_velocities(markers, audience):
    publish(markers, 0, command(), sample(), odometry(), CENTER)
    x, y = (POSITIONS - CENTER).T
    rotation = 1.5 * np.stack((-y, x), axis=-1)
    expected = {'translation': np.tile([0.5, -0.2], (4, 1)), 'rotation': rotation,
                'commanded': rotation + [0.5, -0.2],
                'measured': np.tile([0.4 * math.cos(0.7), 0.4 * math.sin(0.7)], (4, 1))}
    for namespace, velocities in expected.items():
        starts, vectors = arrows(audience, namespace)
        np.testing.assert_allclose(starts, POSITIONS)
        np.testing.assert_allclose(vectors, ARROW_TIME * velocities, atol=1e-12)


def test_the_colours_are_those_of_the_field():
    red, green, blue, _ = np.array([
        REVERSED_COLOR, STYLES['commanded'].color, STYLES['translation'].color,
        STYLES['rotation'].color])
    for channel, of_color in enumerate((red, green, blue)):
        assert of_color[channel] >= 0.8 and np.delete(of_color[:3], channel).max() <= 0.5
    np.testing.assert_allclose(STYLES['rotation'].color[:3], np.array([210, 180, 140]) / 255,
                               atol=0.01)  # the tan of X11 and CSS


def test_a_reversed_module_is_dashed_and_red_and_points_the_way_it_moves(markers, audience):
    publish(markers, 0, command((False, True, False, False)), sample(), odometry(), CENTER)
    drawn = [shown(audience)['commanded', index] for index in range(4)]
    assert [marker.type for marker in drawn] == [
        Marker.ARROW, Marker.LINE_LIST, Marker.ARROW, Marker.ARROW]
    assert color(drawn[1]) == pytest.approx(REVERSED_COLOR)
    strokes = points(drawn[1])[:, :2]
    assert len(strokes) % 2 == 0 and len(strokes) > 8
    np.testing.assert_allclose(strokes[0], POSITIONS[1])
    x, y = POSITIONS[1] - CENTER
    np.testing.assert_allclose(
        strokes[-2], POSITIONS[1] + ARROW_TIME * np.array([0.5 - 1.5 * y, -0.2 + 1.5 * x]))
    # The same marker turns green again.
    publish(markers, 1000 * MILLISECOND, command(), sample(), odometry(), CENTER)
    arrows(audience, 'commanded')


@pytest.mark.parametrize('measured', [
    None, sample(velocities=None), sample(np.zeros(4)), sample(np.full(4, np.nan))])
def test_what_does_not_move_or_is_not_known_has_no_arrow(markers, audience, measured):
    publish(markers, 0, command(), sample(), odometry(), CENTER)
    assert ('measured', 0) in shown(audience)
    publish(markers, 1000 * MILLISECOND, command(), measured, odometry(), CENTER)
    assert {ns for ns, _ in shown(audience)} == set(STYLES) - {'measured'}


def test_unknown_steering_angles_leave_the_commanded_states_out(markers, audience):
    unknown = DriveCommand([0.0] * 4, None, (0.0, 0.0, 0.0), [0.0] * 4, [0.0] * 4)
    publish(markers, 0, unknown, None, odometry(), CENTER)
    assert set(shown(audience)) == {('center_of_rotation', 0), ('odometry_covariance', 0)}
    assert len(audience.pictures[-1].markers) == 4 * 4 + 2


def test_the_centre_of_rotation_is_a_dot_in_the_base_frame(markers, audience):
    publish(markers, 0, command(), None, odometry((5.0, 6.0, 1.0)), CENTER)
    dot = shown(audience)['center_of_rotation', 0]
    assert dot.header.frame_id == 'base_link'
    assert (dot.type, dot.pose.position.x, dot.pose.position.y) == (Marker.SPHERE, 0.1, 0.05)
    assert min(dot.scale.x, dot.scale.y, dot.scale.z) > 0.0


def test_the_ellipse_lies_in_the_odom_frame_along_the_greater_error(markers, audience):
    turn = np.array([(math.cos(0.6), -math.sin(0.6)), (math.sin(0.6), math.cos(0.6))])
    covariance = np.zeros((3, 3))
    covariance[:2, :2] = turn @ np.diag((0.09, 0.01)) @ turn.T
    publish(markers, 0, command(), None, odometry((5.0, 6.0, 1.0), covariance), CENTER)
    ellipse = shown(audience)['odometry_covariance', 0]
    assert (ellipse.header.frame_id, ellipse.type) == ('odom', Marker.CYLINDER)
    assert (ellipse.pose.position.x, ellipse.pose.position.y) == (5.0, 6.0)
    assert ellipse.scale.x == pytest.approx(2.0 * 2.4477468 * 0.3)
    assert ellipse.scale.y == pytest.approx(2.0 * 2.4477468 * 0.1)
    quaternion = ellipse.pose.orientation
    yaw = 2.0 * math.atan2(quaternion.z, quaternion.w)
    assert math.sin(yaw - 0.6) == pytest.approx(0.0, abs=1e-9)


def test_an_ellipse_of_a_known_position_still_has_a_size(markers, audience):
    publish(markers, 0, command(), None, odometry(), CENTER)
    scale = shown(audience)['odometry_covariance', 0].scale
    assert min(scale.x, scale.y, scale.z) > 0.0


def test_rviz_can_place_them_at_any_time_and_forgets_them_by_itself(markers, audience):
    publish(markers, 123 * MILLISECOND, command(), sample(), odometry(), CENTER)
    for marker in audience.pictures[-1].markers:
        assert (marker.header.stamp.sec, marker.header.stamp.nanosec) == (0, 0)
        assert marker.frame_locked and marker.lifetime.sec > 0
        assert marker.pose.orientation.w != 0.0


def test_nothing_is_computed_while_nobody_looks(markers, audience):
    audience.count = 0
    assert not markers.are_due(0)
    assert not audience.pictures
    audience.count = 1
    publish(markers, 100 * MILLISECOND, command(), sample(), odometry(), CENTER)
    assert len(audience.pictures) == 1


def test_ten_pictures_a_second_are_enough(markers, audience):
    for step in range(200):
        publish(markers, step * 5 * MILLISECOND, command(), sample(), odometry(), CENTER)
    assert len(audience.pictures) == 10


def test_a_clock_that_is_set_back_does_not_silence_them(markers, audience):
    for now in (10 ** 18, 0, 50 * MILLISECOND):
        publish(markers, now, command(), sample(), odometry(), CENTER)
    assert len(audience.pictures) == 2


def test_the_configuration_of_rviz_shows_every_namespace():
    file = Path(__file__).parents[2] / 'config' / 'swerve.rviz'
    manager = yaml.safe_load(file.read_text())['Visualization Manager']
    displays = {display['Class'].split('/')[1]: display for display in manager['Displays']}
    assert set(displays) == {'Grid', 'RobotModel', 'MarkerArray', 'Odometry', 'TF'}
    assert displays['MarkerArray']['Namespaces'] == dict.fromkeys(STYLES, True)
    assert displays['MarkerArray']['Topic']['Value'] == '/swerve_node/markers'
    assert displays['Odometry']['Topic']['Value'] == '/odom'
    assert manager['Global Options']['Fixed Frame'] == LAYOUT.odom_frame
