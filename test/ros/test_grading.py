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

"""Findings are reported when they last, graver when they go on, and gone after a while."""

from swerve_kinematics.ros.grading import Grading, Patience

PATIENCE = Patience(warn=1.0, error=4.0, clear=3.0)


def graded(times):
    """Return what is reported at each time [s]; it is seen at those that are true."""
    grading, reports = Grading(PATIENCE), {}
    for time, seen in times.items():
        grading.update({'a': 'finding'} if seen else {}, time)
        reports[time] = grading.findings()
    return reports


def test_a_glimpse_is_not_reported():
    assert not any(graded({0: True, 0.5: True, 1.0: False, 1.5: True, 2.0: False}).values())


def test_what_lasts_is_reported_and_becomes_grave():
    reports = graded(dict.fromkeys(range(6), True))
    assert reports[0] == [] and reports[1] == [(False, 'finding')] == reports[3]
    assert reports[4] == [(True, 'finding')] == reports[5]


def test_it_goes_after_a_while_without_evidence_only():
    reports = graded({0: True, 1: True, 2: False, 3: True, 4: False, 5: False, 6: False})
    assert all(reports[second] for second in range(1, 6))
    assert reports[6] == []


def test_findings_are_told_apart_and_keep_their_latest_words():
    grading = Grading(PATIENCE)
    for second, words in enumerate(('old', 'new')):
        grading.update({'a': words, 'b': 'other'}, second)
    assert grading.findings() == [(False, 'new'), (False, 'other')]


def test_a_clock_that_is_set_back_neither_keeps_a_finding_nor_delays_its_grade():
    grading = Grading(PATIENCE)
    for second in (1000, 1001, 1002, 3):  # set back after 2 s: no time has passed
        grading.update({'a': 'finding'}, second)
    assert grading.findings() == [(False, 'finding')]
    grading.update({'a': 'finding'}, 5)
    assert grading.findings() == [(True, 'finding')]
    grading.update({'a': 'finding'}, 1000)
    for second in (2, 5):
        grading.update({}, second)
    assert grading.findings() == []
