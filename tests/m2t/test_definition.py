"""The model as a node publishes it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from jsonschema import Draft202012Validator

from robosc.base.files.resources import locate
from robosc.model.semantics.definition import definition, definition_text

if TYPE_CHECKING:
    import robosc


def test_fits_its_schema_and_is_what_the_text_says(courier: robosc.Models) -> None:
    assert courier.rosgraph is not None
    text = definition_text(courier.rosgraph)
    assert text.isascii()
    assert json.loads(text) == definition(courier.rosgraph)
    schema = json.loads(locate("schemas/definition.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator(schema).validate(definition(courier.rosgraph))


def test_says_states_variables_transitions(courier: robosc.Models) -> None:
    assert courier.rosgraph is not None
    scanner, counter = definition(courier.rosgraph)["components"]
    assert [state["name"] for state in scanner["states"] if state["initial"]] == ["looking"]
    assert {
        "from": "looking",
        "to": "turning",
        "event": "component_Scanner.c_tau1",
        "guard": "Scanner.seen = left",
    } in (scanner["transitions"])
    assert {"name": "seen", "type": "Side", "values": ["left", "ahead", "far", "nothing"]} in scanner["variables"]
    assert {"name": "limited", "type": "integer", "minimum": -5, "maximum": 200} in counter["variables"]
    assert {"name": "total", "type": "integer"} in counter["variables"]
