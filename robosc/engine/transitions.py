"""The transitions of components that are tried and taken as an event happens."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.semantics.edges import edges_by_event, origin
from robosc.semantics.evaluation import evaluate
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.engine.interpreter import Engine
    from robosc.metamodel import sct


class Transitions:
    """Those of an engine's model that its author wrote; what plants do besides, so as not to block, is none."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        #: Of each event the transitions that plants may take, each with the location that it leaves, if not any.
        self._edges = {
            event_name(event): [
                (plant, [(edge, origin(edge)) for edge in edges])
                for plant, edges in taking_part.items()
                if any(edge.source is not None for edge in edges)
            ]
            for event, taking_part in edges_by_event(engine.model.plants).items()
        }

    def tried(self, event: str) -> Iterator[tuple[sct.Edge, bool]]:
        """What an enabled event tries in the present state, with the inputs that are set, and whether it is taken."""
        for plant, edges in self._edges.get(event, ()):
            here = plant.locations[self._engine.location(plant)]
            for edge, left in edges:
                if left is not None and left is not here:
                    continue
                taken = edge.guard is None or bool(evaluate(edge.guard, self._engine.read))
                if edge.source is not None:
                    yield edge, taken
                if taken:
                    break

    def taken(self, event: str) -> tuple[sct.Edge, ...]:
        """What an enabled event takes in the present state, with the inputs that are set."""
        return tuple(edge for edge, taken in self.tried(event) if taken)
