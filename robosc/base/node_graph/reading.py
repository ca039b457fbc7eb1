"""The JSON file of a node graph, read and checked."""

import json
import re
from collections.abc import Callable
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from robosc.base.diagnostics import Diagnostic, ModelError, Severity, Span
from robosc.base.files import reading as files
from robosc.base.files.json_places import duplicates, position, reason_of, span_of
from robosc.base.files.json_reading import JsonError, json_value
from robosc.base.node_graph import PARTS, NodeGraph, node_graph

RULE = "node-graph"


def _requires(pattern: str, meaning: str) -> Callable[[str], str]:
    """Return a check of a text that raises ValueError with the meaning of the pattern."""

    def check(text: str) -> str:
        if not re.fullmatch(pattern, text):
            raise ValueError(f"must be {meaning}")
        return text

    return check


def _require_type(types: list[str]) -> list[str]:
    if not types:
        raise ValueError("must have a type")
    return types


_NAME, _TYPE = "(/[A-Za-z0-9_]+)+", "[A-Za-z0-9_]+(/(msg|srv|action))?/[A-Za-z0-9_]+"
_Name = Annotated[
    str,
    AfterValidator(_requires(_NAME, "a full name, such as /cmd_vel")),
    Field(json_schema_extra={"pattern": f"^{_NAME}$"}),
]
_Type = Annotated[
    str,
    AfterValidator(_requires(_TYPE, "a type, such as geometry_msgs/Twist")),
    Field(json_schema_extra={"pattern": f"^{_TYPE}$"}),
]
_Types = dict[_Name, Annotated[list[_Type], AfterValidator(_require_type), Field(json_schema_extra={"minItems": 1})]]


class _Checked(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class _Node(_Checked):
    name: _Name = Field(description="The full name of the node, such as /arm/driver.")
    publishers: _Types = Field(default={}, description="Types of the topics that the node publishes.")
    subscribers: _Types = Field(default={}, description="Types of the topics that the node subscribes to.")
    service_servers: _Types = Field(default={}, description="Types of the services that the node serves.")
    service_clients: _Types = Field(default={}, description="Types of the services that the node calls.")
    action_servers: _Types = Field(default={}, description="Types of the actions that the node serves.")
    action_clients: _Types = Field(default={}, description="Types of the actions that the node starts.")


class _Graph(_Checked):
    model_config = ConfigDict(title="Node graph: the nodes of a running ROS system")

    nodes: list[_Node]


def read(file: str) -> NodeGraph:
    """Return the graph in a JSON file. Raises ModelError with all its errors, and OSError."""
    try:
        text = files.read(file).decode("utf-8")
        values = json_value(text)
    except UnicodeDecodeError as error:
        raise ModelError([_error(file, f"not UTF-8: {error.reason} at byte {error.start}")]) from error
    except JsonError as error:
        line, column = position(text, error.position)
        raise ModelError([_error(file, str(error), Span(line, column, line, column + 1), error.hint)]) from error
    findings = [_error(file, f'the key "{key}" occurs twice', span) for key, span in duplicates(text)]
    try:
        graph = _Graph.model_validate(values)
    except ValidationError as error:
        findings += [_error(file, reason_of(fault), span_of(text, fault["loc"])) for fault in error.errors()]
    if findings:
        raise ModelError(findings)
    endpoints = [
        (node.name, part, name, kind)
        for node in graph.nodes
        for part in PARTS
        for name, types in getattr(node, part).items()
        for kind in types
    ]
    return node_graph([node.name for node in graph.nodes], endpoints)


def schema() -> str:
    """Return the JSON Schema of the file, as in `robosc/schemas`."""
    document = {"$schema": "https://json-schema.org/draft/2020-12/schema", **_Graph.model_json_schema()}
    return json.dumps(document, indent=2) + "\n"


def _error(file: str, message: str, span: Span | None = None, hint: str | None = None) -> Diagnostic:
    return Diagnostic(file, span or Span(1, 1, 1, 1), Severity.ERROR, RULE, message, hint)
