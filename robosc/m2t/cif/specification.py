"""CIF text of an sct model, plant by plant and line by line."""

from __future__ import annotations

from decimal import Decimal
from itertools import groupby
from textwrap import wrap
from typing import TYPE_CHECKING

from robosc.m2t.cif.expressions import BREAK, CifPrinter
from robosc.m2t.cif.names import CifNames
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.durations import timer_text
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.roles import input_values, provide_numbers

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.m2m.sct_to_cif import LoweredModel

#: Maximum number of characters in a line. A longer word gets a line of its own.
_WIDTH = 120


class Writer:
    """Writes CIF for a lowered sct model."""

    def __init__(self, lowered: LoweredModel) -> None:
        self._model, self._originals = lowered
        self._names = CifNames(self._model)
        self._outside = CifPrinter(self._names, None)
        original = self._originals[self._model]
        self._meanings = {**_transitions(original), **_choices(original)}

    def write_plants(self) -> str:
        """Return the plants and the requirements."""
        lines = document([f"The plants and requirements of {self._model.name}."], sign="@@")
        plants = self._plants("requirement automaton")
        return fold_lines([*lines, *self._reachability_requirements(), *plants, *self._requirements()])

    def write_supervisor(self, supervisor: sct.Supervisor) -> str:
        """Return the plants with their supervisor: its requirements, and an automaton of its additions."""
        events = [self._names.used_name(guard.event, None) for guard in supervisor.guards]
        requirements = [
            f"supervisor invariant {event}{BREAK}needs {self._outside(guard.requirement)};"
            for event, guard in zip(events, supervisor.guards, strict=True)
            if guard.requirement is not None
        ]
        added = any(guard.synthesis for guard in supervisor.guards)
        return fold_lines(
            [
                *document(self._counted(supervisor), sign="@@"),
                *self._plants("supervisor automaton"),
                *([""] if requirements else []),
                *requirements,
                "",
                *document(["Conditions by synthesis." if added else "Synthesis added nothing to the requirements."]),
                f"supervisor automaton {self._names.supervisor}:",
                f"  alphabet {join_by_commas(events)};" if events else "  alphabet;",
                "",
                "  location:",
                "    initial; marked;",
                *(
                    edge_text(event, "" if guard.synthesis is None else self._outside(guard.synthesis))
                    for event, guard in zip(events, supervisor.guards, strict=True)
                ),
                "end",
            ]
        )

    def _plants(self, requirement: str) -> Iterator[str]:
        """Return the enumerations and the plants, with a blank line before them and between plants.

        `requirement` is the kind of requirement automata. CIF's tools accept no requirement automata beside a
        supervisor; its own synthesis converts them to supervisors.
        """
        if self._model.enumerations:
            yield ""
        for enumeration in self._model.enumerations:
            literals = join_by_commas(map(self._names.declared_name, enumeration.literals))
            yield f"enum {self._names.declared_name(enumeration)} = {literals};"
        for plant in self._model.plants:
            kind = requirement if plant.kind == sct.PlantKind.requirement else "plant"
            described = document([plant.text]) if plant.text else []
            yield from ["", *described, f"{kind} {self._names.declared_name(plant)}:", *self._plant(plant), "end"]

    def _requirements(self) -> Iterator[str]:
        """Return the requirements of the model. Equal conditions on an event appear once."""
        texts: dict[str, list[str]] = {}
        for requirement in self._model.requirements:
            event, condition = self._names.used_name(requirement.event, None), self._outside(requirement.condition)
            needs = requirement.kind == sct.RequirementKind.needs
            parts = (event, f"needs {condition}") if needs else (condition, f"disables {event}")
            statement = f"requirement {BREAK.join(parts)};"
            texts.setdefault(statement, []).append(requirement.text or "")
        for invariant in self._model.invariants:
            name = self._names.invariants.get(invariant)
            named = "" if name is None else f" {name}:"
            statement = f"requirement invariant{named} {self._outside(invariant.condition)};"
            texts.setdefault(statement, []).append(invariant.text or "")
        if texts:
            yield ""
        for text, descriptions in texts.items():
            yield from [*document(dict.fromkeys(filter(None, descriptions))), text]

    def _reachability_requirements(self) -> Iterator[str]:
        """Return the annotations of the specification that are requirements, each after its text."""
        for required in self._model.reachabilityRequirements:
            arguments = [self._outside(required.condition)]
            for name, part in (("from", required.premise), ("stay", required.pathCondition)):
                if part is not None:
                    arguments.append(f"{name}: {self._outside(part)}")
            if required.bound is not None:
                arguments.append(f"bound: {required.bound}")
            yield from document(filter(None, [required.text]), sign="@@")
            yield f"@@requirement:reachable({join_by_commas(arguments)})"

    def _plant(self, plant: sct.Plant) -> Iterator[str]:
        """Return the contents of a plant."""
        printer = CifPrinter(self._names, plant)
        declared = [*self._events(plant), *self._variables(plant, printer)]
        yield from [*declared, *([""] if declared else [])]
        for location in plant.locations:
            name = f" {self._names.declared_name(location)}" if location.name else ""
            marks = ["initial;"] * location.initial + ["marked;"] * location.marked
            inside = [f"    {' '.join(marks)}"] if marks else []
            inside += [self._edge(edge, location, plant, printer) for edge in edges_from(location)]
            yield f"  location{name}{':' if inside else ';'}"
            yield from inside

    def _events(self, plant: sct.Plant) -> Iterator[str]:
        """Return the events of a plant, with similar ones grouped."""
        alike = groupby(
            plant.events, key=lambda event: (event.controllable, self._meanings.get(self._originals[event]))
        )
        for (controllable, meaning), events in alike:
            yield from document([meaning] if meaning else [], "  ")
            kind = "controllable" if controllable else "uncontrollable"
            yield f"  {kind} {join_by_commas(map(self._names.declared_name, events))};"

    def _variables(self, plant: sct.Plant, printer: CifPrinter) -> Iterator[str]:
        """Return the inputs and variables of a plant, with a note on each whose number differs from the model's."""
        members: list[sct.Input | sct.DiscreteVariable] = [*plant.inputs, *plant.variables]
        for member in members:
            name, kind = self._names.declared_name(member), "bool"
            if isinstance(member.type, ex.EnumerationType):
                kind = self._names.declared_name(member.type.enumeration)
            elif isinstance(member.type, ex.IntegerType):
                kind = f"int[{member.type.minimum}..{member.type.maximum}]"
                yield from document(self._range_declarations(member, member.type), "  ")
            initial = member.initial if isinstance(member, sct.DiscreteVariable) else None
            yield f"  input {kind} {name};" if initial is None else f"  disc {kind} {name} = {printer(initial)};"

    def _range_declarations(self, member: sct.Input | sct.DiscreteVariable, kind: ex.IntegerType) -> list[str]:
        """Return notes on the number in an integer variable."""
        if member not in self._originals:
            return ["The number of the provide statement that is chosen, 0 for none."]
        name, original = self._names.declared_name(member), self._originals[member].type
        added = kind.minimum - original.minimum
        return [f"{name} + {added}, with {name} in {original.minimum}..{original.maximum}"] if added else []

    def _edge(self, edge: sct.Edge, location: sct.Location, plant: sct.Plant, printer: CifPrinter) -> str:
        updates = (
            f"{self._names.declared_name(update.variable)} := {printer(update.value)}" for update in edge.updates
        )
        return edge_text(
            self._names.used_name(edge.event, plant),
            "" if edge.guard is None else printer(edge.guard),
            join_by_commas(updates),
            "" if edge.target is location else self._names.declared_name(edge.target),
        )

    def _counted(self, supervisor: sct.Supervisor) -> list[str]:
        """Return the state counts of the supervised plants, as RoboSC and as CIF count them."""
        inputs = input_values(self._model)
        left, all_of = supervisor.controlledStates, supervisor.uncontrolledStates
        subject = f"The plants of {self._model.name} under their supervisor"
        if left is None or all_of is None:  # The supervisor of a saved model may have no counts.
            return [f"{subject}."]
        # Python prints numbers of thousands of digits only as decimals.
        here, there = (f"{Decimal(left * times)} of {Decimal(all_of * times)}" for times in (1, inputs))
        counts = f"CIF counts {there}: each of them with the {Decimal(inputs)} values of the inputs."
        return [f"{subject}, which leaves them {here} states.", *([counts] if inputs > 1 else [])]


def document(texts: Iterable[str], indent: str = "", sign: str = "@") -> list[str]:
    """Return annotations with these texts."""
    return [f"{indent}{sign}doc({quote(text)})" for text in texts]


def edge_text(event: str, guard: str, updates: str = "", target: str = "") -> str:
    """Return an edge without its empty parts."""
    parts = zip(("when", "do", "goto"), (guard, updates, target), strict=True)
    return f"    edge {event}{''.join(f'{BREAK}{word} {text}' for word, text in parts if text)};"


def join_by_commas(texts: Iterable[str]) -> str:
    """Return texts joined by commas."""
    return f",{BREAK}".join(texts)


def quote(text: str) -> str:
    """Return a text as a CIF string in ASCII. A long one becomes a sum of strings, which may span several lines."""
    shown = " ".join(text.split()).encode("ascii", "backslashreplace").decode()
    shown = "".join(character if character.isprintable() else f"\\x{ord(character):02x}" for character in shown)
    parts = wrap(shown, _WIDTH - 10, drop_whitespace=False, break_on_hyphens=False)
    return f"{BREAK}+ ".join('"' + part.replace("\\", "\\\\").replace('"', '\\"') + '"' for part in parts)


def fold_lines(lines: Iterable[str]) -> str:
    """Return declarations in lines of readable length."""
    return "".join(map(_folded, lines))


def _folded(line: str) -> str:
    if len(line) <= _WIDTH:
        return f"{line.replace(BREAK, ' ')}\n"
    indent = " " * (len(line) - len(line.lstrip(" ")))
    text, length = "", 0
    for part in line.split(BREAK):
        if text and length + 1 + len(part) > _WIDTH:
            text += f"\n{indent}  {part}"
            length = len(indent) + 2 + len(part)
        else:
            text += f" {part}" if text else part
            length += 1 + len(part)
    return f"{text}\n"


def _transitions(model: sct.SupervisoryControlModel) -> dict[sct.Event, str]:
    """Describe each silent or timed transition of a component, whose event is only a number."""
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
    """Return the statement of the model that each choice of data selects."""
    plants = (plant for plant in model.plants if plant.kind == sct.PlantKind.data)
    numbers = {event: number for plant in plants for event, number in provide_numbers(plant).items()}
    return {
        event: f"The choice of provide {number} for {_owner(event)}." for event, number in numbers.items() if number
    }


def _owner(event: sct.Event) -> str:
    """Return the robot model's name for the plant of an event."""
    plant: sct.Plant = event.eContainer()
    return plant.origin or plant.name
