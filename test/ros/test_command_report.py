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


"""Several nodes that command the base at once are noticed, and nothing else is."""

from types import SimpleNamespace

import pytest

from swerve_kinematics.ros.command_report import CommandReport, CommandSenders

GO, STAND = (0.4, 0.0, 0.2), (0.0, 0.0, 0.0)


def reports(seconds):
    """Return what each report says after the (number, twist) of the second before it."""
    senders, said = CommandSenders(), []
    for now, commands in enumerate(seconds):
        for number, twist in commands:
            senders.heard(twist, {'publication_sequence_number': number})
        said.append(senders.are_in_conflict(float(now)))
    return said


def both(second, one=GO, other=STAND, ahead=0):
    """Return commands of two senders in turn, one of which may have sent more before."""
    return [command for number in range(10 * second + 1, 10 * second + 11)
            for command in ((number + ahead, one), (number, other))]


@pytest.mark.parametrize('ahead', [0, 1, 500, -500])
def test_two_senders_that_contradict_each_other_are_reported_until_one_ends(ahead):
    alone = [[(1000 * second + number, GO) for number in range(20)] for second in range(1, 6)]
    said = reports([*(both(second, ahead=ahead) for second in range(3)), *alone])
    assert said == [False, True, True, True, True, False, False, False]


@pytest.mark.parametrize('seconds', [
    [[]] * 5,
    # One sender, of which some are lost, and whose command changes all the time.
    [[(50 * second + 3 * at, (0.01 * at, 0.0, 0.0)) for at in range(15)] for second in range(5)],
    # Two that say the same.
    [both(second, other=GO) for second in range(5)],
    # One hands over to the other one each second.
    [[(10 * (second // 2) + at, STAND if second % 2 else GO) for at in range(10)]
     for second in range(8)],
    # A middleware that numbers no messages.
    [[(None, GO), (None, STAND)] * 10] * 5])
def test_whatever_else_comes_is_no_conflict(seconds):
    assert not any(reports(seconds))


def test_who_is_left_alone_is_not_said_to_contradict_itself():
    names = ['/one', '/other']
    report = CommandReport(SimpleNamespace(publishers=lambda _: names),
                           SimpleNamespace(has_come=True, pauses=0))

    def told(now):
        for number, twist in both(now):
            report.senders.heard(twist, {'publication_sequence_number': number})
        return [message for _, message in report.findings(float(now))]
    told(0)
    assert '/one and /other' in told(1)[0]
    del names[1]
    assert told(2) == []
