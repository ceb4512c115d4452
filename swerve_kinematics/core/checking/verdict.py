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

"""What a drive shows about a base."""

from typing import NamedTuple

from swerve_kinematics.core.checking.changes import Change
from swerve_kinematics.core.checking.hypothesis import Hypothesis
from swerve_kinematics.core.checking.joints import JointFault

# Changes that are less sure than this, for want of motion, are none to be made.
LEAST_CONFIDENCE = 0.9


class Verdict(NamedTuple):
    """
    What a drive shows about a base.

    Attributes
    ----------
    joints : tuple of JointFault
        Joints that do not do what they are told, or stand still.
    gyro : str or None
        What is wrong with the gyro itself.
    rolls : tuple of float
        How much farther each wheel rolls than its drive tells, for each radian by which its
        module turns counter-clockwise [m]; empty if they do not.
    changes : tuple of Change
        What must change in the description, or in the wiring.
    hypothesis : Hypothesis or None
        What they follow from; None if nothing could be compared.
    confidence : float
        Between 0 and 1: of these changes against others as simple.
    alternatives : tuple of tuple of Change
        Other changes that this drive cannot tell from them.
    possible : tuple of Hypothesis
        All that explain the data as well, however unlikely they are.
    slipping : tuple of int
        Modules that did not fit for a part of the drive.
    suspect : Change or None
        What explains the data best where the drive is too short to be sure of it.
    unexplained : bool
        Whether the data contradict the description in a way that no change explains.
    leaves_more : bool
        Whether they do so after the changes too: something else must be wrong as well.
    needs_calibration : bool
        Whether small errors explain the drive better than none: of radii and offsets, or of the
        scale of the gyro, which looks like an error of all radii.
    untold : tuple of Change
        What may be wrong as well: this drive cannot rule it out.
    missing : tuple of str
        Motions that it lacks: `forward`, `sideways` or `turning`.
    is_moving : bool
        Whether the base moved for long enough to show anything.
    is_seen : bool
        Whether someone saw which way it went.

    """

    joints: tuple[JointFault, ...] = ()
    gyro: str | None = None
    rolls: tuple[float, ...] = ()
    changes: tuple[Change, ...] = ()
    hypothesis: Hypothesis | None = None
    confidence: float = 1.0
    alternatives: tuple[tuple[Change, ...], ...] = ()
    possible: tuple[Hypothesis, ...] = ()
    slipping: tuple[int, ...] = ()
    suspect: Change | None = None
    unexplained: bool = False
    leaves_more: bool = False
    needs_calibration: bool = False
    untold: tuple[Change, ...] = ()
    missing: tuple[str, ...] = ()
    is_moving: bool = True
    is_seen: bool = False

    @property
    def is_wrong(self) -> bool:
        """Return whether anything must be corrected."""
        return bool(self.joints or self.gyro or self.rolls or self.changes
                    or self.unexplained)

    @property
    def is_ambiguous(self) -> bool:
        """Return whether other changes are as good, and motion that the drive lacks would tell."""
        return bool(self.changes and self.missing) and self.confidence < LEAST_CONFIDENCE
