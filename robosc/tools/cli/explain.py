"""Command `robosc explain`."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import click

from robosc.analysis.explain import (
    NamingError,
    Renderer,
    data_of,
    emptiness,
    explain,
    explore,
    find_event,
    parse_state,
    possibility,
)
from robosc.analysis.supervise import supervise
from robosc.base.diagnostics.visible import visible
from robosc.model.places import place
from robosc.tools.cli import CallError, put, say
from robosc.tools.cli.options import Paths, model, paths, synthesizer
from robosc.tools.cli.progress import note_slow_diagrams, progress
from robosc.tools.cli.reading import read_models, supervise_otherwise
from robosc.tools.cli.report import Report

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.analysis.explain import Explanation, Possibility
    from robosc.analysis.system import SynthesizedSystem
    from robosc.model import sct


@click.command("explain")
@model
@click.option("--event", metavar="EVENT", help="Explain why EVENT can or cannot happen in a state.")
@click.option(
    "--state",
    metavar="STATE",
    help="The state for --event: `Door=open,Gauge.level=3`, or JSON as on `~/state`.  [default: the initial state]",
)
@click.option("--why-empty", is_flag=True, help="Explain why the robot has no supervisor.")
@click.option("--why-never", metavar="EVENT", help="Explain why EVENT cannot happen in any state.")
@click.option("--json", "as_data", is_flag=True, help="Print one JSON object.")
@synthesizer
@paths
def command(
    model: str,
    event: str | None,
    state: str | None,
    why_empty: bool,
    why_never: str | None,
    as_data: bool,
    paths: Paths,
) -> None:
    """Explain why an event is forbidden in a state or in all states, or why there is no supervisor.

    MODEL is a .rscd file with a robot, or an .xmi file written by `transform --to xmi`. An event is one of: a
    communication's name for its usual event (`move`, `Platform.move`), one of its events (`drive.cancel`,
    `grip.error`), or a name from `synthesize --json` (`message_move.c_trigger`). You may give only part of a state. The
    tool picks the matching state that is reached in the fewest steps, and shows the path to it. The explained
    supervisor is that of --synthesizer, else that of a saved model, else that of RoboSC's own synthesis. Suggestions
    for looser requirements always refer to the latter.

    \b
    Examples:
      robosc explain line_follower.rscd --event move
      robosc explain line_follower.rscd --event move --state EmergencyStop=stopped,LineDetector=following
      robosc explain line_follower.rscd --event move --state "$(ros2 topic echo --once --full-length /node/state)"
      robosc explain line_follower.rscd --why-never halt
      robosc explain broken.rscd --why-empty

    Exit status: 0 success, 1 errors in the model, 2 a wrong call, 3 no supervisor exists (without --why-empty).
    """
    if [event is not None, why_empty, why_never is not None].count(True) != 1:
        raise click.UsageError("give one of --event, --why-empty and --why-never")
    if state is not None and event is None:
        raise click.UsageError("--state needs --event")
    with Report(aside=True) as report:
        plants = read_models(model, paths, report, cif=True).sct
        supervise_otherwise(plants)
        note_slow_diagrams()
        with progress("exploring the states of the robot"):
            answer = explore(plants, emptiness if why_empty else question(plants, event, state, why_never))
        if answer is None and not why_empty:
            supervise(plants)  # raises with the cause
        elif as_data:
            put(json.dumps(data_of(answer, position), indent=2))
        else:
            renderer = Renderer(plants, lambda element: visible("{file}:{line}:{column}".format(**position(element))))
            say(renderer.answer(answer))


def question(
    model: sct.SupervisoryControlModel, event: str | None, state: str | None, why_never: str | None
) -> Callable[[SynthesizedSystem], Explanation | Possibility | None]:
    """Return the analysis that answers the question. Its result is None if the supervisor is empty.

    Raises CallError for an unknown event or state.
    """
    try:
        event_in_question = find_event(model, event or why_never or "")
        codes = {} if state is None else parse_state(model, state)
    except NamingError as error:
        raise CallError(str(error)) from error

    def answer(system: SynthesizedSystem) -> Explanation | Possibility | None:
        if not system.controlled.satisfiable():
            return None
        return possibility(system, event_in_question) if event is None else explain(system, event_in_question, codes)

    return answer


def position(element: Any) -> dict[str, Any]:
    """Return the place of an element in its file."""
    file, span = place(element)
    return {"file": file, "line": span.line, "column": span.column}
