"""Audits of event logs: what a node logs has no findings, and changed lines have."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from robosc.base.ros_types import RosTypes
from robosc.run.audit import LogError, LogJudge
from tests.run.audit.test_audit import graph_of
from tests.run.audit.test_parts import CART
from tests.run.audit.test_runs import ROBOTS, recorded_run
from tests.run.runtime.fake import LayerBench, Record

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.model import rosgraph
    from robosc.run.audit import Audit


def audit_of(graph: rosgraph.RosGraph, path: Path, **options: Any) -> Audit:
    return LogJudge(graph.model, graph, RosTypes(), str(path), **options).run()


def line(time: float, direction: str, event: str, value: Any = None) -> dict[str, Any]:
    data = {} if value is None else {"data": {"value": value}}
    return {"time": time, "direction": direction, "event": event, **data}


def write(path: Path, lines: Sequence[dict[str, Any]]) -> Path:
    path.write_text("".join(f"{json.dumps(entry)}\n" for entry in lines), encoding="utf-8")
    return path


@pytest.mark.parametrize("model", ROBOTS)
def test_the_log_of_a_controller_has_no_findings(model: str, tmp_path: Path) -> None:
    recorded_run(Path(model), ROBOTS[model], 4, tmp_path, 150)
    audit = audit_of(graph_of(Path(model)), tmp_path / "events.jsonl")
    assert audit.commands > 5
    assert [(finding.event, finding.because) for finding in audit.findings] == []


def test_a_command_between_the_lines_is_found(tmp_path: Path) -> None:
    """Put a command behind each line; the same judge of bags by hand is not needed: the layer says what it blocks."""
    bench = LayerBench(Path("tests/m2t/layer/usher.rscd"), log=tmp_path / "events.jsonl")
    for charge in (50, 10, 30):
        bench.hear("battery", data=charge)
        bench.passes("speed", Record())
    bench.hear("/stop")
    bench.passes("speed", Record())
    bench.layer.flush_log()
    bench.layer.close()
    lines = [json.loads(text) for text in (tmp_path / "events.jsonl").read_text().splitlines()]
    graph = graph_of(Path("tests/m2t/layer/usher.rscd"))
    assert audit_of(graph, tmp_path / "events.jsonl").findings == []
    # The layer blocked two commands; sent around it, they are the findings.
    around = [entry | {"direction": "outside"} if entry["direction"] == "blocked" else entry for entry in lines]
    audit = audit_of(graph, write(tmp_path / "around.jsonl", around))
    assert [finding.because for finding in audit.findings] == [
        ["requirement speed needs Guard.charge > 20"],
        ["requirement speed needs Guard.clear"],
    ]
    assert audit.commands == 4


def test_events_that_the_model_does_not_expect_are_found(tmp_path: Path) -> None:
    lines = [
        line(1.0, "in", "message_done.u_response"),  # against A1
        line(1.1, "out", "message_down.c_trigger"),
        line(1.2, "in", "message_done.u_response"),
        line(1.3, "out", "message_gear.c_trigger", 1),
        line(1.4, "out", "message_gear.c_trigger", 3),
        line(1.5, "out", "message_gear.c_trigger"),  # its data is not in the log
        line(1.6, "in", "message_seen.u_response", "far"),
        line(1.7, "in", "message_gone.u_response"),
        line(1.8, "blocked", "message_gear.c_trigger", 3),
    ]
    audit = audit_of(graph_of(CART), write(tmp_path / "events.jsonl", lines))
    assert [(str(finding.kind), finding.event, finding.reason) for finding in audit.findings] == [
        ("assumption", "message_done.u_response", "assumption"),
        ("forbidden", "message_gear.c_trigger", "requirement"),
        ("unexpected", "message_seen.u_response", "data"),
        ("unexpected", "message_gone.u_response", "unknown"),
    ]


def test_a_damaged_log_is_reported_with_its_line(tmp_path: Path) -> None:
    graph, path = graph_of(CART), tmp_path / "events.jsonl"
    good = json.dumps(line(1.0, "out", "message_down.c_trigger"))
    path.write_text(f"{good}\n{good[:20]}", encoding="utf-8")
    audit = audit_of(graph, path)
    assert (audit.commands, audit.notes) == (1, ["line 2 is incomplete"])
    for bad in ("[1]", "{", '{"time": "x"}', '{"time": 1e300, "direction": "in", "event": "a"}', "\x00"):
        path.write_text(f"{good}\n{bad}\n", encoding="utf-8")
        with pytest.raises(LogError) as error:
            audit_of(graph, path)
        assert error.value.line == 2
