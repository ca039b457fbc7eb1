"""Transitions of components that an event tries and takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model.semantics.edges import edges_by_event, origin
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.engine.interpreter import Engine
    from robosc.model import sct


class Transitions:
    """Transitions in the text of an engine's model. Edges that plants have only to not block an event are excluded."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        #: For each event, the edges that plants may take, each with the location that it leaves; None: all locations.
        self._edges = {
            event_name(event): [
                (plant, [(edge, origin(edge)) for edge in edges])
                for plant, edges in taking_part.items()
                if any(edge.source is not None for edge in edges)
            ]
            for event, taking_part in edges_by_event(engine.model.plants).items()
        }

    def attempts(self, event: str) -> Iterator[tuple[sct.Edge, bool]]:
        """Iterate over the transitions that an enabled event tries in the current state, and whether each is taken."""
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

    def taken_transitions(self, event: str) -> tuple[sct.Edge, ...]:
        """Return the transitions that an enabled event takes in the current state, with the current inputs."""
        return tuple(edge for edge, taken in self.attempts(event) if taken)
