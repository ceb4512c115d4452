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

"""Feedback that comes far more rarely than commands is reported, once it has lasted."""

import pytest

from swerve_kinematics.ros.slow_feedback import SlowFeedback


def found(rates, control_rate=50.0, timeout=0.5):
    """Return whether there is a finding, at each second."""
    slow = SlowFeedback()
    return [bool(slow.findings(rate, control_rate, timeout, now))
            for now, rate in enumerate(rates)]


def test_it_is_reported_when_it_lasts_and_goes_when_it_is_over():
    assert found([5.0, 5.0, 5.0, 5.0, 50.0, 50.0, 50.0]) == [
        False, False, True, True, True, False, False]


def test_a_rate_at_the_threshold_does_not_flicker():
    assert found([6.0, 6.0, 6.0, *[6.5, 6.0] * 5])[2:] == [True] * 11
    assert not any(found([6.5, 6.0] * 5))


@pytest.mark.parametrize('rates', [[10.0] * 9, [200.0] * 9, [0.0] * 9, [5.0, 50.0, 5.0, 50.0]])
def test_ordinary_rates_silence_and_a_hiccup_are_no_finding(rates):
    assert not any(found(rates))


def test_the_words_tell_both_rates():
    slow = SlowFeedback()
    messages = [slow.findings(2.0, 100.0, 0.75, now) for now in (0.0, 1.0, 2.0)][-1]
    assert messages[0].startswith('joint_states arrive at 2 Hz, far below control_rate 100 Hz')


def test_a_timeout_that_is_shorter_than_the_period_is_reported_while_it_is():
    assert found([10.0] * 4, timeout=0.1)[2:] == [True] * 2
    assert found([9.0, 10.0, 11.0, 10.0], timeout=0.05) == [False, False, True, True]
    assert not any(found([9.0, 10.0, 11.0, 10.0], timeout=0.2))
    slow = SlowFeedback()
    messages = [slow.findings(10.0, 50.0, 0.05, now) for now in (0.0, 1.0, 2.0)][-1]
    assert len(messages) == 1
    assert messages[0].startswith(
        'joint_states arrive at 10 Hz, too rarely for feedback_timeout 0.05 s - raise')
