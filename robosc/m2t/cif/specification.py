"""What the templates of CIF print: an sct model with every name and expression as text."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import groupby
from math import prod
from textwrap import wrap
from typing import TYPE_CHECKING

from robosc.m2t.cif.arithmetic import assigned, condition, held
from robosc.m2t.cif.expressions import CifPrinter
from robosc.m2t.cif.linear import bounds, shift
from robosc.m2t.cif.names import CifNames, is_numbered
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.metamodel.reflection import tree
from robosc.semantics.edges import edges_from, edges_of
from robosc.semantics.roles import provide_numbers

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence


_NOTHING_ADDED = "Synthesis added nothing to the requirements."
#: Characters in a line, unless one word has more.
_WIDTH = 120
#: What stands in one line: up to a comma or one of these words, outside of strings.
_PART = re.compile(
    r'(?:"(?:[^"\\]|\\.)*"|[^\s"]|(?<!,)[ ](?!(?:and|or|=>|elif|else|when|do|goto|needs|disables|[+-])[ ]))+'
)


@dataclass(frozen=True)
class Enumeration:
    """An enumeration and its literals."""

    name: str
    literals: Sequence[str]


@dataclass(frozen=True)
class Events:
    """Events that are declared together, being alike."""

    controllable: bool
    docs: Sequence[str]
    names: Sequence[str]


@dataclass(frozen=True)
class Variable:
    """A variable, or an input without `initial`; `docs` where CIF holds another value than the model has."""

    type: str
    name: str
    initial: str
    docs: Sequence[str]


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
    """A requirement, of the model or as the supervisor keeps it; `docs` are its meaning in the robot model's words."""

    event: str
    kind: str
    condition: str
    docs: Sequence[str]


@dataclass(frozen=True)
class Specification:
    """A specification. The supervisor's parts are empty where there is none."""

    docs: Sequence[str]
    supervised_docs: Sequence[str]
    added_docs: Sequence[str]
    enumerations: Sequence[Enumeration]
    plants: Sequence[Plant]
    requirements: Sequence[Restriction]
    kept: Sequence[Restriction]
    supervisor: str
    edges: Sequence[Edge]


class Writer:
    """Makes a specification of an sct model. Raises Unsupported for an expression that can't be said in CIF."""

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self._model = model
        self._names = CifNames(model)
        self._outside = CifPrinter(self._names, None)
        self._impossible = impossible(model)
        self._meanings = {**_transitions(model), **_choices(model)}
        #: Of all locations, the number in their plant.
        self._numbers = {location: number for plant in model.plants for number, location in enumerate(plant.locations)}
        self._referred = {
            reference.location for _, reference in tree(model) if isinstance(reference, sct.LocationReference)
        }

    def specification(self) -> Specification:
        """All of it."""
        model, supervisor = self._model, self._model.supervisor
        guards = [guard for guard in supervisor.guards if guard.event not in self._impossible] if supervisor else []
        return Specification(
            docs=[quoted(f"The plants and requirements of {model.name}.")],
            supervised_docs=self._counted(),
            added_docs=[
                quoted("What synthesis added." if any(guard.synthesis for guard in guards) else _NOTHING_ADDED)
            ],
            enumerations=[
                Enumeration(
                    self._names.declared(enumeration),
                    [self._names.declared(literal) for literal in enumeration.literals],
                )
                for enumeration in model.enumerations
            ],
            plants=[self.plant(plant) for plant in model.plants],
            requirements=self.requirements(),
            kept=[
                Restriction(self._names.used(guard.event, None), "needs", self._condition(guard.requirement), ())
                for guard in guards
                if guard.requirement is not None
            ],
            supervisor=self._names.supervisor,
            edges=[
                Edge(self._names.used(guard.event, None), self._condition(guard.synthesis), (), "") for guard in guards
            ],
        )

    def requirements(self) -> list[Restriction]:
        """The requirements of the model; what several of them ask of an event alike stands there once."""
        texts: dict[tuple[str, str, str], list[str]] = {}
        for requirement in self._model.requirements:
            said = (
                self._names.used(requirement.event, None),
                str(requirement.kind),
                self._condition(requirement.condition),
            )
            texts.setdefault(said, []).append(requirement.text or "")
        return [
            Restriction(*said, list(map(quoted, dict.fromkeys(filter(None, found))))) for said, found in texts.items()
        ]

    def plant(self, plant: sct.Plant) -> Plant:
        """A plant with all that is in it."""
        printer = CifPrinter(self._names, plant)
        return Plant(
            name=self._names.declared(plant),
            events=[
                Events(controllable, docs, [self._names.declared(event) for event in events])
                for (controllable, docs), events in groupby(
                    self._possible(plant), key=lambda event: (event.controllable, self._meanings.get(event, ()))
                )
            ],
            inputs=[self._variable(parameter, "") for parameter in plant.inputs],
            variables=[
                *(self._variable(variable, printer(held(variable))) for variable in plant.variables),
                *self._number(plant),
            ],
            locations=[
                self._location(location, plant, printer)
                for location in (plant.locations[:1] if is_numbered(plant) else plant.locations)
            ],
        )

    def _counted(self) -> list[str]:
        """What the supervisor leaves of the plants, as it is counted here and in CIF."""
        supervisor = self._model.supervisor
        if supervisor is None:
            return []
        inputs = prod(_values(parameter) for plant in self._model.plants for parameter in plant.inputs)
        left, all_of = supervisor.controlledStates, supervisor.uncontrolledStates
        name = self._model.name
        if left is None or all_of is None:  # A supervisor of a saved model need not have been counted.
            return [quoted(f"The plants of {name} under their supervisor.")]
        told = [f"The plants of {name} under their supervisor, which leaves them {left} of {all_of} states."]
        if inputs > 1:
            told.append(
                f"CIF counts {left * inputs} of {all_of * inputs}: each of them with the {inputs} values of the inputs."
            )
        return list(map(quoted, told))

    def _possible(self, plant: sct.Plant) -> list[sct.Event]:
        return [event for event in plant.events if event not in self._impossible]

    def _condition(self, expression: ex.Expression | None) -> str:
        return "" if expression is None else self._outside(condition(expression))

    def _variable(self, variable: sct.DiscreteVariable | sct.Input, initial: str) -> Variable:
        name = self._names.declared(variable)
        kind, docs = "bool", []
        if isinstance(variable.type, ex.EnumerationType):
            kind = self._names.declared(variable.type.enumeration)
        elif isinstance(variable.type, ex.IntegerType):
            (low, high), up = bounds(variable), shift(variable)
            kind = f"int[{low + up}..{high + up}]"
            if up:
                docs = [quoted(f"{name} + {up}, with {name} in {low}..{high}")]
        return Variable(kind, name, initial, docs)

    def _number(self, plant: sct.Plant) -> Iterator[Variable]:
        name = self._names.number(plant)
        if name is not None:
            initial = next(str(number) for number, location in enumerate(plant.locations) if location.initial)
            docs = [quoted("The number of the provide statement that is chosen, 0 for none.")]
            yield Variable(f"int[0..{len(plant.locations) - 1}]", name, initial, docs)

    def _location(self, location: sct.Location, plant: sct.Plant, printer: CifPrinter) -> Location:
        alone = plant.kind == sct.PlantKind.message and len(plant.locations) == 1
        nameless = is_numbered(plant) or (alone and location not in self._referred)
        return Location(
            name="" if nameless else self._names.declared(location),
            initial=location.initial or is_numbered(plant),
            marked=location.marked,
            edges=[
                self._edge(edge, location, plant, printer)
                for edge in edges_from(location)
                if edge.event not in self._impossible
            ],
        )

    def _edge(self, edge: sct.Edge, location: sct.Location, plant: sct.Plant, printer: CifPrinter) -> Edge:
        number = self._names.number(plant)
        updates = [
            f"{self._names.declared(update.variable)} := {printer(assigned(update.variable, update.value))}"
            for update in edge.updates
        ]
        if number is not None:
            updates.append(f"{number} := {self._numbers[edge.target]}")
        return Edge(
            event=self._names.used(edge.event, plant),
            guard="" if edge.guard is None else printer(condition(edge.guard)),
            updates=updates,
            target="" if edge.target is location or number is not None else self._names.declared(edge.target),
        )


def impossible(model: sct.SupervisoryControlModel) -> set[sct.Event]:
    """The events of which all edges have the guard `false` and which nothing else speaks of: they need not be said.

    So it is with `c_none` where a provide statement has no condition. CIF warns of an event that can never happen.
    """
    found = {event for plant in model.plants for event in plant.events}
    found -= {requirement.event for requirement in model.requirements}
    for plant in model.plants:
        for edge in edges_of(plant):
            never = isinstance(edge.guard, ex.BooleanLiteral) and not edge.guard.value
            if not never or edge.event.eContainer() is not plant:
                found.discard(edge.event)
    return found


def quoted(text: str) -> str:
    """A text as a string of CIF, in plain ASCII; a long one as a sum of strings, which can stand in several lines."""
    shown = " ".join(text.split()).encode("ascii", "backslashreplace").decode()
    shown = "".join(character if character.isprintable() else f"\\x{ord(character):02x}" for character in shown)
    parts = wrap(shown, _WIDTH - 10, drop_whitespace=False, break_on_hyphens=False)
    return " + ".join('"' + part.replace("\\", "\\\\").replace('"', '\\"') + '"' for part in parts)


def folded(text: str) -> str:
    """A specification in lines of a length that can be read; a break takes the place of a space."""
    return "".join(_folded(line) for line in text.splitlines(keepends=True))


def _folded(line: str) -> str:
    if len(line) <= _WIDTH + 1:
        return line
    indent = " " * (len(line) - len(line.lstrip()))
    made, length = [indent], len(indent)
    for number, part in enumerate(_PART.findall(line.strip())):
        if number and length + 1 + len(part) > _WIDTH:
            made.append(f"\n{indent}  {part}")
            length = len(indent) + 2 + len(part)
        else:
            made.append(f" {part}" if number else part)
            length += len(part) + 1
    return "".join(made) + "\n"


def _transitions(model: sct.SupervisoryControlModel) -> dict[sct.Event, tuple[str, ...]]:
    """What each transition of a component by itself does, whose event has no name but a number."""
    steps: dict[sct.Event, dict[str, None]] = {}
    edges = (edge for plant in model.plants for location in plant.locations for edge in location.edges)
    for edge in edges:
        if edge.event.kind == sct.EventKind.tau:
            here, there = edge.eContainer().name, edge.target.name
            steps.setdefault(edge.event, {})[f"in {here}" if here == there else f"from {here} to {there}"] = None
    return {
        event: (quoted(f"A transition of {event.eContainer().origin or event.eContainer().name} {', '.join(steps)}."),)
        for event, steps in steps.items()
    }


def _choices(model: sct.SupervisoryControlModel) -> dict[sct.Event, tuple[str, ...]]:
    """Which statement of the model each choice of data stands for."""
    plants = (plant for plant in model.plants if plant.kind == sct.PlantKind.data)
    numbers = {event: number for plant in plants for event, number in provide_numbers(plant).items()}
    return {
        event: (quoted(f"The choice of provide {number} for {event.eContainer().origin or event.eContainer().name}."),)
        for event, number in numbers.items()
        if number
    }


def _values(member: sct.Input) -> int:
    match member.type:
        case ex.EnumerationType():
            return len(member.type.enumeration.literals)
        case ex.IntegerType():
            low, high = bounds(member)
            return high - low + 1
    return 2
