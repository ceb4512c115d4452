"""One joint at a time, with the wheels off the floor: who moves, and which way round."""

from collections.abc import Sequence
from typing import NamedTuple

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.checking.changes import (
    Change, DRIVE_REVERSED, DRIVES_EXCHANGED, STEERING_REVERSED, STEERINGS_EXCHANGED)
from swerve_kinematics.core.checking.check import Verdict
from swerve_kinematics.core.checking.joints import (
    AGAINST, ASTRAY, DRIVE, JointFault, STANDS, STEERING)
from swerve_kinematics.ros.messages import ForwardCommands, JointCommands
from swerve_kinematics.tools.check.robot import (
    answered, choice, progress, Robot, robot, said)

# How far a module is turned [rad], how fast a rim turns [m/s], and for how long each [s].
STEER, SPEED, STEERING_TIME, DRIVE_TIME = 0.4, 0.1, 1.5, 1.5
# A joint has moved from this part of what was commanded on.
LEAST_PART = 0.4
# Nothing turns faster [rad/s], [m/s]: it has run away then.
FASTEST_STEERING, FASTEST_RIM = 8.0, 0.5
# Time to come back, or to stop [s].
SETTLING = 0.6


class Moved(NamedTuple):
    """What each joint did [m, rad] in a step of the check."""

    drives: list[float]
    steerings: list[float]


class Blocks:
    """
    Moves one joint after another and sees what moves.

    Parameters
    ----------
    seen : Robot
        With joint states coming in.
    asks_nothing : bool
        Whether to take the answers of people for granted.

    """

    def __init__(self, seen: Robot, asks_nothing: bool) -> None:
        """Take the present angles as those to come back to."""
        self._seen, self._asks_nothing = seen, asks_nothing
        self._out: ForwardCommands | JointCommands = seen.joint_commands()
        self._angles = list(seen.sample().angles)
        self._count = len(self._angles)
        self.faults: list[JointFault] = []
        self.changes: list[Change] = []

    def run(self) -> None:
        """Check all joints; whatever happens, leave them stopped."""
        try:
            for module in range(self._count):
                self._steer(module)
            for module in range(self._count):
                self._roll(module)
        finally:
            self.stop()

    def stop(self) -> None:
        """Stop the wheels and hold the steering."""
        for _ in range(5):
            self._publish([0.0] * self._count, None)
        self._out.wait_for_delivery()

    def _publish(self, speeds: Sequence[float], angles: Sequence[float] | None) -> None:
        """Command rim speeds [m/s] and module angles [rad]."""
        joints = self._seen.layout.joints
        self._out.publish(
            self._seen.node.get_clock().now().nanoseconds,
            joints.drives(speeds, [0.0] * self._count),
            None if angles is None else joints.steering_positions(angles))

    def _step(self, speeds: Sequence[float], angles: Sequence[float], seconds: float) -> Moved:
        """Command for some seconds and return what moved; ValueError if one runs away."""
        begun = before = self._seen.sample()
        for _ in self._seen.during(seconds, lambda: self._publish(speeds, angles)):
            # One that starts later, or was discovered late.
            self._seen.refuse_rivals()
            now = self._seen.sample()
            elapsed = (now.stamp - before.stamp) * 1e-9
            if elapsed < 0.1:
                continue
            layout = self._seen.layout
            for module in range(self._count):
                if abs(now.angles[module] - before.angles[module]) > FASTEST_STEERING * elapsed:
                    raise ValueError(f'{layout.steering_joints[module]} runs away: stopped')
                if abs(now.distances[module] - before.distances[module]) > FASTEST_RIM * elapsed:
                    raise ValueError(f'{layout.drive_joints[module]} runs away: stopped')
            before = now
        now = self._seen.sample()
        return Moved([new - old for new, old in zip(now.distances, begun.distances)],
                     [new - old for new, old in zip(now.angles, begun.angles)])

    def _steer(self, module: int) -> None:
        """Turn one module and back."""
        name, still = self._seen.layout.module_names[module], [0.0] * self._count
        progress(f'steering {name}')
        angles = list(self._angles)
        angles[module] += STEER
        moved = self._step(still, angles, STEERING_TIME).steerings
        if self._judged(STEERING, module, moved, STEER):
            self._ask(f'Did {name} turn counter-clockwise, seen from above?', STEERING, module)
        self._step(still, self._angles, SETTLING)

    def _roll(self, module: int) -> None:
        """Turn one wheel."""
        name, speeds = self._seen.layout.module_names[module], [0.0] * self._count
        progress(f'driving {name}')
        speeds[module] = SPEED
        moved = self._step(speeds, self._angles, DRIVE_TIME).drives
        self._step([0.0] * self._count, self._angles, SETTLING)
        if self._judged(DRIVE, module, moved, SPEED * DRIVE_TIME):
            self._ask(f'Did the wheel of {name} roll forward (as its steering points)?', DRIVE,
                      module)

    def _ask(self, question: str, joint: str, module: int) -> None:
        """Ask what no sensor knows: which way round it went, or that another one did."""
        names = self._seen.layout.module_names
        others = [name for name in names if name != names[module]]
        answer = choice(f'{question} Or which other module moved?', ('y', 'n', *others),
                        self._asks_nothing)
        if answer == 'n':
            self._found(Change(
                DRIVE_REVERSED if joint == DRIVE else STEERING_REVERSED, (module,)))
        elif answer != 'y':
            self._exchanged(joint, module, names.index(answer))

    def _exchanged(self, joint: str, module: int, other: int) -> None:
        """Note that two modules have each other's joints."""
        kind = DRIVES_EXCHANGED if joint == DRIVE else STEERINGS_EXCHANGED
        self._found(Change(kind, (min(module, other), max(module, other))))

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
            self._exchanged(joint, module, others[0])
            return False
        self.faults.append(JointFault(joint, ASTRAY if others else STANDS, (module,)))
        return False

    def _found(self, change: Change) -> None:
        """Note a change once: a pair that is exchanged shows twice."""
        if change not in self.changes:
            self.changes.append(change)


def checked_on_blocks(parameters: NodeParameters, asks_nothing: bool,
                      ros_arguments: list[str]) -> Verdict:
    """
    Return what moving one joint at a time tells.

    Raises
    ------
    ValueError
        If another node commands the joints, the joint states fall silent, or one runs away.

    """
    with robot(parameters, ros_arguments) as seen:
        seen.wait_for_joints()
        if not answered('Each joint will move for a second or two. Are the wheels off the floor, '
                        'and a hand on the emergency stop?', asks_nothing):
            raise ValueError('cancelled: nothing was moved')
        blocks = Blocks(seen, asks_nothing)
        blocks.run()
        said('')
        return Verdict(joints=tuple(blocks.faults), changes=tuple(blocks.changes))
