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

"""Drives of a base whose wiring is not what its description says, made fast and without ROS."""

from cmath import rect
from dataclasses import dataclass, field
import math

import numpy as np

from swerve_kinematics.core.checking.drive_data import DriveData
from swerve_kinematics.core.control.controller import SwerveController
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

POSITIONS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
LIMITS = ControllerLimits(
    max_linear_speed=1.5, max_angular_speed=3.0, max_linear_acceleration=2.0,
    max_linear_deceleration=3.0, max_angular_acceleration=6.0, max_module_speed=3.0,
    max_steering_rate=8.0)
DRIVE_LAG, STEERING_LAG, STEERING_RATE = 0.05, 0.03, 12.0  # s, s, rad/s
COUNT = TURN / 4096
RADIUS = 0.05
BIAS, NOISE = math.radians(0.5), math.radians(0.014)  # rad/s, rad/s/sqrt(Hz)
STEP = 0.01  # s, the longest of the simulation


@dataclass(frozen=True)
class Truth:
    """
    How a base differs from its description; modules by index.

    `order` says whose joints have the name of each module, `drive` and `steering` by how much
    a joint turns for what it is told, `drive_encoder` and `steering_encoder` what is read for
    what it turns.
    """

    positions: np.ndarray = field(default_factory=lambda: POSITIONS)
    order: tuple = ()
    drive: dict = field(default_factory=dict)
    drive_encoder: dict = field(default_factory=dict)
    steering: dict = field(default_factory=dict)
    steering_encoder: dict = field(default_factory=dict)
    offset: dict = field(default_factory=dict)
    radius: dict = field(default_factory=dict)
    rolls: dict = field(default_factory=dict)  # turns of a wheel for one of its module
    dead_drives: tuple = ()
    dead_steerings: tuple = ()
    frozen: tuple = ()
    free: tuple = ()
    slip: tuple = ()  # module, factor, from [s], to [s]
    emergency_stop: bool = False
    gyro: float = 1.0
    gyro_fault: str = ''


def both(kind, *modules):
    """Return the fields for joints that turn, and count, the other way round."""
    reversed_joints = {module: -1.0 for module in modules}
    return {kind: reversed_joints, f'{kind}_encoder': reversed_joints}


def all_slightly_off(seed):
    """Return a base whose radii and offsets are off by up to 2 % and 1.5 degrees."""
    radius, offset = np.random.default_rng(seed).uniform(-1.0, 1.0, (2, 4)) * [[0.02], [0.026]]
    return Truth(radius=dict(enumerate(1.0 + radius)), offset=dict(enumerate(offset)))


def per_module(values, count, default=1.0):
    """Return an array (n,) of a dict by module."""
    return np.array([values.get(module, default) for module in range(count)])


def mixed(rng, duration, rest=0.5):
    """Return twists over time: another one, of all kinds, every second or so."""
    changes = np.cumsum(rng.uniform(0.6, 1.6, int(duration / 0.6)))
    twists = rng.uniform(-1.0, 1.0, (len(changes) + 1, 3)) * (0.8, 0.8, 1.5)
    twists *= rng.random(twists.shape) < 0.85
    return lambda time: twists[np.searchsorted(changes, time - rest)] if (
        time >= rest) else np.zeros(3)


class Base:
    """The simulated base: joints that lag, and the rigid body that fits their ways best."""

    def __init__(self, truth):
        """Stand with the modules straight."""
        self._truth, count = truth, len(truth.positions)
        floor = [module for module in range(count) if module not in truth.free]
        self._order = np.array(truth.order or range(count))
        self._place = np.argsort(self._order)
        self._radius = RADIUS * per_module(truth.radius, count)
        self._offset = per_module(truth.offset, count, 0.0)
        self._told = [per_module(each, count) for each in (truth.drive, truth.steering)]
        self._read = [per_module(each, count)
                      for each in (truth.drive_encoder, truth.steering_encoder)]
        obeys = [
            per_module(dict.fromkeys(dead, 0.0), count) * (not truth.emergency_stop)
            for dead in (truth.dead_drives, truth.dead_steerings)]
        # Turn of the rigid body by the ways of the modules on the floor: their least squares.
        arms = truth.positions @ (1.0, 1j)
        arms -= arms[floor].mean()
        lever = np.zeros(count, dtype=complex)
        lever[floor] = arms[floor].conj() / np.sum(np.abs(arms[floor]) ** 2)
        # Of each module: whether drive and steering obey, radius, lever and coupling.
        rolls = per_module(truth.rolls, count, 0.0)
        self._modules = list(zip(*(
            each.tolist() for each in (*obeys, self._radius, lever, rolls))))
        self._frozen = list(truth.frozen)
        self.turned, self.angle = np.zeros(count), np.zeros(count)
        self._slipped = np.zeros(count)
        self._speed = [0.0] * count
        self.yaw = self.rate = 0.0

    def read(self):
        """Return what the joints read [rad], by the names of the description."""
        wheels = np.floor((self.turned + self._slipped) / COUNT) * COUNT * self._read[0]
        angles = np.floor((self.angle + self._offset) / COUNT) * COUNT * self._read[1]
        if self._frozen:
            wheels[self._frozen] = angles[self._frozen] = 0.0
        return wheels[self._order], angles[self._order]

    def move(self, speeds, angles, dt, time):
        """Take commands to the joints [rad/s, rad] for a time [s]."""
        slip = self._truth.slip
        slipping = slip[0] if slip and slip[2] <= time < slip[3] else None
        # Plain numbers are faster than arrays of so few.
        speeds = (speeds[self._place] * self._told[0]).tolist()
        angles = (angles[self._place] * self._told[1] - self._offset).tolist()
        turned, angle, speed = self.turned.tolist(), self.angle.tolist(), self._speed
        steps = math.ceil(dt / STEP - 1e-9)
        h = dt / steps
        gain, pull = -math.expm1(-h / DRIVE_LAG), -math.expm1(-h / STEERING_LAG)
        reach = STEERING_RATE * h
        for _ in range(steps):
            turn = 0.0
            for i, (drives, steers, radius, lever, rolls) in enumerate(self._modules):
                before = speed[i]
                speed[i] = (before + (speeds[i] - before) * gain) * drives
                rolled = 0.5 * h * (before + speed[i])
                steered = min(max((angles[i] - angle[i]) * pull * steers, -reach), reach)
                way = (rolled + rolls * steered) * radius
                turn += (lever * rect(way, angle[i] + 0.5 * steered)).imag
                turned[i] += rolled
                angle[i] += steered
                if i == slipping:
                    self._slipped[i] += (slip[1] - 1.0) * rolled
            self.yaw, self.rate = self.yaw + turn, turn / h
        self.turned, self.angle = np.array(turned), np.array(angle)


def driven(truth=Truth(), twist_at=None, duration=20.0, rate=50.0, seed=0, described=POSITIONS,
           dropped=0.02, base=None):
    """Return the DriveData of a drive by the node's own pipeline and the description."""
    rng = np.random.default_rng(seed)
    twist_at = twist_at or mixed(rng, duration)
    base, dt, drift, rows = base or Base(truth), 1.0 / rate, 0.0, []
    noise = NOISE / math.sqrt(dt)
    controller = SwerveController(SwerveKinematics(described), LIMITS)
    for k in range(int(duration * rate)):
        wheels, angles = base.read()
        error = BIAS + noise * rng.standard_normal()
        drift += error * dt
        command = controller.update(twist_at(k * dt), angles, dt)
        speed, angle = np.array(command.speed), np.array(command.angle)
        if rng.random() >= dropped:
            rows.append((k * dt, wheels, angles, base.yaw + drift, base.rate + error,
                         speed, angle))
        base.move(speed / RADIUS, angle, dt, k * dt)
    return data_of(rows, truth)


def data_of(rows, truth):
    """Return the rows of a drive, with what is wrong with the gyro."""
    stamp, wheels, angles, yaw, rate, speeds, commanded = map(np.array, zip(*rows))
    yaw, rate = truth.gyro * yaw, truth.gyro * rate
    if truth.gyro_fault == 'frozen':
        yaw, rate = np.full_like(yaw, yaw[0]), np.zeros_like(rate)
    if truth.gyro_fault == 'silent':
        yaw, rate = np.full_like(yaw, np.nan), np.full_like(rate, np.nan)
    return DriveData(stamp, wheels * RADIUS, angles, yaw, rate, speeds, commanded)
