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
The simulated base: actuators that follow commands, and the rigid body they carry.

Pure functions on immutable values. Time enters as a step, and nothing is drawn at random
here; what the sensors make of the state is in `sensors`.
"""

from dataclasses import dataclass
from functools import cached_property
from math import ceil, expm1
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.core.geometry.se2 import rotated, se2_exp
from swerve_kinematics.core.kinematics.modules import ModuleStates
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.sim.actuators import Actuator, approach_speed, limited_speed

# The longest step [s] taken at once. The pose is second order in it: at 3 ms, wheels that
# steer at 5 rad/s all the time cost 10 micrometres a metre.
MAX_STEP = 0.003


@dataclass(frozen=True)
class BaseConfig:
    """
    What does not change about a base.

    Attributes
    ----------
    kinematics : SwerveKinematics
        Layout of the n modules.
    joints : ModuleJoints
        What the joints make of the modules. The motors go by their encoders: by the joints.
    drive, steering : Actuator
        All modules have the same; in turns of the wheel and of the module.
    free_wheels : tuple of int
        Wheels off the floor, which do not move the base.

    """

    kinematics: SwerveKinematics
    joints: ModuleJoints
    drive: Actuator
    steering: Actuator
    free_wheels: tuple[int, ...] = ()

    @cached_property
    def wheel_radii(self) -> NDArray[np.float64]:
        """Return the rolling radii (n,) [m]."""
        return np.array(self.joints.wheel_radii)

    @cached_property
    def _floor(self) -> tuple[list[int], SwerveKinematics]:
        """Return the modules whose wheels are on the floor, and their kinematics."""
        carrying = [module for module in range(self.kinematics.module_count)
                    if module not in self.free_wheels]
        return carrying, SwerveKinematics(self.kinematics.module_positions[carrying])

    def motion(self, modules: ModuleStates) -> NDArray[np.float64]:
        """Return the twist (..., 3), or its delta, that best fits the wheels on the floor."""
        carrying, kinematics = self._floor
        return kinematics.forward(ModuleStates(
            modules.speed[..., carrying], modules.angle[..., carrying]))

    @cached_property
    def coupling(self) -> NDArray[np.float64]:
        """Return how far a module's turn turns its wheel back, the drive joint held (n,)."""
        return np.divide(self.joints.drive_coupling_ratios, self.joints.drive_ratios)


@dataclass(frozen=True)
class BaseCommand:
    """
    Setpoints of the joints.

    Attributes
    ----------
    drive_velocity : ndarray (n,)
        Of the drive joints [rad/s].
    steering_position : ndarray (n,)
        Of the steering joints [rad]. Taken as it is: a turn more is a turn to steer.

    """

    drive_velocity: NDArray[np.float64]
    steering_position: NDArray[np.float64]


@dataclass(frozen=True)
class BaseState:
    """
    The truth about a base.

    Attributes
    ----------
    pose : ndarray (3,)
        `[x, y, heading]` [m, m, rad] from where it started, the heading never wrapped.
    wheel_angle : ndarray (n,)
        Distance rolled, as an angle of the wheel [rad].
    wheel_speed : ndarray (n,)
        [rad/s].
    steering_angle : ndarray (n,)
        [rad], 0 along +x, counting turns.
    steering_rate : ndarray (n,)
        [rad/s].
    twist : ndarray (3,)
        `[vx, vy, omega]` [m/s, m/s, rad/s] in the base frame.

    """

    pose: NDArray[np.float64]
    wheel_angle: NDArray[np.float64]
    wheel_speed: NDArray[np.float64]
    steering_angle: NDArray[np.float64]
    steering_rate: NDArray[np.float64]
    twist: NDArray[np.float64]


class Targets(NamedTuple):
    """
    What the setpoints of the joints ask of the modules.

    Attributes
    ----------
    wheel_speed : ndarray (n,)
        Of the wheels while the modules do not steer [rad/s].
    steering_angle : ndarray (n,)
        [rad].

    """

    wheel_speed: NDArray[np.float64]
    steering_angle: NDArray[np.float64]


def at_rest(config: BaseConfig) -> BaseState:
    """
    Return the state of a base that stands at the origin with its modules straight.

    Parameters
    ----------
    config : BaseConfig
        Gives the number of modules.

    Returns
    -------
    BaseState

    """
    zeros = np.zeros(config.kinematics.module_count)
    return BaseState(np.zeros(3), zeros, zeros, zeros, zeros, np.zeros(3))


def hold(config: BaseConfig, state: BaseState) -> BaseCommand:
    """
    Return the command that stops the wheels and leaves the modules where they are.

    Parameters
    ----------
    config : BaseConfig
        Gives the joints: commands go by the encoders.
    state : BaseState
        Gives the steering angles to hold.

    Returns
    -------
    BaseCommand

    """
    return BaseCommand(np.zeros_like(state.wheel_speed),
                       np.array(config.joints.steering_positions(state.steering_angle.tolist())))


def targets_of(config: BaseConfig, command: BaseCommand) -> Targets:
    """
    Return what the setpoints of the joints ask of the modules.

    Parameters
    ----------
    config : BaseConfig
        Gives the joints.
    command : BaseCommand
        The setpoints.

    Returns
    -------
    Targets

    """
    unsteered = [0.0] * len(command.drive_velocity)
    rim_speeds = config.joints.travel(command.drive_velocity.tolist(), unsteered)
    return Targets(rim_speeds / config.wheel_radii, np.array(
        config.joints.module_angles(command.steering_position.tolist())))


def step(config: BaseConfig, state: BaseState, command: BaseCommand, dt: float) -> BaseState:
    """
    Return the state after holding `command` for `dt`, in steps of at most `MAX_STEP`.

    The base moves as the rigid body that fits the motion of all wheels best (least squares),
    along the arc of their mean speeds and steering angles over each step.

    Parameters
    ----------
    config : BaseConfig
        The base that moves.
    state : BaseState
        At the start.
    command : BaseCommand
        Held all the time.
    dt : float
        [s].

    Returns
    -------
    BaseState

    """
    count, targets = max(ceil(dt / MAX_STEP), 0), targets_of(config, command)
    small = dt / max(count, 1)
    starts = np.stack((state.wheel_speed, state.steering_angle, state.steering_rate), axis=1)
    goals = np.stack((targets.wheel_speed, targets.steering_angle, config.coupling), axis=1)
    courses = np.array([_course(config, start, goal, count, small)
                        for start, goal in zip(starts.tolist(), goals.tolist())])
    wheel_speed, steering_angle, steering_rate = courses[:, -1].T
    speeds, angles, _ = 0.5 * (courses[:, 1:] + courses[:, :-1]).T
    rolled = speeds * small
    return BaseState(
        pose=_moved(state.pose, config.motion(ModuleStates(rolled * config.wheel_radii, angles))),
        wheel_angle=state.wheel_angle + rolled.sum(axis=0),
        wheel_speed=wheel_speed,
        steering_angle=steering_angle,
        steering_rate=steering_rate,
        twist=config.motion(ModuleStates(wheel_speed * config.wheel_radii, steering_angle)))


def _course(config: BaseConfig, start: list[float], goal: list[float], count: int,
            dt: float) -> list[list[float]]:
    """
    Return speed, angle and steering rate of a module at the start and after each small step [s].

    It goes for the speed and the angle of the goal, whose third number is its coupling: a drive
    motor holds the speed of its joint, and the wheel gives way as the module steers.
    """
    drive, steering = config.drive, config.steering
    wheel_speed, steering_angle, coupling = goal
    share = -expm1(-dt / drive.time_constant)
    course = [start]
    for _ in range(count):
        speed, angle, rate = course[-1]
        new_rate = limited_speed(
            steering, rate, approach_speed(steering, steering_angle - angle), dt)
        driven = speed + coupling * rate
        lagged = driven + (wheel_speed - driven) * share
        course.append([limited_speed(drive, driven, lagged, dt) - coupling * new_rate,
                       angle + 0.5 * (rate + new_rate) * dt, new_rate])
    return course


def _moved(pose: NDArray[np.float64], motions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a pose (3,) after motions (k, 3) in the base frame, one after the other."""
    turns = motions[:, 2]
    arrived: NDArray[np.float64] = pose + rotated(
        se2_exp(motions), pose[2] + turns.cumsum() - turns).sum(axis=0)
    return arrived
