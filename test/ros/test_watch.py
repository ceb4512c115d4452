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

"""While it drives, a base says within seconds what contradicts its description."""

from functools import cache
from pathlib import Path
import subprocess
import sys

from checking_drives import all_slightly_off, Base, both, driven, POSITIONS, Truth
from checking_faults import DESCRIBED_WRONGLY, OUT_OF_ORDER
from checking_mends import merged
from hypothesis import example, given, settings, strategies as st
import numpy as np
import pytest

from swerve_kinematics.core.checking.changes import Change
from swerve_kinematics.core.checking.drive_data import DriveData
from swerve_kinematics.core.checking.joints import JointFault
from swerve_kinematics.core.checking.wording import (
    change_in_words, fault_in_words, GYRO, STOPPED)
from swerve_kinematics.ros.watch import CONTRADICTION, FAILED, SEVERAL, Watch

NAMES = 'front_left', 'front_right', 'rear_left', 'rear_right'
LOGS = Path(__file__).parents[1] / 'data'
WITHIN = 5.0  # s of driving
REST = 0.5  # s before


def reports(data, positions=POSITIONS, period=1.0, names=NAMES):
    """Return the findings of each second of a drive, by its time."""
    watch = Watch(names, positions, expects_gyro=True)
    found, due = {}, period
    speeds = np.zeros_like(data.distances) if data.commanded_speeds is None else (
        data.commanded_speeds)
    angles = data.angles if data.commanded_angles is None else data.commanded_angles
    for k, stamp in enumerate(data.stamp):
        watch.commanded(speeds[k].tolist(), angles[k].tolist())
        watch.add(int(stamp * 1e9), data.distances[k].tolist(), data.angles[k].tolist(),
                  *(None if series is None else series[k]
                    for series in (data.yaw, data.yaw_rate)))
        if stamp >= due:
            found[due] = watch.findings()
            due += period
    return found


def test_a_diameter_for_a_radius_is_mostly_named_though_more_halves_the_turns_of_a_hexagon():
    angles = np.arange(6) * np.pi / 3.0
    positions = 0.4 * np.column_stack((np.cos(angles), np.sin(angles)))
    truth, named = Truth(positions=positions, radius=dict.fromkeys(range(6), 0.5)), 0
    for seed in range(6):
        drive = driven(truth, seed=seed, duration=9.0, described=positions)
        found = reports(drive, positions, names=tuple('abcdef'))[8.0]
        named += any('all modules: wheel radius 0.5' in message for _, message in found)
    assert named >= 4


FAULTS = {
    **{name: (truth, [change_in_words(Change(kind, modules, 0.0), NAMES)[0].split(': ')[0]
                      for kind, modules in expected])
       for name, (truth, expected) in DESCRIBED_WRONGLY.items()},
    **{name: (truth, [fault_in_words(JointFault(*fault), NAMES)[0].split(': ')[0]])
       for name, (truth, fault) in OUT_OF_ORDER.items()},
    'gyro frozen': (Truth(gyro_fault='frozen'), [GYRO['gyro frozen'].split(':')[0]])}


@cache
def reports_on(name):
    """Return the findings of each second of a drive with one of FAULTS, by its time."""
    seed = [*FAULTS].index(name)
    return reports(driven(FAULTS[name][0], seed=seed, duration=REST + WITHIN + 1.0))


def test_nearly_all_faults_are_reported_within_seconds_and_name_who_is_to_blame():
    silent, unnamed = [], []
    for name, (_, words) in FAULTS.items():
        found = [message for _, message in reports_on(name)[WITHIN]]
        if not found:
            silent.append(name)
        elif not any(word in message for word in words for message in found):
            unnamed.append(name)
    assert len(silent) <= 0.05 * len(FAULTS), silent
    assert len(silent) + len(unnamed) <= 0.14 * len(FAULTS), (silent, unnamed)


@pytest.mark.parametrize('truth', [
    merged(Truth(gyro=57.29578), Truth(**both('drive', 1, 3))),
    merged(Truth(positions=POSITIONS[:, ::-1]), Truth(offset={3: np.pi})),
    merged(Truth(gyro=57.29578), Truth(radius=dict.fromkeys(range(4), 1.35))),
    merged(Truth(**both('steering', 3)), Truth(offset={2: np.pi}))])
def test_one_of_several_faults_is_not_blamed_for_all_of_them(truth):
    found = [message for _, message in reports(driven(truth, seed=3, duration=12.0))[11.0]]
    assert any(message.startswith(SEVERAL) for message in found), found


def test_what_was_found_is_not_withdrawn_while_an_emergency_stop_shows_nothing_of_it():
    drive = driven(Truth(offset={3: np.pi / 2}), seed=1, duration=8.0)
    count = 500
    last = [np.tile(series[-1], (count, 1)) for series in (drive.distances, drive.angles)]
    stopped = DriveData(
        drive.stamp[-1] + 0.02 * np.arange(1, count + 1), *last, np.full(count, drive.yaw[-1]),
        np.zeros(count), np.full_like(last[0], 0.5), last[1])
    found = reports(DriveData(*map(np.concatenate, zip(drive, stopped))))[17.0]
    assert [any(words in message for _, message in found) for words in (
        'steering offset wrong by 90 degrees', 'no joint moves when commanded')] == [True, True]


def test_a_single_fault_is_not_taken_for_several():
    for name in FAULTS:
        assert not any(message.startswith(SEVERAL) for _, message in reports_on(name)[6.0])


def test_a_mistake_in_the_judgement_is_told_and_ends_neither_drive_nor_watch(monkeypatch):
    drive = driven(FAULTS['gyro frozen'][0], seed=1, duration=6.0)
    with monkeypatch.context() as patch:
        patch.setattr('swerve_kinematics.ros.watch.checking', lambda *_, **__: 1 / 0)
        (is_grave, message), = reports(drive)[5.0]
    assert message == f"{FAILED}: ZeroDivisionError('division by zero')" and not is_grave
    assert not any(message.startswith(FAILED) for _, message in reports(drive)[5.0])


LOADED_BY_A_JUDGEMENT = """
import sys
import numpy as np
from swerve_kinematics.ros.watch import Watch
watch = Watch('abcd', np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]), True)
before = {*sys.modules}
for k in range(300):
    watch.commanded([1.0] * 4, [0.0] * 4)
    watch.add(20_000_000 * k, [0.02 * k] * 3 + [-0.02 * k], [0.0] * 4, 0.0, 0.0)
assert watch.findings(), 'nothing was judged'
print(*{*sys.modules} - before)
"""


def test_a_judgement_loads_nothing_while_the_base_drives():
    result = subprocess.run([sys.executable, '-c', LOADED_BY_A_JUDGEMENT], check=True,
                            capture_output=True, text=True)
    assert result.stdout.split() == []


@settings(max_examples=25)
@given(st.lists(st.tuples(st.sampled_from((0.0, 0.1, 0.5)), st.sampled_from((0.0, 0.4)),
                          st.floats(0.02, 12.0), st.sampled_from((0.02, 0.1, 0.4))),
                min_size=2, max_size=6))
@example([(0.5, 0.4, 2.7, 0.02), (0.0, 0.0, 7.0, 0.02), (0.5, 0.4, 1.0, 0.02)])
def test_it_judges_whatever_way_driving_and_resting_alternate(stages):
    watch = Watch(NAMES, POSITIONS, expects_gyro=True)
    stamp, way = 0.0, 0.0
    for commanded, speed, duration, period in stages:
        for _ in range(int(duration / period)):
            stamp, way = stamp + period, way + speed * period
            watch.commanded([commanded] * 4, [0.0] * 4)
            watch.add(int(stamp * 1e9), [way] * 4, [0.0] * 4, 0.0, 0.0)
    assert isinstance(watch.findings(), list)


def test_what_a_circle_does_not_decide_is_called_a_perhaps_and_the_motion_that_would():
    gears_left_out = DESCRIBED_WRONGLY['gears of 5 left out'][0]
    found = reports(driven(gears_left_out, twist_at=lambda time: np.array((0.5, 0.0, 0.6)) * (
        time > REST), duration=12.0))[11.0]
    (is_grave, message), = found
    assert not is_grave and f'{CONTRADICTION} - perhaps ' in message
    assert 'would decide: sideways, turning' in message


def test_a_fault_that_lasts_is_grave():
    drive = driven(DESCRIBED_WRONGLY['offset wrong by 90 degrees'][0], seed=1, duration=12.0)
    levels = [grave for found in reports(drive).values() for grave, _ in found]
    assert levels == sorted(levels) and levels[0] is False and levels[-1] is True


@pytest.mark.parametrize('joint', ['drive', 'steering'])
def test_where_all_joints_are_at_fault_nothing_else_is_blamed(joint):
    drive = driven(OUT_OF_ORDER[f'{joint} in turns'][0], seed=3, duration=12.0)
    assert [message.split(' - ')[0] for _, message in reports(drive)[11.0]] == [
        f'all modules: {joint} does not follow its command']


class HeldBase(Base):
    """A base whose joints of some kinds something holds for twelve seconds."""

    def __init__(self, kinds):
        super().__init__(Truth())
        self._kinds = kinds

    def move(self, speeds, angles, dt, time):
        before = self.turned, self.angle
        super().move(speeds, angles, dt, time)
        if 6.0 < time < 18.0:
            self.turned, self.angle = (
                old if kind in self._kinds else new for kind, old, new in zip(
                    ('drive', 'steering'), before, (self.turned, self.angle)))


@pytest.mark.parametrize('kinds, words', [
    (('drive', 'steering'), 'no joint moves when commanded'),
    (('drive',), 'all modules: drive stands still')])
@pytest.mark.parametrize('seed', [0, 1])
def test_a_base_that_is_held_and_released_is_told_of_in_few_words(kinds, words, seed):
    found = reports(driven(base=HeldBase(kinds), duration=30.0, seed=seed))
    told = {second: [message.split(' - ') for _, message in messages]
            for second, messages in found.items()}
    assert [words, STOPPED] in told[17.0]
    for messages in told.values():
        subjects = [wrong.split(': ') for wrong, _ in messages]
        # Either all modules are named or some, and none beside a base that does not move at all.
        for joint in ('drive', 'steering'):
            whose = [subject for subject, *wrong in subjects
                     if wrong and wrong[0].startswith(joint)]
            assert 'all modules' not in whose or len(whose) == 1, messages
        assert ['no joint moves when commanded'] not in subjects or len(subjects) == 1, messages
    assert found[29.0] == []


@pytest.mark.parametrize('name', [
    'steering in degrees', 'gear in the readings of a steering alone'])
def test_modules_that_turn_on_and_on_are_named_though_all_wheels_wait_for_them(name):
    drive = driven(OUT_OF_ORDER[name][0], seed=3, duration=4.0)
    words = fault_in_words(JointFault(*OUT_OF_ORDER[name][1]), NAMES)[0]
    assert [words in message for _, message in reports(drive)[3.0]] == [True]


@pytest.mark.parametrize('case', [
    {'seed': 1}, {'rate': 10.0}, {'rate': 200.0}, {'truth': Truth(slip=(2, 2.0, 3.0, 4.0))},
    {'twist_at': lambda time: (0.0, 0.0, 1.0)}, {'twist_at': lambda time: (0.0, 0.5, 0.0)},
    {'twist_at': lambda time: (0.0, 0.0, 0.0)},
    {'rate': 20.0, 'twist_at': lambda time: [(0.1, 0.0, 0.0), (0.0, 0.1, 0.0)][
        int(time / 0.4) % 2]}], ids=[
            'mixed', '10 Hz', '200 Hz', 'slip', 'turning', 'strafing', 'standing', 'steering'])
def test_the_right_base_is_left_in_peace(case):
    assert not any(reports(driven(**{'duration': 10.0, **case})).values())


@pytest.mark.parametrize('seed', range(6))
def test_a_base_that_is_not_calibrated_yet_is_left_in_peace(seed):
    assert not any(reports(driven(all_slightly_off(seed), seed=seed, duration=12.0)).values())


@pytest.mark.parametrize('name', ['figure8__drag', 'square_turn__slip'])
def test_a_wheel_that_slips_or_drags_is_no_fault_of_the_description(name):
    log = np.load(LOGS / f'{name}.npz')
    drive = DriveData(log['t'], 0.05 * log['wheel_pos'], log['steer'], log['gyro_yaw'])
    assert not any(reports(drive, log['modules_xy']).values())
