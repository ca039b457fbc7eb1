"""Constant parts of a robot on the page: automata, communication, commands, requirements and texts."""

from __future__ import annotations

from itertools import pairwise
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.analysis.wording import name, words
from robosc.base.diagnostics import in_order
from robosc.language.highlighting.lines import color_lines
from robosc.language.text import Text
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.places import place
from robosc.model.semantics.communication import ANSWERS
from robosc.model.semantics.definition import reported_variables
from robosc.model.semantics.domains import domain
from robosc.model.semantics.edges import edges_of, origin
from robosc.model.semantics.roles import Roles, assumption_text, assumptions, event_name, plant_of
from robosc.run.simulation.data import data_beside
from robosc.tools.diagrams import connections

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic, Span
    from robosc.language.tokens import Token
    from robosc.m2t.models import Models

#: Kinds of automata in a robot's text: behaviors of components, and requirement automata.
AUTOMATA = (sct.PlantKind.behaviour, sct.PlantKind.requirement)
#: Kinds of events that go out to the robot: the supervisor allows or forbids them, and users call them commands.
_OUTGOING = (sct.EventKind.trigger, sct.EventKind.cancel, sct.EventKind.plain, *ANSWERS)
#: Kinds of input fields by type.
_KINDS = {ex.BooleanType: "checkbox", ex.IntegerType: "whole", ex.DoubleType: "number", ex.StringType: "text"}
#: Maximum length of a transition's label. Longer labels are cut; the title has the whole text.
_LONGEST = 60


class Source(NamedTuple):
    """Source of a run in words. `violation`: number of the moment that violates a property, None for other runs."""

    text: str
    violation: int | None = None


SIMULATION = Source("Simulation")


def describe(
    models: Models, texts: Mapping[str, str], findings: Iterable[Diagnostic] = (), source: Source = SIMULATION
) -> dict[str, Any]:
    """Return the description as JSON data; `texts` are the texts of the model's files by their paths.

    `findings` are those about the model. The page shows them in order, consequences below their cause.

    Automata are numbered in the order of the model, and so are the states and transitions of each. A place is a `file`
    (an index in `files`) with the lines and columns of a span, from 1.
    """
    model = models.sct
    describer = _Describer(texts, models.rosgraph)
    automata = [describer.automaton(plant) for plant in automata_of(model)]
    events = {event_name(event): describer.event(event) for event in Roles(model).events}
    requirements = [
        {
            "event": event_name(requirement.event),
            "name": requirement.name or "",
            "text": requirement.text or "",
            "place": describer.place(requirement),
        }
        for requirement in model.requirements
        if requirement.text
    ]
    assumed = [
        {
            "event": event_name(event),
            "name": plant.origin or "",
            "text": assumption_text(plant),
            "place": describer.place(plant),
        }
        for plant in assumptions(model)
        for event in dict.fromkeys(edge.event for edge in edges_of(plant))
    ]
    invariants = [
        {"event": "", "name": invariant.name or "", "text": invariant.text, "place": describer.place(invariant)}
        for invariant in [*model.invariants, *model.reachabilityRequirements]
        if invariant.text
    ]
    return {
        "robot": model.name,
        "source": source.text,
        "violation": source.violation,
        "automata": automata,
        "events": events,
        "commands": [event_name(event) for event in commands_of(model)],
        "requirements": requirements + invariants + assumed,
        "properties": [
            {
                "event": "",
                "name": statement.name or "",
                "text": statement.text or "",
                "place": describer.place(statement),
            }
            for statement in model.properties
        ],
        "findings": [
            {
                "message": finding.message,
                "hint": finding.hint or "",
                "follows": finding.follows > 0,
                "place": describer.span(finding.file, finding.span),
            }
            for finding in in_order(findings)
        ],
        "communication": [] if models.rosgraph is None else _communication(models),
        "files": [{"name": PurePath(path).name, "lines": color_lines(path, text)} for path, text in texts.items()],
    }


def automata_of(model: sct.SupervisoryControlModel) -> list[sct.Plant]:
    """Return the plants that the page draws."""
    return [plant for plant in model.plants if plant.kind in AUTOMATA]


def commands_of(model: sct.SupervisoryControlModel) -> list[sct.Event]:
    """Return the controllable events that go out to the robot."""
    return [event for event in Roles(model).events if event.controllable and event.kind in _OUTGOING]


def transitions_of(plant: sct.Plant) -> list[list[sct.Edge]]:
    """Return the transitions of an automaton, each with all edges that were created for it."""
    by_key: dict[object, list[sct.Edge]] = {}
    for edge in edges_of(plant):
        if not _is_written(edge):
            continue
        key = (origin(edge), edge.target, str(edge.source or ""), edge.event)
        by_key.setdefault(key, []).append(edge)
    return list(by_key.values())


def _is_written(edge: sct.Edge) -> bool:
    """Return whether the text has a transition for an edge.

    An event that a state ignores has an edge, too.
    """
    left = origin(edge)
    silent = edge.target in (None, left) and not edge.updates
    return not silent or (edge.source is not None and str(edge.source) != str(edge.eContainer().source))


class _Describer:
    def __init__(self, texts: Mapping[str, str], graph: rosgraph.RosGraph | None) -> None:
        self._graph = graph
        self._reported = {} if graph is None else reported_variables(graph)
        self._texts = {path: Text(path, text) for path, text in texts.items()}
        self.files: dict[str, int] = {path: number for number, path in enumerate(texts)}

    def place(self, element: Any) -> dict[str, int] | None:
        """Return the place of an element, or None if its text is not available."""
        if element.source is None:
            return None
        return self.span(*place(element))

    def span(self, file: str, span: Span) -> dict[str, int] | None:
        """Return the place of a span, or None if the text of its file is not available."""
        if file not in self.files:
            return None
        return {
            "file": self.files[file],
            "line": span.line,
            "column": span.column,
            "endLine": span.end_line,
            "endColumn": span.end_column,
        }

    def automaton(self, plant: sct.Plant) -> dict[str, Any]:
        """Return an automaton with its states and transitions.

        A transition from every state has `source` null.
        """
        position = {location: number for number, location in enumerate(plant.locations)}
        variables: list[sct.DiscreteVariable | rosgraph.NodeVariable] = [
            *plant.variables,
            *self._stored_variables(plant),
        ]
        return {
            "name": name(plant),
            "key": plant.name,
            "kind": plant.kind.name,
            "variables": [
                {"name": variable.name, "key": f"{plant.origin or plant.name}.{variable.name}"}
                | ({"numeric": True} if isinstance(variable.type, ex.IntegerType | ex.DoubleType) else {})
                for variable in variables
            ],
            "place": self.place(plant),
            "states": [
                {
                    "name": location.name,
                    "initial": bool(location.initial),
                    "marked": bool(location.marked),
                    "place": self.place(location),
                }
                for location in plant.locations
            ],
            "transitions": [
                {
                    "source": None if (left := origin(edges[0])) is None else position[left],
                    "target": position[edges[0].target] if edges[0].target is not None else None,
                    "event": event_name(edges[0].event),
                    **self._label(edges[0]),
                    "place": self.place(edges[0]),
                }
                for edges in transitions_of(plant)
            ],
        }

    def _stored_variables(self, plant: sct.Plant) -> list[rosgraph.NodeVariable]:
        """Return the variables of a component that only the node stores, not the supervisor."""
        return self._reported.get(plant.origin, []) if plant.kind == sct.PlantKind.behaviour else []

    def _label(self, edge: sct.Edge) -> dict[str, str]:
        """Return the text of a transition without comments, whole and shortened for the picture."""
        tokens = self._tokens(edge)
        whole = _spelled(tokens) if tokens else words(edge.event).replace("`", "")
        shorter = tokens[:-2] if len(tokens) > 1 and tokens[-2].is_keyword("goto") else tokens
        shorter = shorter[1:] if len(shorter) > 1 and shorter[0].is_keyword("transition") else shorter
        short = _spelled(shorter) if shorter else whole
        return {"label": short if len(short) <= _LONGEST else f"{short[: _LONGEST - 1]}…", "whole": whole}

    def _tokens(self, edge: sct.Edge) -> list[Token]:
        """Return the tokens of a transition, or none if its text is not available."""
        if edge.source is None:
            return []
        file, span = place(edge)
        text = self._texts.get(file)
        if text is None or span.end_line > text.content.count("\n") + 1:
            return []
        first = text.tokens.index_at(text.offset(span.line, span.column))
        after = text.tokens.index_at(text.offset(span.end_line, span.end_column))
        return [text.tokens[index] for index in range(first, after)]

    def event(self, event: sct.Event) -> dict[str, Any]:
        """Return an event with its words, its place and its possible data."""
        return {
            "words": words(event).replace("`", ""),
            "controllable": bool(event.controllable),
            "owner": plant_of(event).origin or plant_of(event).name,
            "place": self.place(event) or self.place(plant_of(event)),
            **({"timer": True} if event.timer is not None else {}),
            "inputs": [
                {"name": event_input.name, "label": _label(event_input), **_values(event_input.type)}
                for event_input in event.inputs
            ],
            "kept": [] if self._graph is None else self._beside(event, self._graph),
        }

    @staticmethod
    def _beside(event: sct.Event, graph: rosgraph.RosGraph) -> list[dict[str, Any]]:
        """Return the data of an event that only the node stores: the path of fields, and the kind of input field."""
        types_by_path = data_beside(graph, event)
        is_lone = not event.inputs and len(types_by_path) == 1
        return [
            {"path": list(path), "label": "value" if is_lone and len(path) < 2 else ".".join(["value", *path])}
            | {"kind": _KINDS[type(kind)]}
            for path, kind in types_by_path.items()
        ]


def _spelled(tokens: Sequence[Token]) -> str:
    """Return tokens as in their text, with one blank in place of blanks and comments."""
    pieces = [tokens[0].text]
    for before, token in pairwise(tokens):
        pieces += [" " if token.start > before.end else "", token.text]
    return "".join(pieces)


def _label(event_input: sct.Input) -> str:
    """Return the path of an input in the data of its event, as the text of the model writes it."""
    return event_input.text or ".".join(["value", *event_input.name.split("_")[2:]])


def _values(kind: ex.Type) -> dict[str, Any]:
    """Return the values of a type: all of them, or the minimum and the maximum."""
    match kind:
        case ex.BooleanType():
            return {"values": [False, True]}
        case ex.IntegerType():
            return {"minimum": kind.minimum, "maximum": kind.maximum}
    assert isinstance(kind, ex.EnumerationType)
    low, high = domain(kind)
    return {"values": [literal.name for literal in kind.enumeration.literals[low : high + 1]]}


def _communication(models: Models) -> list[dict[str, Any]]:
    """Return the topics, services and actions of the controller, with the communications that use them."""
    assert models.rosgraph is not None
    return [
        {
            "name": connection.name,
            "kind": connection.kind,
            "direction": connection.direction,
            "types": connection.types,
            "uses": connection.uses,
        }
        for connection in connections(models.rosgraph)
    ]
