"""What the header declares: events and what each means, enumerations, locations, state, inputs, names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.m2t.c.comments import comment, comment_text, string_literal
from robosc.m2t.c.types import index_type, number, type_name
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.domains import domain
from robosc.semantics.printing import RobotPrinter
from robosc.semantics.roles import event_name, plant_of, provide_numbers

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.m2t.c.context import Context

_INDENT = 4


class Declarations:
    """Prepares the declarations for the templates."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._numbers: dict[sct.Plant, dict[sct.Event, int]] = {}

    def prepared(self) -> dict[str, Any]:
        """The values that the templates put in."""
        return {
            "robot": comment_text(self._context.sct.name),
            "events": self._groups(),
            # C has no empty enumerations: a robot without events has one that never happens.
            "event_count": max(len(self._context.events), 1),
            "enumerations": [self._enumeration(each) for each in self._context.sct.enumerations],
            "located": [
                {
                    "comment": comment_text(plant.name),
                    "locations": [self._context.names.enumerator(each) for each in plant.locations],
                }
                for plant in self._context.located
            ],
            "state": list(self._state()),
            "inputs": [
                {
                    "type": type_name(each.type),
                    "name": self._context.names.member(each),
                    "comment": _values(each.type),
                    "initial": self._first(each.type),
                }
                for plant in self._context.sct.plants
                for each in plant.inputs
            ],
            "lookups": list(self._lookups()),
            "event_names": [string_literal(event_name(event)) for event in self._context.events] or ['""'],
        }

    def _groups(self) -> list[dict[str, Any]]:
        """The events with what each means, by role."""
        named = [
            ("Cancels: the control loop runs them first.", self._context.roles.cancels),
            (
                "Triggers: what the controller sends, by the control loop, where the supervisor allows it.",
                self._context.roles.triggers,
            ),
            ("Silent events: the control loop runs them until none is enabled.", self._context.roles.silent),
            ("Data: the control loop chooses what the triggers send.", self._context.data),
            ("What comes from the robot: perform these.", self._context.roles.incoming),
        ]
        filled = [(heading, events) for heading, events in named if events]
        return [
            {
                "heading": heading,
                "first": position == 0,
                "last": position == len(filled) - 1,
                "events": [
                    {
                        "name": self._context.names.enumerator(event),
                        "comment": comment(
                            [self._meaning(event), *self._context.table.words(event), *self._carries(event)], _INDENT
                        ),
                    }
                    for event in events
                ],
            }
            for position, (heading, events) in enumerate(filled)
        ]

    def _meaning(self, event: sct.Event) -> str:
        """What happened in the robot when this event has."""
        plant = plant_of(event)
        what = plant.origin or plant.name
        kind, on = plant.kind.name, f" ({plant.topic})" if plant.topic else ""
        arrived = "arrived" if plant.kind == sct.PlantKind.message else "is done"
        if event.kind == sct.EventKind.data:
            return f"{what} is to be sent {self._data(event)}."
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
            sct.EventKind.tau: f"{what} changes by itself{self._steps(event)}.",
        }
        return meanings[event.kind]

    def _data(self, event: sct.Event) -> str:
        """Which data it is then sent with: that of a statement of the model, by its number and condition."""
        plant = plant_of(event)
        if plant not in self._numbers:
            self._numbers[plant] = provide_numbers(plant)
        number = self._numbers[plant][event]
        if not number:
            return "without data"
        edges = self._context.table.edges[event].get(plant_of(event), {})
        guard = next((edges[location].guard for location in edges), None)
        return f"with the data of `provide` {number}" + (f", if {RobotPrinter()(guard)}" if guard else "")

    def _steps(self, event: sct.Event) -> str:
        edges = self._context.table.edges[event].get(plant_of(event), {})
        steps = dict.fromkeys(f"{location.name} to {edge.target.name}" for location, edge in edges.items())
        return f": {', '.join(steps)}" if steps else ""

    def _carries(self, event: sct.Event) -> list[str]:
        names = [f"inputs.{self._context.names.member(each)}" for each in event.inputs]
        return [f"It carries {', '.join(names)}."] if names else []

    def _enumeration(self, enumeration: ex.Enumeration) -> dict[str, Any]:
        return {
            "comment": f"Values of {comment_text(enumeration.name)}.",
            "literals": [self._context.names.enumerator(each) for each in enumeration.literals],
        }

    def _state(self) -> Iterator[dict[str, str]]:
        for plant in self._context.sct.plants:
            if plant in self._context.located:
                yield {
                    "type": index_type(len(plant.locations) - 1),
                    "name": self._context.names.member(plant),
                    "comment": f"a location of {comment_text(plant.name)}",
                    "initial": self._context.names.enumerator(next(each for each in plant.locations if each.initial)),
                }
            for variable in plant.variables:
                yield {
                    "type": type_name(variable.type),
                    "name": self._context.names.member(variable),
                    "comment": _values(variable.type),
                    "initial": self._context.printer(variable.initial),
                }

    def _lookups(self) -> Iterator[dict[str, Any]]:
        owners: list[tuple[sct.Plant | ex.Enumeration, Sequence[ex.NamedElement]]] = [
            *((plant, plant.locations) for plant in self._context.located),
            *((enumeration, enumeration.literals) for enumeration in self._context.sct.enumerations),
        ]
        for owner, elements in owners:
            yield {
                "function": self._context.names.lookup(owner),
                "names": [string_literal(each.name) for each in elements],
            }

    def _first(self, kind: ex.Type) -> str:
        """What an input holds before it is set."""
        match kind:
            case ex.BooleanType():
                return "false"
            case ex.EnumerationType():
                return self._context.names.enumerator(kind.enumeration.literals[0])
        values = domain(kind)
        return number(min(max(0, values.low), values.high))


def _values(kind: ex.Type) -> str:
    """The range of a type in words."""
    match kind:
        case ex.EnumerationType():
            return f"a value of {comment_text(kind.enumeration.name)}"
        case ex.IntegerType():
            return f"{kind.minimum} to {kind.maximum}"
    return "true or false"
