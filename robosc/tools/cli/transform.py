"""Command `robosc transform`."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import click

from robosc.base.files.reading import inputs
from robosc.base.files.writing import write
from robosc.language.configuration import LOCATIONS
from robosc.m2t.targets import TARGETS, Target, targets, together
from robosc.synthesis.memory import limit_memory
from robosc.tools.cli import CallError, interruption, put, say
from robosc.tools.cli.options import Paths, configuration, findings_format, memory, model, paths, synthesizer
from robosc.tools.cli.progress import progress
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report
from robosc.tools.cli.tuning import tuning

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models, TraceTest


#: Valid names of a ROS package or a CMake target.
_INCLUDING = re.compile(r"[A-Za-z][\w.-]*", re.ASCII)


def _targets(_context: click.Context, _parameter: click.Parameter, values: Sequence[str]) -> list[Target]:
    names = [name.strip() for value in values for name in value.split(",")]
    known = targets()
    for name in names:
        if name not in known:
            raise click.BadParameter(f"unknown target {name!r}, expected one of {', '.join(known)}")
    return [known[name] for name in dict.fromkeys(names)]


def _into(_context: click.Context, _parameter: click.Parameter, name: str | None) -> str | None:
    if name is not None and not _INCLUDING.fullmatch(name):
        raise click.BadParameter(
            f"{name!r} is not a name of a package or a target of CMake: use letters, digits, _, - and ."
        )
    return name


class _Command(click.Command):
    """Lists the targets in its help, with those of installed packages. Explains how to name several of them."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        words = list(args)
        try:
            return super().parse_args(ctx, args)
        except click.UsageError as error:
            names = [name for name in (word.removeprefix("--to=") for word in words) if name in targets()]
            if len(names) > 1 and "extra argument" in error.message:
                raise click.UsageError(f"{error.message}: write `--to {','.join(names)}`", ctx) from error
            raise

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        lines = (f"  {target.name:<15} {target.description}" for target in targets().values())
        self.epilog = "\n".join(["\b", "Targets:", *lines])
        super().format_epilog(ctx, formatter)


@click.command("transform", cls=_Command)
@model
@click.option("--to", "targets", required=True, multiple=True, callback=_targets, metavar="TARGET[,TARGET]")
@click.option("-o", "--output", type=click.Path(file_okay=False), help="The output folder.  [default: build/<robot>]")
@configuration
@click.option(
    "--with-tests", is_flag=True, help="Add a test that plays event traces against the node, and a Dockerfile."
)
@click.option(
    "--typed-state",
    is_flag=True,
    help="The node also publishes its state as a message. The package of its type is generated beside it.",
)
@click.option(
    "--into",
    metavar="NAME",
    callback=_into,
    help="Generate no package, but code that your package NAME includes with CMake (for `supervisor`: the target"
    " NAME). fragment.cmake builds the code; inputs.txt lists the files that it comes from.",
)
@click.option(
    "--confirm",
    "confirmed",
    multiple=True,
    type=click.Choice(list(LOCATIONS.values())),
    help="Allow this key of the configuration to name a folder outside of the model's folder; repeatable.",
)
@click.option(
    "--list-inputs",
    is_flag=True,
    help="Write nothing; print all input files of the model, one per line, for build tools.",
)
@findings_format
@memory
@synthesizer
@tuning
@paths
def command(
    model: str,
    targets: Sequence[Target],
    output: str | None,
    chosen: str | None,
    with_tests: bool,
    typed_state: bool,
    into: str | None,
    confirmed: Sequence[str],
    list_inputs: bool,
    form: str,
    megabytes: int,
    paths: Paths,
) -> None:
    """Check a robot, synthesize its supervisor and generate the TARGETs, all of them or none.

    MODEL is a .rscd file with a robot, or an .xmi file written by an earlier `--to xmi`. If no target is a ROS package,
    it may also be a .cif file, which the generated CIF imports from its place.

    \b
    Examples:
      robosc transform line_follower.rscd --to ros2
      robosc transform line_follower.rscd --to ros1 --with-tests
      robosc transform line_follower.rscd --to cif,supervisor,xmi -o out
      robosc transform out/LineFollower.sct.xmi --to cif
      robosc transform line_follower.rscd --to ros2 --list-inputs
      robosc transform line_follower.rscd --to ros2 --into my_robot -o generated

    Exit status: 0 success, 1 errors in the model, 2 a wrong call, 3 no supervisor exists.
    """
    _refuse_what_does_not_fit(targets, with_tests, typed_state, into)
    with Report(form, aside=list_inputs) as report:
        models = read_models(model, paths, report, cif=not any(target.needs_graph for target in targets))
        for target in targets:
            if target.needs_graph and models.rosgraph is None:
                raise CallError(f"{model} has no ROS graph, which {target.name} needs: use its .rosgraph.xmi or .rscd")
        settings = _settings(model, chosen, typed_state, into, report)
        # The output of a build stays in the build.
        copied = [] if into else targets
        copies = _copies(Path(model).parent, copied, settings, confirmed, report)
        report.stop_on_errors()
        if list_inputs:
            put("\n".join(_inputs()))
            return
        supervise_models(models, report, memory=megabytes << 20)
        for target in targets:
            report.add(target.findings(models, settings))
        report.stop_on_errors()
        folder = Path(output or f"build/{models.sct.name}")
        models = replace(models, folder=folder)
        tests: dict[Target, TraceTest | None] = {}
        files = {}
        with together(), limit_memory(megabytes << 20, "generating"):
            for target in targets:
                with progress(f"generating {target.name}"):
                    tests[target] = _tests(target, models, settings, paths) if with_tests else None
                    files[target] = target.files(models, settings, tests[target], into=into)
        if into is None:
            trees = _trees(folder, files, copies, models, settings)
        else:
            (generated,) = files.values()
            trees = {folder: {**generated, "inputs.txt": "".join(f"{name}\n" for name in _inputs())}}
        interruption.check()
        with progress(f"writing to {folder}"):  # may wait for another run
            changed = set(write(trees))
    for written, texts in trees.items():
        resolved = written.resolve()
        say(f"{written}: {len(texts)} files, {sum(resolved / name in changed for name in texts)} written", err=True)
    _tell_coverage(tests)


def _settings(model: str, chosen: str | None, typed_state: bool, into: str | None, report: Report) -> Configuration:
    """Return the configuration, changed by the options of the call. Conflicts go to the report."""
    settings = read_configuration(model, chosen, report)
    settings = settings.model_copy(update={"typed_state": typed_state or settings.typed_state})
    if into and settings.typed_state:
        message = (
            "code for your own package cannot have a typed state: a separate package builds the message before the node"
        )
        hint = "remove the typed state or --into: without --into, both packages are written"
        report.add([settings.error(("typedState",), message, hint)])
    return settings


def _tests(target: Target, models: Models, settings: Configuration, paths: Paths) -> TraceTest | None:
    """Return the test for the package of a target. None if the target has no tests."""
    from robosc.run.node_tests.trace_test import trace_test_of

    return trace_test_of(target, models, settings, paths.interfaces)


def _tell_coverage(tests: Mapping[Target, TraceTest | None]) -> None:
    for target, test in tests.items():
        if test is not None:
            say(f"{target.name}: the tests cover {test.coverage}", err=True)
            for missed in test.missed:
                say(f"  not seen: {missed}", err=True)


def _refuse_what_does_not_fit(targets: Sequence[Target], with_tests: bool, typed_state: bool, into: str | None) -> None:
    if with_tests and not any(target.tested_ros for target in targets):
        tested = [target.name for target in TARGETS.values() if target.tested_ros]
        raise CallError(f"--with-tests is for {' and '.join(tested)}: the other targets have no tests")
    if typed_state and not any(target.package for target in targets):
        nodes = [target.name for target in TARGETS.values() if target.package]
        raise CallError(f"--typed-state is for {', '.join(nodes)}: the other targets have no node")
    if into is not None and not (len(targets) == 1 and targets[0].can_be_included):
        included = [target.name for target in TARGETS.values() if target.can_be_included]
        raise CallError(f"--into is for one of {', '.join(included)}")


def _inputs() -> list[str]:
    """Return the absolute paths of all input files."""
    return sorted(str(Path(name).resolve()) for name in inputs())


def _copies(
    folder: Path, targets: Sequence[Target], configuration: Configuration, confirmed: Sequence[str], report: Report
) -> dict[Target, Path]:
    """Return the folders for copies that the configuration of the model in `folder` names. Errors go to the report.

    The author of the configuration may not be the user who runs the tool. Folders outside of the model's folder
    therefore need confirmation.
    """
    copies = {}
    for target in targets:
        named = getattr(configuration.output, target.location) if target.location else None
        if not target.location or not named:
            continue
        key = LOCATIONS[target.location]
        try:
            copies[target] = folder / Path(named).expanduser()
            inside = copies[target].resolve().is_relative_to(folder.resolve())
        except (OSError, RuntimeError, ValueError) as error:
            report.add([configuration.error(tuple(key.split(".")), f'"{key}" names no folder: {error}')])
            continue
        if not inside and key not in confirmed:
            message = f'"{key}" names {copies[target]}, which is outside of the model\'s folder'
            hint = f"to allow files there, add --confirm {key}"
            report.add([configuration.error(tuple(key.split(".")), message, hint)])
    return copies


def _trees(
    folder: Path,
    generated: Mapping[Target, dict[str, str]],
    copies: Mapping[Target, Path],
    models: Models,
    configuration: Configuration,
) -> dict[Path, dict[str, str]]:
    """Return the texts of each folder: all targets below the output folder, and the configured copies."""
    trees: dict[Path, dict[str, str]] = {folder: {}}
    packages: dict[PurePosixPath, Target] = {}
    for target, files in generated.items():
        below = PurePosixPath(target.folder(models, configuration))
        if target.package and packages.setdefault(below, target) is not target:
            names = f"{packages[below].name} and {target.name}"
            raise CallError(f'{names} would both be {below}: "package.name" names both; generate one at a time')
        trees[folder] |= {(below / path).as_posix(): text for path, text in files.items()}
        trees[folder] |= target.beside(models, configuration)
        if target in copies:
            trees.setdefault(copies[target], {}).update(files)
    return trees
