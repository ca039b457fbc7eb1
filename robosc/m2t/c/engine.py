"""Writes the engine: a header and a source file in C99 (and C++17), with state, guards, events and control loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.m2t.c.comments import comment, comment_text, string_literal
from robosc.m2t.c.effects import Effects
from robosc.m2t.c.expressions import CPrinter
from robosc.m2t.c.guards import EventTable
from robosc.m2t.c.names import CNames
from robosc.m2t.c.ranges import All, Node, Ranges
from robosc.m2t.c.types import index_type, interval_of, number, type_name
from robosc.m2t.templates import environment
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.roles import Roles, event_name, plant_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from robosc.config import ControlLoop

_INDENT = 4


def generate(
    model: sct.SupervisoryControlModel, settings: ControlLoop, templates: Path | None = None
) -> dict[str, str]:
    """The files `P_supervisor.h` and `P_supervisor.c` of a model with its supervisor.

    `settings` become the default settings. The preconditions of `robosc.m2t.c.preconditions` must hold.
    """
    prepared = _Engine(model, settings).prepared()
    loaded = environment("robosc.m2t.c", templates)
    return {
        f"{prepared['p']}_supervisor.{kind}": loaded.get_template(f"supervisor.{kind}.j2").render(prepared)
        for kind in ("h", "c")
    }


@dataclass(frozen=True)
class _Case:
    """A part of a `switch`: its events, a comment on them, its lines, and whether they read a copy of the state."""

    events: list[str]
    comment: str
    lines: list[str]
    old: bool = False


def _merged(cases: Iterable[_Case]) -> list[_Case]:
    """Neighbours with the same lines as one, where the second has no comment."""
    merged: list[_Case] = []
    for case in cases:
        if merged and merged[-1].lines == case.lines and not case.comment:
            merged[-1].events.extend(case.events)
        else:
            merged.append(case)
    return merged


class _Engine:
    def __init__(self, model: sct.SupervisoryControlModel, settings: ControlLoop) -> None:
        self.model = model
        self.settings = settings
        self.names = CNames(model)
        self.ranges = Ranges()
        self.printer = CPrinter(self.names, self.ranges)
        self.table = EventTable(model)
        self.roles = Roles(model)
        self.queued = [*self.roles.cancels, *self.roles.triggers]
        self.data = [event for events in self.roles.data for event in events]
        #: The order of the enumerators: the control loop then knows an event's role by its number.
        self.events = [*self.queued, *self.roles.silent, *self.data, *self.roles.incoming]
        self.located = [plant for plant in model.plants if len(plant.locations) > 1]

    def prepared(self) -> dict[str, Any]:
        effects = Effects(self.names, self.ranges)
        executed, guarded = self.effects(effects), self.guards()
        arrived = [self.arrived(event) for events in self.roles.data for event in events]
        return {
            "p": self.names.prefix,
            "u": self.names.macro,
            "robot": comment_text(self.model.name),
            "events": self.groups(),
            # C has no empty enumerations: a robot without events has one that never happens.
            "event_count": max(len(self.events), 1),
            "index": index_type(len(self.events)),
            "cancels": len(self.roles.cancels),
            "triggers": len(self.roles.triggers),
            "queued": len(self.queued),
            "silent": len(self.roles.silent),
            "bound": self.roles.settling_bound,
            "data": self.data_starts(),
            "settles": bool(self.roles.silent or self.data),
            "topics": len(self.roles.shared_topics),
            "groups": len(self.roles.shared_topics) + len(self.roles.once_per_tick),
            "group_of": self.group_of(),
            "enumerations": [self.enumeration(each) for each in self.model.enumerations],
            "located": [
                {
                    "comment": comment_text(plant.name),
                    "locations": [self.names.enumerator(each) for each in plant.locations],
                }
                for plant in self.located
            ],
            "state": list(self.state()),
            "inputs": [
                {
                    "type": type_name(each.type),
                    "name": self.names.member(each),
                    "comment": _values(each.type),
                    "initial": self.first(each.type),
                }
                for plant in self.model.plants
                for each in plant.inputs
            ],
            "guards": guarded if self.events else [_Case([f"{self.names.prefix}_nothing"], "", ["false"])],
            "guards_read_state": any("state->" in line for each in guarded for line in each.lines),
            "effects": executed,
            "effects_read_inputs": any("inputs->" in line for each in executed for line in each.lines),
            "helpers": sorted(effects.helpers),
            "arrived": [each for each in arrived if each is not None],
            "moved": self.moved(),
            "lookups": list(self.lookups()),
            "event_names": [string_literal(event_name(event)) for event in self.events] or ['""'],
            "settings": self.settings,
        }

    # The header

    def groups(self) -> list[dict[str, Any]]:
        """The events with what each means, by role."""
        named = [
            ("Cancels: the control loop runs them first.", self.roles.cancels),
            (
                "Triggers: what the controller sends, by the control loop, where the supervisor allows it.",
                self.roles.triggers,
            ),
            ("Silent events: the control loop runs them until none is enabled.", self.roles.silent),
            ("Data: the control loop chooses what the triggers send.", self.data),
            ("What comes from the robot: perform these.", self.roles.incoming),
        ]
        filled = [(heading, events) for heading, events in named if events]
        return [
            {
                "heading": heading,
                "first": position == 0,
                "last": position == len(filled) - 1,
                "events": [
                    {
                        "name": self.names.enumerator(event),
                        "comment": comment(
                            [self.meaning(event), *self.requirements(event), *self.carries(event)], _INDENT
                        ),
                    }
                    for event in events
                ],
            }
            for position, (heading, events) in enumerate(filled)
        ]

    def meaning(self, event: sct.Event) -> str:
        """What happened in the robot when this event has."""
        plant = plant_of(event)
        what = plant.origin or plant.name
        kind, on = plant.kind.name, f" ({plant.topic})" if plant.topic else ""
        arrived = "arrived" if plant.kind == sct.PlantKind.message else "is done"
        meanings = {
            sct.EventKind.trigger: {
                "message": f"{what} is sent{on}.",
                "service": f"{what} is called{on}.",
                "action": f"{what} is started{on}.",
            }.get(kind, f"{what}: {event.name}."),
            sct.EventKind.cancel: f"{what} is cancelled{on}.",
            sct.EventKind.response: f"{what} {arrived}{on}.",
            sct.EventKind.error: f"{what} failed{on}.",
            sct.EventKind.feedback: f"{what} is under way{on}.",
            sct.EventKind.reset: f"{what} is ready to be used again.",
            sct.EventKind.tau: f"{what} changes by itself{self.steps(event)}.",
            sct.EventKind.data: f"{what} is to be sent with other data{self.steps(event)}.",
        }
        return meanings[event.kind]

    def steps(self, event: sct.Event) -> str:
        edges = self.table.edges[event].get(plant_of(event), {})
        steps = dict.fromkeys(
            edge.target.name if event.kind == sct.EventKind.data else f"{location.name} to {edge.target.name}"
            for location, edge in edges.items()
        )
        return f": {', '.join(steps)}" if steps else ""

    def requirements(self, event: sct.Event) -> list[str]:
        """The requirements on an event in the model's own words, each with its place."""
        return [
            f"{each.text}{f' ({each.source})' if each.source else ''}"
            for each in self.table.requirements.get(event, ())
            if each.text
        ]

    def carries(self, event: sct.Event) -> list[str]:
        names = [f"inputs.{self.names.member(each)}" for each in event.inputs]
        return [f"It carries {', '.join(names)}."] if names else []

    def enumeration(self, enumeration: ex.Enumeration) -> dict[str, Any]:
        return {
            "comment": f"Values of {comment_text(enumeration.name)}.",
            "literals": [self.names.enumerator(each) for each in enumeration.literals],
        }

    def state(self) -> Iterator[dict[str, str]]:
        for plant in self.model.plants:
            if plant in self.located:
                yield {
                    "type": index_type(len(plant.locations) - 1),
                    "name": self.names.member(plant),
                    "comment": f"a location of {comment_text(plant.name)}",
                    "initial": self.names.enumerator(next(each for each in plant.locations if each.initial)),
                }
            for variable in plant.variables:
                yield {
                    "type": type_name(variable.type),
                    "name": self.names.member(variable),
                    "comment": _values(variable.type),
                    "initial": self.printer(variable.initial),
                }

    def lookups(self) -> Iterator[dict[str, Any]]:
        owners: list[tuple[sct.Plant | ex.Enumeration, Sequence[ex.NamedElement]]] = [
            *((plant, plant.locations) for plant in self.located),
            *((enumeration, enumeration.literals) for enumeration in self.model.enumerations),
        ]
        for owner, elements in owners:
            yield {
                "function": self.names.lookup(owner),
                "names": [string_literal(each.name) for each in elements],
            }

    def first(self, kind: ex.Type) -> str:
        """What an input holds before it is set."""
        match kind:
            case ex.BooleanType():
                return "false"
            case ex.EnumerationType():
                return self.names.enumerator(kind.enumeration.literals[0])
        values = interval_of(kind)
        return number(min(max(0, values.low), values.high))

    # The source

    def guards(self) -> list[_Case]:
        """The conditions of the events, but of those that nothing forbids and that there is nothing to tell about."""
        cases = []
        for event in self.events:
            unforced = All([self.table.possible(event, self.printer), self.table.required(event)])
            added = self.table.added(event)
            told = self.requirements(event)
            if told or self.ranges(All([unforced, added])).single != 1:
                lines = self.lines(unforced, added)
                cases.append(_Case([self.names.enumerator(event)], comment(told, _INDENT), lines))
        return _merged(cases)

    def lines(self, unforced: All, added: All) -> list[str]:
        """A condition, one part a line."""
        operator, terms = self.conditions(All([unforced, added]))
        plain, by_synthesis = self.conditions(unforced)[1], self.conditions(added)[1]
        told = [each for each in by_synthesis if each not in plain] if operator == "&&" else []
        marked = [f"{each} /* added by synthesis */" if each in told else each for each in terms]
        return [marked[0], *(f"{operator} {each}" for each in marked[1:])]

    def conditions(self, node: Node) -> tuple[str, list[str]]:
        """The outermost operator of a condition, and its operands."""
        reduced = self.ranges.reduced(node)
        joined = self.ranges.joined(reduced) if self.ranges(reduced).single is None else None
        if joined is None:
            return "&&", [self.printer(reduced)]
        return "&&" if joined.neutral else "||", self.printer.terms(joined)

    def effects(self, effects: Effects) -> list[_Case]:
        """The statements of the events that change something."""
        cases = []
        for event in self.events:
            lines, old = effects.statements(self.table.edges[event])
            if lines:
                cases.append(_Case([self.names.enumerator(event)], "", lines, old))
        return _merged(cases)

    def data_starts(self) -> list[str]:
        """The first event of each data plant, and the one behind the last."""
        if not self.data:
            return []
        start = len(self.queued) + len(self.roles.silent)
        return [self.names.enumerator(events[0]) for events in self.roles.data] + [f"{start + len(self.data)}"]

    def arrived(self, event: sct.Event) -> dict[str, str] | None:
        stays = self.table.stays(event, plant_of(event))
        if self.ranges(stays).single == 0:
            return None
        return {"event": self.names.enumerator(event), "condition": self.printer(stays)}

    def moved(self) -> list[dict[str, str]]:
        """The triggers whose data a plant with several locations chooses."""
        return [
            {"event": self.names.enumerator(trigger), "member": self.names.member(plant)}
            for trigger, plant in self.roles.data_plants.items()
            if plant in self.located
        ]

    def group_of(self) -> list[int]:
        """For each cancel and trigger: 0, or the number of those of which one runs only."""
        groups = dict.fromkeys(self.queued, 0)
        for number_, events in enumerate(
            [*self.roles.shared_topics, *((each,) for each in self.roles.once_per_tick)], 1
        ):
            groups.update(dict.fromkeys(events, number_))
        return list(groups.values())


def _values(kind: ex.Type) -> str:
    """The range of a type in words."""
    match kind:
        case ex.EnumerationType():
            return f"a value of {comment_text(kind.enumeration.name)}"
        case ex.IntegerType():
            return f"{kind.minimum} to {kind.maximum}"
    return "true or false"
