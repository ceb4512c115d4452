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

"""A node on a real graph names what is wrong with a miswired base."""

from checking_drives import mixed
import numpy as np
import pytest

SENSORS = {'encoder_resolution': 4096, 'gyro_bias': 0.0087, 'dropped_sample_probability': 0.02}


@pytest.mark.parametrize('fault, words', [
    ({'steering_offsets': [0.0, np.pi / 2, 0.0, 0.0]}, 'front_right: steering offset'),
    ({'miswired.dead_drives': ['rear_left']}, 'rear_left: drive stands still')])
def test_a_fault_is_named_on_diagnostics_and_logged_once(
        client, start_node, start_sim, reports, fault, words):
    start_sim(**SENSORS, **fault)
    node = start_node()
    client.wait_until(lambda: client.odom, 'odometry')
    twist_at, now = mixed(np.random.default_rng(0), 60.0, rest=0.0), client.node.get_clock().now
    begun = now()
    client.repeat_until(
        lambda: client.send_twist(*twist_at((now() - begun).nanoseconds * 1e-9).tolist()),
        lambda: any(words in report.message for report in reports), f"'{words}'")
    assert node.output.count(words) <= 1
