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

from itertools import repeat
import math
from operator import sub
from typing import NamedTuple

from numpy import float64
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.angles import TURN
from swerve_kinematics.core.odometry.chord import fit, Readings, Step, without_slipping
from swerve_kinematics.core.odometry.curvature import Bend, bend_after, STRAIGHT
from swerve_kinematics.core.odometry.group import Layout
from swerve_kinematics.core.odometry.gyro import MAX_YAW_RATE, RestDetector
from swerve_kinematics.core.odometry.inertial import Inertial
from swerve_kinematics.core.odometry.readings import LARGEST_SPEED, Modules
from swerve_kinematics.core.odometry.step_noise import consistent_speed
from swerve_kinematics.core.odometry.uncertainty import OdometryNoise
from swerve_kinematics.core.odometry.yaw import YawTracker

# Stamps wander by a few milliseconds against the encoders: this much time [s] a module is
# granted on top of a step before its distance counts as impossible.
STAMP_JITTER = 0.01


class ImuSample(NamedTuple):
    """
    What an accelerometer and the two level gyros say about a step, None where they do not.

    Attributes
    ----------
    force : complex or None
        Mean specific force [m/s^2].
    rates : complex or None
        Mean rates about x and y [rad/s].

    """

    force: complex | None
    rates: complex | None


NO_IMU = ImuSample(None, None)


class Solution(NamedTuple):
    """
    A step as the sensors explain it that are believed.

    Attributes
    ----------
    step : Step
        The motion.
    gyro_turn : float or None
        Turn by the gyro without its bias [rad], None where the wheels tell it.
    coasting_std : float or None
        Standard deviation of the velocity [m/s] where no wheel is believed and the base
        coasts on its accelerometer; None otherwise.
    belated : complex
        What the step tells of the way before it [m], seen from base axes at its end: how much
        further the base has coasted than was told.

    """

    step: Step
    gyro_turn: float | None
    coasting_std: float | None
    belated: complex


class StepSolver:
    """
    Finds the motion of each step.

    Parameters
    ----------
    module_positions : ndarray (n, 2)
        From base_link [m].
    imu_position : complex
        Of the accelerometer, from base_link [m].

    Attributes
    ----------
    gyro : YawTracker
    inertial : Inertial
    slipping : list of bool (n,)
        Which modules the last step left out as wrong: slip, or a jump.
    doubt : list of float (n,)
        For how long the accelerometer has contradicted each module [s].
    at_rest : bool
        Whether no module has moved for a while.

    """

    def __init__(self, module_positions: NDArray[float64], imu_position: complex) -> None:
        """Wait for the first sample."""
        count = len(module_positions)
        self.gyro, self.inertial = YawTracker(), Inertial(imu_position)
        self.slipping, self.doubt = [False] * count, [0.0] * count
        self.at_rest = False
        self._all = tuple(range(count))
        self._layout, self._rest = Layout(module_positions), RestDetector()
        self._modules: Modules = [math.nan] * count, [math.nan] * count
        self._bend_before: tuple[float, list[float], list[float], float,
                                 tuple[int, ...]] | None = None

    def interrupt(self) -> None:
        """Forget the motion so far, after a gap or a step that told none."""
        self._bend_before = None
        self.inertial.interrupt()
        self.doubt = [0.0] * len(self.doubt)

    def hear(self, dt: float, modules: Modules, yaw: float | None, yaw_rate: float | None,
             rate_integral: float | None, bias: float, noise: OdometryNoise) -> Readings:
        """
        Take in a sample, and return what encoders and gyro say about the step that it ends.

        Parameters
        ----------
        dt : float
            Time since the last sample [s].
        modules : Modules
            Distances [m] and angles [rad] now.
        yaw, yaw_rate, rate_integral : float or None
            By the gyro [rad], [rad/s], [rad].
        bias : float
            Of the gyro [rad/s].
        noise : OdometryNoise
            What to expect of the modules.

        """
        (last_distances, last_angles), self._modules = self._modules, modules
        distances, angles = modules
        self.at_rest = self._rest.update(dt, distances, angles)
        gyro_turn = self.gyro.turn(dt, yaw, yaw_rate, rate_integral)
        fastest = min(noise.max_module_speed, LARGEST_SPEED) * (dt + STAMP_JITTER)
        rolled = list(map(sub, distances, last_distances))
        steered = list(map(math.remainder, map(sub, angles, last_angles), repeat(TURN)))
        used, self.slipping = self._all, [False] * len(rolled)
        if not math.hypot(*rolled) <= fastest:
            used = tuple([place for place, way in enumerate(rolled) if -fastest <= way <= fastest])
            self.slipping = [way > fastest or way < -fastest for way in rolled]
        turn = None if gyro_turn is None else gyro_turn - bias * dt
        return Readings(used, rolled, last_angles, steered, turn, self._bend(dt))

    def _bend(self, dt: float) -> Bend:
        """Return what the step before says about the curvature of this one."""
        return bend_after(*self._bend_before, dt) if self._bend_before else STRAIGHT

    def solve(self, dt: float, readings: Readings, imu: ImuSample, bias: float,
              noise: OdometryNoise) -> Solution | None:
        """
        Return the motion of a step, None if the modules in use cannot tell it.

        Parameters
        ----------
        dt : float
            Its duration [s].
        readings : Readings
            By encoders and gyro.
        imu : ImuSample
            By the accelerometer.
        bias : float
            Of the gyro [rad/s].
        noise : OdometryNoise
            What to expect of the modules.

        """
        readings, step = self._checked(dt, readings, bias)
        if step is None:
            return None
        inertial = self.inertial
        if imu.force is None and not inertial.active:
            step = self._without_slipping(dt, readings, step, noise)
        else:
            lever = 2j * math.sin(0.5 * step.turn) * inertial.position
            believed = inertial.judge(dt, step.turn, (step.displacement + lever) / dt,
                                      step.errors, imu.force, imu.rates)
            if any(believed):
                step = self._without_doubted(dt, readings, step, believed, noise)
                inertial.settle(dt, (step.displacement + lever) / dt, step.spread / dt)
            else:
                self._note_doubts(dt, step, believed)
                self._bend_before = None
                coasting = step._replace(displacement=dt * inertial.velocity - lever)
                return Solution(coasting, readings.turn, math.sqrt(inertial.variance), 0j)
        if step.slipping is not None:
            self.slipping[step.slipping] = True
        self._bend_before = dt, readings.rolled, readings.steered, step.turn, step.used
        return Solution(step, readings.turn, None, inertial.belated())

    def _checked(self, dt: float, readings: Readings,
                 bias: float) -> tuple[Readings, Step | None]:
        """Return the readings, without the gyro where the wheels refute it, and their Step."""
        step = self._fit(dt, readings)
        if step is None and readings.turn is None:
            return readings, None
        # Wheels that the accelerometer has caught slipping refute nothing.
        wheel_turn = math.nan if step is None or any(self.doubt) else agreed_turn(dt, step)
        checked = self.gyro.checked(dt, wheel_turn)
        turn = None if checked is None else checked - bias * dt
        if turn != readings.turn:
            readings = readings._replace(turn=turn)
            step = self._fit(dt, readings)
        return readings, step

    def _fit(self, dt: float, readings: Readings) -> Step | None:
        """Return the Step that fits all modules best, None if it tells no turn a base can make."""
        step = fit(self._layout, readings)
        if step is None or abs(step.turn) > MAX_YAW_RATE * (dt + STAMP_JITTER):
            return None
        return step

    def _without_doubted(self, dt: float, readings: Readings, step: Step, believed: list[bool],
                         noise: OdometryNoise) -> Step:
        """Return the Step of the modules that the accelerometer and the others believe."""
        self._note_doubts(dt, step, believed)
        if all(believed):
            return self._without_slipping(dt, readings, step, noise)
        used = tuple(module for module, trusted in zip(step.used, believed) if trusted)
        # Where the believed modules cannot tell the turn, all of them do.
        return fit(self._layout, readings._replace(used=used)) or step

    def _without_slipping(self, dt: float, readings: Readings, step: Step,
                          noise: OdometryNoise) -> Step:
        """Return the Step without the one module that contradicts the others, if any."""
        tolerance = math.hypot(noise.slip_speed * dt, noise.distance_resolution)
        return without_slipping(self._layout, readings, step, tolerance, noise.slip_ratio)

    def _note_doubts(self, dt: float, step: Step, believed: list[bool]) -> None:
        """Keep account of what the accelerometer contradicts."""
        if all(believed):
            self.doubt = [0.0] * len(self.doubt)
            return
        for module, trusted in zip(step.used, believed):
            self.doubt[module] = 0.0 if trusted else self.doubt[module] + dt
            self.slipping[module] |= not trusted


def agreed_turn(dt: float, step: Step) -> float:
    """Return the turn by the wheels [rad], NaN where they do not agree on one among themselves."""
    off = 2.0 * (math.sin(0.5 * step.wheel_turn) - math.sin(0.5 * step.turn))
    # What the votes differ by because the gyro turned otherwise is not the wheels' own.
    own = step.spread ** 2 - off * off * step.group.inertia / step.group.size
    limit = dt * consistent_speed(step.length / dt)
    return step.wheel_turn if own <= limit * limit else math.nan
