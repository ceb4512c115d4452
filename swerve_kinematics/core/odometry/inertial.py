"""Which wheels to believe, by an accelerometer: it knows how the velocity changes."""

import cmath
import math

from swerve_kinematics.core.odometry.velocity_filter import VelocityFilter

STANDARD_GRAVITY = 9.80665

# A wheel is believed within this of the prediction: creep and encoders [m/s], radius and
# direction (a part of the speed), stamps that are not simultaneous (this time [s] times the
# acceleration), and so many standard deviations of the prediction itself.
GATE_SPEED = 0.05
GATE_RATIO = 0.02
GATE_TIME = 0.01
GATE_STDS = 3.0
# Wheels lose their grip together: where fewer than this part of them is left, none is believed.
MAJORITY = 0.5

# Error of the wheels' mean velocity: creep [m/s] and radius (a part of the speed). It keeps
# its value for so long [s] and counts accordingly little per step.
WHEEL_SPEED = 0.02
WHEEL_RATIO = 0.005
CORRELATION_TIME = 0.1
# Innovations beyond this part of the gate, without the prediction's share, count less.
SUSPICIOUS = 0.7

# The base coasts until the wheels have changed for this long [s] as the prediction does, to
# within this [m/s] and so many standard deviations of what bias and lean do in that time: an
# offset that stays is the prediction's.
AGREEMENT_TIME = 0.3
AGREEMENT_SPEED = 0.1
AGREEMENT_STDS = 2.0
# A spell of coasting is over when the wheels have been believed for so long [s].
REGAIN_TIME = 0.1
# The base never coasts for longer than this [s].
LONGEST_COASTING = 2.0
# After the longest coasting the wheels are believed for so long [s]; twice as long each time,
# up to the second value.
DISTRUST_TIME = 5.0
LONGEST_DISTRUST = 60.0

# Beyond a lean of 12 degrees, or a force [m/s^2] near the end of a sensor's 2 g range, the
# base is not driving on a floor.
LARGEST_LEAN = 2.0
LARGEST_FORCE = 18.0

# Until the base has rested the rates about x and y are as wrong as data sheets say: unused.
# At rest their mean is learnt over this time [s].
RATE_TIME = 2.0
# Half a second of rest is enough to use them.
RATE_REST = 0.5


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

    Attributes
    ----------
    believed : bool
        Whether the accelerometer judged the wheels in the last step.
    doubt : float
        For how long [s] the base has been coasting on the accelerometer, in this spell; 0 once
        it is over.

    """

    def __init__(self, position: complex) -> None:
        """Wait for the first step."""
        self.position = position
        self.believed = False
        self.doubt = 0.0
        self._filter = VelocityFilter()
        self._force: complex | None = None
        self._duration = self._turn = 0.0
        self._agreed = self._regained = 0.0
        self._offset = 0j
        self._distrust, self._next_distrust, self._trusted = 0.0, DISTRUST_TIME, 0.0
        self._rate_offset, self._rested = 0j, 0.0
        self._votes: list[complex] = []

    @property
    def active(self) -> bool:
        """Return whether there was a force in the last step."""
        return self._force is not None

    @property
    def velocity(self) -> complex:
        """Return the velocity of the sensor's place [m/s], mean over the last step."""
        return self._filter.velocity

    @property
    def variance(self) -> float:
        """Return the variance of that velocity, in x and in y [m^2/s^2]."""
        return self._filter.variance

    @property
    def lean(self) -> complex:
        """Return the gravity that leaks in because the floor leans [m/s^2], in base axes."""
        return self._filter.lean

    def interrupt(self) -> None:
        """Forget the velocity, after a gap: the wheels tell the next one."""
        self._force, self.believed = None, False
        self._end_doubt()
        self._filter.forget_lean()

    def judge(self, dt: float, turn: float, votes: list[complex], force: complex | None,
              rates: complex | None, at_rest: bool) -> list[bool]:
        """
        Move on by a step, and return which of the wheels to believe.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        turn : float
            Change of heading in it [rad].
        votes : list of complex (k,)
            Velocity of the sensor's place [m/s] that each module implies.
        force : complex or None
            Mean specific force [m/s^2], None where it is unknown.
        rates : complex or None
            Mean rates about x and y [rad/s], None where they are unknown.
        at_rest : bool
            Whether the wheels have stood still for a while.

        Returns
        -------
        list of bool (k,)

        """
        self._votes = votes
        tilted = self._tilt(dt, rates, at_rest)
        if force is not None and not abs(force) <= LARGEST_FORCE:
            force = None
        known = force is not None and self._force is not None
        half_turn = 0.5 * (turn + self._turn)
        if force is not None and self._force is not None:
            gained = 0.5 * (cmath.rect(self._duration, -half_turn) * self._force + dt * force)
            self._filter.predict(0.5 * (dt + self._duration), half_turn, gained, tilted)
        self._force, self._duration, self._turn = force, dt, turn
        self._distrust = max(self._distrust - dt, 0.0)
        self.believed = (known and not self._distrust
                         and abs(self._filter.lean) <= LARGEST_LEAN)
        if not known:
            self._restart()
        if not self.believed:
            self._end_doubt()
            return [True] * len(votes)
        return self._gated(dt, half_turn)

    def _restart(self) -> None:
        """Begin at the velocity of the wheels."""
        mean = sum(self._votes) / len(self._votes)
        self._filter.restart(mean, self._wheel_variance(abs(mean), 0.0))

    def _gated(self, dt: float, turn: float) -> list[bool]:
        """Return which votes lie within the gate, or all where coasting has to end."""
        votes, velocity = self._votes, self._filter.velocity
        gate = (self._fixed_gate(abs(velocity))
                + GATE_STDS * math.sqrt(self._filter.variance))
        believed = [abs(vote - velocity) <= gate for vote in votes]
        if sum(believed) < MAJORITY * len(votes):
            believed = [False] * len(votes)
        if all(believed):
            self._trusted += dt
            if self._trusted > LONGEST_DISTRUST:
                self._next_distrust = DISTRUST_TIME
            # Wheels that only pass through the gate have not come back.
            self._regained += dt
            if self._regained > REGAIN_TIME:
                self._end_doubt()
        elif not any(believed) and self._coasting_ends(dt, turn):
            return [True] * len(votes)
        return believed

    def _fixed_gate(self, speed: float) -> float:
        """Return the part of the gate that is the wheels' [m/s]."""
        return GATE_SPEED + GATE_RATIO * speed + GATE_TIME * self._filter.change

    def _coasting_ends(self, dt: float, turn: float) -> bool:
        """Take in a step that no wheel explains; tell whether the wheels are to be believed."""
        mean = sum(self._votes) / len(self._votes)
        offset = mean - self._filter.velocity
        self._offset *= cmath.rect(1.0, -turn)
        tolerance = AGREEMENT_SPEED + AGREEMENT_STDS * self._filter.force_std * self._agreed
        if not self.doubt or abs(offset - self._offset) > tolerance:
            self._offset, self._agreed = offset, 0.0
        self._regained = 0.0
        self.doubt += dt
        self._agreed += dt
        too_long = self.doubt > LONGEST_COASTING
        if not (too_long or self._agreed > AGREEMENT_TIME):
            return False
        if too_long:
            self._distrust = self._next_distrust
            self._next_distrust = min(2.0 * self._next_distrust, LONGEST_DISTRUST)
            self._trusted = 0.0
        else:
            # What the sensor's bias and the lean have to do with the offset, they learn.
            self._filter.correct(offset, self._wheel_variance(abs(mean), 0.0))
        self._restart()
        self._end_doubt()
        return True

    def _end_doubt(self) -> None:
        """Be done with coasting."""
        self.doubt = self._agreed = self._regained = 0.0

    def settle(self, dt: float, velocity: complex, spread: float) -> None:
        """
        Let the wheels that were believed correct velocity, bias and lean.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        velocity : complex
            Their mean velocity of the sensor's place [m/s].
        spread : float
            Root mean square of their disagreement [m/s].

        """
        speed = abs(velocity)
        innovation = velocity - self._filter.velocity
        variance = self._wheel_variance(speed, spread) * max(2.0 * CORRELATION_TIME / dt, 1.0)
        excess = abs(innovation) / (SUSPICIOUS * self._fixed_gate(speed))
        self._filter.correct(innovation, variance * max(excess, 1.0))

    def _wheel_variance(self, speed: float, spread: float) -> float:
        """Return the variance of the wheels' mean velocity, in x and in y [m^2/s^2]."""
        return WHEEL_SPEED ** 2 + (WHEEL_RATIO * speed) ** 2 + spread * spread

    def _tilt(self, dt: float, rates: complex | None, at_rest: bool) -> complex:
        """Return the change of the lean [m/s^2] by the rates, whose offset rest tells."""
        if rates is None:
            return 0j
        if at_rest:
            self._rested = min(self._rested + dt, RATE_TIME)
            self._rate_offset += dt / max(self._rested, dt) * (rates - self._rate_offset)
        if self._rested < RATE_REST:
            return 0j
        return 1j * STANDARD_GRAVITY * dt * (rates - self._rate_offset)
