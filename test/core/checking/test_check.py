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

"""A check finds what is wrong with a base from what it reported, and nothing where all is well."""

from dataclasses import replace
from pathlib import Path

from checking_drives import all_slightly_off, both, driven, mixed, POSITIONS, Truth
from checking_faults import DESCRIBED_WRONGLY, FL, FR, OUT_OF_ORDER, RL
from checking_mends import is_mended, merged, random_pair
import numpy as np
import pytest

from swerve_kinematics.core.checking.changes import Change, OFFSET, RADIUS
from swerve_kinematics.core.checking.check import check
from swerve_kinematics.core.checking.drive_data import DriveData

LOGS = Path(__file__).parents[2] / 'data'


def named(verdict):
    return [(change.kind, change.modules) for change in verdict.changes]


@pytest.mark.parametrize('name', DESCRIBED_WRONGLY)
def test_a_wrong_description_is_found(name):
    truth, expected = DESCRIBED_WRONGLY[name]
    verdict = check(POSITIONS, driven(truth, seed=3), pairs=False)
    assert len(verdict.changes) == 1 and named(verdict)[0] in expected
    assert is_mended(truth, verdict, seed=103)


@pytest.mark.parametrize('turns', [
    (-0.53,) * 4, (0.1,) * 4, (0.5, -0.5) * 2, (0.0, 0.5, 0.0, 0.0)], ids=str)
def test_wheels_that_roll_as_their_modules_turn_are_found(turns):
    truth = replace(all_slightly_off(3), rolls=dict(enumerate(turns)))
    verdict = check(POSITIONS, driven(truth, seed=5), pairs=False)
    assert verdict.is_wrong and verdict.changes == ()
    assert np.array(verdict.rolls) == pytest.approx(0.05 * np.array(turns), abs=0.0015)


@pytest.mark.parametrize('seed', range(4))
def test_a_late_gyro_or_a_wheel_that_slips_is_no_wheel_that_rolls_as_its_module_turns(seed):
    data = driven(all_slightly_off(seed), seed=seed)
    late = [np.interp(data.stamp - 0.03, data.stamp, each) for each in (data.yaw, data.yaw_rate)]
    slipping = driven(Truth(slip=(seed, 1.3, 3.0, 9.0)), seed=seed)
    for drive in (data, data._replace(yaw=late[0], yaw_rate=late[1]), slipping):
        assert check(POSITIONS, drive, pairs=False).rolls == ()


@pytest.mark.parametrize('name', OUT_OF_ORDER)
def test_a_joint_that_does_not_obey_is_found(name):
    truth, expected = OUT_OF_ORDER[name]
    verdict = check(POSITIONS, driven(truth, seed=3), pairs=False)
    assert [tuple(fault) for fault in verdict.joints] == [expected]
    assert verdict.changes == ()


@pytest.mark.parametrize('name', ['dead drive', 'dead steering', 'module frozen'])
def test_a_joint_that_stands_still_is_found_without_commands(name):
    truth, expected = OUT_OF_ORDER[name]
    data = driven(truth, seed=4)._replace(commanded_speeds=None, commanded_angles=None)
    assert [tuple(fault) for fault in check(POSITIONS, data, pairs=False).joints] == [expected]


@pytest.mark.parametrize('fault', ['frozen', 'silent'])
def test_a_gyro_that_says_nothing_new_is_found(fault):
    verdict = check(POSITIONS, driven(Truth(gyro_fault=fault), seed=3))
    assert verdict.gyro == f'gyro {fault}'
    # Without a gyro a base that is driven by its description agrees with it, right or wrong.
    assert verdict.changes == () and len(verdict.untold) > 20


@pytest.mark.parametrize('sense', [1.0, -1.0])
def test_a_gyro_of_which_the_rate_counts_the_other_way_is_found(sense):
    """As of an IMU upside down whose orientation is right; or its yaw is what is reversed."""
    data = driven(Truth(gyro=sense), seed=3)
    verdict = check(POSITIONS, data._replace(yaw_rate=-data.yaw_rate), pairs=False)
    assert verdict.gyro == 'rate against yaw'
    assert named(verdict) == ([] if sense > 0.0 else [('gyro reversed', ())])


@pytest.mark.parametrize('has_yaw', [True, False])
@pytest.mark.parametrize('sense', [1.0, -1.0])
def test_a_rate_without_noise_is_not_frozen_while_the_base_turns_steadily(has_yaw, sense):
    data = driven(Truth(gyro=sense), twist_at=lambda time: (0.0, 0.0, 1.0), duration=8.0)
    steady = data._replace(yaw_rate=np.full_like(data.yaw_rate, sense),
                           yaw=sense * data.stamp if has_yaw else None)
    assert check(POSITIONS, steady, pairs=False).gyro is None
    if has_yaw:
        still = steady._replace(yaw=0.0 * data.stamp)
        assert check(POSITIONS, still, pairs=False).gyro == 'yaw frozen'
    frozen = steady._replace(yaw_rate=np.full_like(data.yaw_rate, 0.2),
                             yaw=np.full_like(data.stamp, 0.3) if has_yaw else None)
    assert check(POSITIONS, frozen, pairs=False).gyro == 'gyro frozen'


def test_two_faults_at_once_are_mended_in_most_cases():
    # Not in all: a base that is driven by a wrong description shows the gyro one number at a time,
    # and some pairs show the same numbers as other faults do, or hide the second until the first
    # is mended.
    mended = []
    for seed in range(10):
        truth = merged(*random_pair(np.random.default_rng(seed)))
        mended.append(is_mended(truth, check(POSITIONS, driven(truth, seed=seed)), seed + 100))
    assert sum(mended) >= 8


RIGHT = {
    'mixed': {}, 'at 10 Hz': {'rate': 10.0}, 'at 200 Hz': {'rate': 200.0, 'duration': 8.0},
    'one wheel slips': {'truth': Truth(slip=(1, 1.8, 4.0, 5.0))},
    'not calibrated': {'truth': Truth(radius={0: 1.01, 3: 0.99}, offset={1: 0.015})},
    'turning': {'twist_at': lambda time: (0.0, 0.0, 1.0 * (time > 0.5))},
    'strafing': {'twist_at': lambda time: (0.0, 0.5 * (time > 0.5), 0.0)},
    'standing': {'twist_at': lambda time: (0.0, 0.0, 0.0)},
}


@pytest.mark.parametrize('name', RIGHT)
def test_nothing_is_wrong_with_the_right_base(name):
    verdict = check(POSITIONS, driven(seed=8, **RIGHT[name]))
    assert not verdict.is_wrong and verdict.changes == ()


SMALL = {
    'gyro that reads too little': Truth(gyro=0.978),
    'gyro that reads too much': Truth(gyro=1.025),
    'all radii': Truth(radius=dict.fromkeys(range(4), 0.975)),
    'a radius': Truth(radius={0: 0.972}), 'an offset': Truth(offset={0: -0.035})}


@pytest.mark.parametrize('duration', [6.0, 20.0, 40.0])
@pytest.mark.parametrize('name', SMALL)
def test_what_calibration_finds_is_not_taken_for_something_greater(name, duration):
    verdict = check(POSITIONS, driven(SMALL[name], seed=2, duration=duration), pairs=False)
    assert not verdict.is_wrong and verdict.suspect is None


@pytest.mark.parametrize('seed', range(8))
def test_small_errors_of_all_modules_are_not_taken_for_a_greater_one_of_a_single_module(seed):
    verdict = check(POSITIONS, driven(all_slightly_off(seed), seed=seed, duration=12.0))
    assert not verdict.is_wrong and verdict.suspect is None
    assert verdict.needs_calibration
    assert all(change.kind in (OFFSET, RADIUS) for change in verdict.untold)


@pytest.mark.parametrize('seed', range(1, 9))
def test_a_circle_does_not_make_small_errors_a_greater_one(seed):
    # All that it shows is another turn, which any single number explains.
    circle = np.array((1.0, 0.0, 1.0))
    verdict = check(POSITIONS, driven(all_slightly_off(seed), seed=seed, duration=8.0,
                                      twist_at=lambda time: circle * (time > 0.5)))
    assert not verdict.is_wrong and verdict.suspect is None
    assert 'sideways' in verdict.missing


def test_small_errors_rule_nothing_out_that_a_calibrated_base_leaves_open():
    """Of two modules at nearly the same place no drive tells the joints apart."""
    positions = np.array([(0.3, 0.25), (0.3, 0.2501), (-0.3, 0.25), (-0.3, -0.25)])
    for truth in (Truth(positions=positions), replace(all_slightly_off(1), positions=positions)):
        verdict = check(positions, driven(truth, seed=1, duration=12.0, described=positions),
                        pairs=False)
        assert {('drive joints swapped', (0, 1)), ('steering joints swapped', (0, 1))} <= {
            (change.kind, change.modules) for change in verdict.untold}


@pytest.mark.parametrize('fault', [Truth(offset={2: np.radians(12.0)}), Truth(radius={1: 1.15})],
                         ids=['offset', 'radius'])
def test_a_module_that_is_worse_than_all_others_is_found_among_small_errors(fault):
    expected, = named(check(POSITIONS, driven(fault, seed=3), pairs=False))
    for seed in range(4):
        truth = merged(all_slightly_off(seed), fault)
        verdict = check(POSITIONS, driven(truth, seed=seed), pairs=False)
        first, *others = [(change.kind, change.modules) for change, in (
            verdict.changes, *verdict.alternatives)]
        # Another module may have another small error that makes as good an explanation.
        assert first == expected or expected in others and verdict.confidence < 0.9


def test_a_small_error_beside_a_fault_is_not_taken_for_a_second_fault():
    truth = Truth(gyro=0.978, **both('drive', 0))
    assert named(check(POSITIONS, driven(truth, seed=1))) == [('drive reversed', (0,))]


def test_a_module_that_the_base_turns_about_is_not_dead():
    positions = POSITIONS - POSITIONS[0]
    data = driven(Truth(positions=positions), described=positions, duration=10.0,
                  twist_at=lambda time: (0.0, 0.0, np.sin(time)))
    assert not check(positions, data).is_wrong


@pytest.mark.parametrize('dead', [{'frozen': (FL, FR)}, {'frozen': (FL, RL)},
                                  {'dead_drives': (FR,), 'frozen': (RL,)}])
def test_two_modules_that_are_left_tell_of_themselves_alone(dead):
    verdict = check(POSITIONS, driven(Truth(**dead), seed=1))
    assert {module for fault in verdict.joints for module in fault.modules} == {
        module for modules in dead.values() for module in modules}
    assert verdict.changes == () and not verdict.unexplained


def test_a_module_whose_readings_are_frozen_discredits_no_other():
    twist_at = mixed(np.random.default_rng(5), 12.0)
    verdict = check(POSITIONS, driven(Truth(frozen=(FR,)), twist_at, duration=12.0, seed=1))
    assert [fault.modules for fault in verdict.joints] == [(FR,)]
    assert verdict.changes == ()


@pytest.mark.parametrize('offset', [-0.06, 0.03, 0.1])
def test_without_a_gyro_a_base_is_not_taken_to_go_backwards(offset):
    data = driven(seed=1)
    data = data._replace(angles=data.angles + offset, yaw=None, yaw_rate=None)
    verdict = check(POSITIONS, data, expects_gyro=False, pairs=False)
    assert all(change.kind == 'steering offset' and change.value == pytest.approx(offset, abs=0.02)
               for change in verdict.changes)


@pytest.mark.parametrize('offset', [-0.06, -0.03, 0.03, 0.05, 0.1])
def test_wheels_that_agree_better_do_not_have_the_base_go_backwards(offset):
    data = driven(seed=1, duration=5.0, twist_at=lambda time: np.array(
        (0.5 * np.cos(2.0 * time), 0.5 * np.sin(1.7 * time), min(time, 1.0))))
    verdict = check(POSITIONS, data._replace(angles=data.angles + offset), pairs=False)
    if abs(offset) < np.radians(2.5):
        assert not verdict.is_wrong and verdict.suspect is None
    else:
        assert [change.kind for change in verdict.changes] == ['steering offset']
        assert verdict.changes[0].value == pytest.approx(offset, abs=0.02)


@pytest.mark.parametrize('name', ['figure8__drag', 'square_turn__slip', 'strafe__clean'])
def test_tyres_that_creep_and_slip_are_no_fault(name):
    log = np.load(LOGS / f'{name}.npz')
    data = DriveData(log['t'], 0.05 * log['wheel_pos'], log['steer'], log['gyro_yaw'])
    verdict = check(log['modules_xy'], data)
    assert not verdict.is_wrong
    assert (verdict.slipping == ()) == name.endswith('clean')


@pytest.mark.parametrize('unit', [np.degrees(1.0), 1.0 / (2.0 * np.pi)], ids=['degrees', 'turns'])
def test_steering_in_another_unit_is_not_taken_for_a_slipping_wheel(unit):
    data = driven(seed=4)
    verdict = check(POSITIONS, data._replace(
        angles=unit * data.angles, commanded_speeds=None, commanded_angles=None), pairs=False)
    assert verdict.unexplained and not verdict.slipping


@pytest.mark.parametrize('twist', [(0.5, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 1.0)], ids=[
    'straight', 'strafing', 'turning'])
@pytest.mark.parametrize('fault', [
    both('drive', 0), both('steering', 2), {'offset': {0: -np.pi / 2}}, {'gyro': -1.0},
    {'radius': {1: 1.1}}, {'order': (1, 0, 2, 3)}, {'drive': {3: -1.0}}], ids=str)
def test_motion_of_one_kind_makes_nobody_sure_of_what_is_wrong(twist, fault):
    truth = Truth(**fault)
    data = driven(truth, twist_at=lambda time: np.array(twist) * (time > 0.5), seed=1)
    verdict = check(POSITIONS, data, pairs=False)
    assert verdict.untold or verdict.is_ambiguous or verdict.joints or (
        # ... but for what shows in it.
        is_mended(truth, verdict, seed=101))


@pytest.mark.parametrize('twist', [
    (0.5, 0.0, 0.6), (0.7, 0.0, 0.3), (0.2, 0.0, 0.8), (0.3, 0.3, 0.5), (0.0, 0.4, -0.7)], ids=str)
def test_a_circle_makes_nobody_sure_of_a_wrong_cause(twist):
    for name in ('gears of 5 left out', 'gears of 12 left out', 'order rotated',
                 'gears of 7 given the wrong way round', 'all steering clockwise',
                 'offset wrong by 20 degrees'):
        truth, expected = DESCRIBED_WRONGLY[name]
        data = driven(truth, twist_at=lambda time: np.array(twist) * (time > 0.5), duration=7.0)
        verdict = check(POSITIONS, data, pairs=False)
        sure = [(change.kind, change.modules) for change in verdict.changes
                if not verdict.is_ambiguous]
        assert not sure or sure[0] in expected, name
        # Forwards, sideways and turning are in step, so any two of them are missing.
        assert not verdict.is_ambiguous or len(verdict.missing) >= 2, name


def test_no_gear_is_tried_that_would_look_like_a_gyro_in_degrees():
    whole = Change(RADIUS, tuple(range(len(POSITIONS))))
    assert whole.values.max() < 0.5 * np.degrees(1.0)
    # Of gears up to 16 the wrong way round, each is between two values that are close.
    assert whole.values.min() < 16.0 ** -2 and np.diff(np.log(whole.values)).max() < 0.1


def test_a_gyro_in_degrees_is_found_though_the_base_hardly_turns():
    truth = Truth(gyro=57.29578, positions=POSITIONS[:, ::-1])
    verdict = check(POSITIONS, driven(truth, seed=2, duration=12.0))
    assert sorted(named(verdict)) == [('gyro in degrees', ()), ('x and y swapped', ())]


@pytest.mark.parametrize('gyro', [1.0, -1.0])
def test_no_two_scales_of_the_turns_are_fitted_to_a_base_of_many_faults(gyro):
    # Any turn is that of a gyro in degrees on a base whose modules point 89 degrees astray.
    truth = Truth(**both('drive', 2), offset={0: 0.12, 1: -0.07, 2: 0.2, 3: -0.15}, gyro=gyro)
    kinds = [change.kind for change in check(POSITIONS, driven(truth)).changes]
    assert kinds and 'gyro in degrees' not in kinds


def test_what_a_drive_does_not_tell_is_named_with_the_motion_that_would_tell_it():
    straight = driven(twist_at=lambda time: (0.5 * (time > 0.5), 0.0, 0.0))
    verdict = check(POSITIONS, straight)
    kinds = {change.kind for change in verdict.untold}
    assert {'steering reversed', 'x and y swapped', 'gyro reversed'} <= kinds
    assert verdict.missing == ('sideways', 'turning')
    assert check(POSITIONS, driven()).untold == () == check(POSITIONS, driven()).missing


def test_too_little_motion_tells_nothing():
    assert not check(POSITIONS, driven(duration=2.0)).is_moving


@pytest.mark.parametrize('positions', [
    [(0.3, 0.0), (-0.2, 0.25), (-0.2, -0.25)],
    [(0.5, 0.3), (0.5, -0.3), (0.0, 0.35), (0.0, -0.35), (-0.5, 0.3), (-0.5, -0.3)]])
def test_bases_of_other_shapes(positions):
    positions = np.array(positions)
    right = Truth(positions=positions)
    assert not check(positions, driven(right, described=positions)).is_wrong
    wrong = replace(right, offset={1: np.pi / 2})
    verdict = check(positions, driven(wrong, described=positions), pairs=False)
    assert named(verdict) == [('steering offset', (1,))]
    assert verdict.changes[0].value == pytest.approx(np.pi / 2, abs=0.02)


def test_a_base_that_is_pushed_shows_the_fault_in_its_wheels():
    # As if by hand: the wheels of the right base roll, and one encoder reads backwards.
    data = driven(seed=2)
    distances = data.distances * (1.0, 1.0, -1.0, 1.0)
    pushed = data._replace(distances=distances, commanded_speeds=None, commanded_angles=None)
    verdict = check(POSITIONS, pushed, pairs=False)
    assert named(verdict) == [('drive reversed', (2,))]
    assert verdict.hypothesis.agreeing == (0,) == verdict.hypothesis.moving


def test_a_clock_that_is_set_by_years_amid_a_drive_hides_no_fault():
    truth, expected = OUT_OF_ORDER['dead drive']
    data = driven(truth, seed=3)
    leap = np.where(np.arange(len(data.stamp)) < 400, 0.0, 1.8e9)
    verdict = check(POSITIONS, data._replace(stamp=data.stamp + leap), pairs=False)
    assert [tuple(fault) for fault in verdict.joints] == [expected]


@pytest.mark.parametrize('burst', [2, 5])
def test_stamps_that_come_in_bursts_hide_no_fault(burst):
    truth, expected = DESCRIBED_WRONGLY['rear right steering clockwise']
    data = driven(truth, seed=3, dropped=0.0)
    place = np.arange(len(data.stamp)) % burst
    arrival = data.stamp + (burst - 1 - place) * (0.02 - 1e-4)
    verdict = check(POSITIONS, data._replace(stamp=arrival), pairs=False)
    assert named(verdict)[0] in expected


def test_data_of_no_use_are_refused():
    data = driven(duration=1.0)
    for wrong in (data._replace(stamp=data.stamp[::-1]),
                  data._replace(distances=data.distances[:, :3]),
                  data._replace(angles=data.angles * np.nan)):
        with pytest.raises(ValueError):
            check(POSITIONS, wrong)
