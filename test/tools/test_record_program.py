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

"""The program on the page about the interface records a drive that swerve_calibrate reads."""

from pathlib import Path
import re
import signal
import subprocess
import sys

import pytest
from sensor_msgs.msg import JointState
from swerve_kinematics.configuration.program import read_parameters
from swerve_kinematics.tools.recordings.bag import read_bag, Topics

ROOT = Path(__file__).resolve().parents[2]
# Joint states that go by, 2 s, and that are recorded: the recorder is heard of before it hears.
SENT, ENOUGH = 200, 15


def program():
    """Return the program that records."""
    page = (ROOT / 'docs' / 'interface.md').read_text()
    blocks = re.findall(r'```python\n(.*?)```', page, re.DOTALL)
    return next(block for block in blocks if 'Writer' in block)


def test_the_program_records_until_it_is_interrupted(start_sim, client, namespace, tmp_path):
    pytest.importorskip('rosbags')
    (tmp_path / 'record.py').write_text(program())
    start_sim()
    record = subprocess.Popen(
        [sys.executable, 'record.py', '--ros-args', '-r', f'__ns:={namespace}'], cwd=tmp_path)
    try:
        client.wait_until(lambda: client.node.count_subscribers('ground_truth'), 'the recorder')
        client.wait_for_count(client.listen(JointState, 'joint_states'), SENT, 'joint states')
        record.send_signal(signal.SIGINT)
        assert record.wait(timeout=20.0) == 0
    finally:
        record.kill()
        record.wait()
    drive = read_bag(
        tmp_path / 'drive', read_parameters(ROOT / 'config' / 'four_modules.yaml'),
        Topics('/joint_states', '/imu', '/ground_truth')).drive(needs_truth=True)
    assert len(drive.poses) > ENOUGH
