"""Data that a node stores, followed event by event, for inputs that the node computes from it."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any

from robosc.engine.transitions import Transitions
from robosc.model.semantics.messages import reads_stored, receptions, sent_messages, sent_values
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.roles import event_name
from robosc.run.runtime.core.node_data import within_range

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.engine import Engine
    from robosc.engine.state import Value
    from robosc.model import expression as ex
    from robosc.model import rosgraph
    from robosc.run.runtime.core.node_data import NodeData

    #: Stored values by their variables.
    Stored = Mapping[rosgraph.NodeVariable, Any]


class TrackedData:
    """Follows the variables of a node through the events of a run. `node` holds their present values.

    It follows nothing if no input of the supervisor depends on them.
    """

    def __init__(self, engine: Engine, graph: rosgraph.RosGraph, node: NodeData) -> None:
        values = [assignment.value for reception in receptions(graph) for assignment in reception.inputs]
        for sending in (sending for _, _, sending in sent_messages(graph) if sending.inputs):
            values += [*(assignment.value for assignment in sending.inputs), *sent_values(sending)]
        self.is_needed = any(map(reads_stored, values))
        self._engine = engine
        self._node = node
        self._reactions: dict[str, list[rosgraph.Reaction]] = {}
        if self.is_needed:
            self._transitions = Transitions(engine)
            for reaction in graph.reactions:
                self._reactions.setdefault(event_name(reaction.event), []).append(reaction)

    @property
    def values(self) -> Stored:
        """The present values."""
        return dict(self._node.variables) if self.is_needed else {}

    @values.setter
    def values(self, stored: Stored) -> None:
        self._node.variables.update(stored)

    def before(self, event: str, inputs: Mapping[str, Value], received: Callable[[ex.Expression], Any]) -> None:
        """Change the values as an event does that is about to happen with these inputs.

        The transitions that components take decide which values change. `received` returns the event's data as an
        expression reads it. A value that cannot be read does not change.
        """
        reactions = self._reactions.get(event, ())
        if not reactions:
            return
        self._engine.set_inputs(event, inputs)
        taken = {(edge.source, edge.eContainer()) for edge in self._transitions.taken_transitions(event)}
        changed: dict[rosgraph.NodeVariable, Any] = {}
        for reaction in reactions:
            if any((reaction.source, location) in taken for location in reaction.locations):
                for assigned in reaction.assignments:
                    with suppress(UnreadableError):
                        value = self._node.value(assigned.value, received(assigned.value))
                        changed[assigned.variable] = within_range(value, assigned.variable.type)
        self._node.variables.update(changed)
