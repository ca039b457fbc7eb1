"""The text of CIF for an sct model, plant by plant and line by line."""

from __future__ import annotations

import re
from itertools import groupby
from textwrap import wrap
from typing import TYPE_CHECKING

from robosc.m2t.cif.arithmetic import assigned, condition, held
from robosc.m2t.cif.expressions import CifPrinter
from robosc.m2t.cif.linear import bounds, shift
from robosc.m2t.cif.names import CifNames, is_numbered
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.metamodel.reflection import tree
from robosc.semantics.durations import timer_text
from robosc.semantics.edges import edges_from, edges_of
from robosc.semantics.roles import input_values, provide_numbers

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

#: Characters in a line, unless one word has more.
_WIDTH = 120
#: What stands in one line: up to a comma or one of these words, outside of strings.
_PART = re.compile(
    r'(?:"(?:[^"\\]|\\.)*"|[^\s"]|(?<!,)[ ](?!(?:and|or|=>|elif|else|when|do|goto|needs|disables|[+-])[ ]))+'
)


class Writer:
    """Writes CIF of one sct model. Raises Unsupported for an expression that can't be said in CIF."""

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

    def unsupervised(self) -> str:
        """The plants and the requirements."""
        lines = document([f"The plants and requirements of {self._model.name}."], sign="@@")
        return folded([*lines, *self._plants(), *self._requirements()])

    def supervised(self, supervisor: sct.Supervisor) -> str:
        """The plants under their supervisor: the requirements as it keeps them, and an automaton of what it adds."""
        guards = [guard for guard in supervisor.guards if guard.event not in self._impossible]
        events = [self._names.used(guard.event, None) for guard in guards]
        kept = [
            f"supervisor invariant {event} needs {self._condition(guard.requirement)};"
            for event, guard in zip(events, guards, strict=True)
            if guard.requirement is not None
        ]
        added = any(guard.synthesis for guard in guards)
        return folded(
            [
                *document(self._counted(supervisor), sign="@@"),
                *self._plants(),
                *([""] if kept else []),
                *kept,
                "",
                *document(["What synthesis added." if added else "Synthesis added nothing to the requirements."]),
                f"supervisor automaton {self._names.supervisor}:",
                f"  alphabet {', '.join(events)};" if events else "  alphabet;",
                "",
                "  location:",
                "    initial; marked;",
                *(
                    edge_text(event, self._condition(guard.synthesis))
                    for event, guard in zip(events, guards, strict=True)
                ),
                "end",
            ]
        )

    def _plants(self) -> Iterator[str]:
        """The enumerations and the plants, with a blank line before them and between plants."""
        if self._model.enumerations:
            yield ""
        for enumeration in self._model.enumerations:
            literals = ", ".join(map(self._names.declared, enumeration.literals))
            yield f"enum {self._names.declared(enumeration)} = {literals};"
        for plant in self._model.plants:
            kind = "requirement automaton" if plant.kind == sct.PlantKind.requirement else "plant"
            yield from ["", f"{kind} {self._names.declared(plant)}:", *self._plant(plant), "end"]

    def _requirements(self) -> Iterator[str]:
        """The requirements of the model; what several of them ask of an event alike stands there once."""
        texts: dict[str, list[str]] = {}
        for requirement in self._model.requirements:
            event, asked = self._names.used(requirement.event, None), self._condition(requirement.condition)
            needs = requirement.kind == sct.RequirementKind.needs
            said = f"requirement {event} needs {asked};" if needs else f"requirement {asked} disables {event};"
            texts.setdefault(said, []).append(requirement.text or "")
        for invariant in self._model.invariants:
            name = self._names.invariants.get(invariant)
            named = "" if name is None else f" {name}:"
            said = f"requirement invariant{named} {self._condition(invariant.condition)};"
            texts.setdefault(said, []).append(invariant.text or "")
        if texts:
            yield ""
        for text, found in texts.items():
            yield from [*document(dict.fromkeys(filter(None, found))), text]

    def _plant(self, plant: sct.Plant) -> Iterator[str]:
        """What is in a plant."""
        printer = CifPrinter(self._names, plant)
        declared = [*self._events(plant), *self._variables(plant, printer)]
        yield from [*declared, *([""] if declared else [])]
        numbered = is_numbered(plant)
        for location in plant.locations[:1] if numbered else plant.locations:
            alone = plant.kind == sct.PlantKind.message and len(plant.locations) == 1
            nameless = numbered or (alone and location not in self._referred)
            marks = ["initial;"] * (location.initial or numbered) + ["marked;"] * location.marked
            inside = [f"    {' '.join(marks)}"] if marks else []
            inside += [
                self._edge(edge, location, plant, printer)
                for edge in edges_from(location)
                if edge.event not in self._impossible
            ]
            yield f"  location{'' if nameless else f' {self._names.declared(location)}'}{':' if inside else ';'}"
            yield from inside

    def _events(self, plant: sct.Plant) -> Iterator[str]:
        """The events of a plant that can happen, those together that are alike."""
        possible = (event for event in plant.events if event not in self._impossible)
        alike = groupby(possible, key=lambda event: (event.controllable, self._meanings.get(event)))
        for (controllable, meaning), events in alike:
            yield from document([meaning] if meaning else [], "  ")
            kind = "controllable" if controllable else "uncontrollable"
            yield f"  {kind} {', '.join(map(self._names.declared, events))};"

    def _variables(self, plant: sct.Plant, printer: CifPrinter) -> Iterator[str]:
        """The inputs and variables of a plant, with a note on those that hold another number than in the model."""
        members: list[sct.Input | sct.DiscreteVariable] = [*plant.inputs, *plant.variables]
        for member in members:
            name, kind = self._names.declared(member), "bool"
            if isinstance(member.type, ex.EnumerationType):
                kind = self._names.declared(member.type.enumeration)
            elif isinstance(member.type, ex.IntegerType):
                (low, high), up = bounds(member), shift(member)
                kind = f"int[{low + up}..{high + up}]"
                yield from document([f"{name} + {up}, with {name} in {low}..{high}"] if up else [], "  ")
            initial = printer(held(member)) if isinstance(member, sct.DiscreteVariable) else None
            yield f"  input {kind} {name};" if initial is None else f"  disc {kind} {name} = {initial};"
        number = self._names.number(plant)
        if number is not None:
            start = next(position for position, location in enumerate(plant.locations) if location.initial)
            yield from document(["The number of the provide statement that is chosen, 0 for none."], "  ")
            yield f"  disc int[0..{len(plant.locations) - 1}] {number} = {start};"

    def _edge(self, edge: sct.Edge, location: sct.Location, plant: sct.Plant, printer: CifPrinter) -> str:
        number = self._names.number(plant)
        updates = [
            f"{self._names.declared(update.variable)} := {printer(assigned(update.variable, update.value))}"
            for update in edge.updates
        ]
        if number is not None:
            updates.append(f"{number} := {self._numbers[edge.target]}")
        stays = edge.target is location or number is not None
        return edge_text(
            self._names.used(edge.event, plant),
            "" if edge.guard is None else printer(condition(edge.guard)),
            ", ".join(updates),
            "" if stays else self._names.declared(edge.target),
        )

    def _counted(self, supervisor: sct.Supervisor) -> list[str]:
        """What the supervisor leaves of the plants, as it is counted here and in CIF."""
        inputs = input_values(self._model)
        left, all_of = supervisor.controlledStates, supervisor.uncontrolledStates
        told = f"The plants of {self._model.name} under their supervisor"
        if left is None or all_of is None:  # A supervisor of a saved model need not have been counted.
            return [f"{told}."]
        counts = (
            f"CIF counts {left * inputs} of {all_of * inputs}: each of them with the {inputs} values of the inputs."
        )
        return [f"{told}, which leaves them {left} of {all_of} states.", *([counts] if inputs > 1 else [])]

    def _condition(self, expression: ex.Expression | None) -> str:
        return "" if expression is None else self._outside(condition(expression))


def document(texts: Iterable[str], indent: str = "", sign: str = "@") -> list[str]:
    """Annotations with these texts."""
    return [f"{indent}{sign}doc({quoted(text)})" for text in texts]


def edge_text(event: str, guard: str, updates: str = "", target: str = "") -> str:
    """An edge; what is empty is left out."""
    parts = zip((" when ", " do ", " goto "), (guard, updates, target), strict=True)
    return f"    edge {event}{''.join(word + text for word, text in parts if text)};"


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


def folded(lines: Sequence[str]) -> str:
    """Lines of a specification in such of a length that can be read; a break takes the place of a space."""
    return "".join(_folded(line) for line in lines)


def _folded(line: str) -> str:
    if len(line) <= _WIDTH:
        return f"{line}\n"
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


def _transitions(model: sct.SupervisoryControlModel) -> dict[sct.Event, str]:
    """What each transition of a component by itself does, whose event has no name but a number."""
    steps: dict[sct.Event, dict[str, None]] = {}
    edges = (edge for plant in model.plants for location in plant.locations for edge in location.edges)
    for edge in edges:
        if edge.event.kind in (sct.EventKind.tau, sct.EventKind.timeout):
            here, there = edge.eContainer().name, edge.target.name
            steps.setdefault(edge.event, {})[f"in {here}" if here == there else f"from {here} to {there}"] = None
    times = {event: f" after {timer_text(event.timer)}" if event.timer else "" for event in steps}
    return {
        event: f"A transition of {_owner(event)}{times[event]} {', '.join(steps)}." for event, steps in steps.items()
    }


def _choices(model: sct.SupervisoryControlModel) -> dict[sct.Event, str]:
    """Which statement of the model each choice of data stands for."""
    plants = (plant for plant in model.plants if plant.kind == sct.PlantKind.data)
    numbers = {event: number for plant in plants for event, number in provide_numbers(plant).items()}
    return {
        event: f"The choice of provide {number} for {_owner(event)}." for event, number in numbers.items() if number
    }


def _owner(event: sct.Event) -> str:
    """What the robot model calls the plant of an event."""
    plant: sct.Plant = event.eContainer()
    return plant.origin or plant.name
