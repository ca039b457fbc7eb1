"""Generates the engine: a header and a source file in C99 (and C++17), with state, guards, events and control loop."""

from __future__ import annotations

import textwrap
from itertools import accumulate
from typing import TYPE_CHECKING, Any

from robosc.base.files.templates import environment
from robosc.m2t.c.comments import comment, comment_text, string_literal
from robosc.m2t.c.expressions import CPrinter, clamp, type_name, unsigned_type
from robosc.m2t.c.names import CNames
from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.reflection import tree
from robosc.model.semantics.durations import duration_text
from robosc.model.semantics.roles import assumption_name, assumption_text, assumptions, is_from_cif

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from robosc.language.configuration import ControlLoop

_INDENT = 4
#: Maximum number of events that a comment on a shared condition names.
_NAMED = 3
#: Bits of a word in a set.
_WORD = 32
#: Places in the queue for each of its elements. More places make it less often necessary to close gaps.
_GENEROUS = 3
#: Number of events that the engine stores before it looks up their readers. A message rarely causes more.
_BEHIND = 8
_HEADINGS = {
    engine.Role.cancel: "Cancels: the control loop runs them first.",
    engine.Role.trigger: "Triggers: what the controller sends, by the control loop, where the supervisor allows it.",
    engine.Role.silent: "Silent events: the control loop runs them until none is enabled.",
    engine.Role.data: "Data: the control loop chooses what the triggers send.",
    engine.Role.incoming: "Data from the robot: perform these.",
    engine.Role.timeout: "Timeouts: they happen when their time is up.",
}


def generate(executed: engine.EngineModel, settings: ControlLoop, templates: Path | None = None) -> dict[str, str]:
    """Return the files `P_supervisor.h` and `P_supervisor.c` of an engine model.

    `settings` become the default settings. The preconditions of `robosc.m2t.c.preconditions` must hold.
    """
    model = executed.model
    names = CNames(model)
    prepared = {
        "p": names.prefix,
        "u": names.macro,
        "settings": settings,
        "stepwise": is_from_cif(model),
        **_Preparation(executed, names).all(),
    }
    loaded = environment("robosc.m2t.c", overrides=templates)
    return {
        f"{names.prefix}_supervisor.{kind}": loaded.get_template(f"supervisor.{kind}.j2").render(prepared)
        for kind in ("h", "c")
    }


class _Preparation:
    """Values for the templates."""

    def __init__(self, model: engine.EngineModel, names: CNames) -> None:
        self._model = model
        self._names = names
        self._printer = CPrinter(names)
        self._events = {role: [event for event in model.events if event.role == role] for role in _HEADINGS}
        self._queued = self._events[engine.Role.cancel] + self._events[engine.Role.trigger]
        self._silent = self._events[engine.Role.silent]
        self._located = [variable.plant for variable in model.variables if variable.variable is None]

    def all(self) -> dict[str, Any]:
        """Return all values by name."""
        readers = self._readers() if self._model.incremental else {}
        parts = (self._declarations(), self._computations(), self._assumptions(), self._loop(), self._timers(), readers)
        return {name: value for part in parts for name, value in part.items()}

    def _enumerator(self, event: engine.Event) -> str:
        return self._names.enumerator(event.event)

    def _declarations(self) -> dict[str, Any]:
        """Return the declarations of the header: events, enumerations, locations, state, inputs, names."""
        model, names = self._model, self._names
        groups = [(heading, self._events[role]) for role, heading in _HEADINGS.items() if self._events[role]]
        owners: list[tuple[sct.Plant | ex.Enumeration, Sequence[ex.NamedElement]]] = [
            *((plant, plant.locations) for plant in self._located),
            *((enumeration, enumeration.literals) for enumeration in model.model.enumerations),
        ]
        return {
            "robot": comment_text(model.name),
            "events": [
                {
                    "heading": heading,
                    "first": position == 0,
                    "last": position == len(groups) - 1,
                    "events": [{"name": self._enumerator(event), "comment": self._meaning(event)} for event in events],
                }
                for position, (heading, events) in enumerate(groups)
            ],
            # C has no empty enumerations: a robot without events gets one that never happens.
            "event_count": max(len(model.events), 1),
            "enumerations": [
                {
                    "comment": f"Values of {comment_text(enumeration.name)}.",
                    "literals": [names.enumerator(literal) for literal in enumeration.literals],
                }
                for enumeration in model.model.enumerations
            ],
            "located": [
                {
                    "comment": comment_text(plant.name),
                    "locations": [names.enumerator(location) for location in plant.locations],
                }
                for plant in self._located
            ],
            "state": [self._declaration(variable) for variable in model.variables],
            "inputs": [self._declaration(declared) for declared in model.inputs],
            "lookups": [
                {"function": names.lookup(owner), "names": [string_literal(value.name) for value in values]}
                for owner, values in owners
            ],
            "event_names": [string_literal(event.name) for event in model.events] or ['""'],
        }

    def _meaning(self, event: engine.Event) -> str:
        carried = [f"inputs.{self._names.of(declared)}" for declared in event.inputs]
        carried_text = [f"It carries {', '.join(carried)}."] if carried else []
        return comment([event.description, *event.remarks, *carried_text], _INDENT)

    def _declaration(self, declared: engine.StateVariable | engine.Input) -> dict[str, str]:
        return {
            "type": type_name(declared.type),
            "name": self._names.of(declared),
            "comment": _values(declared.type),
            "initial": self._printer.constant(declared.type, declared.initial),
        }

    def _computations(self) -> dict[str, Any]:
        """Return the guards and effects of the events, and their shared conditions."""
        events = self._model.events
        guards = [
            (event, comment(event.remarks, _INDENT), self._printer.guard(event.guard))
            for event in events
            # All others are always allowed and have no remarks.
            if event.guard.terms or event.remarks
        ]
        effects = [(event, self._printer.effect(event.effect)) for event in events if event.effect.steps]
        data_guards = [
            (event, self._printer.lines(event.guard.data)) for event in events if event.guard.data is not None
        ]
        in_data_guards = [node for event, _ in data_guards for _, node in tree(event.guard.data)]
        in_guards = [node for event in events for term in event.guard.terms for _, node in tree(term)]
        in_effects = [node for event in events for _, node in tree(event.effect)]
        return {
            "conditions": [
                {
                    "name": condition.name,
                    "comment": comment([_used_in(condition)]),
                    "lines": self._printer.lines(condition.value),
                }
                for condition in self._model.conditions
            ],
            "guards": _merged([(self._enumerator(event), remarks, lines, False) for event, remarks, lines in guards])
            if events
            else _merged([(f"{self._names.prefix}_nothing", "", ["false"], False)]),
            "data_guards": _merged([(self._enumerator(event), "", lines, False) for event, lines in data_guards]),
            "data_guards_read_state": any(isinstance(node, engine.VariableReference) for node in in_data_guards),
            "guards_read_state": any(
                isinstance(node, (engine.VariableReference, engine.ConditionReference)) for node in in_guards
            ),
            "effects": _merged(
                [(self._enumerator(event), "", lines, bool(event.effect.copied)) for event, lines in effects]
            ),
            "effects_read_inputs": any(isinstance(node, engine.InputReference) for node in in_effects),
            "helpers": sorted({clamp(node) for node in in_effects if isinstance(node, engine.Saturation)}),
            "arrived": [
                {"event": self._enumerator(alternative.event), "condition": self._printer(alternative.chosen)}
                for choice in self._model.choices
                for alternative in choice.alternatives
                if alternative.chosen is not None
            ],
        }

    def _assumptions(self) -> dict[str, Any]:
        """Return the assumptions, and the conditions under which an event violates each of them."""
        plants = assumptions(self._model.model)
        number = {plant: position for position, plant in enumerate(plants)}
        cases = []
        for event in self._model.events:
            reasons = [
                (number[reason.assumption], self._printer.lines(reason.condition))
                for reason in event.reasons
                if reason.assumption is not None and reason.condition is not None
            ]
            if reasons:
                possible = None if event.guard.plants is None else self._printer.lines(event.guard.plants)
                cases.append({"event": self._enumerator(event), "possible": possible, "reasons": reasons})
        return {
            "assumptions": [
                {"name": string_literal(assumption_name(plant)), "text": string_literal(assumption_text(plant))}
                for plant in plants
            ],
            "violations": cases,
            "violations_read_state": any("state->" in line for case in cases for line in _lines_of(case)),
        }

    def _loop(self) -> dict[str, Any]:
        """Return the control loop's data on events: their numbers, and the groups that exclude each other."""
        model, queued, silent = self._model, len(self._queued), len(self._silent)
        data = self._events[engine.Role.data]
        incoming = self._events[engine.Role.incoming] + self._events[engine.Role.timeout]
        first = [self._enumerator(choice.alternatives[0].event) for choice in model.choices]
        groups = {group: number for number, group in enumerate(model.groups, 1)}
        sources = {source: number for number, source in enumerate(model.sources, 1)}
        return {
            "incremental": model.incremental,
            "index": unsigned_type(len(model.events)),
            "cancels": len(self._events[engine.Role.cancel]),
            "triggers": len(self._events[engine.Role.trigger]),
            "queued": queued,
            "silent": silent,
            "own": " + ".join(["QUEUED"] * bool(queued) + ["SILENT"] * bool(silent)),
            "bound": model.settlingBound,
            # The first event of each choice, and the event after the last choice.
            "data": [*first, str(queued + silent + len(data))] if first else [],
            "settles": bool(silent or first),
            "topics": sum(group.span == engine.Span.round for group in model.groups),
            "groups": len(groups),
            "group_of": [0 if event.group is None else groups[event.group] for event in self._queued],
            "incoming": len(model.events) - len(incoming),
            "sources": len(sources) + 1,
            "source_index": unsigned_type(len(sources) + 1),
            "source_of": [sources[event.source] for event in incoming if event.source is not None],
            "moved": [
                {"event": self._enumerator(event), "member": self._names.of(event.choice.variable)}
                for event in self._queued
                if event.choice is not None and event.choice.variable is not None
            ],
        }

    def _timers(self) -> dict[str, Any]:
        """Return the timers and the effects of events on them."""
        timers = self._model.timers
        numbers = {timer: number for number, timer in enumerate(timers)}
        located = [timer.location.eContainer() for timer in timers if timer.location is not None]
        owners = {plant: number for number, plant in enumerate(dict.fromkeys(located), 1)}

        def lines(restart: engine.Restart) -> list[str]:
            left = [] if restart.left is None else [f"leave(self, {owners[restart.left]}U);"]
            done = [*left, *(f"begin_time(self, {numbers[timer]}U);" for timer in restart.starts)]
            if restart.condition is None:
                return done
            return [f"if ({self._printer(restart.condition)}) {{", *(f"    {line}" for line in done), "}"]

        restarts = [restart for event in self._model.events for restart in event.restarts]
        in_restarts = [node for restart in restarts for _, node in tree(restart)]
        return {
            "now": ", uint32_t now" if timers else "",
            "timers": [
                {
                    "number": number,
                    "milliseconds": timer.milliseconds,
                    "owner": 0 if timer.location is None else owners[timer.location.eContainer()],
                    "initial": timer.initial,
                }
                for timer, number in numbers.items()
            ],
            "durations": [
                {
                    "member": self._names.setting(duration),
                    "name": comment_text(duration_text(duration)),
                    "default": duration.milliseconds,
                    "shortest": duration.shortest,
                    "longest": duration.longest,
                    "timers": [number for timer, number in numbers.items() if timer.duration is duration],
                }
                for duration in self._model.model.durations
            ],
            "timer_index": unsigned_type(len(timers)),
            "timeouts": len(self._model.events) - len(timers),
            "starting": any(timer.initial for timer in timers) or any(restart.starts for restart in restarts),
            "leaving": any(restart.left is not None for restart in restarts),
            "restarts_read_state": any(isinstance(node, engine.VariableReference) for node in in_restarts),
            "restarts_read_inputs": any(isinstance(node, engine.InputReference) for node in in_restarts),
            "restarts": _merged(
                [
                    (
                        self._enumerator(event),
                        "",
                        [line for restart in event.restarts for line in lines(restart)],
                        False,
                    )
                    for event in self._model.events
                    if event.restarts
                ]
            ),
        }

    def _readers(self) -> dict[str, Any]:
        """Return the incremental loop's tables: the readers of variables that each event writes."""
        model, queued = self._model, len(self._queued)
        conditions = [condition for condition in model.conditions if condition.readers]
        queries = [*self._queued, *self._silent, *model.choices]
        number = {reader: position for position, reader in enumerate((*queries, *conditions))}
        rows = [(of.name, [number[reader] for reader in of.readers]) for of in (*model.events, *conditions)]
        starts = accumulate((len(readers) for _, readers in rows), initial=0)
        places = _GENEROUS * queued
        words = -(-max(len(number), places, len(model.events)) // _WORD)
        chosen = [event.choice.variable.maximum + 1 for event in self._queued if event.choice and event.choice.variable]
        either = self._events[engine.Role.cancel] and self._events[engine.Role.trigger]
        return {
            "watched": len(queries),
            "behind": _BEHIND,
            "after_queued": "QUEUED" if queued else "0U",
            "places": places,
            "queue_index": unsigned_type(queued),
            "place_index": unsigned_type(places),
            "moved_index": unsigned_type(max(chosen, default=1)),
            "ready": "ready_like(self, event)" if either else "&self->ready",
            "words": words,
            "summary": -(-words // _WORD),
            "watched_conditions": [f"{condition.name}(state)" for condition in conditions],
            "watched_index": unsigned_type(len(number)),
            "reader_index": unsigned_type(sum(len(readers) for _, readers in rows)),
            "readers": [
                {"of": comment_text(name), "numbers": ", ".join(map(str, readers))} for name, readers in rows if readers
            ],
            "first_reader": textwrap.fill(", ".join(map(str, starts)), 100, subsequent_indent="    "),
        }


def _merged(cases: Sequence[tuple[str, str, list[str], bool]]) -> list[dict[str, Any]]:
    """Return the cases of a `switch`. Neighbors with equal lines are merged if the second has no comment.

    A case is an enumerator, a comment, the lines, and whether these read a copy of the state.
    """
    merged: list[dict[str, Any]] = []
    for event, remarks, lines, old in cases:
        if merged and merged[-1]["lines"] == lines and not remarks:
            merged[-1]["events"].append(event)
        else:
            merged.append({"events": [event], "comment": remarks, "lines": lines, "old": old})
    return merged


def _lines_of(case: dict[str, Any]) -> list[str]:
    """Return the lines of the conditions of an event's violations."""
    return [*(case["possible"] or ()), *(line for _, lines in case["reasons"] for line in lines)]


def _used_in(condition: engine.Condition) -> str:
    named = [event.name for event in condition.events[:_NAMED]]
    more = len(condition.events) - len(named)
    return f"In the guards of {', '.join(named)}{f' and {more} more' if more else ''}."


def _values(kind: ex.Type) -> str:
    """Return the range of a type in words."""
    match kind:
        case engine.LocationType():
            return f"a location of {comment_text(kind.plant.name)}"
        case ex.EnumerationType():
            return f"a value of {comment_text(kind.enumeration.name)}"
        case ex.IntegerType():
            return f"{kind.minimum} to {kind.maximum}"
    return "true or false"
