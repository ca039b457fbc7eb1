"""Command `robosc synthesize`."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING, Any

import click

from robosc.analysis.blocking_in_words import describe_blocking
from robosc.analysis.supervise import Diagnosis, EmptySupervisorError, diagnose, supervise
from robosc.analysis.system import format_count, format_number
from robosc.analysis.wording import change, quote_requirements
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.naming import enumeration
from robosc.model.semantics.printing import RobotPrinter, SctPrinter, conjunction
from robosc.model.semantics.roles import SILENT, assumptions, event_name, input_values
from robosc.model.semantics.walks import copy_tree
from robosc.synthesis import count
from robosc.tools.cli import EMPTY_SUPERVISOR, put, say
from robosc.tools.cli.options import Paths, chosen_synthesizer, memory, model, paths, synthesizer
from robosc.tools.cli.progress import show_progress
from robosc.tools.cli.reading import read_models, supervise_otherwise
from robosc.tools.cli.report import Report
from robosc.tools.cli.synthesis_cost import show_cost
from robosc.tools.cli.tuning import chosen_tuning, tuning

if sys.platform not in {"win32", "emscripten"}:
    import resource

if TYPE_CHECKING:
    from robosc.analysis.observations import Weight
    from robosc.model import expression as ex
    from robosc.synthesis import Counts, Statistics, Synthesis

#: Maximum number of conditions that synthesis adds to a guard that is printed.
_LONGEST = 200


@click.command("synthesize")
@model
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
@click.option("--counts", is_flag=True, help="Print only the numbers of states, without guards and findings.")
@click.option(
    "--count-inputs", is_flag=True, help="Count states as CIF does: each state once for each value of the inputs."
)
@click.option("--without", metavar="NAME", help="Print what changes without the assumption NAME.")
@memory
@click.option("--explain-cost", is_flag=True, help="Print what makes synthesis expensive, instead of guards.")
@synthesizer
@tuning
@paths
def command(
    model: str,
    as_json: bool,
    counts: bool,
    count_inputs: bool,
    without: str | None,
    explain_cost: bool,
    megabytes: int,
    paths: Paths,
) -> None:
    """Synthesize the supervisor of a robot and print its states and guards.

    MODEL is a .rscd file with a robot, a .cif or .wmod file, or an .xmi file written by `transform --to xmi`. A guard
    is the condition under which the supervisor allows an event that the robot itself can perform. Additions of
    synthesis, which no requirement states, are shown separately. For each requirement, the output has the number of
    states in which it restricts the robot; for `never` and `always`, the number of states that they forbid.

    --json lists all events, including those for outgoing data and those from the robot, and the cost of synthesis.
    Guards too long to read are omitted (`guard` is null), and `guard_nodes` is the size of the decision diagram.
    --counts omits all guards. --count-inputs counts each state once for each value of the robot's inputs, as CIF's
    tools do. States of .cif files are always counted in this way. --without synthesizes a second time without one
    assumption, and prints the guards and the requirements for which the result differs. --explain-cost prints the
    elements, events and requirements that cost most, and the order of the decision diagrams. --order and --strategy
    change the cost of synthesis, but never the supervisor (docs/synthesis.md).

    \b
    Examples:
      robosc synthesize line_follower.rscd
      robosc synthesize line_follower.rscd --json | jq .controlled_states

    Exit status: 0 success, 1 errors in the model, 2 a wrong call, 3 no supervisor exists.
    """
    _require_compatible(counts=counts, explain_cost=explain_cost, without=without)
    with Report(aside=True) as report:
        plants = read_models(model, paths, report, cif=True).sct
        times = input_values(plants) if count_inputs else 1
        assumption = None if without is None else _assumption(plants, without)
        if explain_cost:
            if not show_cost(plants, chosen_tuning(plants), megabytes << 20, times, as_json=as_json):
                raise click.exceptions.Exit(EMPTY_SUPERVISOR)
            return
        if counts:
            _count(plants, megabytes << 20, times, as_json=as_json)
            return
        synthesis = supervise_otherwise(plants, memory=megabytes << 20)
        if synthesis is not None:
            show = _show_json if as_json else _show
            show(plants, Diagnosis(**vars(synthesis)), times)
            return
        tuned = chosen_tuning(plants, longest=_LONGEST)
        try:
            with show_progress(plants) as statistics:
                supervision = supervise(plants, memory=megabytes << 20, statistics=statistics, weigh=True, tuning=tuned)
        except EmptySupervisorError as error:
            if as_json:
                _show_json(plants, error.synthesis, times)
            raise
        if assumption is not None:
            plants.plants.remove(assumption)
            other = diagnose(plants, memory=megabytes << 20, weigh=True, tuning=tuned)
            changes = _changes(plants, supervision.synthesis, other, times)
            if as_json:
                put(json.dumps({"without": without, **changes}, indent=2))
            else:
                _show_changes(plants, changes)
            return
        report.add(supervision.findings)
        show = _show_json if as_json else _show
        show(plants, supervision.synthesis, times)


def _require_compatible(*, counts: bool, explain_cost: bool, without: str | None) -> None:
    """Raise UsageError if options of the call exclude each other."""
    if (counts or explain_cost) and chosen_synthesizer() is not None:
        option = "--counts" if counts else "--explain-cost"
        raise click.UsageError(f"{option} needs RoboSC's own synthesis: remove it or --synthesizer")
    if explain_cost and (counts or without is not None):
        raise click.UsageError("--explain-cost replaces the other output: remove it, or --counts and --without")
    if without is not None and (counts or chosen_synthesizer() is not None):
        raise click.UsageError("--without compares guards: remove it, or --counts and --synthesizer")


def _assumption(model: sct.SupervisoryControlModel, name: str) -> sct.Plant:
    """Return the assumption with a name."""
    known = {plant.origin: plant for plant in assumptions(model) if plant.origin}
    if name not in known:
        some = f" {name!r}: expected {enumeration(known)}" if known else " with a name"
        raise click.BadParameter(f"{model.name} has no assumption{some}", param_hint="'--without'")
    return known[name]


def _changes(model: sct.SupervisoryControlModel, synthesis: Diagnosis, other: Diagnosis, times: int) -> dict[str, Any]:
    """Return what differs in another synthesis of a model: numbers of states, guards, requirements that matter."""
    guards, other_guards = ({row["name"]: row for row in _events(model, each)} for each in (synthesis, other))
    weights, others = ({tuple(row["texts"]): row for row in map(_weight, each.weights)} for each in (synthesis, other))
    empty = other.supervisor is None
    return {
        "empty": empty,
        "reason": None if other.reason is None else describe_blocking(other.reason),
        "controlled_states": [each.controlled_states * times for each in (synthesis, other)],
        "guards": [
            {"name": name, "guards": [_guard(row), _guard(other_guards[name])]}
            for name, row in guards.items()
            # Two guards that are too long to be written may differ, also if they have the same size.
            if not empty and (row["guard"] is None or _guard(row) != _guard(other_guards[name]))
        ],
        "requirements": [
            {"texts": row["texts"], "line": row["line"], "states": [row["states"], others[texts]["states"]]}
            for texts, row in weights.items()
            if texts in others and row["states"] != others[texts]["states"]
        ],
    }


def _guard(event: dict[str, Any]) -> str:
    """Return the guard of an event in words; if it is too long, its size."""
    if not event["ever_enabled"]:
        return "never enabled"
    return str(event["guard"] or f"too long to compare: a decision diagram of {event['guard_nodes']} nodes")


def _show_changes(model: sct.SupervisoryControlModel, changes: dict[str, Any]) -> None:
    """Print what differs without an assumption, each fact with its value before and after."""
    before, after = (format_count(number, "state") for number in changes["controlled_states"])
    if changes["empty"]:
        say(f"{model.name}: the supervisor is empty: {changes['reason']}")
        return
    say(f"{model.name}: {before} before, {after} after")
    for row in changes["guards"]:
        say(f"\n{row['name']}\n    before: {row['guards'][0]}\n    after: {row['guards'][1]}")
    for row in changes["requirements"]:
        before, after = (format_count(number, "state") for number in row["states"])
        say(f"\n`{row['texts'][0]}` (line {row['line']})\n    before: {before}\n    after: {after}")
    if not changes["guards"] and not changes["requirements"]:
        say("no guard and no requirement changes")


def count_states(
    model: sct.SupervisoryControlModel, memory: int, times: int = 1
) -> tuple[Counts | Synthesis, dict[str, Any]]:
    """Return the numbers of states of a supervised model, as such and as `--counts --json` prints them."""
    with show_progress(model) as statistics:
        counted = count(model, memory=memory, statistics=statistics, tuning=chosen_tuning(model))
    return counted, _counts(model, counted, statistics, times)


def _count(model: sct.SupervisoryControlModel, memory: int, times: int, *, as_json: bool) -> None:
    counted, answer = count_states(model, memory, times)
    if as_json:
        put(json.dumps(answer, indent=2))
    else:
        say(_states(model, counted, times))
    if not counted.controlled_states:
        raise click.exceptions.Exit(EMPTY_SUPERVISOR)


def _counts(
    model: sct.SupervisoryControlModel, counted: Counts | Synthesis, statistics: Statistics, times: int, **more: Any
) -> dict[str, Any]:
    without = counted.uncontrolled_states
    return {
        "robot": model.name,
        "uncontrolled_states": None if without is None else without * times,
        "controlled_states": counted.controlled_states * times,
        "empty": counted.controlled_states == 0,
        **more,
        "seconds": round(sum(statistics.seconds.values()), 3),
        "processor_seconds": round(sum(statistics.processor_seconds.values()), 3),
        "bdd_nodes": counted.bdd_nodes,
        **_cost(statistics),
    }


def _show_json(model: sct.SupervisoryControlModel, synthesis: Diagnosis, times: int) -> None:
    put(json.dumps(as_object(model, synthesis, times), indent=2))


def as_object(model: sct.SupervisoryControlModel, synthesis: Diagnosis, times: int = 1) -> dict[str, Any]:
    """Return the object that `--json` prints: states, requirements, events with their guards, and the cost."""
    return _counts(
        model,
        synthesis,
        synthesis.statistics,
        times,
        requirements=[_weight(weight) for weight in synthesis.weights],
        events=_events(model, synthesis),
    )


def _events(model: sct.SupervisoryControlModel, synthesis: Synthesis) -> list[dict[str, Any]]:
    """Return all events with their guards; none if there is no supervisor."""
    guards = {guard.event: guard for guard in synthesis.supervisor.guards} if synthesis.supervisor else {}
    events = [event for plant in model.plants for event in plant.events] if synthesis.supervisor else []
    return [_event(event, guards.get(event), synthesis) for event in events]


def _weight(weight: Weight) -> dict[str, Any]:
    """Return a requirement of the text and the number of states in which it matters."""
    first = weight.requirements[0]
    file, span = place(first)
    texts = list(dict.fromkeys(requirement.text for requirement in weight.requirements))
    return {
        "name": first.name,
        "texts": texts,
        "file": file,
        "line": span.line,
        "column": span.column,
        "states": weight.states,
    }


def _cost(statistics: Statistics) -> dict[str, Any]:
    """Return the cost of synthesis. Only its seconds and bytes differ from run to run."""
    return {
        "peak_nodes": statistics.peak_nodes,
        "operations": statistics.operations,
        "rounds": statistics.rounds,
        "strategy": statistics.strategy,
        "attempts": statistics.attempts,
        "phase_seconds": {phase: round(seconds, 3) for phase, seconds in statistics.seconds.items()},
        "peak_bytes": _peak_bytes(),
    }


def _peak_bytes() -> int | None:
    """Return the peak memory of the process in bytes. None if the system does not report it."""
    if sys.platform in {"win32", "emscripten"}:
        return None
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most if sys.platform == "darwin" else most * 1024


class _GuardPrinter(SctPrinter):
    """Prints a guard with the texts of the conditions that the node computes from data."""

    def atom(self, expression: ex.Expression) -> str:
        """Return a computed condition by its text, in parentheses."""
        if isinstance(expression, sct.InputReference) and expression.input.text is not None:
            return f"({expression.input.text})"
        return super().atom(expression)


def _event(event: sct.Event, guard: sct.EventGuard | None, synthesis: Synthesis) -> dict[str, Any]:
    """Return an event with its guard. Without a guard, `ever_enabled` depends on the reachable states of the plants."""
    shown = RobotPrinter() if event.kind in (sct.EventKind.plain, sct.EventKind.input) else _GuardPrinter()
    parts = [part for part in (guard.requirement, guard.synthesis) if part] if guard else []
    whole = conjunction(map(copy_tree, parts))
    unwritten = synthesis.unwritten.get(event)
    return {
        "name": event_name(event),
        "controllable": event.controllable,
        "guard": None if unwritten else shown(whole) if whole else "true",
        "added_by_synthesis": shown(guard.synthesis) if guard and guard.synthesis else None,
        "ever_enabled": guard.everEnabled if guard else event in synthesis.possible,
        **({"guard_nodes": unwritten} if unwritten else {}),
    }


def _states(model: sct.SupervisoryControlModel, counts: Counts | Synthesis, times: int) -> str:
    """Return the number of states, each counted `times` times."""
    without = counts.uncontrolled_states
    beside = "" if without is None else f", of {format_number(without * times)} without requirements"
    return f"{model.name}: {format_count(counts.controlled_states * times, 'state')}{beside}"


def _show(model: sct.SupervisoryControlModel, synthesis: Diagnosis, times: int) -> None:
    """Print the states and guards. Omits the selection of outgoing data, which does not restrict the robot."""
    assert synthesis.supervisor is not None
    say(_states(model, synthesis, times))
    for guard in synthesis.supervisor.guards:
        if guard.event.kind == sct.EventKind.data:
            continue
        event = _event(guard.event, guard, synthesis)
        heading = change(guard.event) if guard.event.kind in SILENT else event["name"]
        say(f"\n{heading}{'' if event['ever_enabled'] else ' (never enabled)'}")
        if event["ever_enabled"] or event["guard"] != "true":
            nodes = event.get("guard_nodes")
            too_long = f"too long to print: a decision diagram of {nodes} nodes"
            say(f"    guard: {too_long if nodes else event['guard']}")
        if event["added_by_synthesis"]:
            say(f"    added by synthesis: {event['added_by_synthesis']}")
    for weight in synthesis.weights:
        say(f"\n{quote_requirements(weight.requirements)}")
        count = format_count(weight.states, "state")
        invariant = isinstance(weight.requirements[0], sct.StateInvariant | sct.ReachabilityRequirement)
        matters = f"forbids {count}" if invariant else f"restricts the robot in {count}"
        say(f"    {matters if weight.states else 'matters in no state'}")
