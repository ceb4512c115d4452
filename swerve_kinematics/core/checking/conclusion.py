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

"""Which of the changes that a search has tried are believed, and what remains open."""

import numpy as np

from swerve_kinematics.core.checking.changes import Change, DRIVE_REVERSED, OFFSET, OUTSIDER
from swerve_kinematics.core.checking.hypothesis import Hypothesis
from swerve_kinematics.core.checking.search import Search
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.core.geometry.angles import wrap_angle

# Hypotheses that are worse by less than this [nat] cannot be told from the best.
MARGIN = 6.0
# A change that is not sure yet is suspected when it explains this much [nat].
SUSPICION = 6.0
# A change must be worth this much a moving window [nat]: what tyres creep and slip is not.
LEAST_GAIN = 0.15
# Others that may explain a drive, besides the one believed, of which people are told.
MOST_ALTERNATIVES = 4


def concluded(verdict: Verdict, search: Search, null: Hypothesis, singles: list[Hypothesis],
              pairs: bool) -> Verdict:
    """
    Return a verdict with the changes that a search supports, if it supports any.

    Parameters
    ----------
    verdict : Verdict
        Of the joints and the gyro.
    search : Search
        Over the drive.
    null : Hypothesis
        That nothing is to be changed, but all modules may be a little off.
    singles : list of Hypothesis
        Of a single change each, best first.
    pairs : bool
        Whether to look for two changes at once.

    Returns
    -------
    Verdict

    """
    due = [single for single in singles
           if search.is_plausible(single) and search.is_due(single.changes)]
    faults = [single for single in due if not _is_harmless(single)]
    harmless = [single for single in due if _is_harmless(single)]
    best, least = null, LEAST_GAIN * search.moving_windows
    if faults and search.null.total - faults[0].total > least and (
            faults[0].total < min(other.total for other in (null, *harmless))):
        best = faults[0]
    elif harmless and _is_slip(harmless[0]) and null.total - harmless[0].total > 0.0 and not (
            search.is_contradicted_by(harmless[0])):
        return verdict._replace(slipping=harmless[0].changes[0].modules, hypothesis=null,
                                untold=_untold(harmless[0], faults))
    # What is negligible alone need not be so together with something else.
    doubles = _pairs(search, singles) if pairs and (
        best is not null or search.is_contradicted) else []
    gain = best.total - doubles[0].total if doubles else 0.0
    if gain > 0.0 and (best is not null
                       or gain > least and not search.is_contradicted_by(doubles[0])):
        best = doubles[0]
    if best is not null:
        return _with_changes(verdict, search, best, due + doubles)
    return verdict._replace(
        hypothesis=null, untold=_untold(null, faults),
        needs_calibration=search.null.total - null.total > least,
        suspect=None if verdict.joints else _suspect(null, faults, harmless),
        unexplained=search.is_contradicted and not verdict.joints)


def _pairs(search: Search, singles: list[Hypothesis]) -> list[Hypothesis]:
    """Return the hypotheses of two changes that call for a correction, best first."""
    doubles = search.best_pairs(singles)
    if doubles and doubles[0].is_negligible:
        return []  # what is left is a matter of calibration
    return [pair for pair in doubles if not pair.is_negligible]


def _with_changes(verdict: Verdict, search: Search, best: Hypothesis,
                  candidates: list[Hypothesis]) -> Verdict:
    """Return a verdict with the best changes, and with what else may explain the drive."""
    rivals = [other for other in candidates
              if other.total < best.total + MARGIN and not _same(other.changes, best.changes)]
    weights = np.exp([best.total - other.total for other in rivals])
    return verdict._replace(
        changes=best.changes, hypothesis=best, confidence=float(1.0 / (1.0 + weights.sum())),
        alternatives=tuple(other.changes for other in rivals[:MOST_ALTERNATIVES]),
        leaves_more=search.leaves_more(best),
        possible=tuple(other for other in candidates if other.misfit < best.misfit + MARGIN))


def _suspect(null: Hypothesis, faults: list[Hypothesis],
             harmless: list[Hypothesis]) -> Change | None:
    """Return the change that explains most, if that is much and more than the harmless do."""
    # All that a circle shows is how much the base turns, which one number explains as well as any
    # other does: small errors of all modules, as of a sound base, or a great one of any of them.
    misfit, best = min(((fault.misfit + fault.changes[0].freedom, fault) for fault in faults),
                       key=lambda pair: pair[0], default=(null.misfit, null))
    least = min([null.misfit - SUSPICION, *(other.misfit for other in harmless)])
    return best.changes[0] if misfit < least else None


def _is_slip(hypothesis: Hypothesis) -> bool:
    """Tell whether a hypothesis is that of a module that the gyro contradicts at times."""
    return hypothesis.changes[0].kind == OUTSIDER


def _is_harmless(hypothesis: Hypothesis) -> bool:
    """Tell whether a hypothesis calls for no correction: slip, or what calibration will find."""
    return _is_slip(hypothesis) or hypothesis.is_negligible


def _untold(best: Hypothesis, singles: list[Hypothesis]) -> tuple[Change, ...]:
    """Return the changes that fit as well as none."""
    return tuple(single.changes[0] for single in singles
                 if single.misfit < best.misfit + MARGIN)


def _same(first: tuple[Change, ...], second: tuple[Change, ...]) -> bool:
    """Tell whether changes mean the same: a direction and half a turn of offset do."""
    return {_meaning(change) for change in first} == {_meaning(change) for change in second}


def _meaning(change: Change) -> tuple[str, tuple[int, ...]]:
    """Return what identifies a change whatever its number is."""
    if change.kind == OFFSET and change.value is not None and (
            abs(wrap_angle(change.value - np.pi)) < np.radians(3.0)):
        return DRIVE_REVERSED, change.modules
    return change.kind, change.modules
