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

"""When wheels that the accelerometer has contradicted are to be believed again."""

import math

from swerve_kinematics.core.odometry.traction import ICY_GRIP

# Wheels have come back when their velocity changes as the prediction does, to within this [m/s]
# and so many standard deviations of what bias, lean and mounting do in that time, and jitter of
# the stamps. Wheels that slip pass through the gate too, so within it that must hold more
# closely, for the first time [s]; outside, for the second: an offset that stays is the
# prediction's, if an error of the force [m/s^2] can have made it so large in this spell: at most
# three standard deviations of a bias and a lean.
AGREEMENT_SPEED = 0.06
AGREEMENT_STDS, PASSING_STDS = 2.0, 1.0
REGAIN_TIME = 0.09
AGREEMENT_TIME = 0.29
LARGEST_ERROR = 1.5
# Wheels that keep their velocity, and for so long [s] do not pull the base towards it by as much
# as on ice, have rolled with the base.
UNPULLED_TIME = 0.3
# But where they have changed their velocity in this spell and the base, to within this part of
# the change, has not, it is held by an obstacle, or stands on ice.
HELD = 0.3
# The base never coasts for longer than the first time [s] without a break against wheels that
# are credible, nor at all for longer than the second.
LONGEST_DISPUTE = 2.0
LONGEST_COASTING = 7.0
# Nor further than this [m] while it is pushed away from the velocity of its wheels, harder than
# they pull: a collision or a hard push is over sooner, so the sensor is wrong.
LONGEST_PUSH = 2.0
# After the longest coasting the wheels are believed for so long [s]; twice as long each time,
# up to the second value.
DISTRUST_TIME = 5.0
LONGEST_DISTRUST = 60.0


class Coasting:
    """
    A spell in which the base moves as its accelerometer says, and what ends it.

    Attributes
    ----------
    time : float
        How long the spell has lasted [s]; 0 while the wheels are believed.
    distrust : float
        For how long the accelerometer will not be believed [s].
    apart : complex
        How much further the wheels have gone in the spell than the base has coasted [m].

    """

    def __init__(self) -> None:
        """Start with trust in the wheels and in the accelerometer."""
        self.time = self.distrust = 0.0
        self._next_distrust, self._trusted = DISTRUST_TIME, 0.0
        self._offset = self._smoothed = self._changed = self.apart = 0j
        self._left_apart = 0.0
        self._agreed = self._disputed = self._unpulled = self._pushed = 0.0
        self._is_sudden, self._stood = False, 0.0

    def grip(self, dt: float) -> None:
        """Take in a step of `dt` [s] that wheels and accelerometer agree on."""
        self._trusted += dt
        if self._trusted > LONGEST_DISTRUST:
            self._next_distrust = DISTRUST_TIME

    def end(self) -> None:
        """Be done with the spell."""
        self.time = self._agreed = self._disputed = self._unpulled = self._pushed = 0.0
        self._smoothed = self._changed = self.apart = 0j
        self._is_sudden, self._stood = False, 0.0

    @property
    def is_too_long(self) -> bool:
        """Return whether it goes on for longer than an accelerometer is to be believed."""
        return (self._disputed > LONGEST_DISPUTE or self.time > LONGEST_COASTING
                or self._pushed > LONGEST_PUSH)

    def smoothed(self, share: float, back: complex, offset: complex) -> complex:
        """Return the offset [m/s], smoothed, with this share of the last one."""
        self._smoothed *= back
        self._smoothed += share * (offset - self._smoothed)
        return self._smoothed

    def has_regained(self, dt: float, back: complex, offset: complex, consistent: bool,
                     within: bool, force_std: float, jitter: float) -> bool:
        """
        Take in a step, and return whether the wheels have come back.

        Parameters
        ----------
        dt : float
            Its duration [s].
        back : complex
            What turns a vector of the step before into base axes, which have turned since.
        offset : complex
            Mean velocity by the wheels less that by the accelerometer [m/s].
        consistent : bool
            Whether the wheels agree with each other.
        within : bool
            Whether the offset lies within the gate.
        force_std : float
            By how much the force may mislead, in x and in y [m/s^2].
        jitter : float
            Standard deviation of the wheels' velocity for their stamps [m/s].

        """
        self._offset *= back
        stds = PASSING_STDS if within else AGREEMENT_STDS
        tolerance = (math.hypot(AGREEMENT_SPEED, AGREEMENT_STDS * jitter)
                     + stds * force_std * self._agreed)
        if not self.time or not consistent or abs(offset - self._offset) > tolerance:
            self._offset, self._agreed = offset, 0.0
        else:
            self._agreed += dt
        self.apart = back * self.apart + dt * offset
        self.time += dt
        if within:
            return self._agreed > REGAIN_TIME
        return (self._agreed > AGREEMENT_TIME
                and abs(offset) <= AGREEMENT_SPEED + LARGEST_ERROR * self.time)

    def watch_hold(self, dt: float, excess: float, has_stopped: bool) -> None:
        """
        Find out whether something holds the base against its wheels, as a wall or a hand.

        It was stopped faster than an error of the force would make it seem, and stands.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        excess : float
            By how much the offset of the wheels exceeds the gate [m/s].
        has_stopped : bool
            Whether the accelerometer has felt the base stop in this spell, and it stands.

        """
        self._is_sudden |= excess > LARGEST_ERROR * self.time
        is_held = has_stopped and self._is_sudden and excess > 0.0
        self._stood = self._stood + dt if is_held else 0.0

    @property
    def may_be_held(self) -> bool:
        """Return whether the base has stopped, for however short a time, while its wheels run."""
        return self._stood > 0.0

    @property
    def is_held(self) -> bool:
        """Return whether it has stood for so long that something holds it."""
        return self._stood > UNPULLED_TIME

    def has_rolled(self, dt: float, back: complex, steady: bool, offset: complex,
                   changed: complex, acceleration: complex) -> bool:
        """
        Take in a step, and return whether the base has rolled on its wheels for all that.

        Parameters
        ----------
        dt : float
            Its duration [s].
        back : complex
            What turns a vector of the step before into base axes, which have turned since.
        steady : bool
            Whether the wheels agree with each other and keep their velocity.
        offset : complex
            Mean velocity by the wheels less that by the accelerometer [m/s].
        changed : complex
            By how much that of the wheels has changed in the step [m/s].
        acceleration : complex
            Of the base, by the accelerometer [m/s^2].

        """
        self._changed = back * self._changed + changed
        # Away from the wheels' velocity somebody pushes it.
        pull, size = (acceleration * offset.conjugate()).real, abs(offset)
        self._pushed = self._pushed + size * dt if pull < -ICY_GRIP * size else 0.0
        unpulled = steady and abs(pull) < ICY_GRIP * size
        self._unpulled = self._unpulled + dt if unpulled else 0.0
        return (self._unpulled > UNPULLED_TIME
                and abs(offset - self._changed) >= HELD * abs(self._changed))

    def dispute(self, dt: float, credible: bool) -> None:
        """
        Take in a step of `dt` [s] in which the wheels have not come back.

        Wheels that differ among themselves by more than the prediction may be wrong, or change
        faster than a floor lets them, slip for certain. They are credible while they do neither,
        and the longer the accelerometer contradicts them then, the more likely the fault is its
        own.
        """
        self._disputed = self._disputed + dt if credible else 0.0

    def break_off(self) -> None:
        """Be done with the spell, if there is one, though neither side has won."""
        if self.time:
            self._left_apart = abs(self.apart)
            self.end()

    def give_up(self) -> None:
        """Believe the wheels whatever the accelerometer says, the longer the more often."""
        self.break_off()
        self.distrust = self._next_distrust
        self._next_distrust = min(2.0 * self._next_distrust, LONGEST_DISTRUST)
        self._trusted = 0.0

    def forget_way(self) -> None:
        """Forget how far apart wheels and accelerometer are: the pose is known anew."""
        self.apart, self._left_apart = 0j, 0.0

    def unsettled(self) -> float:
        """Return once how far apart [m] both were when the last spell ended without a winner."""
        apart, self._left_apart = self._left_apart, 0.0
        return apart


def agreement(votes: list[complex]) -> tuple[complex, float]:
    """Return mean and spread (root mean square) of votes, without the farthest of four or more."""
    mean = sum(votes) / len(votes)
    if len(votes) > 3:
        votes = sorted(votes, key=lambda vote: abs(vote - mean))[:-1]
        mean = sum(votes) / len(votes)
    return mean, math.hypot(*[abs(vote - mean) for vote in votes]) / math.sqrt(len(votes))
