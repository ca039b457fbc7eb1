"""The measurement of a layer's costs: its model, its steps for a message, its page."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from benchmarks import layer_cost
from benchmarks.performance_page import KINDS, PAGE, page
from robosc.model.semantics.evaluation import Program
from robosc.run.runtime.core import composer
from tests.run.runtime.fake import LayerBench, Record

if TYPE_CHECKING:
    from collections.abc import Callable

    import pytest


def velocity(linear: float, angular: float = 0.5) -> Record:
    return Record(linear=Record(x=linear, y=0.0, z=0.0), angular=Record(x=7.0, y=0.0, z=angular))


def bench() -> LayerBench:
    """Return the measured layer after a first velocity."""
    made = LayerBench(layer_cost.MODEL)
    assert made.passes("velocity", velocity(0.5))
    return made


def scan(made: LayerBench, distance: float) -> None:
    made.hear("/scan", ranges=[distance] * 3)


def test_the_layer_limits_and_judges_velocities() -> None:
    made = bench()
    assert made.forwarded("velocity", velocity(2.0, 0.9)) == velocity(1.0, 0.9).plain()
    scan(made, 0.4)
    assert made.forwarded("velocity", velocity(0.5)) == velocity(0.3).plain()
    assert not made.passes("velocity", velocity(0.5, 0.9))
    scan(made, 2.0)
    made.hear("/emergency_stop", data=True)
    assert not made.passes("velocity", velocity(0.0))


def test_steps_of_a_message(monkeypatch: pytest.MonkeyPatch) -> None:
    """Numbers of evaluations for a velocity. They do not grow unnoticed."""
    made, steps = bench(), Counter[str]()

    def count(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def counted(*arguments: Any) -> Any:
            steps[name] += 1
            return function(*arguments)

        return counted

    engine = made.layer._control.engine
    for name, guards in (("guards", engine._guards), ("guards of data", engine._data_guards)):
        guards.update({event: count(name, guard) for event, guard in guards.items()})
    monkeypatch.setattr(Program, "__call__", count("expressions", Program.__call__))
    for name in ("copy", "deepcopy", "doubles_read", "stored_doubles"):
        monkeypatch.setattr(composer, name, count(name, getattr(composer, name)))
    assert made.passes("velocity", velocity(0.5))
    # The message and its linear part are copied. The value of a limit, a condition, and the data of a requirement.
    assert steps == {"guards": 1, "guards of data": 2, "copy": 2, "expressions": 3}
    scan(made, 0.4)
    steps.clear()
    assert made.passes("velocity", velocity(0.5))
    assert steps == {"guards": 1, "guards of data": 2, "copy": 2, "expressions": 4}


def test_sections_without_measurements_stay() -> None:
    times = {"median": 0.5, "p99": 1.25, "max": 2.0}
    nodes = {name: times | {"processor": 40.0} for name in ("relay", "layer")}
    measured = {"direct": times, **nodes, "hz": 1000, "seconds": 20.0, "rounds": 5}
    before = PAGE.read_text(encoding="utf-8")
    after = page({"machine": "two shared cores", "layer": {KINDS[-1].key: measured}}, before)
    assert [line for line in after.splitlines() if line.startswith("# ")] == ["# Performance"]
    assert "| ROS 2, `robosc run`: layer | 0.50 | 1.25 | 40 µs |" in after
    kept = before.partition("\n## ")[2].partition("\n## A layer")[0]
    assert kept.strip() in after
    assert page({"machine": "two shared cores"}, after) == after
