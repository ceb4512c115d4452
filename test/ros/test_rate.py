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

"""A rate is that of the time between two looks, whenever they are taken."""

import pytest

from swerve_kinematics.ros.rate import Rate


@pytest.mark.parametrize('looks', [
    [1.0, 2.0, 3.0], [1.05, 2.0, 3.1], [1.0, 7.5, 7.6, 8.0]],
    ids=['in time', 'late', 'held up'])
def test_a_look_that_comes_late_changes_nothing(looks):
    rate = Rate(100.0)
    assert [rate.look(round(200 * time), 100.0 + time) for time in looks] == pytest.approx(
        [200.0] * len(looks))


def test_what_does_not_come_has_no_rate():
    rate = Rate(1.0)
    assert [rate.look(0, 2.0), rate.look(10, 3.0), rate.look(10, 4.0), rate.look(11, 4.0)] == [
        0.0, 10.0, 0.0, 0.0]
