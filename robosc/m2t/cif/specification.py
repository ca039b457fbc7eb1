"""What the templates of CIF print: an sct model with every name and expression as text."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING

from robosc.m2t.cif.arithmetic import assigned, condition, held
from robosc.m2t.cif.expressions import CifPrinter
from robosc.m2t.cif.linear import bounds, shift
from robosc.m2t.cif.names import CifNames
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.metamodel.reflection import tree

if TYPE_CHECKING:
    from collections.abc import Sequence


@dataclass(frozen=True)
class Enumeration:
    """An enumeration and its literals."""

    name: str
    literals: Sequence[str]


@dataclass(frozen=True)
class Events:
    """Events that are declared together, being alike."""

    controllable: bool
    names: Sequence[str]


@dataclass(frozen=True)
class Variable:
    """A variable, or an input without `initial`; `remark` where CIF holds another value than the model has."""

    type: str
    name: str
    initial: str
    remark: str


@dataclass(frozen=True)
class Edge:
    """An edge; `guard`, `updates` and `target` are empty where there is nothing to say."""

    event: str
    guard: str
    updates: Sequence[str]
    target: str


@dataclass(frozen=True)
class Location:
    """A location; without a name where it is alone and nothing refers to it."""

    name: str
    initial: bool
    marked: bool
    edges: Sequence[Edge]


@dataclass(frozen=True)
class Plant:
    """A plant."""

    name: str
    events: Sequence[Events]
    inputs: Sequence[Variable]
    variables: Sequence[Variable]
    locations: Sequence[Location]


@dataclass(frozen=True)
class Restriction:
    """A requirement, of the model or as the supervisor keeps it; `texts` are its meaning in the robot model's words."""

    event: str
    kind: str
    condition: str
    texts: Sequence[str]


@dataclass(frozen=True)
class Specification:
    """A specification. The supervisor's parts are empty where there is none."""

    name: str
    enumerations: Sequence[Enumeration]
    plants: Sequence[Plant]
    requirements: Sequence[Restriction]
    kept: Sequence[Restriction]
    supervisor: str
    edges: Sequence[Edge]
    states: str


class Writer:
    """Makes a specification of an sct model. Raises Unsupported for an expression that can't be said in CIF."""

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._model = model
        self._names = CifNames(model)
        self._outside = CifPrinter(self._names, None)
        self._impossible = impossible(model)
        self._referred = {each.location for _, each in tree(model) if isinstance(each, sct.LocationReference)}

    def specification(self) -> Specification:
        """All of it."""
        model, supervisor = self._model, self._model.supervisor
        guards = [each for each in supervisor.guards if each.event not in self._impossible] if supervisor else []
        return Specification(
            name=model.name,
            enumerations=[
                Enumeration(self._names.declared(each), [self._names.declared(literal) for literal in each.literals])
                for each in model.enumerations
            ],
            plants=[self.plant(each) for each in model.plants],
            requirements=self.requirements(),
            kept=[
                Restriction(self._names.used(each.event, None), "needs", self._condition(each.requirement), ())
                for each in guards
                if each.requirement is not None
            ],
            supervisor=self._names.supervisor,
            edges=[
                Edge(self._names.used(each.event, None), self._condition(each.synthesis), (), "") for each in guards
            ],
            states=f"{supervisor.controlledStates} of {supervisor.uncontrolledStates}" if supervisor else "",
        )

    def requirements(self) -> list[Restriction]:
        """The requirements of the model; what several of them ask of an event alike stands there once."""
        texts: dict[tuple[str, str, str], list[str]] = {}
        for each in self._model.requirements:
            said = self._names.used(each.event, None), str(each.kind), self._condition(each.condition)
            texts.setdefault(said, []).append(remark(each.text))
        return [Restriction(*said, list(dict.fromkeys(filter(None, found)))) for said, found in texts.items()]

    def plant(self, plant: sct.Plant) -> Plant:
        """A plant with all that is in it."""
        printer = CifPrinter(self._names, plant)
        return Plant(
            name=self._names.declared(plant),
            events=[
                Events(controllable, [self._names.declared(each) for each in events])
                for controllable, events in groupby(self._possible(plant), key=lambda each: each.controllable)
            ],
            inputs=[self._variable(each, "") for each in plant.inputs],
            variables=[self._variable(each, printer(held(each))) for each in plant.variables],
            locations=[self._location(each, plant, printer) for each in plant.locations],
        )

    def _possible(self, plant: sct.Plant) -> list[sct.Event]:
        return [each for each in plant.events if each not in self._impossible]

    def _condition(self, expression: ex.Expression | None) -> str:
        return "" if expression is None else self._outside(condition(expression))

    def _variable(self, variable: sct.DiscreteVariable | sct.Input, initial: str) -> Variable:
        name = self._names.declared(variable)
        kind, note = "bool", ""
        if isinstance(variable.type, ex.EnumerationType):
            kind = self._names.declared(variable.type.enumeration)
        elif isinstance(variable.type, ex.IntegerType):
            (low, high), up = bounds(variable), shift(variable)
            kind = f"int[{low + up}..{high + up}]"
            note = f"{name} + {up}, with {name} in {low}..{high}" if up else ""
        return Variable(kind, name, initial, note)

    def _location(self, location: sct.Location, plant: sct.Plant, printer: CifPrinter) -> Location:
        alone = plant.kind == sct.PlantKind.message and len(plant.locations) == 1
        return Location(
            name="" if alone and location not in self._referred else self._names.declared(location),
            initial=location.initial,
            marked=location.marked,
            edges=[
                self._edge(each, location, plant, printer)
                for each in location.edges
                if each.event not in self._impossible
            ],
        )

    def _edge(self, edge: sct.Edge, location: sct.Location, plant: sct.Plant, printer: CifPrinter) -> Edge:
        return Edge(
            event=self._names.used(edge.event, plant),
            guard="" if edge.guard is None else printer(condition(edge.guard)),
            updates=[
                f"{self._names.declared(each.variable)} := {printer(assigned(each.variable, each.value))}"
                for each in edge.updates
            ],
            target="" if edge.target is location else self._names.declared(edge.target),
        )


def impossible(model: sct.SupervisoryControlModel) -> set[sct.Event]:
    """The events of which all edges have the guard `false` and which nothing else speaks of: they need not be said.

    So it is with `c_none` where a provide statement has no condition. CIF warns of an event that can never happen.
    """
    found = {event for plant in model.plants for event in plant.events}
    found -= {each.event for each in model.requirements}
    for plant in model.plants:
        for edge in (edge for location in plant.locations for edge in location.edges):
            never = isinstance(edge.guard, ex.BooleanLiteral) and not edge.guard.value
            if not never or edge.event.eContainer() is not plant:
                found.discard(edge.event)
    return found


def remark(text: str | None) -> str:
    """A text in one line of plain ASCII, which no comment can end."""
    shown = " ".join((text or "").split()).encode("ascii", "backslashreplace").decode()
    return "".join(each if each.isprintable() else f"\\x{ord(each):02x}" for each in shown)
