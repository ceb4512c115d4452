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

"""What someone saw decides between descriptions that no sensor can tell apart."""

from collections.abc import Iterable, Sequence
from itertools import product
import math

import numpy as np

from swerve_kinematics.core.checking.changes import (
    Change, DRIVE_REVERSED, GYRO_REVERSED, MIRRORED_X, MIRRORED_Y, STEERING_REVERSED)
from swerve_kinematics.core.checking.drive_data import DriveData, Floats, Windows, windows_of
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.core.checking.wiring import as_described, rigid_motion, Wiring

# Changes after which joints and gyro read the same while the base goes another way: the signs of
# its motion forward, to the left and turning left. Any two of them together are another such.
HIDDEN = (
    ((DRIVE_REVERSED, GYRO_REVERSED), (-1.0, -1.0, -1.0)),
    # The front of the base is where the description has its back.
    ((DRIVE_REVERSED, MIRRORED_X, MIRRORED_Y), (-1.0, -1.0, 1.0)),
    ((STEERING_REVERSED, MIRRORED_Y, GYRO_REVERSED), (1.0, -1.0, -1.0)))
# A motion that goes with the one believed by less than this share goes neither way, and one that
# goes with it by less than the other is seen by nobody to go this way.
LEAST_LIKENESS, LEAST_SEEN = 0.3, 0.2
# Nor does anybody see what is so many times as weak as believed, beside all the motion there is.
WEAK = 0.05


def as_seen(verdict: Verdict, positions: Floats, data: DriveData,
            seen: Sequence[bool]) -> Verdict:
    """
    Return the verdict on a base that someone watched.

    Parameters
    ----------
    verdict : Verdict
        From the data.
    positions : ndarray (n, 2)
        Of the modules by the description [m].
    data : DriveData
        Where it comes from.
    seen : sequence of bool (3,)
        Whether the base went forward, to the left, and turned left when told to.

    Returns
    -------
    Verdict
        With the simplest changes that explain what was seen as well.

    """
    if verdict.hypothesis is None:
        return verdict._replace(is_seen=True)
    described, windows = as_described(positions), windows_of(data)
    signs = np.where(seen, 1.0, -1.0)
    likenesses = [(hypothesis, after, signs * turned * likeness)
                  for hypothesis in (*verdict.possible, verdict.hypothesis)
                  for likeness in [_likeness(described, hypothesis.changes, windows)]
                  for after, turned in _equivalents(hypothesis.changes, len(positions))]
    # Who answers carelessly may have seen what nothing explains: then less is asked of a yes.
    for least in np.where(seen, LEAST_SEEN, -LEAST_LIKENESS), np.full(3, -LEAST_LIKENESS):
        found = {after: hypothesis.misfit + math.fsum(change.cost for change in after)
                 for hypothesis, after, likeness in likenesses if (likeness > least).all()}
        if found:
            break
    best = min(found, key=lambda changes: found[changes])
    if best == verdict.changes:
        return verdict._replace(is_seen=True, alternatives=tuple(
            other for other in verdict.alternatives if other in found))
    return verdict._replace(is_seen=True, changes=best, hypothesis=None, alternatives=())


def _equivalents(changes: tuple[Change, ...],
                 count: int) -> Iterable[tuple[tuple[Change, ...], Floats]]:
    """Yield changes that no sensor can tell from the given, and the signs of their motion."""
    for chosen in product((False, True), repeat=len(HIDDEN)):
        after, turned = changes, np.ones(3)
        for (kinds, signs), is_chosen in zip(HIDDEN, chosen):
            if is_chosen:
                turned = turned * signs
                for kind in kinds:
                    after = _toggled(after, Change(kind, tuple(range(count)) if kind in (
                        DRIVE_REVERSED, STEERING_REVERSED) else ()))
        yield after, turned


def _toggled(changes: tuple[Change, ...], change: Change) -> tuple[Change, ...]:
    """Return changes with one more, or without it where it is among them."""
    rest = tuple(other for other in changes if other != change)
    return rest if len(rest) < len(changes) else (*rest, change)


def _likeness(described: Wiring, changes: tuple[Change, ...], windows: Windows) -> Floats:
    """Return the correlations (3,) of the motion after changes with that as described."""
    wiring = described
    for change in changes:
        wiring = change.applied(wiring)
    believed, true = (rigid_motion(each, windows) for each in (described, wiring))
    believed_size, true_size = (np.linalg.norm(each, axis=1) for each in (believed, true))
    scale = np.linalg.norm(true_size) / np.maximum(np.linalg.norm(believed_size), 1e-12)
    size = believed_size * np.maximum(true_size, WEAK * scale * believed_size)
    likeness: Floats = (believed * true).sum(axis=1) / np.maximum(size, 1e-12)
    return likeness
