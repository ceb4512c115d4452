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

"""Which clock counts for what: clocks that the test moves, no graph needed."""

from types import SimpleNamespace

from hypothesis import given, strategies as st
import pytest

from swerve_kinematics.configuration.declarations import ListOf
from swerve_kinematics.configuration.node import NODE_DECLARATIONS, parameters_from
from swerve_kinematics.ros.drive import Drive
from swerve_kinematics.ros.timeline import LONG_AGO, Timeline

S = 1_000_000_000  # ns
TICK = S // 50
TIMEOUT = S // 2
FORWARD, STOP = (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)


class Clocks:
    """A node's clock and real time, in the place of both."""

    def __init__(self, simulated=False, grain=1):
        """Start at times that have nothing to do with each other."""
        self.stamp, self.real = 1_700_000_000 * S, 77 * S
        self.is_simulated, self._grain, self.handle = simulated, grain, self

    def get_ros_time_override_is_enabled(self):
        """Tell whether the node's clock is on simulated time, as its handle does."""
        return self.is_simulated

    def now(self):
        """Return the time of the node's clock."""
        return SimpleNamespace(nanoseconds=self.stamp // self._grain * self._grain)

    def pass_by(self, real, rate=1.0):
        """Let real time pass, and the node's clock at a rate."""
        self.real += real
        self.stamp += round(rate * real)


class Base:
    """A Drive on clocks that the test moves."""

    def __init__(self, clocks, **changes):
        """Start with feedback, at rest."""
        values = {d.name: [] if isinstance(d.default, ListOf) else d.default
                  for d in NODE_DECLARATIONS}
        self.clocks = clocks
        self.timeline = Timeline(
            clocks, TIMEOUT, lambda: clocks.real, lambda: clocks.now().nanoseconds)
        self.drive = Drive(parameters_from({**values, **changes}))
        self.speed = 0.0

    def turn(self, twist=None, feedback=True, rate=1.0, real=TICK):
        """Let one turn of the control loop pass; return the speed [m/s]."""
        self.clocks.pass_by(real, rate)
        now = self.timeline.now()
        if feedback:
            self.drive.measured(now.stamp, [0.0] * 4, (self.speed, 0.0, 0.0), now)
        if twist is not None:
            self.drive.input.accept(twist, now)
        self.speed = self.drive.step(now, 0.0).twist[0]
        return self.speed

    def turns(self, seconds, **how):
        """Let turns pass for some real time; return the speeds."""
        return [self.turn(**how) for _ in range(round(seconds * S / TICK))]


@pytest.fixture
def driving():
    """Return a function that makes a base that drives at 1 m/s."""
    def make(**how):
        base = Base(Clocks(**how))
        base.turns(1.0, twist=FORWARD)
        assert base.speed == pytest.approx(1.0)
        return base
    return make


def test_a_base_without_feedback_says_nothing_of_the_command_that_it_does_not_execute():
    base = Base(Clocks(), steering_lower_limits=[-1.0], steering_upper_limits=[1.0])
    for _ in range(50):
        base.turn(twist=(0.0, 5.0, 0.0))
    assert base.drive.scale < 1.0 and all(base.drive.unreachable)
    base.drive.is_held = True
    base.turns(1.0, twist=FORWARD, feedback=False)
    assert base.drive.mode == 'no feedback' and base.drive.scale == 1.0
    assert not any(base.drive.unreachable) and not base.drive.is_held


@pytest.mark.parametrize('jump', [-600 * S, -S // 10, S // 10, 600 * S])
def test_a_system_clock_that_is_set_changes_nothing(driving, jump):
    base, same = driving(), driving()
    base.clocks.stamp += jump
    assert base.turns(0.2, twist=FORWARD) == same.turns(0.2, twist=FORWARD)
    speeds = base.turns(1.5)
    assert speeds == same.turns(1.5)
    assert min(speeds[:24]) > 0.99 and speeds[-1] == 0.0


@given(st.lists(st.integers(-10 * S, 10 * S), min_size=1, max_size=40))
def test_without_simulated_time_motion_never_outlives_the_timeout(jumps):
    base = Base(Clocks())
    base.turns(1.0, twist=FORWARD)
    for jump in jumps:
        base.clocks.stamp += jump
        base.turn()
    base.turns(1.0)
    assert base.speed == 0.0


@pytest.mark.parametrize('end', ['silence', 'zero', 'lock'])
@pytest.mark.parametrize('rate', [0.0, 1e-3])
def test_whatever_asks_for_a_stop_has_it_while_simulated_time_stands(driving, rate, end):
    base = driving(simulated=True)
    base.turns(1.0, twist=FORWARD, rate=rate)
    assert base.speed == pytest.approx(1.0)  # it goes on in a pause as long as it is told to
    if end == 'lock':
        base.drive.controller.lock()
    speeds = base.turns(1.5, rate=rate,
                        twist={'silence': None, 'zero': STOP, 'lock': FORWARD}[end])
    assert speeds[-1] == 0.0
    # Within the deceleration limit of 3 m/s^2 and two periods of a ramp that came late.
    assert max(a - b for a, b in zip(speeds, speeds[1:])) < 3.0 * 0.041


def test_without_a_clock_ramps_run_on_real_time():
    base = Base(Clocks(simulated=True))
    base.turns(1.0, twist=STOP, rate=0.0)
    speeds = base.turns(1.0, twist=FORWARD, rate=0.0)
    assert max(b - a for a, b in zip(speeds, speeds[1:])) < 2.0 * 0.041
    assert speeds[-1] == pytest.approx(1.0)


def test_simulated_time_set_while_driving_stops_on_silence(driving):
    base = driving()
    base.clocks.is_simulated, base.clocks.stamp = True, 0
    assert base.turns(1.0, twist=FORWARD, rate=0.0)[-1] == pytest.approx(1.0)
    assert base.turns(2.0, rate=0.0)[-1] == 0.0


@pytest.mark.parametrize('end', [None, STOP])
def test_a_clock_that_loops_stops_it_too(driving, end):
    base = driving(simulated=True)
    for _ in range(10):
        base.clocks.stamp -= 3 * S // 10
        speeds = base.turns(0.3, twist=end)
    assert speeds[-1] == 0.0


def test_a_clock_set_back_takes_the_command_along(driving):
    base = driving(simulated=True)
    base.clocks.stamp -= 90 * S
    assert base.turn() < 1.0


@pytest.mark.parametrize('rate', [0.1, 0.5, 3.0])
def test_a_command_and_its_ramp_last_as_long_in_simulated_time_at_any_rate(driving, rate):
    base = driving(simulated=True)
    speeds = base.turns(0.45 / rate, rate=rate)
    assert min(speeds) > 0.99
    assert base.turns(1.0 / rate, rate=rate)[-1] == 0.0


@pytest.mark.parametrize('rate', [100, 20, 10, 5])
def test_the_ramp_is_as_fast_by_a_coarse_clock(rate):
    base = Base(Clocks(simulated=True, grain=S // rate))
    base.turns(1.0, twist=STOP)
    speeds = base.turns(1.5, twist=FORWARD)
    arrived = next(i for i, speed in enumerate(speeds) if speed > 0.99) * TICK / S
    assert arrived == pytest.approx(0.5, abs=max(0.06, 1.0 / rate))


def test_one_jump_of_simulated_time_is_no_grain(driving):
    base = driving(simulated=True)
    base.turns(3.0, twist=STOP)
    base.clocks.stamp += 10 * S
    assert base.turn(twist=FORWARD) < 0.09


def test_two_clocks_that_take_turns_make_no_lurch(driving):
    base = driving(simulated=True)
    base.turns(3.0, twist=STOP)
    speeds = [base.speed]
    for turn in range(40):
        base.clocks.stamp += (-1) ** turn * 95 * S
        speeds.append(base.turn(twist=FORWARD))
    assert max(b - a for a, b in zip(speeds, speeds[1:])) < 0.09


def test_after_a_freeze_the_ramp_begins_anew(driving):
    base = driving()
    base.clocks.pass_by(4 * S)
    speeds = base.turns(1.0, twist=FORWARD)
    assert speeds[0] == 0.0
    assert max(b - a for a, b in zip(speeds, speeds[1:])) < 2.0 * 0.041
    assert speeds[-1] == pytest.approx(1.0)


def test_feedback_that_stays_away_stops_it_in_the_end_whatever_the_clock_does(driving):
    base = driving(simulated=True)
    base.turns(9.0, twist=FORWARD, rate=0.0, feedback=False)
    assert base.speed == pytest.approx(1.0)
    base.turns(2.0, twist=FORWARD, rate=0.0, feedback=False)
    assert base.speed == 0.0


def test_what_never_came_is_older_than_any_timeout():
    now = Timeline(Clocks(), TIMEOUT, lambda: 0).now()
    assert min(now.age(LONG_AGO), now.feedback_age(LONG_AGO)) > 1e9 * S


def test_the_first_time_of_a_simulated_clock_comes_after_no_time():
    base = Base(Clocks(simulated=True))
    base.clocks.stamp = 0  # what the node's clock shows before the first message on /clock
    for _ in range(3):
        base.turn(twist=FORWARD, rate=0.0)
    commanded = base.timeline.now()
    base.clocks.stamp = 100 * S
    now = base.timeline.now()
    assert now.age(commanded) == 0
    assert base.drive.input.twist(now) == FORWARD and base.drive.has_feedback(now)
