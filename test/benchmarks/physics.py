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

"""
Compare what our commands and the WPILib recipe do to tyres and motors, in rigid-body physics.

    python test/benchmarks/physics.py [SEEDS]

Both drive the same simulated base (50 kg, MuJoCo) by the same random velocity commands, under
limits of the same size, with the wheels' own encoders as feedback. Prints one table and writes
it, with every run, to bench-output/physics.json. Needs the package with its `physics` and
`test` extras. SEEDS: how many random sequences of each kind (default 3).
"""

from dataclasses import asdict, dataclass, replace
import json
from pathlib import Path
import sys

import numpy as np

from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.sim.actuators import Actuator
from swerve_kinematics.sim.base import BaseCommand, BaseConfig
from swerve_kinematics.sim.physics.base import PhysicsBase
from swerve_kinematics.sim.physics.model import Floor
from wpilib_recipe import Recipe

OUTPUT = Path('bench-output/physics.json')
CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
RADIUS = 0.05
# Half the diagonal of the wheel contacts: metres at the rim for a radian of turn.
ARM = float(np.hypot(*CORNERS[0]))
PERIOD, DURATION = 0.02, 40.0
LIMITS = ControllerLimits(
    max_linear_speed=2.0, max_angular_speed=4.0, max_linear_acceleration=3.0,
    max_linear_deceleration=3.0, max_angular_acceleration=10.0, max_module_speed=3.6,
    max_steering_rate=8.0)
GRIP = 1.0  # of what the floor can hold, on the wet floor; the controller keeps a margin
# A command counts as reached within this part of the change.
REACHED = 0.1


@dataclass(frozen=True)
class Style:
    """How someone drives: the largest twist, and how long a command lasts [s]."""

    linear: float
    angular: float
    shortest: float
    longest: float
    friction: float = 0.9
    has_grip_limit: bool = False


STYLES = {
    'gentle': Style(1.0, 1.5, 1.5, 4.0),
    'quick': Style(2.0, 4.0, 0.8, 2.0),
    'wild': Style(2.0, 4.0, 0.2, 0.8),
    'wet floor': Style(2.0, 4.0, 0.8, 2.0, friction=0.4),
    'wet floor, grip limit': Style(2.0, 4.0, 0.8, 2.0, friction=0.4, has_grip_limit=True),
}


@dataclass(frozen=True)
class Outcome:
    """
    What came of one run.

    Attributes
    ----------
    scrub : float
        How far a wheel slid, mean of the wheels, for each metre that the base drove [mm/m].
    slip : float
        Root mean square of the sliding speed [mm/s].
    energy : float
        Work of drive and steering motors for each metre driven, less what they took back in
        braking [J/m].
    work : float
        The same where braking gives nothing back [J/m].
    error : float
        Root mean square difference of the base's twist and the commanded one, a turn counted
        at the wheels [m/s].
    reach : float
        Mean time until the twist was within a tenth of a changed command [s].

    """

    scrub: float
    slip: float
    energy: float
    work: float
    error: float
    reach: float


def commands(style, generator):
    """Return a sequence of twists, one for each period: steps, as from a hurried driver."""
    steps = round(DURATION / PERIOD)
    twists, count = np.zeros((steps, 3)), 0
    while count < steps:
        lasting = round(generator.uniform(style.shortest, style.longest) / PERIOD)
        twists[count:count + lasting] = _twist(style, generator)
        count += lasting
    twists[-round(1.5 / PERIOD):] = 0.0
    return twists


def _twist(style, generator):
    """Return a random twist: rest, straight, turn on the spot, or both."""
    kind = generator.choice(['rest', 'straight', 'turn', 'both'], p=[0.15, 0.3, 0.15, 0.4])
    heading, speed = generator.uniform(-np.pi, np.pi), style.linear * generator.uniform(0.2, 1)
    omega = style.angular * generator.uniform(0.2, 1.0) * generator.choice([-1, 1])
    return np.array([speed * np.cos(heading), speed * np.sin(heading), omega]) * {
        'rest': (0, 0, 0), 'straight': (1, 1, 0), 'turn': (0, 0, 1), 'both': (1, 1, 1)}[kind]


def ours(style):
    """Return a function from a twist and measured angles to speeds and angles."""
    limits = LIMITS
    if style.has_grip_limit:
        limits = replace(limits, max_grip_acceleration=GRIP * style.friction * 9.81)
    controller = SwerveController(SwerveKinematics(CORNERS), limits)

    def update(twist, angles):
        command = controller.update(twist, angles, PERIOD)
        return command.speed, command.angle
    return update


def run(update, style, twists):
    """Drive the base by a sequence of twists; return the Outcome."""
    config = BaseConfig(
        SwerveKinematics(CORNERS), ModuleJoints([RADIUS] * 4), Actuator(0.05, 80.0, 400.0),
        Actuator(0.03, LIMITS.max_steering_rate, 200.0))
    base = PhysicsBase(config, floor=Floor(friction=style.friction))
    actual = np.zeros_like(twists)
    for index, twist in enumerate(twists):
        speed, angle = update(twist, base.state.steering_angle)
        base.step(BaseCommand(speed / RADIUS, angle), PERIOD)
        actual[index] = base.state.twist
    driven = np.abs(actual * (1.0, 1.0, ARM))
    way = float((np.hypot(driven[:, 0], driven[:, 1]) + driven[:, 2]).sum()) * PERIOD
    misses = np.linalg.norm((actual - twists) * (1.0, 1.0, ARM), axis=1)
    return Outcome(
        1e3 * float(base.slip.scrub.mean()) / way,
        1e3 * float(np.sqrt(base.slip.squared.mean() / DURATION)),
        base.slip.energy / way, base.slip.work / way, float(np.sqrt(np.mean(misses ** 2))),
        _time_to_reach(twists, misses))


def _time_to_reach(twists, misses):
    """Return the mean time [s] from a changed command until it is reached, or changed again."""
    scaled = twists * (1.0, 1.0, ARM)
    sizes = np.linalg.norm(np.diff(scaled, axis=0), axis=1)
    starts = np.flatnonzero(sizes > 1e-9) + 1
    times = []
    for start, end in zip(starts, [*starts[1:], len(twists)]):
        near = misses[start:end] <= REACHED * sizes[start - 1]
        times.append(PERIOD * (int(np.argmax(near)) if near.any() else end - start))
    return float(np.mean(times))


def main(seeds=3):
    """Print the table and write the file."""
    print(f"{'driving':24}{'figure':>10}{'ours':>10}{'recipe':>10}{'ratio':>8}")
    records = []
    for name, style in STYLES.items():
        pairs = []
        for seed in range(int(seeds)):
            twists = commands(style, np.random.default_rng(seed))
            recipe = Recipe(CORNERS, LIMITS, PERIOD)
            pairs.append([asdict(run(update, style, twists))
                          for update in (ours(style), recipe.update)])
        for figure in pairs[0][0]:
            mine, theirs = (float(np.mean([pair[i][figure] for pair in pairs])) for i in (0, 1))
            print(f'{name:24}{figure:>10}{mine:10.3f}{theirs:10.3f}{mine / theirs:8.2f}')
            records.append({'driving': name, 'figure': figure, 'ours': mine, 'recipe': theirs})
        records.append({'driving': name, 'runs': pairs})
    OUTPUT.parent.mkdir(exist_ok=True)
    OUTPUT.write_text(json.dumps(records, indent=1))
    print(f'written to {OUTPUT}')


if __name__ == '__main__':
    main(*sys.argv[1:2])
