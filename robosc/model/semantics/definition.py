"""The model's definition, as a node publishes it on `~/definition`, and its state by the names that users read."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, TypeVar

from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.durations import timer_text
from robosc.model.semantics.edges import edges_from, edges_of
from robosc.model.semantics.messages import is_structured
from robosc.model.semantics.printing import RobotPrinter
from robosc.model.semantics.roles import assumption_name, assumption_text, assumptions, event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Set

_Value = TypeVar("_Value")

#: Kinds of plants of communications.
_COMMUNICATIONS = (sct.PlantKind.message, sct.PlantKind.service, sct.PlantKind.action)
#: Maximum number of recent events in a report on `~/state`. While simulated time is stopped, no report is due for long.
TRANSITIONS_KEPT = 5000


def definition(graph: rosgraph.RosGraph) -> dict[str, Any]:
    """Return the definition as JSON data: components, communication, requirements, and assumptions if there are any.

    A component has states, variables and transitions.
    """
    plants = graph.model.plants
    stored = reported_variables(graph)
    assigning = {(reaction.event, location) for reaction in graph.reactions for location in reaction.locations}
    assumed = [
        {
            "name": assumption_name(plant),
            "events": [event_name(event) for event in dict.fromkeys(edge.event for edge in edges_of(plant))],
            "text": assumption_text(plant),
        }
        for plant in assumptions(graph.model)
    ]
    return {
        "robot": graph.name,
        "components": [
            _component(plant, stored.get(plant.origin, ()), assigning)
            for plant in plants
            if plant.kind == sct.PlantKind.behaviour
        ],
        "communications": [
            {
                "name": plant.origin,
                "kind": plant.kind.name,
                "topic": plant.topic,
                "events": [event_name(event) for event in plant.events],
            }
            for plant in plants
            if plant.kind in _COMMUNICATIONS
        ],
        "requirements": [
            {"event": event_name(requirement.event), "text": requirement.text}
            for requirement in graph.model.requirements
            if requirement.text
        ]
        + [{"text": own.text} for own in [*graph.model.invariants, *graph.model.reachabilityRequirements] if own.text],
        **({"assumptions": assumed} if assumed else {}),
    }


def definition_text(graph: rosgraph.RosGraph) -> str:
    """Return the definition as JSON in ASCII, with one line for each element of its lists."""
    members = (f"{json.dumps(name)}: {_lines(value)}" for name, value in definition(graph).items())
    return "{" + ",\n".join(members) + "}"


def _lines(value: Any) -> str:
    if not isinstance(value, list) or not value:
        return json.dumps(value)
    return "[\n" + ",\n".join(f"  {json.dumps(element)}" for element in value) + "]"


def reported_variables(graph: rosgraph.RosGraph) -> dict[str | None, list[rosgraph.NodeVariable]]:
    """Return the variables that reports show, by component. Arrays and objects are excluded: they may be large."""
    by_component: dict[str | None, list[rosgraph.NodeVariable]] = {}
    for variable in graph.variables:
        if not is_structured(variable.type):
            by_component.setdefault(variable.component, []).append(variable)
    return by_component


def _component(
    plant: sct.Plant, own: Iterable[rosgraph.NodeVariable], assigning: Set[tuple[sct.Event, sct.Location]]
) -> dict[str, Any]:
    return {
        "name": plant.origin or plant.name,
        "states": [
            {"name": location.name, "initial": location.initial, "marked": location.marked}
            for location in plant.locations
        ],
        "variables": [
            *({"name": variable.name, **_type(variable.type)} for variable in plant.variables),
            *({"name": variable.name, **_type(variable.type)} for variable in own),
        ],
        "transitions": [
            _transition(location, edge)
            for location in plant.locations
            for edge in edges_from(location)
            if edge.target != location or edge.updates or edge.guard or (edge.event, location) in assigning
        ],
    }


def _transition(location: sct.Location, edge: sct.Edge) -> dict[str, Any]:
    guard = {} if edge.guard is None else {"guard": RobotPrinter()(edge.guard)}
    after = {} if edge.event.timer is None else {"after": timer_text(edge.event.timer)}
    return {"from": location.name, "to": edge.target.name, "event": event_name(edge.event), **after, **guard}


def _type(kind: ex.Type) -> dict[str, Any]:
    match kind:
        case ex.EnumerationType():
            return {"type": kind.enumeration.name, "values": [literal.name for literal in kind.enumeration.literals]}
        case ex.IntegerType():
            bounds = {"minimum": kind.minimum, "maximum": kind.maximum}
            return {"type": "integer", **{name: bound for name, bound in bounds.items() if bound is not None}}
    names = {ex.BooleanType: "boolean", ex.DoubleType: "double", ex.StringType: "string"}
    return {"type": names[type(kind)]}


def named_state(
    model: sct.SupervisoryControlModel, value: Callable[[sct.Plant | sct.DiscreteVariable], _Value]
) -> dict[str, _Value]:
    """Return the state as users read it: each plant's location by its name, then variables as `Component.variable`.

    `value` returns the name of a plant's location, or the value of a variable.
    """
    state: dict[str, _Value] = {}
    for plant in model.plants:
        state[plant.name] = value(plant)
        for variable in plant.variables:
            state[f"{plant.origin or plant.name}.{variable.name}"] = value(variable)
    return state
