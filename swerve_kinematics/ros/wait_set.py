"""What an executor waits for: gathered once from the nodes, and waited for again and again."""

from collections.abc import Callable
from contextlib import ExitStack
from typing import Any, NamedTuple

from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.node import Node
from rclpy.waitable import NumberOfEntities

# A node's entities, in the order in which those that are ready are called; what the wait set
# calls their kind; and the method of rclpy's Executor that takes one.
KINDS = (('timers', 'timer', '_take_timer'),
         ('subscriptions', 'subscription', '_take_subscription'),
         ('guards', 'guard_condition', '_take_guard_condition'),
         ('clients', 'client', '_take_client'), ('services', 'service', '_take_service'))


class Entry(NamedTuple):
    """Something to wait for, and what to call once it is ready."""

    entity: Any
    call: Callable[[], None]


class WaitSet:
    """
    A wait set of all that some nodes have at one moment; none of it is destroyed before `close`.

    Parameters
    ----------
    nodes : list of rclpy.node.Node
        Whose entities it holds.
    guards : list
        Handles of the executor's own guard conditions.
    context : rclpy.context.Context
        Of the nodes.
    can_execute : callable
        Tells of an entity whether it may be called at present; others are left out.
    call_for : callable
        Returns what to call for an entity of a node, and the name of the method that takes it.

    """

    def __init__(self, nodes: list[Node], guards: list[Any], context: Any,
                 can_execute: Callable[[Any], bool],
                 call_for: Callable[[Any, Node, str], Callable[[], None]]) -> None:
        """Gather the entities."""
        self._held, self._can_execute = ExitStack(), can_execute
        self._entities: dict[Any, dict[int, Entry]] = {kind: {
            entity.handle.pointer: Entry(entity, call_for(entity, node, take)) for node in nodes
            for entity in getattr(node, name) if self._holds(entity, entity.handle)}
            for name, kind, take in KINDS}
        self._waitables = [
            Entry(waitable, call_for(waitable, node, '_take_waitable')) for node in nodes
            for waitable in node.waitables if self._holds(waitable, waitable)]
        for handle in (*guards, context.handle):
            self._held.enter_context(handle)
        self._set = _rclpy.WaitSet(*self._sizes(len(guards)), context.handle)
        self._additions = [(getattr(self._set, f'add_{kind}'), entry.entity.handle)
                           for kind, entries in self._entities.items()
                           for entry in entries.values()]
        self._additions += [(self._set.add_guard_condition, handle) for handle in guards]

    def _holds(self, entity: Any, handle: Any) -> bool:
        """Tell whether an entity can be called, and if so keep it from being destroyed."""
        try:
            return self._can_execute(entity) and (self._held.enter_context(handle) or True)
        except _rclpy.InvalidHandle:
            return False

    def _sizes(self, guard_count: int) -> tuple[int, int, int, int, int, int]:
        """Return how many entities of each kind there are."""
        size = {kind: len(entities) for kind, entities in self._entities.items()}
        count = NumberOfEntities(size['subscription'], size['guard_condition'] + guard_count,
                                 size['timer'], size['client'], size['service'])
        for waitable, *_ in self._waitables:
            count += waitable.get_num_entities()
        return (count.num_subscriptions, count.num_guard_conditions, count.num_timers,
                count.num_clients, count.num_services, count.num_events)

    def wait(self, nanoseconds: int) -> list[int]:
        """
        Wait until something is ready, at most for a time [ns]; without end if negative.

        Returns
        -------
        list of int
            Pointers of the guard conditions that were triggered.

        """
        # Waiting takes out of the set what is not ready.
        self._set.clear_entities()
        for add, handle in self._additions:
            add(handle)
        for waitable, *_ in self._waitables:
            waitable.add_to_wait_set(self._set)
        self._set.wait(nanoseconds)
        triggered: list[int] = self._set.get_ready_entities('guard_condition')
        return triggered

    def ready(self) -> list[Entry]:
        """Return what the last wait has found ready."""
        found = [waitable for waitable in self._waitables if waitable.entity.is_ready(self._set)]
        for kind, entries in self._entities.items():
            if entries:
                found += [entries[pointer] for pointer in self._set.get_ready_entities(kind)
                          if pointer in entries]
        return found

    def close(self) -> None:
        """Let go of everything."""
        self._held.close()
