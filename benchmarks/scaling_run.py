"""Run one measurement of `scaling.py` in its own process; print the results as JSON.

    python benchmarks/scaling_run.py TOOL MODEL.rscd

TOOL is `robosc`, all of it phase by phase, or only the synthesis by the definition (`definition`) or by `faudes`. At a
limit of processor time, it prints its results up to then.
"""

from __future__ import annotations

import json
import signal
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "examples" / "plugins" / "robosc-faudes")]

from robosc_faudes.automata import faudes_states  # noqa: E402

import robosc  # noqa: E402
from benchmarks.families import FAMILIES  # noqa: E402
from robosc.analysis.supervise import diagnose  # noqa: E402
from robosc.base.diagnostics import has_errors  # noqa: E402
from robosc.language import reading  # noqa: E402
from robosc.synthesis import Phase, Statistics  # noqa: E402
from tests.synthesis.oracle import Oracle  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.model.robosc import Robot

INTERFACES = [ROOT / "benchmarks" / "interfaces"]
TARGETS = ("cif", "supervisor", "ros1", "ros2")


class Costs(Statistics):
    """Costs of each phase: wall seconds, and processor seconds."""

    def __init__(self) -> None:
        super().__init__()
        self.phases: dict[str, tuple[float, float]] = {}

    @contextmanager
    def during(self, phase: str) -> Iterator[None]:
        """Add the costs of the `with` block to a phase."""
        began = perf_counter(), process_time()
        before = self.phases.get(phase, (0.0, 0.0))
        try:
            with super().during(Phase(phase)) if phase in {*Phase} else _nothing():
                yield
        finally:
            took = perf_counter() - began[0], process_time() - began[1]
            self.phases[phase] = before[0] + took[0], before[1] + took[1]


@contextmanager
def _nothing() -> Iterator[None]:
    yield


class _LimitError(Exception):
    pass


def main() -> None:
    tool, model = sys.argv[1:]
    found: dict[str, Any] = {"finished": False}
    signal.signal(signal.SIGXCPU, _stop)
    try:
        {"robosc": _robosc, "definition": _definition, "faudes": _faudes}[tool](Path(model), found)
        found["finished"] = True
    except (_LimitError, MemoryError):
        pass
    print(json.dumps(found))


def _stop(*_: object) -> None:
    # The signal comes again each second.
    signal.signal(signal.SIGXCPU, signal.SIG_IGN)
    raise _LimitError


def _robosc(path: Path, found: dict[str, Any]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        # One-time loading and building is no part of the phases.
        first = Path(folder) / "first.rscd"
        first.write_text(FAMILIES["sensors"].text(1))
        _transform(first, Costs(), {})
    costs = Costs()
    found["phases"] = costs.phases
    try:
        _transform(path, costs, found)
    finally:
        found |= {"peak_nodes": costs.peak_nodes, "operations": costs.operations, "rounds": costs.rounds}


def _transform(path: Path, costs: Costs, found: dict[str, Any]) -> None:
    robot = _robot(path, costs)
    with costs.during("check"):
        assert not has_errors(robosc.check(robot, INTERFACES))
    with costs.during("m2m"):
        models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot, INTERFACES), robot)
    synthesis = diagnose(models.sct, statistics=costs)
    models.sct.supervisor = synthesis.supervisor
    found |= {"uncontrolled": synthesis.uncontrolled_states, "states": synthesis.controlled_states}
    found["nodes"] = synthesis.bdd_nodes
    for target in TARGETS:
        with costs.during(target):
            robosc.generate(target, models)


def _robot(path: Path, costs: Costs) -> Robot:
    link = reading.link

    def linking(*arguments: Any) -> Any:
        with costs.during("link"):
            return link(*arguments)

    with costs.during("parse"), patch.object(reading, "link", linking):
        robot = robosc.load(path, (), INTERFACES)
    parse, link_ = costs.phases["parse"], costs.phases["link"]
    costs.phases["parse"] = parse[0] - link_[0], parse[1] - link_[1]
    return robot


def _definition(path: Path, found: dict[str, Any]) -> None:
    costs = Costs()
    found["phases"] = costs.phases
    oracle = Oracle(robosc.to_sct(robosc.load(path, (), INTERFACES)))
    with costs.during("synthesis"):
        found |= {"uncontrolled": len(oracle.uncontrolled), "states": len(oracle.controlled)}


def _faudes(path: Path, found: dict[str, Any]) -> None:
    costs = Costs()
    found["phases"] = costs.phases
    model = robosc.to_sct(robosc.load(path, (), INTERFACES))
    found["uncontrolled"], found["states"] = faudes_states(model, costs.during)


if __name__ == "__main__":
    main()
