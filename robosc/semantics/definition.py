"""The model's definition, as a node publishes it on `~/definition`: what viewers draw, and what `~/state` refers to."""

from __future__ import annotations

import json
from typing import Any

from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.semantics.edges import edges_from
from robosc.semantics.printing import RobotPrinter
from robosc.semantics.roles import event_name

#: A report on `~/state` tells the last so many events. Where simulated time stands still there is none for long.
TRANSITIONS_KEPT = 5000


def definition(graph: rosgraph.RosGraph) -> dict[str, Any]:
    """The definition as JSON data: components with states, variables and transitions, communication, requirements."""
    plants = graph.model.plants
    return {
        "robot": graph.name,
        "components": [_component(each, graph) for each in plants if each.kind == sct.PlantKind.behaviour],
        "communications": [
            {"name": each.origin, "kind": each.kind.name, "topic": each.topic, "events": _events(each)}
            for each in plants
            if each.kind not in (sct.PlantKind.behaviour, sct.PlantKind.data)
        ],
        "requirements": [
            {"event": event_name(each.event), "text": each.text} for each in graph.model.requirements if each.text
        ],
    }


def definition_text(graph: rosgraph.RosGraph) -> str:
    """The definition as JSON in ASCII, a line for each element of its lists."""
    members = (f"{json.dumps(name)}: {_lines(value)}" for name, value in definition(graph).items())
    return "{" + ",\n".join(members) + "}"


def _lines(value: Any) -> str:
    if not isinstance(value, list) or not value:
        return json.dumps(value)
    return "[\n" + ",\n".join(f"  {json.dumps(each)}" for each in value) + "]"


def _component(plant: sct.Plant, graph: rosgraph.RosGraph) -> dict[str, Any]:
    mine = [each for each in graph.variables if each.component == plant.origin]
    assigning = {(reaction.event, each) for reaction in graph.reactions for each in reaction.locations}
    return {
        "name": plant.origin or plant.name,
        "states": [{"name": each.name, "initial": each.initial, "marked": each.marked} for each in plant.locations],
        "variables": [
            *({"name": each.name, **_type(each.type)} for each in plant.variables),
            *({"name": each.name, **_type(each.type)} for each in mine),
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
    return {"from": location.name, "to": edge.target.name, "event": event_name(edge.event), **guard}


def _events(plant: sct.Plant) -> list[str]:
    return [event_name(each) for each in plant.events]


def _type(kind: ex.Type) -> dict[str, Any]:
    match kind:
        case ex.EnumerationType():
            return {"type": kind.enumeration.name, "values": [each.name for each in kind.enumeration.literals]}
        case ex.IntegerType():
            bounds = {"minimum": kind.minimum, "maximum": kind.maximum}
            return {"type": "integer", **{name: bound for name, bound in bounds.items() if bound is not None}}
    names = {ex.BooleanType: "boolean", ex.DoubleType: "double", ex.StringType: "string"}
    return {"type": names[type(kind)]}
