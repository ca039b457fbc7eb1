"""Command `robosc audit`."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from functools import wraps
from typing import TYPE_CHECKING, Any

import click

from robosc.base.diagnostics.visible import visible
from robosc.base.recordings import RecordingError
from robosc.run.audit.as_text import lines
from robosc.run.audit.findings import MILLISECOND
from robosc.tools.cli import ERRORS_FOUND, CallError, interruption, put, say
from robosc.tools.cli.options import Paths, configuration, model, paths, synthesizer
from robosc.tools.cli.parameters import parameters, set_parameters
from robosc.tools.cli.progress import progress
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.engine.state import Value
    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.model import sct
    from robosc.run.audit import LogJudge, RecordingJudge
    from robosc.run.audit.judge import Watch

#: A recorder and a controller get the messages of two topics in different orders: on a busy computer, some tens of
#: milliseconds apart.
TOLERANCE_MS = 50


def _remappings(_context: click.Context, _parameter: click.Parameter, texts: Sequence[str]) -> dict[str, str]:
    names = {}
    for text in texts:
        name, separator, other = text.partition(":=")
        if not (name and separator and other):
            raise click.BadParameter(f"{text!r} is not FROM:=TO, such as /cmd_vel:=/base/cmd_vel")
        names[name] = other
    return names


@dataclass(frozen=True)
class Judgment:
    """Options of a judgment: the state at the start, the tolerance in milliseconds, and the names of the recording."""

    state: str | None = None
    tolerance: float = TOLERANCE_MS
    namespace: str = ""
    remappings: Mapping[str, str] = field(default_factory=dict)


def judging(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options of a judgment to a command, which receives them as `judgment`."""

    @click.option(
        "--from-state",
        "state",
        metavar="STATE",
        help="The state at the start of the recording: `Door=open,Gauge.level=3`.  [default: the initial state]",
    )
    @click.option(
        "--tolerance",
        type=click.FloatRange(min=0, max=60_000),
        default=TOLERANCE_MS,
        show_default=True,
        metavar="MS",
        help="Accept a command that is permitted at most this many milliseconds earlier or later.",
    )
    @click.option("--namespace", default="", metavar="NS", help="The namespace of relative names in the recording.")
    @click.option(
        "--remap",
        "-r",
        "remappings",
        multiple=True,
        metavar="FROM:=TO",
        callback=_remappings,
        help="The recording has the topic, service or action TO in place of FROM; repeatable.",
    )
    @wraps(command)
    def with_judgment(
        *, state: str | None, tolerance: float, namespace: str, remappings: Mapping[str, str], **options: Any
    ) -> None:
        command(judgment=Judgment(state, tolerance, namespace, remappings), **options)

    return with_judgment


@click.command("audit")
@model
@click.argument("recording", type=click.Path(exists=True, readable=True))
@click.option("--json", "as_object", is_flag=True, help="Print one JSON object.")
@judging
@parameters
@configuration
@synthesizer
@paths
def command(
    model: str,
    recording: str,
    as_object: bool,
    judgment: Judgment,
    parameter_texts: Sequence[str],
    chosen: str | None,
    paths: Paths,
) -> None:
    """Judge a recorded run: commands that a requirement forbids, violated assumptions, unexpected events.

    MODEL is a .rscd file with a robot, or an .xmi file written by `transform --to xmi`. RECORDING is a bag of ROS 1
    (.bag), a folder of `ros2 bag`, an .mcap or a .db3 file, or the event log of a node. The robot needs no node of
    RoboSC: the command reads the messages of the model's topics. It needs no ROS.

    \b
    Examples:
      robosc audit line_follower.rscd rosbag2_2026_11_24-10_20_30
      robosc audit line_follower.rscd drive.bag --from-state LineDetector=following
      robosc audit line_follower.rscd run.mcap --tolerance 20 --json
      robosc view line_follower.rscd --audit run.mcap

    Exit status: 0 no findings, 1 findings or errors in the model, 2 a wrong call, 3 no supervisor exists.
    """
    with Report(aside=True) as report:
        models = read_models(model, paths, report)
        set_parameters(models.rosgraph, parameter_texts)
        settings = read_configuration(model, chosen, report)
        supervise_models(models, report)
    judge = judge_of(models, settings, recording, judgment)
    fault = run(judge)
    audit = judge.audit
    if fault and audit.end is None:
        raise CallError(fault)
    if as_object:
        put(json.dumps(audit.as_json(), indent=2))
    else:
        for line in lines(audit):
            say(visible(line))
    if fault:
        raise CallError(fault)
    if audit.findings:
        raise click.exceptions.Exit(ERRORS_FOUND)


def judge_of(
    models: Models,
    settings: Configuration,
    recording: str,
    judgment: Judgment,
    watch: Watch | None = None,
) -> RecordingJudge | LogJudge:
    """Return the judge of a recording. Raises CallError."""
    from robosc.base.recordings import is_recording
    from robosc.base.ros_types import RosTypes
    from robosc.model.semantics.roles import event_name
    from robosc.run.audit import AuditOptions, LogJudge, RecordingJudge
    from robosc.run.audit.judge import safe_messages

    types = models.ros_types or RosTypes()
    start = {} if judgment.state is None else _state(models.sct, judgment.state)
    if not is_recording(recording):
        graph = models.rosgraph
        safe = [] if graph is None else [event_name(message.event) for message in safe_messages(graph, settings)]
        return LogJudge(models.sct, graph, types, recording, start, watch, safe)
    if models.rosgraph is None:
        raise CallError("the model has no ROS graph: use its .rosgraph.xmi or .rscd")
    options = AuditOptions(
        start, round(judgment.tolerance * MILLISECOND), judgment.namespace, judgment.remappings, watch
    )
    return RecordingJudge(models.rosgraph, settings, types, recording, options)


def run(judge: RecordingJudge | LogJudge) -> str:
    """Run an audit; return why it ended early, empty if it did not."""
    from robosc.run.audit import LogError

    audit = judge.audit

    def how_far() -> str:
        seconds = 0.0 if audit.end is None else audit.seconds(audit.end)
        return f"auditing: {audit.events + audit.commands:,} events, {seconds:,.0f} s of the recording"

    try:
        with progress(how_far):
            judge.run()
            interruption.check()
    except RecordingError as error:
        fault = str(error)
    except LogError as error:
        fault = f"{judge.path}:{error.line}: {error}"
    else:
        return ""
    if audit.end is not None:
        audit.notes.append(f"the audit ends after {audit.seconds(audit.end):,.3f} s: the recording is damaged there")
    return fault


def _state(model: sct.SupervisoryControlModel, text: str) -> dict[sct.Plant | sct.DiscreteVariable, Value]:
    """Return the values of a state in a call. Raises CallError."""
    from robosc.analysis.explain import NamingError, parse_state
    from robosc.engine.state import Domain
    from robosc.model import sct

    try:
        codes = parse_state(model, text)
    except NamingError as error:
        raise CallError(f"--from-state: {error}") from None
    values: dict[sct.Plant | sct.DiscreteVariable, Value] = {}
    for element, code in codes.items():
        if isinstance(element, sct.Plant):
            values[element] = element.locations[code].name
        elif isinstance(element, sct.DiscreteVariable):
            domain = Domain(element.type)
            values[element] = domain.external(domain.low + code)
    return values
