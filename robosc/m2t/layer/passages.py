"""What the controller sends: each passes the supervisor, or is blocked for a reason that is told."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.cpp.expressions import CppPrinter
from robosc.metamodel import sct
from robosc.semantics.edges import edges_from
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from robosc.m2t.cpp.names import CppNames


@dataclass(frozen=True)
class Reason:
    """A reason as an expression of C++ (a text), and the condition under which it is one."""

    condition: str
    text: str


@dataclass(frozen=True)
class Passage:
    """What the controller sends: a word fit for names, the event's enumerator, its communication in the model."""

    word: str
    event: str
    name: str
    #: The requirements on it, as the model has them.
    requirements: list[str]
    #: Where a requirement fails.
    failing: list[Reason]
    #: Where a component or a communication has no transition for it.
    missing: list[Reason]
    #: What would follow if synthesis did not forbid it, as a literal of C++.
    explanation: str | None


class Passages:
    """The passages of one sct model."""

    def __init__(self, model: sct.SupervisoryControlModel, names: CppNames) -> None:
        self._model = model
        self._names = names
        self._printer = CppPrinter(names)

    def __call__(self, event: sct.Event) -> Passage:
        """How an event is passed or blocked."""
        plant = plant_of(event)
        mine = [each for each in self._model.requirements if each.event == event]
        guards = self._model.supervisor.guards if self._model.supervisor else ()
        return Passage(
            self._names.c.member(plant),
            self._names.c.enumerator(event),
            plant.origin or plant.name,
            [each.text for each in mine if each.text],
            [Reason(self._failing(each), string_literal(each.text or "a requirement")) for each in mine],
            [each for plant in self._model.plants for each in self._missing(plant, event)],
            next(
                (string_literal(each.explanation) for each in guards if each.event == event and each.explanation), None
            ),
        )

    def _failing(self, requirement: sct.Requirement) -> str:
        holds = self._printer(requirement.condition)
        return holds if requirement.kind == sct.RequirementKind.disables else f"!({holds})"

    def _missing(self, plant: sct.Plant, event: sct.Event) -> list[Reason]:
        """That a plant which takes part in the event can't, with its location."""
        edges = {location: edge for location in plant.locations for edge in edges_from(location) if edge.event == event}
        if not edges or (len(edges) == len(plant.locations) and not any(edge.guard for edge in edges.values())):
            return []
        possible = " || ".join(self._taken(location, edge) for location, edge in edges.items())
        origin = plant.origin or plant.name
        if len(plant.locations) == 1:
            text = string_literal(f"{origin}.{plant.locations[0].name}")
        else:
            location = f"{self._names.c.lookup(plant)}({self._names.state(plant)})"
            text = f"std::string({string_literal(origin + '.')}) + {location}"
        return [Reason(f"!({possible})", text)]

    def _taken(self, location: sct.Location, edge: sct.Edge) -> str:
        here = self._names.is_in(location)
        return here if edge.guard is None else f"({here} && {self._printer.tight(edge.guard)})"
