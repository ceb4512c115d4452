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

"""Which of several publishers of the same joints is believed: no graph needed."""

import itertools
import math

import pytest

from swerve_kinematics.ros import joint_sources
from swerve_kinematics.ros.joint_sources import JointSources

JOINTS = ('a_drive', 'b_drive', 'a_steer', 'b_steer')
MS = 1_000_000  # ns


class Graph:
    """Publishers of a topic, and what reaches the node; numbered as a middleware does or not."""

    def __init__(self, monkeypatch, numbered=True, count=2):
        self.now, self.changes, self.count, self.numbered = 0, 0, count, numbered
        monkeypatch.setattr(joint_sources.time, 'monotonic_ns', lambda: self.now)
        self.use_gears(1.0)

    def use_gears(self, ratio):
        """Start anew, with joints that turn so many times as fast as wheels and modules."""
        self.sources = JointSources(
            dict.fromkeys(JOINTS, ratio), 500 * MS, lambda: self.count, self.changed)
        self.sources.report()

    def changed(self):
        self.changes += 1

    def publisher(self, names=JOINTS, first=1, step=1):
        """
        Return a function that publishes a position of all joints: is it believed.

        Of so many messages as `step` says, all but one are lost.
        """
        numbers = itertools.count(first, step)

        def publish(position):
            self.now += 5 * step * MS
            number = next(numbers)
            return self.sources.believes(
                names, [position] * len(names),
                {'publication_sequence_number': number if self.numbered else None})
        return publish


@pytest.fixture(params=[True, False], ids=['numbered', 'not numbered'])
def graph(monkeypatch, request):
    return Graph(monkeypatch, request.param)


@pytest.fixture
def numbered(monkeypatch):
    return Graph(monkeypatch)


@pytest.fixture
def alone(monkeypatch):
    return Graph(monkeypatch, count=1)


def test_one_publisher_is_believed_whatever_it_says(graph):
    graph.count = 1
    graph.sources.report()
    publish = graph.publisher()
    assert all(map(publish, (0.0, 1.0, 1e6, -3.0, 1.0)))


@pytest.mark.parametrize('is_reported', [True, False])
def test_who_was_alone_is_believed_though_a_placeholder_comes_before_its_next_message(
        alone, is_reported):
    driver, placeholder = alone.publisher(first=1000), alone.publisher()
    assert driver(10.0) and driver(10.0)
    alone.count = 2
    if is_reported:
        alone.sources.report()
    for _ in range(10):
        assert not placeholder(0.0)
        assert driver(10.0)


@pytest.mark.parametrize('is_reported', [True, False])
def test_who_was_alone_and_fell_silent_gives_way_to_who_comes_first(alone, is_reported):
    assert alone.publisher(first=1000)(10.0)
    alone.now += 10_000 * MS
    alone.count = 2
    if is_reported:
        alone.sources.report()
    driver, placeholder = alone.publisher(), alone.publisher()
    for _ in range(10):
        assert driver(20.0)
        assert not placeholder(0.0)


def test_who_was_alone_is_believed_though_messages_were_lost_before_another_one_came(alone):
    assert alone.publisher(first=1000)(10.0)
    alone.now += 300 * MS
    alone.count = 2
    assert alone.publisher(first=1060)(20.0)
    assert alone.changes == 0


def test_zeros_between_moving_states_are_not_believed(graph):
    driver, placeholder = graph.publisher(first=1000), graph.publisher()
    assert driver(10.0)
    for k in range(100):
        assert driver(10.0 + 0.3 * k)
        assert not placeholder(0.0)
    assert graph.sources.ignored == {joint_sources.REFUSED: 100}
    assert graph.changes == 0


@pytest.mark.parametrize('first', [1, 2, 5000])
def test_zeros_that_came_first_give_way_to_states_that_move(numbered, first):
    placeholder, driver = numbered.publisher(), numbered.publisher(first=first)
    assert placeholder(0.0)
    driver(10.0)
    for k in range(100):
        assert driver(10.1 + 0.3 * k)
        assert not placeholder(0.0)
    assert numbered.changes <= 1


def test_publishers_with_the_same_numbers_are_told_apart_by_their_values(numbered):
    driver, placeholder = numbered.publisher(), numbered.publisher()
    driver(1.0)
    for k in range(20):
        believed = driver(2.0 + 0.3 * k), placeholder(0.0)
    assert believed == (True, False)


@pytest.mark.parametrize('step', [0.05, 0.4])
@pytest.mark.parametrize('is_driver_first', [True, False])
def test_of_publishers_that_begin_alike_the_one_that_moves_is_believed(
        graph, is_driver_first, step):
    driver, placeholder = graph.publisher(), graph.publisher()
    for k in range(100):
        if is_driver_first:
            believed = driver(step * k), placeholder(0.0)
        else:
            believed = (placeholder(0.0), driver(step * k))[::-1]
    assert believed == (True, False)


def test_publishers_of_different_joints_are_all_believed(graph):
    drives, steerings = graph.publisher(JOINTS[:2]), graph.publisher(JOINTS[2:])
    assert all(drives(0.1 * k) and steerings(0.0) for k in range(50))
    assert graph.publisher(('arm',))(0.0)


def test_zeros_of_all_joints_give_way_to_publishers_of_some_each(numbered):
    placeholder = numbered.publisher()
    drives, steerings = numbered.publisher(JOINTS[:2]), numbered.publisher(JOINTS[2:])
    placeholder(0.0), steerings(0.0), drives(0.0), drives(0.1)
    assert not placeholder(0.0)
    assert drives(0.2) and steerings(0.0)
    assert not placeholder(0.0)


def test_a_placeholder_does_not_take_over_from_drivers_that_die(graph):
    driver, placeholder = graph.publisher(first=1000), graph.publisher()
    assert all(driver(10.0 + k * 0.1) and not placeholder(0.0) for k in range(5))
    graph.count = 1
    for _ in range(300):
        graph.sources.report()
        assert not placeholder(0.0)


@pytest.mark.parametrize('first', range(1, 8))
@pytest.mark.parametrize('lost', [None, 'driver', 'placeholder'])
def test_nor_if_a_message_is_lost_where_both_have_numbers_alike(numbered, first, lost):
    driver, placeholder = numbered.publisher(first=4), numbered.publisher(first=first)
    for k in range(30):
        if k == 10 and lost:  # numbered, but not heard
            believes, numbered.sources.believes = numbered.sources.believes, lambda *_: False
            {'driver': driver, 'placeholder': placeholder}[lost](0.0)
            numbered.sources.believes = believes
        assert driver(10.0 + k * 0.1) and not placeholder(0.0)
    assert not any(placeholder(0.0) for _ in range(300))


def test_drivers_that_are_started_again_are_believed(numbered):
    driver, placeholder = numbered.publisher(first=1000), numbered.publisher()
    assert all(driver(10.0 + k * 0.1) and not placeholder(0.0) for k in range(5))
    numbered.now += 1000 * MS
    assert not placeholder(0.0)
    driver = numbered.publisher()
    assert driver(50.0)
    assert not placeholder(0.0)
    assert driver(50.1)


@pytest.mark.parametrize('position', [10.0, 0.0])
def test_a_driver_that_is_started_again_at_once_is_believed_though_the_base_stands(
        numbered, position):
    driver = numbered.publisher(first=1000)
    assert driver(10.0) and driver(10.0)
    driver = numbered.publisher()
    believed = [driver(position) for _ in range(200)]
    assert not believed[0] and believed[-1]
    assert numbered.changes == 1


def test_a_driver_that_stands_is_not_taken_for_one_that_died_when_its_numbers_meet(numbered):
    driver = numbered.publisher(first=1000)
    assert driver(10.0) and driver(10.0)
    driver = numbered.publisher()
    believed = [driver(10.0) for _ in range(1200)]
    assert all(believed[200:])
    assert numbered.changes == 1


def test_an_encoder_that_is_reset_stays_in_the_story_of_its_publisher(numbered):
    drives, steerings = numbered.publisher(JOINTS[:2]), numbered.publisher(JOINTS[2:])
    assert drives(1000.0) and steerings(0.0) and drives(0.0) and drives(0.1)


@pytest.mark.parametrize('reading', [
    lambda way: math.remainder(way, math.tau), lambda way: way % math.tau,
    lambda way: math.remainder(way, 2.0 * math.tau)], ids=['+-pi', '0 to 2 pi', '+-2 pi'])
def test_a_joint_that_wraps_stays_in_the_story_of_its_publisher(graph, reading):
    drives, steerings = graph.publisher(JOINTS[:2], step=2), graph.publisher(JOINTS[2:])
    assert all(drives(reading(0.1 + 0.4 * k)) and steerings(0.0) for k in range(100))


def test_a_fast_motor_before_a_gear_stays_in_the_story_of_its_publisher(graph):
    graph.use_gears(5.08)
    drives, steerings = graph.publisher(JOINTS[:2], step=2), graph.publisher(JOINTS[2:])
    assert all(drives(4.0 * k) and steerings(0.0) for k in range(100))


def test_publishers_that_come_and_go_do_not_fill_the_memory(numbered):
    for k in range(1000):
        numbered.publisher((f'other_{k}', *JOINTS))(float(k))
    assert len(numbered.sources._stories) <= joint_sources.REMEMBERED_STORIES
