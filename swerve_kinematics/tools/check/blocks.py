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

"""One joint at a time, with the wheels off the floor: who moves, and which way round."""

from collections.abc import Callable, Mapping, Sequence

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.checking.changes import (
    Change, DRIVE_REVERSED, DRIVES_EXCHANGED, DRIVES_MISNAMED, EXCHANGED, ORDER,
    STEERING_REVERSED, STEERINGS_EXCHANGED, STEERINGS_MISNAMED)
from swerve_kinematics.core.checking.joints import (
    AGAINST, ASTRAY, CROOKED, DRIVE, JointFault, STANDS, STEERING, UNSEEN)
from swerve_kinematics.core.checking.verdict import Verdict
from swerve_kinematics.tools.check.lifted_base import LiftedBase
from swerve_kinematics.tools.check.questions import HARDLY, progress, Questions, said
from swerve_kinematics.tools.check.robot import Moved, Robot, robot
from swerve_kinematics.tools.check.straight_ahead import crooked_modules

# How far a module is turned [rad], if no end stop is nearer, and how fast a rim turns [m/s].
STEER, SPEED = 0.4, 0.1
# A joint has moved from this part of what was commanded on.
LEAST_PART = 0.4
# Joints of the other kind stay where they are, within this [m], [rad].
ASTRAY_WAY, ASTRAY_ANGLE = 0.05, 0.2


class Blocks:
    """
    Moves one joint after another and sees what moves.

    Parameters
    ----------
    seen : Robot
        With joint states coming in.
    questions : Questions
        For what no sensor knows.
    step_time : float
        For how long each joint is moved [s].

    """

    def __init__(self, seen: Robot, questions: Questions, step_time: float) -> None:
        """Start with nothing moved."""
        self._seen, self._questions, self._step_time = seen, questions, step_time
        self._base = LiftedBase(seen)
        self._angles = self._base.angles
        self._count = len(self._angles)
        self.faults: list[JointFault] = []
        self._reversed: list[Change] = []
        # By kind and place, whose joints belong there instead of its own.
        self._instead: dict[str, dict[int, int]] = {}

    @property
    def changes(self) -> list[Change]:
        """Return what parameters or cables mend."""
        return self._reversed + [change for kind, instead in self._instead.items()
                                 for change in _mixed_up(kind, instead)]

    def run(self) -> None:
        """Check all joints; whatever happens, leave them stopped."""
        try:
            # Where commands and readings are mixed up, keeping the present angles moves modules:
            # once, and before any is judged.
            hold = self._base.commanding(self._angles)
            self._step(hold)
            self._seen.wait_until_still(hold)
            for module in range(self._count):
                self._steer(module)
            for module in range(self._count):
                self._roll(module)
            if self._steers_well():
                self.faults += [JointFault(STEERING, CROOKED, (module,))
                                for module in crooked_modules(self._base, self._questions)]
        finally:
            self._base.stop()

    def _step(self, command: Callable[[], None]) -> Moved:
        """Command for a step and return what moved; ValueError if one runs away."""
        begun = self._seen.sample()
        for _ in self._base.moving(self._step_time, command):
            pass
        return self._seen.moved(begun, self._seen.sample())

    def _steer(self, module: int) -> None:
        """Turn one module and back."""
        name = self._seen.layout.module_names[module]
        progress(f'steering {name}')
        angles, turn = list(self._angles), self._turn(module)
        angles[module] += turn
        command = self._base.commanding(angles)
        moved = self._step(command)
        self._refuse_strays(self._seen.layout.drive_joints, moved.drives, ASTRAY_WAY)
        if self._judged(STEERING, module, moved.steerings, turn):
            way = 'counter-clockwise' if turn > 0.0 else 'clockwise'
            self._ask(f'Did {name} turn {way}, seen from above?', STEERING, module, command)
        self._seen.wait_until_still(self._base.commanding(self._angles))

    def _turn(self, module: int) -> float:
        """Return by how far to turn a module [rad], the way on which its end stop is farther."""
        angle, (lower, upper) = self._angles[module], self._seen.steering_ranges[module]
        left, right = min(STEER, upper - angle), min(STEER, angle - lower)
        return left if left >= right else -right

    def _roll(self, module: int) -> None:
        """Turn one wheel."""
        name, speeds = self._seen.layout.module_names[module], [0.0] * self._count
        progress(f'driving {name}')
        speeds[module] = SPEED
        moved = self._step(self._base.commanding(self._angles, speeds))
        stop = self._base.commanding(self._angles)
        self._seen.wait_until_still(stop)
        self._refuse_strays(self._seen.layout.steering_joints, moved.steerings, ASTRAY_ANGLE)
        if self._judged(DRIVE, module, moved.drives, SPEED * self._step_time):
            self._ask(f'Did the wheel of {name} roll forward (as its steering points)?', DRIVE,
                      module, stop)

    def _steers_well(self) -> bool:
        """Tell whether nothing is wrong with the steering so far, so that its zero can be seen."""
        return not (any(fault.joint == STEERING for fault in self.faults)
                    or any(change.kind == STEERING_REVERSED for change in self._reversed)
                    or {STEERINGS_EXCHANGED, STEERINGS_MISNAMED} & {*self._instead})

    def _refuse_strays(self, names: Sequence[str], moved: Sequence[float], least: float) -> None:
        """Raise ValueError if joints moved of the kind that was not commanded."""
        strays = [name for name, way in zip(names, moved) if abs(way) > least]
        if strays:
            raise ValueError(f'{strays[0]} moves without a command: stopped')

    def _ask(self, question: str, joint: str, module: int,
             meanwhile: Callable[[], None]) -> None:
        """Ask what no sensor knows: which way round it went, or that another one did."""
        names = self._seen.layout.module_names
        others = [name for name in names if name != names[module]]
        # A module may be called n, for north.
        yes, no = ('yes', 'no') if {'y', 'n'} & {*others} else ('y', 'n')
        answer = self._questions.choice(f'{question} Or which other module moved?',
                                        (yes, no, HARDLY, *others), self._seen.keeping(meanwhile))
        if answer == no:
            self._reversed.append(Change(
                DRIVE_REVERSED if joint == DRIVE else STEERING_REVERSED, (module,)))
        elif answer == HARDLY:
            self.faults.append(JointFault(joint, UNSEEN, (module,)))
        elif answer != yes:
            kind = DRIVES_EXCHANGED if joint == DRIVE else STEERINGS_EXCHANGED
            self._instead.setdefault(kind, {})[names.index(answer)] = module

    def _judged(self, joint: str, module: int, moved: Sequence[float], due: float) -> bool:
        """Note what is wrong with the joint that was commanded; tell whether it moved itself."""
        parts = [way / due for way in moved]
        own = parts[module]
        others = [other for other in range(self._count)
                  if other != module and abs(parts[other]) > LEAST_PART]
        if abs(own) > LEAST_PART and not others:
            if own < 0.0:
                self.faults.append(JointFault(joint, AGAINST, (module,)))
            return True
        if len(others) == 1 and abs(own) <= LEAST_PART:
            kind = DRIVES_MISNAMED if joint == DRIVE else STEERINGS_MISNAMED
            self._instead.setdefault(kind, {})[module] = others[0]
            return False
        self.faults.append(JointFault(joint, ASTRAY if others else STANDS, (module,)))
        return False


def _mixed_up(kind: str, instead: Mapping[int, int]) -> list[Change]:
    """Return a change for each ring of modules, mostly two, each with the joints of the next."""
    changes: list[Change] = []
    for first, other in sorted(instead.items()):
        ring = [first]
        while other not in ring and other in instead:
            ring.append(other)
            other = instead[other]
        # The others of a ring were not seen to move: those two at least.
        chosen = tuple(ring) if other == first else tuple(sorted((first, instead[first])))
        if not any(set(chosen) <= set(change.modules) for change in changes):
            changes.append(Change(kind, chosen))
    return changes


def _merged(changes: Sequence[Change]) -> tuple[Change, ...]:
    """Return changes in which modules whose drives and steerings are swapped are swapped."""
    both = [change.modules for change in changes if change.kind == DRIVES_EXCHANGED
            and Change(STEERINGS_EXCHANGED, change.modules) in changes]
    swapped = tuple(Change(EXCHANGED, ring) if len(ring) == 2 else Change(ORDER, ring, 1)
                    for ring in both)
    return swapped + tuple(change for change in changes if not (
        change.kind in (DRIVES_EXCHANGED, STEERINGS_EXCHANGED) and change.modules in both))


def checked_on_blocks(parameters: NodeParameters, questions: Questions, step_time: float,
                      ros_arguments: list[str]) -> Verdict:
    """
    Return what moving one joint at a time tells.

    Raises
    ------
    ValueError
        If another node commands the joints, the joint states fall silent, or a joint moves when
        it should not.

    """
    with robot(parameters, ros_arguments) as seen:
        seen.wait_for_joints()
        if not questions.is_so('Each joint will move for a second or two. Are the wheels off the '
                               'floor, and a hand on the emergency stop?', seen.keeping()):
            raise ValueError('cancelled: nothing was moved')
        blocks = Blocks(seen, questions, step_time)
        blocks.run()
        said('')
        return Verdict(joints=tuple(blocks.faults), changes=_merged(blocks.changes))
