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

"""What someone saw decides where no sensor does."""

from functools import cache
from itertools import product

from checking_drives import both, driven, POSITIONS, Truth
from checking_faults import ALL
from checking_mends import is_mended, PARAMETERS, positions_of, watched
import numpy as np
import pytest

from swerve_kinematics.core.checking.check import check
from swerve_kinematics.core.checking.eye import as_seen
from swerve_kinematics.core.checking.mends import mended

# Bases of which joints and gyro read the same as those of another.
ALIKE = {
    'gyro reversed': Truth(gyro=-1.0), 'all drives reversed': Truth(**both('drive', *ALL)),
    'half a turn of the order': Truth(order=(3, 2, 1, 0)),
    'the front is the back': Truth(positions=-POSITIONS, **both('drive', *ALL)),
    'all steering clockwise': Truth(**both('steering', *ALL)),
    'x of wrong sign': Truth(positions=POSITIONS * (-1, 1))}


@pytest.mark.parametrize('name', ALIKE)
def test_who_saw_the_base_move_knows_which_of_them_it_is(name):
    truth = ALIKE[name]
    assert is_mended(truth, check(POSITIONS, driven(truth, seed=3), pairs=False), seed=103)


@cache
def short_drive():
    """Return a short drive of the right base, and the verdict on it."""
    data = driven(seed=5, duration=8.0)
    return data, check(POSITIONS, data)


@pytest.mark.parametrize('seen', list(product((True, False), repeat=3)), ids=str)
def test_whatever_is_seen_has_an_explanation_that_the_data_allow(seen):
    data, verdict = short_drive()
    verdict = as_seen(verdict, POSITIONS, data, seen)
    assert (verdict.changes == ()) == all(seen)
    # What the mended description makes of the same readings.
    parameters = {**PARAMETERS, **mended(PARAMETERS, verdict.changes)}
    sign = -1.0 if 'gyro reversed' in [change.kind for change in verdict.changes] else 1.0
    again = check(positions_of(parameters), data._replace(
        distances=data.distances * parameters['drive_directions'],
        angles=data.angles * parameters['steering_directions'],
        yaw=sign * data.yaw, yaw_rate=sign * data.yaw_rate, commanded_speeds=None,
        commanded_angles=None))
    assert not again.is_wrong and again.untold == ()


def test_what_was_seen_tells_two_mistakes_from_one_that_looks_the_same_to_the_gyro():
    truth = Truth(offset={0: np.pi}, **both('drive', 3))
    assert [change.kind for change in check(POSITIONS, driven(truth, seed=4)).changes] == [
        'modules swapped']
    assert sorted(change[:2] for change in watched(truth, seed=4).changes) == [
        ('drive reversed', (0,)), ('drive reversed', (3,))]


# One axis at a time, as on the floor, then in curves: wheels agree, and the gyro sees a scale.
ON_THE_FLOOR = np.array([
    (0.0, 0.0, 0.0), (0.2, 0.0, 0.0), (0.0, 0.2, 0.0), (0.0, 0.0, 0.5), (-0.2, 0.0, 0.0),
    (0.0, -0.2, 0.0), (0.0, 0.0, -0.5), (0.14, 0.14, 0.0), (0.1, 0.1, 0.3), (-0.1, -0.1, -0.3)])


@pytest.mark.parametrize('gear', [2.0, 5.0, 12.0])
def test_a_base_that_was_seen_to_go_backwards_is_not_taken_to_go_aside(gear):
    truth = Truth(radius=dict.fromkeys(ALL, 1.0 / gear), **both('drive', *ALL))
    data = driven(truth, lambda time: ON_THE_FLOOR[int(time / 2.5)], 25.0, seed=3)
    verdict = as_seen(check(POSITIONS, data), POSITIONS, data, (False, False, False))
    assert sorted(change[:2] for change in verdict.changes) == [
        ('drive reversed', ALL), ('wheel radius', ALL)]


# To the gyro, wheels that point sideways, or belong to the next module, turn the base as little as
# gears that are described the wrong way round.
@pytest.mark.parametrize('gear', [5.0, 7.0, 12.0])
def test_a_base_that_was_seen_to_go_ahead_is_not_taken_to_go_aside(gear):
    truth = Truth(radius=dict.fromkeys(ALL, gear ** -2))
    data = driven(truth, lambda time: ON_THE_FLOOR[int(time / 2.5)], 25.0, seed=3)
    verdict = check(POSITIONS, data)
    assert len(verdict.alternatives) > 0
    seen = as_seen(verdict, POSITIONS, data, (True, True, True))
    assert [change[:2] for change in seen.changes] == [('wheel radius', ALL)]
    assert seen.changes[0].value == pytest.approx(gear ** -2, rel=0.02)


def test_a_base_that_does_not_move_is_not_described_anew():
    data = driven(Truth(emergency_stop=True), seed=4, duration=8.0)
    verdict = as_seen(check(POSITIONS, data), POSITIONS, data, (False, False, False))
    assert verdict.changes == () and verdict.joints


def test_explanations_that_nobody_saw_are_dropped():
    data = driven(Truth(gyro=-1.0), seed=3)
    verdict = check(POSITIONS, data, pairs=False)
    assert len(verdict.alternatives) > 0
    seen = as_seen(verdict, POSITIONS, data, (True, True, True))
    assert seen.changes == verdict.changes and seen.alternatives == ()
