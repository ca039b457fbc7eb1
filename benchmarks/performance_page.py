"""The page of the documentation with what `reaction.py` has measured."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

Results = dict[str, Any]


@dataclass(frozen=True)
class Kind:
    """A kind of node: generated and compiled, or `run` straight from its model, over ROS 1 or 2."""

    ros: int
    nodes: str

    @property
    def key(self) -> str:
        """In results."""
        return f"{self.nodes}-ros{self.ros}"

    @property
    def title(self) -> str:
        """For people."""
        return f"ROS {self.ros}, {'compiled' if self.nodes == 'compiled' else '`robosc run`'}"


KINDS = [Kind(ros, nodes) for ros in (1, 2) for nodes in ("compiled", "run")]
#: Mean, least, most and standard deviation of the nodes that the thesis measured, in microseconds (table 6.8).
THESIS = {
    "Line follower": (71, 16, 868, 46),
    "Simple navigation": (9, 4, 248, 6),
    "Obstacle navigation": (11, 5, 906, 19),
    "Object finder": (33, 8, 340, 37),
    "Maze solver": (36, 8, 451, 42),
    "Push ball": (42, 15, 528, 26),
    "Person follower": (52, 6, 1606, 52),
}

HEAD = """\
# Performance

How soon a robot stops, and what its node costs. `python benchmarks/reaction.py` measured it on {machine} and wrote this
page.

The world around the node is a Python program here. The times include what the middleware and the measuring program
take. To show how much that is, an echo was measured in between: a small message to another Python node, and its answer.
"""

STOP = """\
## Stop

From publishing `true` on `/emergency_stop` to receiving the first zero on `/cmd_vel`: the line follower, {times} stops
at random moments, while another program sends scans and corrections at 30 Hz. In milliseconds.

A scan that flickers between free and blocked does not delay a stop, however long the period: it uses up its own
[count of reactions](control-loop.md), not that of the button. Tests hold the control loop to this for any
robot.
"""

OBSTACLE = """\
## Obstacle

From publishing the first scan with an obstacle to receiving the first zero on `/cmd_vel`: the line follower, {times}
obstacles at random moments of the control loop's period of 100 ms. In milliseconds. With the tool of the thesis, which
decides in its ticks only and runs one event in each, it was 212 in the median and 5,200 at worst.
"""

#: Measured by `expiry.py`.
TIMES = """\
## Times

From pressing a button to the beep that a model sends 200 ms later (`after 200 ms`), with the way of two messages, while
a sensor sends at 100 Hz: 200 times each. Milliseconds later than that; none was early. `python benchmarks/expiry.py`
measures it. The two cores were loaded to four times their capacity, and to twelve times while the node was the
compiled one of ROS 2.

| node | median | maximum | early |
| --- | ---: | ---: | ---: |
| ROS 1, compiled | 1.5 | 13.1 | 0 |
| ROS 1, `robosc run` | 2.3 | 31.1 | 0 |
| ROS 2, compiled | 4.0 | 20.2 | 0 |
| ROS 2, `robosc run` | 4.8 | 23.5 | 0 |
"""

COSTS = """\
## Processor and memory

Each node drives the robot of its [scenario](simulator.md) for {seconds} s in real time, all eight at once; a world
that has ended begins anew. Processor time as a share of one core; the most memory in use, in MB, ROS's own included.
"""

WATCHED = """\
## Who looks

What it costs a node that somebody looks: the line follower on its line, with 30 scans and 30 corrections a second, in
turn for {seconds} s with nobody, with the page of [`robosc view`](view.md) on its state, and with a monitor on
[`/diagnostics`](ros-output.md#diagnostics); the median of {rounds} rounds. *More* is the median of the differences
to nobody in the same round. Processor time of the node as a share of one core, without that of page and monitor.
"""

TICKS = """\
## One tick

How long the control loop takes at each tick, in microseconds: table 6.8 of the thesis, whose machine was another.
*Node* is all that happens in a tick, messages published included; *engine* the supervisor's C alone, the same tick done
again with nobody to tell. The supervisory layer has no ticks. The cores are shared: a maximum of milliseconds is a
moment at which the processor was somebody else's, and one such among 3,000 ticks moves a mean.
"""


def percentiles(seconds: Sequence[float]) -> dict[str, float]:
    """Milliseconds: the median, what 99 of 100 keep (nearest rank), and the most."""
    ordered = sorted(1000 * second for second in seconds)
    return {"median": median(ordered), "p99": ordered[math.ceil(0.99 * len(ordered)) - 1], "max": ordered[-1]}


def page(results: Results) -> str:
    """The page, in Markdown, of all that was measured."""
    parts = [HEAD.format(machine=results["machine"])]
    for part, text in (("stop", STOP), ("obstacle", OBSTACLE)):
        if found := _of(results, part):
            parts.append(text.format(times=_span(f"{measured['times']:,}" for measured in found.values())))
            parts.append(_reactions(found))
    parts.append(TIMES)
    if found := _of(results, "costs"):
        parts += [
            COSTS.format(seconds=_span(f"{measured['seconds']:.0f}" for measured in found.values())),
            _costs(found),
        ]
    if found := _of(results, "watched"):
        rounds, seconds = (
            _span(f"{measured[measure]:.0f}" for measured in found.values()) for measure in ("rounds", "seconds")
        )
        parts += [WATCHED.format(rounds=rounds, seconds=seconds), _watched(found)]
    if found := _of(results, "costs"):
        parts += [TICKS, *(_ticks(kind, measured) for kind, measured in found.items())]
    return "\n".join(parts)


def _of(results: Results, part: str) -> dict[Kind, Results]:
    return {kind: results[part][kind.key] for kind in KINDS if kind.key in results.get(part, {})}


def _span(values: Iterator[str]) -> str:
    return " or ".join(dict.fromkeys(values))


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _reactions(found: Mapping[Kind, Results]) -> str:
    columns = [(of, value) for of in ("reaction", "echo") for value in ("median", "p99", "max")]
    head = ["node", "median", "p99", "maximum", "echo: median", "p99", "maximum"]
    return _table(
        head,
        [[kind.title, *(f"{measured[of][value]:.1f}" for of, value in columns)] for kind, measured in found.items()],
    )


def _costs(found: Mapping[Kind, Results]) -> str:
    head = ["node", *(f"{kind.title}: {measure}" for kind in found for measure in ("processor", "memory"))]
    titles = next(iter(found.values()))["nodes"]
    return _table(
        head,
        [
            [title, *(text for measured in found.values() for text in _cost(measured["nodes"][title]))]
            for title in titles
        ],
    )


def _watched(found: Mapping[Kind, Results]) -> str:
    head = ["node", "nobody", "`robosc view`", "more", "monitor", "more"]
    rows = []
    for kind, measured in found.items():
        taken, more = measured["taken"], measured["more"]
        shares = [taken["nobody"], taken["view"], more["view"], taken["monitor"], more["monitor"]]
        rows.append([kind.title, *(f"{100 * share:.1f} %" for share in shares)])
    return _table(head, rows)


def _cost(node: Results) -> list[str]:
    return [f"{100 * node['processor']:.1f} %", f"{node['resident']:.0f}"]


def _ticks(kind: Kind, found: Results) -> str:
    compiled = kind.nodes == "compiled"
    values = ("mean", "min", "max", "deviation")
    words = ["mean", "min.", "max.", "s. d."]
    head = ["", f"node: {words[0]}", *words[1:]]
    if compiled:
        head += [f"engine: {words[0]}", *words[1:]]
    head += [f"thesis: {words[0]}", *words[1:]]
    rows = []
    for title, node in found["nodes"].items():
        if "node" in node:
            row = [title, *(f"{node['node'][value]:.0f}" for value in values)]
            if compiled:
                row += [f"{node['engine'][value]:.2f}" for value in values]
            rows.append([*row, *map(str, THESIS[title])])
    return f"### {kind.title}\n\n" + _table(head, rows)
