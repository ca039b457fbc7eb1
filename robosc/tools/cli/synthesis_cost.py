"""Output of `robosc synthesize --explain-cost`."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robosc.analysis.cost import Cost, explain_cost
from robosc.analysis.system import format_count, format_number
from robosc.analysis.wording import quote_requirements, words
from robosc.model.places import place
from robosc.synthesis.encoding import element_name
from robosc.tools.cli import put, say
from robosc.tools.cli.progress import note_slow_diagrams, progress

if TYPE_CHECKING:
    from robosc.analysis.cost import EventCost
    from robosc.model import sct
    from robosc.synthesis import Tuning

#: Maximum number of printed events and of printed requirements.
_ROWS = 10
#: Maximum number of printed events that synthesis follows as one step.
_NAMED = 3


def show_cost(model: sct.SupervisoryControlModel, tuning: Tuning, memory: int, times: int, *, as_json: bool) -> bool:
    """Print what makes the synthesis of a model expensive. States count `times` times.

    Returns whether there is a supervisor.
    """
    note_slow_diagrams()
    with progress("following the cost of synthesis"):
        cost = explain_cost(model, tuning, memory=memory)
    if as_json:
        put(json.dumps(_as_json(model, cost, times), indent=2))
    else:
        _show(model, cost, times)
    return cost.counts.controlled_states > 0


def _as_json(model: sct.SupervisoryControlModel, cost: Cost, times: int) -> dict[str, Any]:
    return {
        "robot": model.name,
        "controlled_states": cost.counts.controlled_states * times,
        "operations": cost.statistics.operations,
        "peak_nodes": cost.statistics.peak_nodes,
        "strategy": cost.statistics.strategy,
        "hubs": [{"element": element_name(hub), "couplings": number} for hub, number in cost.hubs],
        "couplings": cost.couplings,
        "events": [
            {"names": list(map(words, row.events)), "operations": row.operations, "nodes": row.nodes}
            for row in cost.events
        ],
        "requirements": [
            {"text": requirement.text, "line": place(requirement)[1].line, "nodes": nodes}
            for requirement, nodes in cost.requirements
        ],
        "order": list(map(element_name, cost.order)),
    }


def _show(model: sct.SupervisoryControlModel, cost: Cost, times: int) -> None:
    statistics = cost.statistics
    say(f"{model.name}: {format_count(cost.counts.controlled_states * times, 'state')}")
    operations = format_count(statistics.operations, "operation")
    most = format_count(statistics.peak_nodes, "node")
    say(f"{operations}, at most {most} at a time, {statistics.strategy} strategy")
    for hub, number in cost.hubs:
        say(f"\n{element_name(hub)} is a hub: {number} of {cost.couplings} events and conditions concern it")
    total = sum(row.nodes for row in cost.events) or 1
    if cost.events:
        say("\nevents with the largest diagrams:")
    for row in cost.events[:_ROWS]:
        say(f"  {100 * row.nodes / total:3.0f} %  {format_number(row.operations):>9} operations  {_names(row)}")
    if cost.requirements:
        say("\nrequirements with the largest diagrams:")
    for requirement, nodes in cost.requirements[:_ROWS]:
        say(f"  {format_number(nodes):>7} nodes  {quote_requirements([requirement])}")
    say("\norder of the diagrams, from the top (a file with these lines is a value of --order):")
    for element in cost.order:
        say(f"  {element_name(element)}")


def _names(row: EventCost) -> str:
    names = [words(event) for event in row.events[:_NAMED]]
    more = len(row.events) - len(names)
    return "; ".join([*names, *([f"{more} more"] if more else [])])
