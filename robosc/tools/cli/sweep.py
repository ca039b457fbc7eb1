"""Command `robosc sweep`."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from rich.console import Console
from rich.table import Table
from rich.text import Text

from robosc.analysis.system import format_count
from robosc.base.diagnostics.visible import visible
from robosc.base.files import reading as files
from robosc.language import configuration as config
from robosc.language.libraries import declared_name, search_folders
from robosc.tools.cli import WRONG_CALL, CallError, interruption, say
from robosc.tools.cli.options import FILE, Paths, configuration, memory, paths
from robosc.tools.cli.progress import note_slow_diagrams, progress
from robosc.tools.cli.report import Report
from robosc.tools.sweep.jobs import Job, absolute, inputs_of, perform
from robosc.tools.sweep.results import Results, Row
from robosc.tools.sweep.variants import SettingError, combinations, replaced, require_at_most, whole_numbers
from robosc.tools.workers import completed, processors

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

_SUFFIXES = (".rscd", ".cif")
_STYLES = {0: ("ok", "green"), 1: ("failed", "bold red"), 2: ("not done", "yellow"), 3: ("no supervisor", "bold red")}
#: Width of the table without a terminal.
_WIDTH = 120


@click.command("sweep")
@click.argument("action", type=click.Choice(["check", "synthesize", "verify", "test"]))
@click.argument("targets", nargs=-1, required=True, type=click.Path(exists=True), metavar="PATH...")
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="NAME=A,B,C",
    help="Use each of these values, or a range such as 1..9, for a constant or parameter; repeat for all combinations.",
)
@click.option("--seeds", metavar="A..B", help="With test: play a random walk for each seed instead of scenarios.")
@click.option(
    "--events", type=click.IntRange(1), default=1000, show_default=True, help="The number of events of a random walk."
)
@click.option(
    "--scenarios",
    type=FILE,
    multiple=True,
    help="With test: play these scenarios with all models; repeatable.  [default: MODEL.scenarios beside MODEL.rscd]",
)
@click.option(
    "--engine",
    type=click.Choice(["python", "c"]),
    default="python",
    show_default=True,
    help="The control loop that plays scenarios.",
)
@click.option(
    "--output", type=click.Path(dir_okay=False), help="Append a line of JSON for each job to FILE, and resume."
)
@click.option("--jobs", type=click.IntRange(1), metavar="N", help="Use N processes.  [default: one for each processor]")
@click.option("--cluster", metavar="ADDRESS", help="Use a cluster: dask:tcp://HOST:PORT or ray:ADDRESS.")
@configuration
@memory
@paths
def command(
    action: str,
    targets: Sequence[str],
    settings: Sequence[str],
    seeds: str | None,
    events: int,
    scenarios: Sequence[str],
    engine: str,
    output: str | None,
    jobs: int | None,
    cluster: str | None,
    chosen: str | None,
    megabytes: int,
    paths: Paths,
) -> None:
    """Check, synthesize, verify or test many models and variants of models, in processes or on a cluster.

    PATH is a model, or a folder with models at any depth. A job is one model with one combination of the values of
    --set and one seed. --output appends the result of each job as soon as it is done. The same call resumes an
    interrupted sweep: it repeats only jobs that are not in the file, or whose inputs have changed. docs/sweep.md
    describes the results and clusters.

    \b
    Examples:
      robosc sweep check robots
      robosc sweep synthesize cell.rscd --set places=1..10 --output results.jsonl
      robosc sweep verify robots --jobs 4 --output results.jsonl
      robosc sweep test robots --seeds 1..100 --events 5000
      robosc sweep verify robots --cluster dask:tcp://10.0.0.1:8786 --output results.jsonl

    Exit status: the highest one of a job, as its command alone has it: 0 success, 1 errors, a refuted property or a
    failed scenario, 2 a wrong call, 3 no supervisor exists.
    """
    if action != "test" and (seeds or scenarios):
        raise click.UsageError("--seeds and --scenarios need `sweep test`")
    if cluster and jobs:
        raise click.UsageError("--cluster has its own processes: remove it or --jobs")
    if seeds and scenarios:
        raise click.UsageError("--seeds and --scenarios exclude each other")
    own: dict[str, Any] = {"check": {}, "test": {"engine": engine}}.get(action, {"megabytes": megabytes})
    if seeds:
        own = {"megabytes": megabytes, "events": events}
    with Report(aside=True):
        try:
            numbers = [None] if seeds is None else whole_numbers(seeds)
            variants = combinations(settings)
            played = None if action == "test" and not seeds and not scenarios else scenarios
            models = _models(targets, action, needs_scenarios=played is None)
            require_at_most(len(models) * len(variants) * len(numbers))
            planned = [
                replace(job, settings=tuple(own.items()), seed=seed)
                for job in _variants(action, models, variants, played, chosen, paths)
                for seed in numbers
            ]
        except SettingError as error:
            raise CallError(str(error)) from error
    by_identity = {job.identity: job for job in planned}
    with Results(output) as results:
        killed = _do(by_identity, results, jobs, cluster, resumable=output is not None)
        rows = [results.by_job.get(identity) for identity in by_identity]
    _show(list(by_identity.values()), rows)
    status = max([WRONG_CALL if killed else 0, *(row.status for row in rows if row is not None)])
    if status:
        raise click.exceptions.Exit(status)


def _models(targets: Sequence[str], action: str, *, needs_scenarios: bool) -> list[str]:
    """Return the models in files and folders. Models in folders are left out if the action cannot apply to them."""
    models: list[str] = []
    for target in targets:
        if not Path(target).is_dir():
            beside = Path(target).with_suffix(".scenarios")
            if needs_scenarios and not beside.is_file():
                raise CallError(f"{target} has no {beside.name} beside it; add --scenarios FILE or --seeds A..B")
            models.append(target)
            continue
        below = sorted(path for path in Path(target).rglob("*") if path.suffix in _SUFFIXES and path.is_file())
        for path in below:
            hidden = any(part.startswith(".") for part in path.relative_to(target).parts)
            library = path.suffix == ".rscd" and action != "check" and declared_name(files.read(path)) is not None
            unplayed = needs_scenarios and not path.with_suffix(".scenarios").is_file()
            if not hidden and not library and not unplayed:
                models.append(str(path))
    if not models:
        raise CallError(f"{', '.join(targets)}: there is no model to {action}")
    return list(dict.fromkeys(models))


def _variants(
    action: str,
    models: Sequence[str],
    variants: Sequence[Mapping[str, str]],
    scenarios: Sequence[str] | None,
    chosen: str | None,
    paths: Paths,
) -> Iterator[Job]:
    """Yield a job for each variant of each model, with the bytes of its inputs.

    `scenarios` are the same for all models; None for those beside each model. Raises SettingError for all models.
    """
    environment = [folder for folder in os.environ.get("ROBOSC_INTERFACE_PATH", "").split(os.pathsep) if folder]
    libraries = [str(folder) for folder in search_folders(paths.libraries)[:-1]]
    searched = Paths(libraries, [*paths.interfaces, *environment])
    faults = []
    for model in models:
        try:
            changes = replaced(model, searched, variants) if variants != [{}] else [{}]
        except SettingError as error:
            faults += str(error).splitlines()
            continue
        contents = inputs_of(model, searched)
        settings = chosen or (config.find(Path(model).parent) if action in {"verify", "test"} else None)
        played = [str(Path(model).with_suffix(".scenarios"))] if scenarios is None else scenarios
        for name in [*([str(settings)] if settings else []), *played]:
            contents[absolute(name)] = files.read(name)
        for variant, changed in zip(variants, changes, strict=True):
            texts = {absolute(name): text.encode() for name, text in changed.items()}
            yield Job(
                action,
                model,
                searched,
                contents | texts,
                str(Path.cwd()),
                None if settings is None else str(settings),
                tuple(played),
                values=tuple(variant.items()),
            )
    if faults:
        raise SettingError("\n".join(dict.fromkeys(faults)))


def _do(planned: Mapping[str, Job], results: Results, jobs: int | None, cluster: str | None, *, resumable: bool) -> int:
    """Do the jobs without a result, and return the number of those whose process was killed."""
    rest = [job for identity, job in planned.items() if identity not in results.by_job]
    before = len(planned) - len(rest)
    if before:
        say(f"{before} of {format_count(len(planned), 'job')} have results already", err=True)
    if any(job.command != "check" for job in rest):
        note_slow_diagrams()
    done = killed = 0
    try:
        with progress(lambda: f"{before + done} of {format_count(len(planned), 'job')} done"):
            number = min(jobs or processors(), max(len(rest), 1))
            for _, line in completed(perform, rest, number, cluster):
                interruption.check()
                if line is None:
                    killed += 1
                else:
                    results.add(line)
                    done += 1
    except KeyboardInterrupt:
        hint = "; the same call does the others" if resumable else ""
        say(f"interrupted: {before + done} of {format_count(len(planned), 'job')} have results{hint}", err=True)
        raise
    return killed


def _show(planned: Sequence[Job], rows: Sequence[Row | None]) -> None:
    """Print a table of the results, in the order of the call."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = _WIDTH
    table = Table()
    for heading in ("model", "variant", "status", "result"):
        table.add_column(heading)
    table.add_column("seconds", justify="right")
    for job, row in zip(planned, rows, strict=True):
        variant = [
            *(f"{name}={value}" for name, value in job.values),
            *([] if job.seed is None else [f"seed {job.seed}"]),
        ]
        if row is None:
            status, style, result, seconds = (
                "killed",
                "bold red",
                "its process was killed, most often for its memory",
                "",
            )
        else:
            status, style = _STYLES.get(row.status, ("internal error", "bold red"))
            result, seconds = row.summary, f"{row.seconds:.2f}"
        cells = [Text(visible(cell)) for cell in (job.model, " ".join(variant))]
        table.add_row(*cells, Text(status, style), Text(visible(result)), seconds)
    console.print(table)
    failed = sum(row is None or row.status != 0 for row in rows)
    say(f"\n{format_count(len(rows), 'job')}: {len(rows) - failed} ok, {failed} failed")
