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

"""What an executor waits for: gathered once from the nodes, and waited for again and again."""

from collections.abc import Callable
from contextlib import ExitStack
from time import monotonic_ns
from typing import Any, NamedTuple

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.node import Node
from rclpy.waitable import NumberOfEntities

from swerve_kinematics.ros.stamps import nanoseconds

# A node's entities, in the order in which those that are ready are called; what the wait set
# calls their kind; and the method of rclpy's Executor that takes one.
KINDS = (('timers', 'timer', '_take_timer'),
         ('subscriptions', 'subscription', '_take_subscription'),
         ('guards', 'guard_condition', '_take_guard_condition'),
         ('clients', 'client', '_take_client'), ('services', 'service', '_take_service'))
# To wait for an entity costs something at every wake-up, and a node has more services than all
# else together. While it wakes at intervals shorter than STREAM [ns], services, clients, events,
# actions, rclpy's Ctrl-C and all that is Unhurried are looked at once in RARELY [ns] only.
RARE_KINDS = ('client', 'service')
STREAM, RARELY = nanoseconds(0.015), nanoseconds(0.05)
# A method of the wait set, and the handle that it adds.
Addition = tuple[Callable[[Any], Any], Any]


class Unhurried(MutuallyExclusiveCallbackGroup):
    """The callback group of timers and subscriptions that can wait a moment, as services do."""

    def __init__(self) -> None:
        """Start without an entity."""
        super().__init__()  # type: ignore[no-untyped-call, unused-ignore]


class Entry(NamedTuple):
    """Something to wait for, and what to call once it is ready."""

    entity: Any
    call: Callable[[], object]


class WaitSet:
    """
    A wait set of all that some nodes have at one moment; none of it is destroyed before `close`.

    Parameters
    ----------
    nodes : list of rclpy.node.Node
        Whose entities it holds.
    guards : list
        Handles of the executor's own guard conditions: what wakes it, and then those of rclpy.
    context : rclpy.context.Context
        Of the nodes.
    can_execute : callable
        Tells of an entity whether it may be called at present; others are left out.
    call_for : callable
        Returns what to call for an entity, by its node and the names of the node's entities of
        this kind and of the method that takes it.

    """

    def __init__(self, nodes: list[Node], guards: list[Any], context: Any,
                 can_execute: Callable[[Any], bool],
                 call_for: Callable[[Any, Node, str, str], Callable[[], object]]) -> None:
        """Gather the entities."""
        self._held, self._can_execute = ExitStack(), can_execute
        self._entries: list[tuple[str, dict[int, Entry]]] = [(kind, {
            entity.handle.pointer: Entry(entity, call_for(entity, node, name, take))
            for node in nodes for entity in getattr(node, name)
            if self._holds(entity, entity.handle)})
            for name, kind, take in KINDS]
        self._frequent_entries = [
            (kind, entries) for kind, entries in self._entries if kind not in RARE_KINDS]
        self._waitables = [
            Entry(waitable, call_for(waitable, node, 'waitables', '_take_waitable'))
            for node in nodes for waitable in node.waitables if self._holds(waitable, waitable)]
        for handle in (*guards, context.handle):
            self._held.enter_context(handle)
        self._set: Any = _rclpy.WaitSet(*self._sizes(len(guards)), context.handle)
        additions: list[Addition] = [(self._set.add_guard_condition, handle) for handle in guards]
        self._additions, self._rare_additions = additions[:1], additions[1:]
        for kind, entries in self._entries:
            add = getattr(self._set, f'add_{kind}')
            for entity, _ in entries.values():
                is_rare = kind in RARE_KINDS or isinstance(entity.callback_group, Unhurried)
                (self._rare_additions if is_rare else self._additions).append(
                    (add, entity.handle))
        for guard, _ in dict(self._entries)['guard_condition'].values():
            if guard._executor_triggered:  # and not called: an exception came in between, say
                guard.trigger()
        self._woke = self._looked = monotonic_ns()
        self._is_streaming = False

    def _holds(self, entity: Any, handle: Any) -> bool:
        """Tell whether an entity can be called, and if so keep it from being destroyed."""
        try:
            if not self._can_execute(entity):
                return False
            self._held.enter_context(handle)
        except _rclpy.InvalidHandle:
            return False
        return True

    def _sizes(self, guard_count: int) -> tuple[int, int, int, int, int, int]:
        """Return how many entities of each kind there are."""
        size = {kind: len(entries) for kind, entries in self._entries}
        count = NumberOfEntities(size['subscription'], size['guard_condition'] + guard_count,
                                 size['timer'], size['client'], size['service'])
        for waitable, *_ in self._waitables:
            count += waitable.get_num_entities()
        return (count.num_subscriptions, count.num_guard_conditions, count.num_timers,
                count.num_clients, count.num_services, count.num_events)

    def wait(self, timeout: int) -> tuple[list[Entry], bool]:
        """
        Wait until something is ready, at most for a time [ns]; without end if negative.

        Returns
        -------
        list of Entry
            What is ready: nothing at the end of the time, or of a stream of messages.
        bool
            Whether a guard condition was triggered.

        """
        looks_at_all = not self._is_streaming or self._woke - self._looked >= RARELY
        # Waiting takes out of the set what is not ready.
        self._set.clear_entities()
        for add, handle in self._additions:
            add(handle)
        if looks_at_all:
            for add, handle in self._rare_additions:
                add(handle)
            for waitable, _ in self._waitables:
                waitable.add_to_wait_set(self._set)
        elif not 0 <= timeout <= RARELY:
            timeout = RARELY
        self._set.wait(timeout)
        woke = monotonic_ns()
        self._is_streaming, self._woke = woke - self._woke < STREAM, woke
        ready: list[Entry] = []
        if looks_at_all:
            self._looked = woke
            ready += [entry for entry in self._waitables if entry.entity.is_ready(self._set)]
        triggered = False
        for kind, entries in self._entries if looks_at_all else self._frequent_entries:
            pointers = self._set.get_ready_entities(kind)
            if pointers:
                found = [entries[pointer] for pointer in pointers if pointer in entries]
                ready += found
                if kind == 'guard_condition':
                    triggered = True
                    for guard, _ in found:
                        guard._executor_triggered = True  # until it is taken
        return ready, triggered

    def close(self) -> None:
        """Let go of everything."""
        self._held.close()
