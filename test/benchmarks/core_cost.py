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

"""What the core costs beside WPILib's loop from Python, beside bare numpy, and how it grows."""

from functools import partial
import itertools
import time

from figures import Figure
import numpy as np
from swerve_kinematics import (
    ControllerLimits, optimize, SwerveController, SwerveKinematics, SwerveOdometry)
import wpimath.geometry as geometry
import wpimath.kinematics as wpi

CORNERS = ((0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25))
BATCHES = (1, 100, 10_000, 1_000_000)
LARGE = 10_000  # from here on the targets hold
WPILIB_ITEMS = 1_000  # its loop costs the same for every item, so a part of a batch will do
MODULE_COUNTS = (2, 4, 8, 16, 32)
GROWTH_BATCH = 10_000
GROWTH_BATCHES = (10_000, 100_000, 1_000_000)
REPETITIONS = 7
SHORTEST = 0.02  # s, of one timing


def seconds(action):
    """Return the time of one call [s], from as many as take `SHORTEST`."""
    calls, elapsed = 0, 0.0
    start = time.perf_counter()
    while elapsed < SHORTEST:
        action()
        calls += 1
        elapsed = time.perf_counter() - start
    return elapsed / calls


def interleaved(actions, repetitions=REPETITIONS):
    """Return the times [s] of each action (actions, repetitions), measured in turn."""
    for action in actions:
        action()
    return np.array([[seconds(action) for action in actions] for _ in range(repetitions)]).T


class Inputs:
    """
    One batch of random twists and module states, as arrays and as WPILib's objects.

    Parameters
    ----------
    count : int
        Of items.
    positions : array_like (n, 2)
        Of the modules [m].

    """

    def __init__(self, count, positions=CORNERS):
        """Draw them."""
        random = np.random.default_rng(0)
        self.kinematics = SwerveKinematics(positions)
        self.twists = random.uniform(-2.0, 2.0, (count, 3))
        self.states = self.kinematics.inverse(self.twists)
        self.measured = random.uniform(-np.pi, np.pi, self.states.angle.shape)
        self.x = self.states.speed * np.cos(self.states.angle)
        self.y = self.states.speed * np.sin(self.states.angle)

    def ours(self):
        """Return what computes the whole batch with our core, by name."""
        kinematics = self.kinematics
        return {'inverse': partial(kinematics.inverse, self.twists),
                'forward': partial(kinematics.forward, self.states),
                'optimize': partial(optimize, self.states, self.measured)}

    def bare(self):
        """Compute speed and angle of every module by numpy, from velocities that are there."""
        return np.hypot(self.x, self.y), np.arctan2(self.y, self.x)

    def wpilib(self):
        """
        Return what computes the first items with WPILib, by name, and their number.

        The same task as ours: from arrays to arrays.
        """
        part = slice(WPILIB_ITEMS)
        twists, speeds, angles, measured = (array[part] for array in (
            self.twists, *self.states, self.measured))
        theirs = wpi.SwerveDrive4Kinematics(*(geometry.Translation2d(*xy) for xy in CORNERS))

        def inverse():
            return np.array([_numbers(theirs.toSwerveModuleStates(wpi.ChassisSpeeds(*twist)))
                             for twist in twists.tolist()])

        def forward():
            results = [theirs.toChassisSpeeds(list(map(_wpilib_state, speed, angle)))
                       for speed, angle in zip(speeds.tolist(), angles.tolist())]
            return np.array([(twist.vx, twist.vy, twist.omega) for twist in results])

        def optimized():
            results = []
            for speed, angle, at in zip(speeds.tolist(), angles.tolist(), measured.tolist()):
                modules = list(map(_wpilib_state, speed, angle))
                for module, measured_angle in zip(modules, at):
                    module.optimize(geometry.Rotation2d(measured_angle))
                results.append(_numbers(modules))
            return np.array(results)

        return {'inverse': inverse, 'forward': forward, 'optimize': optimized}, len(twists)

    def wpilib_calls(self):
        """Return WPILib's calls alone, with objects made in advance and results unread."""
        part = slice(WPILIB_ITEMS)
        twists = [wpi.ChassisSpeeds(*twist) for twist in self.twists[part].tolist()]
        states = [list(map(_wpilib_state, *pair)) for pair in zip(
            self.states.speed[part].tolist(), self.states.angle[part].tolist())]
        measured = [list(map(geometry.Rotation2d, angles))
                    for angles in self.measured[part].tolist()]
        theirs = wpi.SwerveDrive4Kinematics(*(geometry.Translation2d(*xy) for xy in CORNERS))
        return {
            'inverse': lambda: [theirs.toSwerveModuleStates(twist) for twist in twists],
            'forward': lambda: [theirs.toChassisSpeeds(modules) for modules in states],
            'optimize': lambda: [module.optimize(angle) for modules, angles in zip(
                states, measured) for module, angle in zip(modules, angles)],
        }


def _wpilib_state(speed, angle):
    """Return WPILib's state of one module."""
    return wpi.SwerveModuleState(speed, geometry.Rotation2d(angle))


def _numbers(modules):
    """Return WPILib's module states as numbers."""
    return [(module.speed, module.angle.radians()) for module in modules]


def batch_figures():
    """Yield the cost per item against WPILib, and of inverse against bare numpy."""
    for count in BATCHES:
        inputs = Inputs(count)
        ours, calls, (theirs, items) = inputs.ours(), inputs.wpilib_calls(), inputs.wpilib()
        large = count >= LARGE
        for name in ours:
            label = f'{name}, {count:,} at once'
            actions = [ours[name], theirs[name], calls[name]]
            own, wpilib, call = 1e9 * interleaved(actions)
            yield Figure(label, 'ns/item', own / count, 'WPILib', wpilib / items,
                         'ratio <= 0.05' if large else '')
            yield Figure(label, 'ns/item', own / count, 'its calls', call / items)
        own, bare = 1e9 * interleaved([ours['inverse'], inputs.bare])
        yield Figure(f'inverse, {count:,} at once', 'ns/item', own / count, 'numpy',
                     bare / count, 'ratio <= 2.0' if large else '')


def odometry_figure():
    """Return the cost of one odometry update; each needs the one before it."""
    theirs = wpi.SwerveDrive4Odometry(
        wpi.SwerveDrive4Kinematics(*(geometry.Translation2d(*xy) for xy in CORNERS)),
        geometry.Rotation2d(), (wpi.SwerveModulePosition(),) * 4)
    ways = itertools.count(0.0, 0.02)

    def their_update():
        position = wpi.SwerveModulePosition(next(ways), geometry.Rotation2d(0.1))
        theirs.update(geometry.Rotation2d(), (position,) * 4)

    ours, wpilib = 1e9 * interleaved([our_odometry_update(CORNERS), their_update])
    return Figure('odometry update', 'ns/item', ours, 'WPILib', wpilib)


def our_odometry_update(positions):
    """Return a function that takes a base on a straight line one step on."""
    odometry = SwerveOdometry(SwerveKinematics(positions))
    count, ways = len(positions), itertools.count(0.0, 0.02)

    def update():
        way = next(ways)
        odometry.update(way, [way] * count, [0.1] * count, 0.0)

    return update


def controller_figure():
    """Return the cost of one controller update, all limits on, beside WPILib's usual steps."""
    limits = ControllerLimits(3.0, 6.0, 2.0, 3.0, 6.0, 20.0, 60.0, 4.0, 10.0, 8.0)
    controller = SwerveController(SwerveKinematics(CORNERS), limits)
    theirs = wpi.SwerveDrive4Kinematics(*(geometry.Translation2d(*xy) for xy in CORNERS))
    measured, speeds = np.zeros(4), wpi.ChassisSpeeds(1.0, 0.5, 0.4)
    # Between two twists, so that there is always a ramp to compute.
    twists = itertools.cycle([(1.0, 0.5, 0.4)] * 50 + [(0.3, -0.2, -0.4)] * 50)

    def their_steps():
        states = theirs.toSwerveModuleStates(wpi.ChassisSpeeds.discretize(speeds, 0.02))
        for state in theirs.desaturateWheelSpeeds(states, 4.0):
            state.optimize(geometry.Rotation2d())
            state.cosineScale(geometry.Rotation2d())

    ours, wpilib = 1e9 * interleaved(
        [lambda: controller.update(next(twists), measured, 0.02), their_steps])
    return Figure('controller update', 'ns/item', ours, 'WPILib', wpilib)


def growth_figures():
    """Yield the exponents of cost against the number of modules, and of items."""
    by_modules = [Inputs(GROWTH_BATCH, _ring(count)) for count in MODULE_COUNTS]
    by_items = [Inputs(count) for count in GROWTH_BATCHES]
    for name in by_items[0].ours():
        yield _growth(f'{name}: exponent for 2 to 32 modules', MODULE_COUNTS,
                      [inputs.ours()[name] for inputs in by_modules])
        yield _growth(f'{name}: exponent for 10,000 to 1,000,000 at once', GROWTH_BATCHES,
                      [inputs.ours()[name] for inputs in by_items])
    yield _growth('odometry update: exponent for 2 to 32 modules', MODULE_COUNTS,
                  [our_odometry_update(_ring(count)) for count in MODULE_COUNTS])


def _growth(name, sizes, actions):
    """Return the figure of the slope that fits the logarithms of cost and size best."""
    times = interleaved(actions)
    slopes = np.polyfit(np.log(sizes), np.log(times), 1)[0]
    return Figure(name, '', slopes, target='value <= 1.1')


def _ring(count):
    """Return the positions of modules on a circle [m]."""
    angle = 2.0 * np.pi * np.arange(count) / count
    return 0.4 * np.column_stack((np.cos(angle), np.sin(angle)))


def figures():
    """Return the figures of the core."""
    return [*batch_figures(), controller_figure(), odometry_figure(), *growth_figures()]
