"""Data in a generated node: conversions, assignments, ranges, defaults, missing elements, numbers that are not finite.

The model is `tests/m2t/cpp/courier.rscd`, the steps are those of `send_to_courier.py`.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

from robosc.base.files.resources import locate

if TYPE_CHECKING:
    from tests.ros.conftest import Courier

HERE = Path(__file__).parent
NOTHING = '"nothing" ??/ */ \\'


def variables(courier: Courier, step: str, component: str) -> dict[str, Any]:
    values: dict[str, Any] = courier.steps[step]["components"][component]["variables"]
    return values


def sent(courier: Courier, step: str, topic: str) -> Any:
    return courier.steps[step]["sent"][topic]["data"]


def position(courier: Courier, step: str) -> tuple[float, float, float]:
    point = courier.steps[step]["sent"]["target"]["pose"]["position"]
    return point["x"], point["y"], point["z"]


def test_starts_with_the_initial_values_of_the_model(courier: Courier) -> None:
    assert variables(courier, "start", "Scanner") == {"seen": "nothing", "first": -1.5, "before": 0, "fourth": 0.25}
    assert variables(courier, "start", "Counter") == {
        "limited": 0,
        "total": 0,
        "capped": 3,
        "class": "small",
        "text": NOTHING,
    }
    assert sent(courier, "start", "report") == NOTHING
    assert "target" not in courier.steps["start"]["sent"]


def test_sends_the_default_where_no_statement_provides_data(courier: Courier) -> None:
    # A comparison with NaN is false, also with `!=`; a rule that reads past the end does not match.
    assert variables(courier, "no angle", "Scanner")["seen"] == "far"
    assert position(courier, "no angle") == (0, 0, 0)


def test_stamps_headers_and_sends_quaternions_of_length_one(courier: Courier) -> None:
    target = courier.steps["no angle"]["sent"]["target"]
    assert target["header"]["frame_id"] == "map"
    assert target["pose"]["orientation"] == {"x": 0, "y": 0, "z": 0, "w": 1}
    stamp = target["header"]["stamp"]
    assert stamp not in ("0", {"sec": 0, "nanosec": 0})


def test_assigns_all_at_once(courier: Courier) -> None:
    assert position(courier, "ahead") == (0.5, 3.0, 13.0)
    assert variables(courier, "swapped", "Scanner") == {"seen": "ahead", "first": 3.0, "before": 0.5, "fourth": 1.0}
    assert courier.steps["left"]["components"]["Scanner"]["state"] == "turning"
    assert courier.steps["swapped"]["components"]["Scanner"]["state"] == "looking"
    assert position(courier, "swapped") == (3.0, 0.5, 1.0)


def test_does_not_receive_what_reads_past_the_end_and_says_so(courier: Courier) -> None:
    # The other event of the same message still occurs.
    assert variables(courier, "short", "Scanner") == {"seen": "ahead", "first": 0.5, "before": 3.0, "fourth": 7.0}
    assert variables(courier, "empty", "Scanner")["seen"] == "far"
    assert variables(courier, "empty", "Scanner")["first"] == 0.5
    assert "/scan: there is no element 3 in an array of 1" in courier.node_output


def test_withholds_what_is_not_finite_and_says_so(courier: Courier) -> None:
    assert variables(courier, "infinite", "Scanner")["seen"] == "ahead"
    assert variables(courier, "infinite", "Scanner")["fourth"] is None
    assert "target" not in courier.steps["infinite"]["sent"]
    assert "target is withheld: its pose.position.z would not be finite" in courier.node_output
    assert variables(courier, "division by zero", "Counter")["capped"] == 0
    assert "ratio" not in courier.steps["division by zero"]["sent"]


def test_saturates_at_ranges_and_wire_types(courier: Courier) -> None:
    high = {"limited": 200, "total": 60000, "capped": -300, "class": "large", "text": NOTHING}
    assert variables(courier, "high count", "Counter") == high
    assert sent(courier, "high count", "sum") == 255
    assert sent(courier, "high count", "ratio") == pytest.approx(-200)
    low = {"limited": -5, "total": -5536, "capped": 300, "class": "negative", "text": NOTHING}
    assert variables(courier, "low count", "Counter") == low
    assert sent(courier, "low count", "sum") == 0


def test_holds_back_what_a_requirement_forbids(courier: Courier) -> None:
    assert not {"target", "report"} & set(courier.steps["high count"]["sent"])
    assert {"target", "report"} <= set(courier.steps["low count"]["sent"])


def test_stores_and_sends_any_text(courier: Courier) -> None:
    # The count is still above 100: the node withholds the report, but stores the text.
    assert variables(courier, "word", "Counter")["text"] == 'idle "ü" \\ \n'


def test_evaluates_booleans(courier: Courier) -> None:
    assert sent(courier, "high count", "busy") is True
    assert sent(courier, "low count", "busy") is False
    assert sent(courier, "word", "busy") is True
    assert sent(courier, "idle", "busy") is False


def test_logs_events_with_their_data(courier: Courier) -> None:
    words = [entry["data"]["value"] for entry in courier.log if entry["event"] == "message_word.u_response"]
    assert words == ['idle "ü" \\ \n', "idle"]
    sides = [entry["data"] for entry in courier.log if entry["event"] == "message_side.u_response"]
    # Each scan arrives once, after the node is connected; scans with too few elements cause no `detail`.
    assert [side["value"] for side in sides] == ["far", "ahead", "ahead", "ahead", "far", "left", "ahead"]
    details = [entry.get("data") for entry in courier.log if entry["event"] == "message_detail.u_response"]
    ranges = [(3.0, 7.0), (0.5, 7.0), (0.5, None), (3.0, 1.0), (0.5, 1.0)]
    assert details == [{"value": {"ranges": {"0": first, "3": fourth}}} for first, fourth in ranges]
    targets = [entry.get("data") for entry in courier.log if entry["event"] == "message_target.c_trigger"]
    assert {"value": {"pose": {"position": {"x": 0.5, "y": 3.0, "z": 13.0}}}} in targets
    assert {"value": {}} in targets
    assert {"data_target.c_d1", "component_Scanner.c_tau1"} < {
        entry["event"] for entry in courier.log if entry["direction"] == "internal"
    }
    validator = Draft202012Validator(json.loads(locate("schemas/event-log.schema.json").read_text()))
    assert not [error for entry in courier.log for error in validator.iter_errors(entry)]
    times = [entry["time"] for entry in courier.log]
    assert times == sorted(times)
    assert not math.isnan(times[0])


def test_a_compiled_node_tells_its_state_as_a_message(courier: Courier) -> None:
    if not any(step["typed"] for step in courier.steps.values()):
        pytest.skip("the package of the message's type is built with a compiled node")
    text = (HERE.parent / "m2t" / "typed_state" / "State.msg").read_text()
    values: dict[str, list[str]] = {}
    constants: list[str] = []
    for name, is_constant in re.findall(r"^\w+ (\w+)(=\d+)?$", text, re.MULTILINE):
        if is_constant:
            constants.append(name)
        else:
            values[name], constants = constants, []
    for name, step in courier.steps.items():
        typed = step["typed"]
        for component, status in step["components"].items():
            state = values[component.lower()][typed[component.lower()]]
            assert state == f"{component}_is_{status['state']}".upper()
            for variable, value in status["variables"].items():
                field = f"{component}_{variable}".lower()
                seen = typed[field]
                if values[field]:
                    assert values[field][seen] == f"{field}_is_{value}".upper(), name
                else:
                    assert seen == value or value is None, name
