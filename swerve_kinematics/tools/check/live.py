"""A drive for a check while it happens: by hand, or by small motions that we command."""

from collections.abc import Callable

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.tools.check.robot import answered, PERIOD, progress, Robot, robot, said
from swerve_kinematics.tools.recordings.collector import Collector

Twist = tuple[float, float, float]
Step = tuple[str, Twist, float]

# No motion is faster [m/s, rad/s], and no rim may be [m/s]: something runs away then.
SPEED, TURN = 0.2, 0.5
FASTEST_RIM = 0.8
# A base that is to stand does so within this [s], to this [m/s].
STOPPING, STANDING = 2.0, 0.02
# What is driven: name, share of the speeds, duration [s]. Every axis for itself, then together.
FORWARD = 'forward', (1.0, 0.0, 0.0), 2.5
STEPS = (
    ('backward', (-1.0, 0.0, 0.0), 2.5), ('to the left', (0.0, 1.0, 0.0), 2.5),
    ('to the right', (0.0, -1.0, 0.0), 2.5), ('turning left', (0.0, 0.0, 1.0), 3.0),
    ('turning right', (0.0, 0.0, -1.0), 3.0), ('in curves', (0.7, 0.0, 0.8), 1.5),
    ('in curves', (0.0, 0.7, -0.8), 1.5), ('in curves', (-0.7, 0.3, 0.8), 1.5),
    ('in curves', (-0.3, -0.7, -0.8), 1.5), ('in curves', (0.4, -0.5, 1.0), 1.5),
    ('in curves', (0.4, 0.6, -1.0), 1.5))


def driven_by_hand(parameters: NodeParameters, seconds: float,
                   ros_arguments: list[str]) -> Collector:
    """Return what a robot does for some seconds while someone drives it."""
    with robot(parameters, ros_arguments) as seen:
        seen.wait_for_joints()
        said('Now drive forward, sideways and around curves, all mixed.')
        for time in seen.during(seconds, lambda: None):
            progress(f'{seconds - time:.0f} s left')
        return seen.collector


def driven_on_the_floor(parameters: NodeParameters, asks_nothing: bool,
                        ros_arguments: list[str]) -> tuple[Collector, bool]:
    """
    Return what a robot does that we move along one axis at a time, and if it went forward.

    swerve_node drives it, so that its limits and its stop hold too.

    Raises
    ------
    ValueError
        If nobody listens, the joint states fall silent, or a joint moves when it should not.

    """
    with robot(parameters, ros_arguments) as seen:
        seen.wait_for_joints()
        command = seen.twist_commands()
        if not answered('The base will move up to 1 m. Is there enough space, and a hand on '
                        'the emergency stop?', asks_nothing):
            raise ValueError('cancelled: nothing was moved')
        try:
            _drive(seen, command, ('standing', (0.0, 0.0, 0.0), 1.0))
            _stand(seen, command)
            _drive(seen, command, FORWARD)
            _stand(seen, command)
            went_forward = answered('Did the base move forward?', asks_nothing)
            for step in STEPS:
                _drive(seen, command, step)
            _stand(seen, command)
        finally:
            for _ in range(5):
                command((0.0, 0.0, 0.0))
        return seen.collector, went_forward


def _drive(seen: Robot, command: Callable[[Twist], None], step: Step) -> None:
    """Drive one step; ValueError if a wheel runs away or the joint states fall silent."""
    name, (x, y, turn), seconds = step
    twist = SPEED * x, SPEED * y, TURN * turn
    before = seen.sample()
    for time in seen.during(seconds, lambda: command(twist)):
        progress(f'{name}: {seconds - time:.0f} s left')
        now = seen.sample()
        elapsed = (now.stamp - before.stamp) * 1e-9
        if elapsed < 5.0 * PERIOD:
            continue
        for module, (new, old) in enumerate(zip(now.distances, before.distances)):
            if abs(new - old) > FASTEST_RIM * elapsed:
                raise ValueError(f'{seen.layout.drive_joints[module]} runs away: stopped')
        before = now


def _stand(seen: Robot, command: Callable[[Twist], None]) -> None:
    """Stop the base; ValueError if a wheel goes on."""
    _drive(seen, command, ('stopping', (0.0, 0.0, 0.0), STOPPING))
    before = seen.sample()
    _drive(seen, command, ('standing', (0.0, 0.0, 0.0), 0.4))
    now = seen.sample()
    elapsed = max((now.stamp - before.stamp) * 1e-9, PERIOD)
    for module, (new, old) in enumerate(zip(now.distances, before.distances)):
        if abs(new - old) > STANDING * elapsed:
            raise ValueError(f'{seen.layout.drive_joints[module]} does not stand still when '
                             'nothing is commanded: stopped')
