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

"""What swerve_node draws for RViz while it drives, and that it draws only for who looks."""

import math

from rclpy.qos import qos_profile_system_default
from visualization_msgs.msg import Marker, MarkerArray


def test_the_markers_show_the_drive_and_the_measurement(client, start_node, start_sim):
    start_sim()
    start_node()
    pictures = client.listen(MarkerArray, 'swerve_node/markers', qos_profile_system_default)

    def shown():
        return {(marker.ns, marker.id): marker for marker in pictures[-1].markers
                if marker.action == Marker.ADD} if pictures else {}

    def length(name):
        if name not in shown():
            return 0.0
        start, end = shown()[name].points[:2]
        return math.hypot(end.x - start.x, end.y - start.y)
    client.repeat_until(
        lambda: client.send_twist(vx=0.5, omega=0.5),
        lambda: min(length((kind, 0)) for kind in
                    ('commanded', 'measured', 'translation', 'rotation')) > 0.03,
        'all arrows')
    assert length(('measured', 0)) < 1.5 * length(('commanded', 0))
    assert shown()['odometry_covariance', 0].header.frame_id == 'odom'
    assert shown()['commanded', 0].header.frame_id == 'base_link'


def test_what_was_measured_is_not_shown_when_feedback_falls_silent(
        client, start_node, start_sim):
    start_node(open_loop=True, feedback_timeout=0.1)
    base = start_sim()
    pictures = client.listen(MarkerArray, 'swerve_node/markers', qos_profile_system_default)

    def is_shown(kind):
        return bool(pictures) and any(marker.ns == kind and marker.action == Marker.ADD
                                      for marker in pictures[-1].markers)

    def drive():
        client.send_twist(vx=0.5)
    client.repeat_until(drive, lambda: is_shown('measured'), 'a measurement')
    base.end()
    client.repeat_until(drive, lambda: not is_shown('measured'), 'its end')
    assert is_shown('commanded')
