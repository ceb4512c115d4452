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

"""Drives of a base whose radii and offsets are not what its parameters say."""

from typing import NamedTuple

import numpy as np

from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.core.geometry.angles import nearest_equivalent, TURN
from swerve_kinematics.core.kinematics.modules import optimize
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.sim import base, sensors
from swerve_kinematics.sim.actuators import Actuator

KINEMATICS = SwerveKinematics([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
NOMINAL_RADIUS = 0.05
ENCODER_STEP = TURN / 4096
BIAS = np.radians(0.5)


class Errors(NamedTuple):
    """True radii over nominal ones (n,), offsets (n,) [rad], true turn over the gyro's."""

    radius_scale: np.ndarray
    steering_offset: np.ndarray
    gyro_scale: float


class Log(NamedTuple):
    """What joints and gyro read, (t,), (t, n) [s, rad], and true poses (t, 3)."""

    stamp: np.ndarray
    wheel_angle: np.ndarray
    steering_angle: np.ndarray
    yaw: np.ndarray
    poses: np.ndarray


def random_errors(rng):
    """Return errors of up to 2 % and 1 degree."""
    return Errors(1.0 + rng.uniform(-0.02, 0.02, 4), np.radians(rng.uniform(-1.0, 1.0, 4)),
                  1.0 + rng.uniform(-0.02, 0.02))


def counted(angle):
    """Return what a 12-bit encoder reads."""
    return np.floor(angle / ENCODER_STEP) * ENCODER_STEP


def rolled(errors, stamp, velocity, heading, rng, finer=10):
    """
    Return the Log of wheels that roll freely: no slip, 12-bit encoders, a drifting gyro.

    `velocity` (complex, [m/s]) and `heading` [rad] of the base are given `finer` times as
    often as the log has samples.
    """
    dt = stamp[1] - stamp[0]
    omega = np.gradient(heading, dt)
    arms = KINEMATICS.module_positions @ (1.0, 1j)
    modules = velocity[:, np.newaxis] + 1j * omega[:, np.newaxis] * arms
    angle = np.unwrap(np.angle(modules), axis=0)
    position = integral(velocity * np.exp(1j * heading), dt)
    way = integral(np.abs(modules), dt)
    noise = np.radians(0.2) * np.sqrt(0.005 * dt) * rng.standard_normal(len(stamp))
    pick = slice(None, None, finer)
    return Log(
        stamp[pick], counted(way / (NOMINAL_RADIUS * errors.radius_scale))[pick],
        counted(angle + errors.steering_offset)[pick],
        (heading / errors.gyro_scale + BIAS * stamp + np.cumsum(noise))[pick],
        np.column_stack((position.real, position.imag, heading))[pick])


def integral(values, dt):
    """Return the integral of samples (t, ...) by the trapezoid rule."""
    steps = 0.5 * dt * (values[1:] + values[:-1])
    return np.concatenate((np.zeros_like(values[:1]), np.cumsum(steps, axis=0)))


def varied(errors, rng, rate=50, duration=30.0):
    """Return the Log of a drive with translation and rotation in all directions."""
    stamp = np.arange(0.0, duration, 0.1 / rate)
    (fx, fy, fw), (px, py, pw) = rng.uniform(0.4, 0.9, 3), rng.uniform(0.0, TURN, 3)
    velocity = np.sin(fx * stamp + px) + 1j * np.sin(fy * stamp + py)
    heading = 1.5 / fw * np.sin(fw * stamp + pw)
    return rolled(errors, stamp, velocity, heading, rng)


def forced(kinematics, errors, grip, rng, duration=40.0, give_way=False):
    """
    Return the Log of driven wheels that fight each other, of any base.

    The base moves as the rigid body that fits its wheels best, each with a weight, its grip (n,).
    Motors that `give_way` let their wheels roll as fast as the frame takes them.
    """
    stamp = np.arange(0.0, duration, 0.005)
    (fx, fy, fw), (px, py, pw) = rng.uniform(0.4, 0.9, 3), rng.uniform(0.0, TURN, 3)
    told = kinematics.inverse(np.column_stack((
        np.sin(fx * stamp + px), np.sin(fy * stamp + py), 1.5 * np.sin(fw * stamp + pw))))
    angle = np.unwrap(told.angle, axis=0)
    wheels = told.speed * errors.radius_scale * np.exp(1j * (angle - errors.steering_offset))
    weight = np.sqrt(np.tile(grip, 2))
    x, y = kinematics.module_positions.T
    ones, zeros = np.ones_like(x), np.zeros_like(x)
    rigid = np.column_stack((np.r_[ones, zeros], np.r_[zeros, ones], np.r_[-y, x]))
    twist = np.linalg.lstsq(
        weight[:, np.newaxis] * rigid, (weight * np.column_stack((wheels.real, wheels.imag))).T,
        rcond=None)[0]
    speed = told.speed
    if give_way:
        ways = (twist[0] + 1j * twist[1])[:, np.newaxis] + 1j * np.outer(twist[2], x + 1j * y)
        speed = np.real(ways * np.exp(-1j * (angle - errors.steering_offset)))
        speed /= errors.radius_scale
    heading = integral(twist[2], 0.005)
    position = integral((twist[0] + 1j * twist[1]) * np.exp(1j * heading), 0.005)
    pick = slice(None, None, 4)
    return Log(stamp[pick], counted(integral(speed, 0.005) / NOMINAL_RADIUS)[pick],
               counted(angle)[pick], heading[pick],
               np.column_stack((position.real, position.imag, heading))[pick])


def straight(errors, rng, direction=0.0, rate=50):
    """Return the Log of about 5.5 m along a line, and its length [m]; 1 s of rest each end."""
    stamp = np.arange(0.0, 12.0, 0.1 / rate)
    speed = 0.55 * np.clip(np.minimum(stamp - 1.0, 11.0 - stamp), 0.0, 1.0)
    way = integral(speed, stamp[1])
    heading = np.radians(0.3) * np.sin(rng.uniform(0.5, 2.0) * way)
    log = rolled(errors, stamp, speed * np.exp(1j * (direction - heading)), heading, rng)
    return log, np.hypot(*(log.poses[-1, :2] - log.poses[0, :2]))


def driven(errors, rng, duration=20.0, dt=0.02, twist_at=None):
    """
    Return the Log of the simulated base, whose wheels go by their wrong encoders.

    It goes as `twist_at` says of each time, or all ways at once.

    They fight each other, and the base moves as the rigid body that fits them best.
    """
    config = base.BaseConfig(
        KINEMATICS,
        ModuleJoints(NOMINAL_RADIUS * errors.radius_scale,
                     steering_offsets=errors.steering_offset),
        Actuator(0.05, 80.0, 200.0), Actuator(0.03, 12.0, 200.0))
    faults = sensors.SensorFaults(encoder_resolution=4096)
    frequency, phase = rng.uniform(0.4, 0.9, 3), rng.uniform(0.0, TURN, 3)
    state, drift, rows = base.at_rest(config), 0.0, []
    reading, drift = sensors.sense(config, faults, state, drift, dt, rng)
    for k in range(int(duration / dt)):
        twist = twist_at(k * dt) if twist_at else (
            np.array([1.0, 0.8, 1.2]) * np.sin(frequency * k * dt + phase))
        wanted = optimize(KINEMATICS.inverse(twist), reading.steering_position)
        command = base.BaseCommand(
            wanted.speed / NOMINAL_RADIUS,
            nearest_equivalent(wanted.angle, reading.steering_position))
        state = base.step(config, state, command, dt)
        reading, drift = sensors.sense(config, faults, state, drift, dt, rng)
        rows.append((k * dt, reading.drive_position, reading.steering_position, reading.yaw,
                     state.pose))
    return Log(*(np.array(series) for series in zip(*rows)))
