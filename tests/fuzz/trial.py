"""One text through the whole pipeline: invariants that hold for any text, and the outcome."""

from __future__ import annotations

import os
import re
import shutil
import signal
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn

from click.testing import CliRunner

import robosc
import robosc.language.cif
from robosc.analysis.supervise import EmptySupervisorError, supervise
from robosc.base.diagnostics import START, Diagnostic, ModelError, as_json, as_sarif, as_text, has_errors
from robosc.language.checks import check
from robosc.language.configuration import FILE_NAME
from robosc.language.reading import read
from robosc.m2t.models import Models
from robosc.m2t.targets import TARGETS
from robosc.model import robosc as rsc
from robosc.model.validity import faults
from robosc.tools import cli
from tests.fuzz.mutants import LIBRARIES
from tests.fuzz.saved_mutants import UNTOLD, saved_mutant

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path


#: More characters of output than any hand-written model needs.
MOST_OUTPUT = 1_000_000
#: Control characters except the line feed, changes of direction, invisible characters, and noncharacters.
_UNSEEN = re.compile(
    "[\\x00-\\x09\\x0b-\\x1f\\x7f-\\x9f\\u200b-\\u200f\\u2028-\\u202e\\u2060-\\u2069\\ufeff\\ufffe\\uffff]"
)


class HangError(Exception):
    """A model took too long."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise HangError after a number of seconds of CPU time, which does not depend on the load of the machine."""

    def ended(*_: Any) -> NoReturn:
        raise HangError(f"more than {seconds} s")

    before = signal.signal(signal.SIGPROF, ended)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


@dataclass(frozen=True)
class Outcome:
    """Outcome of a trial: the exit statuses that `check` and `transform` must return, and any models."""

    check_status: int
    status: int
    findings: Sequence[Diagnostic]
    models: Models | None = None


def tried(path: Path, targets: Sequence[str]) -> Outcome:
    """Read, check, transform, synthesize and generate; every error must be a located finding.

    Raises AssertionError for a finding outside its text and for a model that violates its metamodel.
    """
    reading = read(path, [LIBRARIES])
    found = [*reading.findings, *check(reading.base, reading.findings)]
    _located(found, reading.texts)
    if has_errors(found) or not isinstance(reading.base, rsc.Robot):
        return Outcome(int(has_errors(found)), 2 if isinstance(reading.base, rsc.Library) else 1, found)
    try:
        return _generated(reading.base, found, reading.texts, targets)
    except ModelError as error:
        _located(error.diagnostics, reading.texts)
        return Outcome(
            0,
            3 if isinstance(error, EmptySupervisorError) else int(has_errors(error.diagnostics)),
            [*found, *error.diagnostics],
        )


def _generated(robot: rsc.Robot, found: list[Diagnostic], texts: dict[str, str], targets: Sequence[str]) -> Outcome:
    graph = robosc.to_rosgraph(robot)
    models = Models(robosc.to_sct(robot), graph, robot)
    for model in (models.sct, graph):
        assert [fault for _, fault in faults(model)] == []
    supervision = supervise(models.sct)
    _located(supervision.findings, texts)
    if has_errors(supervision.findings):
        raise ModelError(supervision.findings)
    configuration = robosc.Configuration()
    if graph.serviceClients or graph.actionClients:
        targets = [target for target in targets if not TARGETS[target].needs_graph]  # They support messages only.
    refused = [finding for target in targets for finding in TARGETS[target].findings(models, configuration)]
    _located(refused, texts)
    if has_errors(refused):
        raise ModelError(refused)
    for target in targets:
        for name, text in robosc.generate(target, models).items():
            assert text.endswith("\n"), f"{target}: {name}"
    return Outcome(0, 0, [*found, *supervision.findings, *refused], models)


def called(path: Path, seed: int) -> int:
    """Run the same steps on the command line and check the exit statuses; return that of `transform`."""
    outcome = tried(path, ["cif"])
    form = ("text", "json", "sarif")[seed % 3]
    checking = _run("check", str(path), "-I", str(LIBRARIES), "--format", form)
    assert checking == outcome.check_status, f"check ends with {checking}, not {outcome.check_status}"
    synthesizing = _run("synthesize", str(path), "-I", str(LIBRARIES))
    transforming = _run(
        "transform", str(path), "-I", str(LIBRARIES), "--to", "cif", "-o", str(path.parent / "generated")
    )
    assert transforming == outcome.status, f"transform ends with {transforming}, not {outcome.status}"
    if "cif" not in {finding.rule for finding in outcome.findings}:
        assert synthesizing == outcome.status, f"synthesize ends with {synthesizing}, not {outcome.status}"
    return transforming


#: Commands for a saved model, with `MODEL` and `OUT`.
_ASKED = (
    "check MODEL",
    "check MODEL --format json",
    "check MODEL --format sarif",
    "synthesize MODEL",
    "synthesize MODEL --json",
    "explain MODEL --event move",
    "diagram MODEL",
    "simulate MODEL --random 20",
    "transform MODEL --to cif,supervisor,xmi -o OUT",
    "transform MODEL --to ros1,ros2 --with-tests -o OUT",
    "transform MODEL --to ros2-layer -o OUT",
)


def saved_tried(folder: Path, seed: int) -> int:
    """Save a mutant of a saved model, beside files that it may name but must not reveal, and run a command on it.

    Returns the exit status. Raises AssertionError if the status is not one of the documented ones, and if the output
    reveals the content of a file outside the model.
    """
    (folder / "secret.txt").write_text(UNTOLD, encoding="utf-8")
    models = folder / f"models{seed}"
    models.mkdir()
    os.mkfifo(models / "pipe")
    mutated, files = saved_mutant(seed)
    for name, text in files.items():
        (models / name).write_bytes(text.encode("utf-8", "surrogatepass"))
    words = _ASKED[seed % len(_ASKED)].split()
    places = {"MODEL": str(models / mutated), "OUT": str(models / "out")}
    try:
        status, output = said(*(places.get(word, word) for word in words))
    finally:
        shutil.rmtree(models)
    assert UNTOLD not in output, "a file beside the folder is told of"
    assert os.environ.get("PATH", UNTOLD) not in output, "the environment is told of"
    return status


def cif_tried(folder: Path, files: dict[str, bytes]) -> int:
    """Write a CIF specification, and check, synthesize and transform it; return the status of `synthesize`.

    Raises AssertionError for a finding outside its text and for commands that contradict each other.
    """
    for name, content in files.items():
        (folder / name).write_bytes(content)
    path = folder / next(iter(files))
    reading = robosc.language.cif.read(path)
    _located(reading.findings, reading.texts)
    assert (reading.model is None) == has_errors(reading.findings)
    checking = _run("check", str(path))
    assert checking == int(has_errors(reading.findings)), f"check ends with {checking}"
    synthesizing = _run("synthesize", str(path))
    transforming = _run("transform", str(path), "--to", "cif", "-o", str(folder / "generated"))
    assert (synthesizing, transforming) in ([(1, 1)] if checking else [(0, 0), (3, 3), (0, 1), (1, 1)]), (
        f"synthesize ends with {synthesizing}, transform with {transforming}"
    )
    return synthesizing


def _run(*arguments: str) -> int:
    return said(*arguments)[0]


def said(*arguments: str) -> tuple[int, str]:
    """Run the command line; return its exit status and its output.

    Raises AssertionError for an undocumented status, for more text than a person reads, and for characters that move
    the cursor of a terminal.
    """
    result = CliRunner().invoke(cli.main, arguments)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    output = result.output
    assert result.exit_code in {0, 1, 2, 3}, f"{' '.join(arguments)} ends with {result.exit_code}: {output[-300:]}"
    assert "Traceback" not in output
    # Machine-readable formats list all findings, the text format at most a hundred.
    most = MOST_OUTPUT * (10 if "--format" in arguments else 1)
    assert len(output) < most, f"{' '.join(arguments)} prints {len(output)} characters"
    unseen = set(_UNSEEN.findall(output))
    assert not unseen, f"{' '.join(arguments)} prints {unseen}"
    return result.exit_code, output


def _located(findings: Sequence[Diagnostic], texts: dict[str, str]) -> None:
    """Check that findings lie within their texts, have a message, and can be printed in each format."""
    # A finding about the configuration concerns a missing entry, so it has no text.
    by_name = {FILE_NAME: "", **{path.rpartition("/")[2]: text for path, text in texts.items()}}
    for finding in findings:
        text = texts[finding.file] if finding.file in texts else by_name[finding.file]
        assert finding.message, finding
        assert finding.span == START or _inside(finding, text.split("\n")), finding
    if findings:
        assert as_text.render(findings, texts)
        assert as_json.render(findings)
        assert as_sarif.render(findings, robosc.__version__)


def _inside(finding: Diagnostic, lines: list[str]) -> bool:
    span = finding.span
    ends = ((span.line, span.column), (span.end_line, span.end_column))
    return ends[0] <= ends[1] and all(
        1 <= line <= len(lines) and 1 <= column <= len(lines[line - 1]) + 1 for line, column in ends
    )
