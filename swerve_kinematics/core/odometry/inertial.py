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

"""Which wheels to believe, by an accelerometer: it knows how the velocity changes."""

import cmath
import math

from swerve_kinematics.core.odometry.chord import Step
from swerve_kinematics.core.odometry.coasting import agreement, Coasting
from swerve_kinematics.core.odometry.gaps import Gaps
from swerve_kinematics.core.odometry.gate import (
    Gate, GATE_SPEED, GATE_STDS, own_error, PLACE_STD)
from swerve_kinematics.core.odometry.mounting_yaw import MountingYaw
from swerve_kinematics.core.odometry.standstill import Standstill
from swerve_kinematics.core.odometry.tilt import TiltRates
from swerve_kinematics.core.odometry.traction import ICY_GRIP, USUAL_GRIP
from swerve_kinematics.core.odometry.velocity_filter import VelocityFilter

# Wheels lose their grip together: where fewer than this part of them is left, none is believed.
MAJORITY = 0.5

# Error of the wheels' mean velocity: unsteady creep [m/s], radius (a part of the speed), and how
# far creep is from proportional to the force (this time [s] times the acceleration: 2 cm/s at
# 2 m/s^2). It keeps its value for so long [s] and counts accordingly little per step.
WHEEL_SPEED = 0.02
WHEEL_RATIO = 0.005
WHEEL_TIME = 0.01
CORRELATION_TIME = 0.1
# Innovations beyond this part of the gate, without the prediction's share, count less.
SUSPICIOUS = 0.7

# Beyond a lean of 12 degrees, or a force [m/s^2] near the end of a sensor's 2 g range, the
# base is not driving on a floor.
LARGEST_LEAN = 2.0
USUAL_RANGE = 18.0
# A lost message must not have the base believe wheels that spin: the last force stands in for
# those of so long a time [s]. A force beyond the range is a collision, and likely to leave the
# base with another velocity than its wheels: for that it stands in only while the base coasts.
LONGEST_LOSS = 0.1
# Over a step that is longer than this [s] a force tells nothing: what changes of it may hide of
# the velocity (see `gaps.UNSEEN_JERK`) is 1 m/s by then, and the base may have turned far.
LONGEST_STEP = 1.0

# What a parked base shows at first is gravity, of a floor that leans or along a sensor that is
# mounted otherwise: nothing is judged by it until the base moves or its rest is known, which takes
# no longer than this [s].
LONGEST_START = 0.5

# A base that creeps no faster than this [m/s], [rad/s] is not being tilted by the floor.
CREEP_SPEED = 0.05
CREEP_TURN = 0.05


class Inertial:
    """
    The velocity of the base as an accelerometer and the wheels tell it together.

    The wheels say the velocity of the sensor's place, one vote a module; the accelerometer
    says how it changes. Votes that contradict the prediction by more than wheels and sensor
    explain are not believed; with none left, the base coasts on the prediction.

    Parameters
    ----------
    position : complex
        Of the accelerometer, from base_link [m].
    force_range : float
        A force beyond this is not believed [m/s^2].

    Attributes
    ----------
    believed : bool
        Whether the accelerometer judged the wheels in the last step.
    coasting : Coasting
        The spell of coasting, if it lasts, and what follows from the last ones.
    gaps : Gaps
        What gaps in the messages leave unknown.

    """

    def __init__(self, position: complex, force_range: float = USUAL_RANGE) -> None:
        """Wait for the first step."""
        self.position, self._force_range = position, force_range
        self.believed = False
        self.coasting, self.gaps = Coasting(), Gaps()
        self._filter, self._tilt = VelocityFilter(), TiltRates()
        self._gate, self._mounting = Gate(), MountingYaw()
        self._standstill, self._stands = Standstill(), False
        self._starting = LONGEST_START  # how long a rest at the start may go on to be found [s]
        self._rounding = 0.0  # of the encoders in this step [m/s]
        self._came_at = 0.0  # speed before a spell of coasting, or a hit that began it [m/s]
        self._force: complex | None = None
        self._duration = self._turn = self._unheard = 0.0
        self._mean = self._last_mean = 0j

    @property
    def active(self) -> bool:
        """Return whether it goes on in a step without a force: with what it knows, till a gap."""
        return (self._force is not None or self.coasting.distrust > 0.0
                or self._filter.lean != 0j)

    @property
    def velocity(self) -> complex:
        """Return the velocity of the sensor's place [m/s], mean over the last step."""
        return self._filter.velocity

    @property
    def variance(self) -> float:
        """Return the variance of that velocity, in x and in y [m^2/s^2]."""
        return self._filter.variance + self.gaps.unseen * self.gaps.unseen

    @property
    def stamp_scatter(self) -> float | None:
        """Return the standard deviation of stamps [s] where it makes the force useless."""
        stamps = self._gate.stamps
        return math.sqrt(stamps.variance) if stamps.are_useless else None

    @property
    def scatter(self) -> float:
        """Return the standard deviation of the wheels' velocity for their stamps [m/s], else 0."""
        return self._gate.stamps.scatter if self.believed else 0.0

    @property
    def yaw_error(self) -> float:
        """Return what is to be added to the yaw of the mounting [rad], 0 where it seems right."""
        return self._mounting.error

    @property
    def lean(self) -> complex:
        """Return the gravity that leaks in because the floor leans [m/s^2], in base axes."""
        return self._filter.lean

    def interrupt(self) -> None:
        """Forget the velocity, after a gap: the wheels tell the next one."""
        if self._force is not None:
            self.gaps.hides_slip = True
        self._force, self.believed = None, False
        self.coasting.break_off()
        self._filter.forget_lean()

    def forget_scatter(self) -> None:
        """Take stamps for right again: what seemed off about them has another reason."""
        self._gate.forget_stamps()

    def forget_way(self) -> None:
        """Have nothing to tell of how far the base has coasted so far."""
        self._filter.forget_way()
        self.coasting.forget_way()

    def judge(self, dt: float, step: Step, mean: complex, force: complex | None,
              rates: complex | None, resolution: float, at_rest: bool = False) -> list[bool]:
        """
        Move on by a step, and return which of the wheels to believe.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        step : Step
            The motion that fits all modules best.
        mean : complex
            Velocity of the sensor's place by it [m/s].
        force : complex or None
            Mean specific force [m/s^2], None where it is unknown.
        rates : complex or None
            Mean rates about x and y [rad/s], None where they are unknown.
        resolution : float
            Of the encoders [m].
        at_rest : bool
            Whether no module has moved for a while.

        Returns
        -------
        list of bool (k,)

        """
        self._last_mean, self._mean, turn = self._mean, mean, step.turn
        tilted = self._tilt.change(dt, rates, rates is not None and self._is_slow(dt, step))
        force = self._usable(dt, force)
        self._look_for_rest(dt, force, at_rest and abs(turn) < CREEP_TURN * dt)
        if dt > LONGEST_STEP:
            self.interrupt()
            force = None
        before, duration = self._force, self._duration
        # The base turns under a velocity, by this from the middle of a step to that of the next.
        back = cmath.rect(1.0, -0.5 * (turn + self._turn))
        self._force, self._duration, self._turn = force, dt, turn
        coasting, self._rounding = self.coasting, resolution / dt
        if coasting.distrust:
            coasting.distrust = max(coasting.distrust - dt, 0.0)
        if force is None or before is None:
            self._begin(0.5 * (dt + duration), back, tilted)
        else:
            gained = 0.5 * (duration * back * before + dt * force)
            if not coasting.time and abs(self._filter.acceleration) < USUAL_GRIP:
                self._came_at = abs(self._filter.velocity)
            self._filter.predict(0.5 * (dt + duration), back, gained, tilted)
            if (coasting.time or coasting.distrust or self._mounting.error
                    or not self._mounting.proof.is_given):
                # A mounting that is wrong makes the accelerometer contradict the wheels.
                if self._mounting.add(
                        0.5 * (dt + duration), back, mean - back * self._last_mean, gained,
                        step.spread <= own_error(abs(mean)) * dt):
                    self._suspect_mounting(back)
            offset = mean - self._filter.wheel_velocity
            self.gaps.take_step(max(dt, duration), abs(offset))
            self._gate.take_step(dt, back, offset, abs(mean), abs(self._filter.velocity),
                                 turn / dt, self.gaps.unseen, resolution)
            self.believed = not (self._starting or coasting.distrust
                                 or self._gate.stamps.are_useless
                                 or self._mounting.error
                                 or abs(self._filter.lean) > LARGEST_LEAN)
        if not self.believed:
            coasting.break_off()
            return [True] * step.group.size
        return self._gated(dt, back, step)

    def _look_for_rest(self, dt: float, force: complex | None, still: bool) -> None:
        """Find out whether the base stands; a wait for the first rest ends then, or in motion."""
        contradicted = self.coasting.time + self.coasting.distrust > 0.0
        self._stands = self._standstill.lasts(dt, force, still, contradicted)
        if self._starting:
            is_parked = abs(self._mean) < CREEP_SPEED and not self._stands
            self._starting = max(self._starting - dt, 0.0) if is_parked else 0.0

    def _suspect_mounting(self, back: complex) -> None:
        """Believe the wheels for a while, and that they were right while the base coasted."""
        if self.coasting.time:
            self._filter.way_error += back * self.coasting.apart
            self._filter.forget_bias()
            self._filter.forget_lean()
            self.coasting.give_up()

    def _begin(self, dt: float, back: complex, tilted: complex | None) -> None:
        """Begin anew, a time [s] after the step before: how the velocity changed is not known."""
        if self._filter.lean:
            # The base turns on its slope all the same, and what the wheels do nobody sees.
            self._filter.predict(dt, back, 0j, tilted)
            if self._unheard > LONGEST_LOSS:
                self.gaps.hides_slip = abs(self._mean) > CREEP_SPEED
        self._restart(0j)
        self._gate.stamps.interrupt()
        self._mounting.interrupt()
        self.gaps.begin()
        self.believed = False

    def _usable(self, dt: float, force: complex | None) -> complex | None:
        """Return the force to use in a step, None where none is known."""
        if force is not None and abs(force) <= self._force_range:
            self._unheard = 0.0
            return force
        self._unheard += dt
        stands_in = force is None or self.coasting.time > 0.0
        return self._force if stands_in and self._unheard <= LONGEST_LOSS else None

    def _restart(self, acceleration: complex) -> None:
        """Begin at the velocity of the wheels."""
        variance = self._wheel_variance(
            abs(self._mean), math.hypot(self._rounding, self._gate.jitter))
        self._filter.restart(self._mean, variance, acceleration)

    def _is_slow(self, dt: float, step: Step) -> bool:
        """Return whether wheels, gyro and accelerometer agree that the base creeps at most."""
        return (abs(self._filter.velocity) < CREEP_SPEED and abs(step.turn) < CREEP_TURN * dt
                and abs(self._mean) < CREEP_SPEED
                and max(map(abs, step.errors)) < CREEP_SPEED * dt)

    def _gated(self, dt: float, back: complex, step: Step) -> list[bool]:
        """Return which votes lie within the gate, none while the base has to coast."""
        coasting, gate = self.coasting, self._gate
        is_new = self.gaps.is_on_probation(dt)
        offset, jitter = gate.offset, gate.jitter
        mean = coasting.smoothed(gate.share, back, offset)
        std = math.sqrt(self._filter.wheel_variance)
        # A step may be off by all that stamps make of it, the mean of many may not.
        is_astray = gate.calm < jitter and abs(mean) > gate.width(gate.calm, std)
        if coasting.time:
            offset, jitter = mean, gate.calm
        width, errors = gate.width(jitter, std), step.errors
        # No error is larger than the root of the sum of all squares.
        largest = step.spread * math.sqrt(len(errors))
        # Of a base that stands, nothing is to be judged.
        if not (coasting.time or is_astray) and (
                self._stands or largest <= (width - abs(offset)) * dt):
            coasting.grip(dt)
            return [True] * len(errors)
        votes = [offset + error / dt for error in errors]
        believed = [abs(vote) <= width for vote in votes]
        if sum(believed) < MAJORITY * len(votes) or is_astray and all(believed):
            believed = [False] * len(votes)
        if is_new and not (coasting.time or any(believed)):
            self.gaps.contradict(abs(offset))
            self._restart(0j)
            return [True] * len(votes)
        if coasting.time or not any(believed):
            return self._coasted(dt, back, votes, believed, jitter, width)
        coasting.grip(dt)
        return believed

    def _coasted(self, dt: float, back: complex, votes: list[complex], believed: list[bool],
                 jitter: float, width: float) -> list[bool]:
        """
        Take in a step of a spell of coasting; return which wheels to believe at its end.

        Votes are velocities by the wheels less the expected one, with the jitter of their stamps,
        and the width of the gate.
        It ends where wheels come back within the gate, which are believed as ever; where they
        come back outside or have rolled all along, so that the prediction was wrong and learns
        from them, unless the base is held; or after too long, whoever is right. After the last two
        it begins anew at the velocity of the wheels.
        """
        coasting, within = self.coasting, any(believed)
        offset, spread = agreement([vote for vote, trusted in zip(votes, believed)
                                    if trusted or not within])
        of_step = self._gate.jitter
        tolerance = self._gate.width(of_step)
        regained = coasting.has_regained(dt, back, offset, spread <= tolerance, within,
                                         self._filter.force_std, jitter)
        coasting.watch_hold(dt, abs(offset) - width, self._has_stopped(dt))
        changed = self._mean - back * self._last_mean
        # The acceleration of the wheels [m/s^2], less what jitter may make of it.
        rate = (abs(changed) - GATE_STDS * of_step) / dt
        coasting.dispute(dt, spread <= max(tolerance, math.sqrt(self._filter.variance))
                         and rate <= USUAL_GRIP and not coasting.is_held)
        rolls = coasting.has_rolled(dt, back, spread <= tolerance and rate < ICY_GRIP,
                                    offset, changed, self._filter.acceleration)
        if regained and within:
            coasting.end()
            return believed
        if self._stands:
            self._take_rest(offset, jitter)
        elif (regained or rolls) and not coasting.may_be_held:
            # What the sensor's bias and the lean have to do with the offset, they learn: all of it
            # where the base has not slid.
            learn = self._filter.correct if rolls else self._filter.reconcile
            learn(offset, self._wheel_variance(abs(self._mean), jitter))
            coasting.end()
        elif coasting.is_too_long:
            coasting.give_up()
        else:
            self._filter.coast(dt)
            if coasting.is_held:
                self._hold(dt)
            return [False] * len(believed)
        self._restart(self._filter.acceleration)
        return [True] * len(believed)

    def _has_stopped(self, dt: float) -> bool:
        """Return whether the base, which moved before the spell, stands by gyro and force."""
        estimate = self._filter
        slow = GATE_SPEED + GATE_STDS * math.sqrt(estimate.variance)
        return (abs(estimate.velocity) <= slow < self._came_at
                and abs(estimate.acceleration) < ICY_GRIP and abs(self._turn) < CREEP_TURN * dt)

    def _hold(self, dt: float) -> None:
        """Let the rest of a base that is held correct the prediction, as that of wheels would."""
        variance = self._wheel_variance(0.0, 0.0) * max(2.0 * CORRELATION_TIME / dt, 1.0)
        self._filter.correct(-self._filter.wheel_velocity, variance)

    def _take_rest(self, offset: complex, jitter: float) -> None:
        """
        End a spell of coasting with the base at rest.

        All of its velocity was an error, far beyond what bias and lean were thought to be: they
        are to be learnt anew, and how far the base has come is not known well.
        """
        self._filter.reconcile(offset, self._wheel_variance(0.0, jitter))
        self._filter.forget_bias()
        self._filter.forget_lean()
        self.coasting.break_off()

    def belated(self) -> complex:
        """Return how much further [m] than was told the base has coasted, seen from its axes."""
        error = self._filter.way_error
        if error:
            self._filter.way_error = 0j
        return error

    def settle(self, dt: float, velocity: complex, spread: float) -> complex:
        """
        Let the wheels that were believed correct velocity, bias, lean and creep.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        velocity : complex
            Their mean velocity of the sensor's place [m/s].
        spread : float
            Root mean square of their disagreement [m/s].

        Returns
        -------
        complex
            By how much the wheels ran ahead of the base in the step [m/s].

        """
        estimate = self._filter
        innovation = velocity - estimate.wheel_velocity
        variance = self._wheel_variance(abs(velocity), spread)
        correlated = 2.0 * CORRELATION_TIME / dt
        if correlated > 1.0:
            variance *= correlated
        jitter = self._gate.jitter
        variance += jitter * self._gate.calm
        if abs(innovation) > SUSPICIOUS * GATE_SPEED and not self._stands:
            usual = own_error(abs(velocity)) + GATE_STDS * jitter
            variance *= max(1.0, abs(innovation) / (SUSPICIOUS * usual))
        estimate.correct(innovation, variance)
        return estimate.known_creep * estimate.acceleration if self.believed else 0j

    def _wheel_variance(self, speed: float, spread: float) -> float:
        """Return the variance of the wheels' mean velocity, in x and in y [m^2/s^2]."""
        radius, creep = WHEEL_RATIO * speed, WHEEL_TIME * abs(self._filter.acceleration)
        place = PLACE_STD * self._turn / self._duration
        return (WHEEL_SPEED * WHEEL_SPEED + radius * radius + creep * creep + place * place
                + spread * spread)
