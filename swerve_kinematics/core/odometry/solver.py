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

"""Which motion explains a step, and which sensors to believe about it."""

import math

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.odometry.chord import fit, Step, without_slipping
from swerve_kinematics.core.odometry.group import Group, Groups
from swerve_kinematics.core.odometry.gyro import largest_turn, STAMP_JITTER
from swerve_kinematics.core.odometry.inertial import Inertial
from swerve_kinematics.core.odometry.module_paths import ModulePaths
from swerve_kinematics.core.odometry.pace import Pace
from swerve_kinematics.core.odometry.rest import RestDetector
from swerve_kinematics.core.odometry.step_noise import consistent_speed
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise
from swerve_kinematics.core.odometry.wheel_time import WheelTime
from swerve_kinematics.core.odometry.yaw import YawTracker

# An accelerometer that contradicts wheels for longer than this [s] may be misled by the gyro.
LONG_DOUBT = 1.0


class StepSolver:
    """
    Finds the motion of each step.

    Parameters
    ----------
    module_positions : ndarray (n, 2)
        From base_link [m].
    imu_position : complex
        Of the accelerometer, from base_link [m].
    force_range : float
        Of the accelerometer [m/s^2].

    Attributes
    ----------
    gyro : YawTracker
    inertial : Inertial
    pace : Pace
    time : WheelTime
    lasted : float
        How long the wheels took for the last step [s], which is how fast they were; `hear` tells
        how much time has passed.
    paths : ModulePaths
    slipping : list of bool (n,)
        Which modules the last step left out as wrong: slip, or a jump.
    doubt : list of float (n,)
        For how long the accelerometer has contradicted each module [s].
    is_doubting : bool
        Whether it contradicts any.
    at_rest : bool
        Whether no module has moved for a while.
    gyro_turn : float or None
        Of the last step [rad], None where no gyro told it that is believed.

    """

    def __init__(self, module_positions: NDArray[np.float64], imu_position: complex,
                 force_range: float) -> None:
        """Wait for the first sample."""
        count = len(module_positions)
        self.gyro, self.inertial = YawTracker(), Inertial(imu_position, force_range)
        self.slipping = [False] * count
        self.doubt, self.is_doubting = [0.0] * count, False
        self.at_rest = False
        self.paths = ModulePaths(count)
        self._groups, self._rest = Groups(module_positions), RestDetector()
        self.pace, self.time, self.lasted = Pace(count), WheelTime(count), 0.0
        self._all = self._groups.of(tuple(range(count)))
        self._group: Group | None = self._all
        self.gyro_turn: float | None = None

    def interrupt(self) -> None:
        """Forget the motion so far, after a gap or a step that told none."""
        self.paths.forget()
        self.interrupt_clock()
        self.inertial.interrupt()
        self._forget_doubts()

    def interrupt_clock(self) -> None:
        """Let the time to the next sample be that of no step."""
        self.pace.interrupt()
        self.time.interrupt()

    def hear(self, dt: float, distances: list[float], angles: list[float], yaw: float | None,
             yaw_rate: float | None, rate_integral: float | None, noise: OdometryNoise) -> float:
        """
        Take in a sample of encoders and gyro, which ends a step, and return how long that was [s].

        Parameters
        ----------
        dt : float
            Time since the last sample by the stamps [s].
        distances, angles : list of float (n,)
            Of the modules now [m], [rad]; NaN where unknown.
        yaw, yaw_rate, rate_integral : float or None
            By the gyro [rad], [rad/s], [rad].
        noise : OdometryNoise
            What to expect of the modules.

        """
        self.paths.update(distances, angles)
        rolled = self.paths.rolled
        way = math.hypot(*rolled)
        duration = self.pace.duration(dt, way)
        self.lasted = self.time.duration(duration, way, self.pace.usual)
        self.paths.take_duration(self.lasted)
        if duration != dt and yaw is None:
            # A yaw tells the turn whatever the stamps say, but the integral counts all their time.
            dt, rate_integral = duration, None
        self.gyro_turn = self.gyro.turn(dt, yaw, yaw_rate, rate_integral)
        self.at_rest = self._rest.update(duration, distances, angles)
        fastest = noise.largest_speed * (duration + STAMP_JITTER)
        self._group, self.slipping = self._all, [False] * len(rolled)
        if not way <= fastest:
            used = tuple([place for place, way in enumerate(rolled) if -fastest <= way <= fastest])
            self._group = self._groups.of(used) if used else None
            self.slipping = [way > fastest or way < -fastest for way in rolled]
        return duration

    def solve(self, force: complex | None, rates: complex | None, bias: float,
              noise: OdometryNoise) -> Step | None:
        """
        Return the motion of the step, None if the modules in use cannot tell it.

        Parameters
        ----------
        force : complex or None
            Mean specific force in it [m/s^2], None where no accelerometer tells it.
        rates : complex or None
            Mean rates about x and y [rad/s], None where no gyro tells them.
        bias : float
            Of the gyro [rad/s].
        noise : OdometryNoise
            What to expect of the modules.

        """
        dt = self.lasted
        step = self._fitted(dt, bias, noise)
        if step is None:
            return None
        if force is None and not self.inertial.active:
            step = self._without_slipping(dt, step, noise)
        else:
            step = self._judged(dt, step, force, rates, noise)
        if step.coasting_std is not None:
            self.paths.forget()
            return step
        self.paths.keep(dt, step.turn, step.group.used)
        return step

    def _fitted(self, dt: float, bias: float, noise: OdometryNoise) -> Step | None:
        """Return the Step of all modules in use, without the gyro where the wheels refute it."""
        told = self.gyro_turn
        step = self._fit(dt, told, bias)
        if step is None and told is None:
            return None
        wheel_turn = astray = math.nan
        if step is not None and not self.gyro.is_silent:
            wheel_turn = agreed_turn(dt, step, noise.distance_resolution)
            astray = wheel_turn - step.turn
            if self.is_doubting and max(self.doubt) < LONG_DOUBT:
                # Wheels that the accelerometer has caught slipping refute nothing.
                wheel_turn = math.nan
        self.gyro_turn = checked = self.gyro.checked(wheel_turn, astray)
        return step if checked == told else self._fit(dt, checked, bias)

    def _fit(self, dt: float, gyro_turn: float | None, bias: float) -> Step | None:
        """Return the Step that fits the modules best, None if it tells no turn a base can make."""
        turn = None if gyro_turn is None else gyro_turn - bias * dt
        step = fit(self.paths, self._group, turn)
        if step is None or abs(step.turn) > largest_turn(dt):
            return None
        return step

    def _without_slipping(self, dt: float, step: Step, noise: OdometryNoise) -> Step:
        """Return the Step without the one wheel that contradicts the others, if any."""
        step = without_slipping(dt, self.paths, self._groups, step, noise)
        if step.slipping is not None:
            self.slipping[step.slipping] = True
        return step

    def _judged(self, dt: float, step: Step, force: complex | None, rates: complex | None,
                noise: OdometryNoise) -> Step:
        """Return the Step of the modules that the accelerometer believes, or its own."""
        inertial = self.inertial
        if not step.by_gyro:
            # A wheel that slips spoils the turn by all wheels, and so what each tells of the rest.
            step = self._without_slipping(dt, step, noise)
        lever = 2j * math.sin(0.5 * step.turn) * inertial.position
        believed = inertial.judge(dt, step, (step.displacement + lever) / dt, force, rates,
                                  noise.distance_resolution, self.at_rest)
        if all(believed):
            if self.is_doubting:
                self._forget_doubts()
            if step.by_gyro:
                step = self._without_slipping(dt, step, noise)
        else:
            self._note_doubts(dt, step, believed)
            if not any(believed):
                step.displacement = dt * inertial.velocity - lever
                step.coasting_std = math.sqrt(inertial.variance)
                return step
            step = self._without_doubted(step, believed)
        step.creep = inertial.settle(dt, (step.displacement + lever) / dt, step.spread / dt)
        step.displacement -= dt * step.creep
        step.belated = inertial.belated()
        return step

    def _without_doubted(self, step: Step, believed: list[bool]) -> Step:
        """Return the Step of the modules that are believed."""
        used = tuple([module for module, trusted in zip(step.group.used, believed) if trusted])
        turn = step.turn if step.by_gyro else None
        # Where the believed modules cannot tell the turn, all of them do.
        return fit(self.paths, self._groups.of(used), turn) or step

    def _note_doubts(self, dt: float, step: Step, believed: list[bool]) -> None:
        """Keep account of what the accelerometer contradicts."""
        for module, trusted in zip(step.group.used, believed):
            self.doubt[module] = 0.0 if trusted else self.doubt[module] + dt
            self.slipping[module] |= not trusted
        self.is_doubting = any(self.doubt)

    def _forget_doubts(self) -> None:
        """Believe all modules."""
        self.doubt, self.is_doubting = [0.0] * len(self.doubt), False


def agreed_turn(dt: float, step: Step, resolution: float) -> float:
    """
    Return the turn by the wheels [rad], NaN where they do not agree on one among themselves.

    To within the last bit of their encoders, which has this `resolution` [m]: in short steps it
    is more than wheels creep.
    """
    limit = dt * consistent_speed(step.length / dt) + resolution
    return step.wheel_turn if step.do_wheels_agree(limit) else math.nan
