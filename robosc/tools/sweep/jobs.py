"""Jobs of a sweep: a job holds the texts of all its inputs, so that any machine with the same robosc can do it."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path, PurePath
from random import Random
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any

from robosc import __version__
from robosc.analysis.supervise import Supervision, supervise
from robosc.analysis.verify import Outcome, verify
from robosc.analysis.verify.properties import requirement_name
from robosc.analysis.verify.verdict import as_json
from robosc.base.files import reading as files
from robosc.base.files.writing import temporary_folder
from robosc.language import configuration
from robosc.model import sct
from robosc.model.semantics.evaluation import evaluate
from robosc.run.simulation import Simulation
from robosc.run.simulation.session import trace_line
from robosc.tools.cli import ERRORS_FOUND
from robosc.tools.cli.options import Paths
from robosc.tools.cli.reading import read, read_models
from robosc.tools.cli.report import Report, attempt
from robosc.tools.cli.test import Call, as_objects, play_all
from robosc.tools.sweep.variants import is_shipped

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.m2t.models import Models
    from robosc.tools.cli.test import Run

#: Ends of the names of files that count in a folder with ROS types.
_DEFINITIONS = (".msg", ".srv", ".action", "package.xml", "_IGNORE")


@dataclass(frozen=True)
class Job:
    """A command on a variant of a model.

    `model`, `config` and `scenarios` are paths as in the call, and `settings` its options by name. `contents` are the
    bytes of all input files by their absolute paths, and `folder` is the working folder. With a `seed`, `test` plays a
    random walk.
    """

    command: str
    model: str
    paths: Paths
    contents: Mapping[str, bytes]
    folder: str
    config: str | None = None
    scenarios: Sequence[str] = ()
    settings: tuple[tuple[str, Any], ...] = ()
    values: tuple[tuple[str, str], ...] = ()
    seed: int | None = None

    @property
    def identity(self) -> str:
        """Digest of all that determines the result: version, command, settings, and the inputs by relative path."""
        inputs = sorted(
            (os.path.relpath(path, self.folder), hashlib.sha256(content).hexdigest())
            for path, content in self.contents.items()
        )
        searched = [[os.path.relpath(path, self.folder) for path in own] for own in vars(self.paths).values()]
        own = [self.command, self.model, self.config, self.scenarios, self.settings, self.values, self.seed]
        return hashlib.sha256(json.dumps([__version__, own, inputs, searched]).encode()).hexdigest()[:32]


def inputs_of(model: str, paths: Paths) -> dict[str, bytes]:
    """Return the contents of a model and all that it imports, by absolute path. Raises OSError."""
    content = files.read(model)
    named = [model]
    if b"import" in content or model.endswith(".automata"):
        with files.record_inputs():
            read(model, Paths(paths.libraries), Report())
            named += files.inputs()
    for folder in paths.interfaces:
        named += [str(path) for path in Path(folder).rglob("*") if path.name.endswith(_DEFINITIONS) and path.is_file()]
    return {absolute(name): files.read(name) for name in dict.fromkeys(named) if not is_shipped(name)}


def absolute(path: str) -> str:
    """Return a path from the root, without `..`; links stay."""
    return os.path.normpath(Path(path).absolute())


def perform(job: Job) -> dict[str, Any]:
    """Do a job in a temporary folder, and return its line of results: an object that JSON can hold."""
    began, used = perf_counter(), process_time()
    with temporary_folder() as place:
        root = place.resolve()

        def inside(path: str) -> str:
            whole = PurePath(os.path.normpath(Path(job.folder, path)))
            return str(root / whole.relative_to(whole.anchor))

        for path, content in job.contents.items():
            target = Path(inside(path))
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        status, result, error, findings = _attempted(job, inside)
        answer = {
            "id": job.identity,
            "command": job.command,
            "model": job.model,
            "set": dict(job.values),
            "seed": job.seed,
            "exit_status": status,
            "error": error,
            "result": result,
            "findings": findings,
            "seconds": round(perf_counter() - began, 3),
            "processor_seconds": round(process_time() - used, 3),
            "version": __version__,
        }
        # Paths as the user knows them: relative below the working folder, else absolute.
        text = json.dumps(answer, ensure_ascii=False)
        for path in (f"{inside(job.folder)}{os.sep}", str(root)):
            text = text.replace(json.dumps(path, ensure_ascii=False)[1:-1], "")
    replaced: dict[str, Any] = json.loads(text)
    return replaced


def _attempted(job: Job, inside: Callable[[str], str]) -> tuple[int, dict[str, Any], str | None, list[Any]]:
    """Return the exit status that the command alone would have, its result, its error, and its findings."""
    paths = Paths(*([inside(path) for path in own] for own in (job.paths.libraries, job.paths.interfaces)))
    result: dict[str, Any] = {}
    status, error, findings = attempt(lambda report: _COMMANDS[job.command](job, inside, paths, report, result))
    return status, result, error, findings


def _check(job: Job, inside: Callable[[str], str], paths: Paths, report: Report, _result: dict[str, Any]) -> int:
    read(inside(job.model), paths, report)
    return 0


def _supervised(
    job: Job, inside: Callable[[str], str], paths: Paths, report: Report
) -> tuple[Models, Supervision | None]:
    """Return the models with their supervisor, and its synthesis unless the model had one."""
    models = read_models(inside(job.model), paths, report, cif=True)
    if models.sct.supervisor is not None:
        return models, None
    supervision = supervise(models.sct, memory=dict(job.settings)["megabytes"] << 20)
    report.add(supervision.findings)
    report.stop_on_errors()
    return models, supervision


def _synthesize(job: Job, inside: Callable[[str], str], paths: Paths, report: Report, result: dict[str, Any]) -> int:
    _, supervision = _supervised(job, inside, paths, report)
    if supervision is not None:
        synthesis = supervision.synthesis
        statistics = synthesis.statistics
        result |= {
            "controlled_states": synthesis.controlled_states,
            "uncontrolled_states": synthesis.uncontrolled_states,
            "operations": statistics.operations,
            "peak_nodes": statistics.peak_nodes,
        }
    return 0


def _verify(job: Job, inside: Callable[[str], str], paths: Paths, report: Report, result: dict[str, Any]) -> int:
    models, _ = _supervised(job, inside, paths, report)
    config = configuration.read(Path(inside(job.config))) if job.config else configuration.Configuration()
    verdicts = verify(models, config)
    report.add(finding for verdict in verdicts for finding in verdict.findings)
    result |= json.loads(as_json(models.sct.name, verdicts))
    return ERRORS_FOUND if any(verdict.outcome is Outcome.REFUTED for verdict in verdicts) else 0


def _test(job: Job, inside: Callable[[str], str], paths: Paths, report: Report, result: dict[str, Any]) -> int:
    if job.seed is not None:
        return _walk(job, inside, paths, report, result)
    scenarios = [inside(scenario) for scenario in job.scenarios]
    runs: list[Run] = []
    config = inside(job.config) if job.config else None
    play_all(Call(inside(job.model), scenarios, dict(job.settings)["engine"], chosen=config, paths=paths), report, runs)
    result["scenarios"] = as_objects(runs)
    return 0


def _walk(job: Job, inside: Callable[[str], str], paths: Paths, report: Report, result: dict[str, Any]) -> int:
    """Play random events. It fails in a state that violates an invariant, or that is not marked and has no event."""
    models, _ = _supervised(job, inside, paths, report)
    simulation = Simulation(models.sct, models.rosgraph, models.ros_types)
    claims: list[sct.StateInvariant | sct.InvariantProperty] = [*models.sct.invariants]
    claims += [own for own in models.sct.properties if isinstance(own, sct.InvariantProperty)]
    random = Random(job.seed)  # noqa: S311
    fault, most = None, dict(job.settings)["events"]
    for number in range(most + 1):
        violated = [own for own in claims if not evaluate(own.condition, simulation.engine.read)]
        if violated:
            fault = f"violated: {requirement_name(violated[0])}"
            break
        if number < most and simulation.random_step(random) is None:
            fault = None if _is_marked(simulation) else "no event is possible in a state that is not marked"
            break
    result |= {"events": len(simulation.trace), "fault": fault}
    if fault is not None:
        result["trace"] = [json.loads(trace_line(happened)) for happened in simulation.trace]
    return ERRORS_FOUND if fault else 0


def _is_marked(simulation: Simulation) -> bool:
    engine = simulation.engine
    marked = all(plant.locations[engine.location(plant)].marked for plant in engine.model.plants)
    return marked and all(evaluate(predicate, engine.read) for predicate in engine.model.markerPredicates)


_COMMANDS = {"check": _check, "synthesize": _synthesize, "verify": _verify, "test": _test}
