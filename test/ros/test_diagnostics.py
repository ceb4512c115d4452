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

"""What the diagnostics find wrong, and what they leave alone: no graph needed."""

from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from rclpy.clock import Clock

from swerve_kinematics.ros.diagnostics import Diagnostics, ERROR, OK, WARN
from swerve_kinematics.ros.findings import findings_and_values
from swerve_kinematics.ros.stamps import NEVER

LAYOUT = SimpleNamespace(module_names=('a', 'b', 'c'), gyro_joint='heading',
                         drive_joints=('a_drive', 'b_drive', 'c_drive'))
NONE = np.zeros(3, dtype=bool)
B = np.array([False, True, False])


def findings(gyro_source='joint', yaw=0.0, rate=None, lacks_feedback=False, slipping=NONE,
             unreachable=NONE, lost=NONE, is_held=False, still=False, trusted=(True, True),
             lies=(), wraps_at=None, missing=None, fault=None, heard=True, scatter=None,
             yaw_error=0.0, distrust=0.0):
    drive = SimpleNamespace(
        lacks_feedback=lambda now: lacks_feedback, feedback_age=lambda now: now,
        input=SimpleNamespace(age=lambda now: now - NEVER), mode='driving', scale=1.0,
        unreachable=unreachable, lost=lost, is_held=is_held)
    odometry = SimpleNamespace(slipping=slipping, gyro_bias=0.0, residual=0.0,
                               gyro_trusted=trusted, doubt=0.32 * slipping, coasting=0.0,
                               lean=np.array((0.1711, -0.0855)), accelerometer_believed=True,
                               stamp_scatter=scatter, imu_yaw_error=yaw_error,
                               distrust=distrust)
    accelerometer = SimpleNamespace(heard=heard, fault=fault)
    config = SimpleNamespace(layout=LAYOUT, gyro_source=gyro_source)
    sample = SimpleNamespace(yaw=yaw, yaw_rate=rate)
    feedback = SimpleNamespace(
        merged=3, without_gyro=2, foreign=4, missing=missing,
        gyro=SimpleNamespace(yaw_stands_still=still),
        speeds=SimpleNamespace(contradictions=lambda: lies),
        unwrapper=SimpleNamespace(is_found=wraps_at is not None, period=wraps_at))
    estimation = SimpleNamespace(
        feedback=feedback, imu=SimpleNamespace(accelerometer=accelerometer), odometry=odometry,
        sample=sample)
    return findings_and_values(config, drive, estimation, 5_000_000_000, 50.0)


def test_nothing_is_wrong_with_a_healthy_base():
    found, values = findings()
    assert found == []
    assert values['feedback age [s]'] == 5.0
    assert values['command age [s]'] == 'never'
    assert values['feedback merged from several messages'] == 3
    assert values['feedback without gyro'] == 2


@pytest.mark.parametrize('state, level, word', [
    ({'lacks_feedback': True}, ERROR, 'feedback'),
    ({'slipping': B}, WARN, 'b'),
    ({'lost': (True, False, True)}, ERROR, 'a, c: steering reads another angle'),
    ({'is_held': True}, WARN, 'does not follow'),
    ({'unreachable': B}, WARN, 'range: b'),
    ({'wraps_at': 2.0 * np.pi}, WARN, 'drive_joint_period to 6.28319'),
    ({'yaw': None}, WARN, 'no gyro: yaw comes from the wheels - joint_states tell nothing of '
                          'heading, see gyro_source'),
    ({'yaw': None, 'gyro_source': 'imu'}, WARN, 'no gyro: yaw comes from the wheels'),
    ({'still': True}, WARN, 'stands still'),
    ({'trusted': (False, True)}, WARN, 'the yaw of the gyro contradicts'),
    ({'trusted': (True, False)}, WARN, 'the rate of the gyro contradicts'),
    ({'fault': 'silent'}, WARN, 'accelerometer of the IMU is not used: silent'),
    ({'scatter': 0.0058}, WARN, 'the stamps of joint_states scatter by 6 ms'),
    ({'yaw_error': -1.5708}, WARN, 'the yaw of its imu_orientation is wrong by -90 degrees'),
    ({'distrust': 4.2}, WARN, 'contradicted wheels that agree with one another for too long; it '
                              'has another chance in 5 s'),
    ({'lies': [(1, 'it fits as rpm')]}, WARN, 'velocity of b_drive')])
def test_each_fault_has_its_level_and_its_words(state, level, word):
    found, _ = findings(**state)
    assert [at for at, _ in found] == [level]
    assert word in found[0][1]


def test_what_the_accelerometer_tells_is_among_the_values():
    _, values = findings(slipping=B)
    assert values['accelerometer'] == 'trusted'
    assert values['doubted wheels'] == 'b for 0.32 s'
    assert values['floor rises ahead, to the left [deg]'] == '1.0, -0.5'
    assert findings(heard=False)[1]['accelerometer'] == 'none'
    assert findings(fault='silent')[1]['accelerometer'] == 'silent'


def test_without_feedback_the_joints_that_are_missing_are_named():
    found, _ = findings(lacks_feedback=True, missing='joint_states lack a')
    assert (ERROR, 'joint_states lack a') in found
    assert findings(missing='joint_states lack a')[0] == []


@pytest.mark.parametrize('state', [{'yaw': None, 'rate': 0.1},
                                   {'yaw': None, 'gyro_source': 'none'}])
def test_a_gyro_of_rates_or_none_at_all_is_no_fault(state):
    assert findings(**state)[0] == []


class Audience:
    """Stands in for the node, its log and its publisher."""

    def __init__(self):
        self.count, self.reports, self.said = 0, [], []
        self.info, self.warning, self.error = (
            lambda text, level=level: self.said.append((level, text))
            for level in (OK, WARN, ERROR))
        self.publish = self.reports.append

    def create_publisher(self, *_, **__):
        return self

    def get_subscription_count(self):
        return self.count

    def get_fully_qualified_name(self):
        return '/swerve_node'

    def get_clock(self):
        return Clock()

    def get_logger(self):
        return self


def test_a_report_goes_out_only_to_who_listens_but_a_change_is_always_logged():
    audience = Audience()
    diagnostics = Diagnostics(audience)
    for _ in range(2):
        diagnostics.publish([(ERROR, 'no feedback')], {}, Counter())
    assert (audience.said, audience.reports) == ([(ERROR, 'diagnostics: no feedback')], [])
    audience.count = 1
    diagnostics.publish([], {'mode': 'stopped'}, Counter({'cmd_vel not finite': 2}))
    status = audience.reports[0].status[0]
    assert (status.level, status.message) == (WARN, 'ignored input: cmd_vel not finite')
    assert [(pair.key, pair.value) for pair in status.values] == [
        ('mode', 'stopped'), ('ignored: cmd_vel not finite', '2')]
    assert audience.said[1:] == [(WARN, 'diagnostics: ignored input: cmd_vel not finite')]
