"""Why a command can't be sent in the present state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.semantics.edges import edges_by_event, edges_from
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.engine import Engine
    from robosc.metamodel import rosgraph, sct
    from robosc.runtime.core.node_data import NodeData

#: How a sentence on each kind of reason begins; the texts of the reasons follow.
_SAID = {
    "requirement": ("forbidden", ": "),
    "state": ("not possible", " in "),
    "synthesis": ("forbidden by synthesis", ": "),
}


@dataclass(frozen=True)
class Reason:
    """What `~/blocked` tells: a kind, and the texts of that kind."""

    kind: str
    because: Sequence[str]

    def __str__(self) -> str:
        said, joint = _SAID[self.kind]
        return said + (joint + ("; " if joint == ": " else ", ").join(self.because) if self.because else "")


class Blocking:
    """Looks for reasons: requirements that fail; else plants without a transition; else what synthesis prevents."""

    def __init__(self, graph: rosgraph.RosGraph, engine: Engine, data: NodeData) -> None:
        self.engine = engine
        self.data = data
        assert graph.model.supervisor is not None
        guards = graph.model.supervisor.guards
        self._edges = edges_by_event(graph.model.plants)
        self._explained = {guard.event: [guard.explanation] for guard in guards if guard.explanation}

    def reason(self, event: sct.Event) -> Reason:
        """Why an event is blocked that the supervisor does not let happen now."""
        failing = self.engine.failing(event_name(event))
        if failing:
            return Reason("requirement", [requirement.text or "a requirement" for requirement in failing])
        missing = [place for plant in self._edges.get(event, ()) for place in self._missing(plant, event)]
        return Reason("state", missing) if missing else Reason("synthesis", self._explained.get(event, []))

    def _missing(self, plant: sct.Plant, event: sct.Event) -> list[str]:
        """The location of a plant that takes part in the event, where it has no transition for it."""
        here = next(location for location in plant.locations if self.data.is_in(location))
        possible = any(
            edge.event == event and (edge.guard is None or self.data.value(edge.guard)) for edge in edges_from(here)
        )
        return [] if possible else [f"{plant.origin or plant.name}.{here.name}"]
