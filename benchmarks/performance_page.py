"""Page of the documentation with the measurements of `reaction.py` and `layer_cost.py`."""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

Results = dict[str, Any]
ROOT = Path(__file__).parent.parent
STORED = ROOT / "benchmarks" / "performance.json"
PAGE = ROOT / "docs" / "performance.md"


@dataclass(frozen=True)
class Kind:
    """Kind of node: generated and compiled for ROS 1 or 2, or `run` directly from its model over ROS 2."""

    ros: int
    nodes: str

    @property
    def key(self) -> str:
        """The key in results."""
        return f"{self.nodes}-ros{self.ros}"

    @property
    def title(self) -> str:
        """The displayed title."""
        return f"ROS {self.ros}, {'compiled' if self.nodes == 'compiled' else '`robosc run`'}"


KINDS = [Kind(1, "compiled"), Kind(2, "compiled"), Kind(2, "run")]
HEAD = """\
# Performance

This page shows how soon a robot stops and what its node costs. The numbers come from {machine}.
Measure your computer with

<!-- not run: it takes an hour and needs ROS -->
```sh
python benchmarks/reaction.py
python benchmarks/expiry.py
python benchmarks/layer_cost.py
```

Proofs do not bound these times: they hold for any delay.
"""

#: The times of `after` are measured by `expiry.py`.
REACTION = """\
## Reaction

All times are milliseconds, from the message to the node until the message of the node.

- *Stop*: from the message of the emergency stop to the first zero on `/cmd_vel`. The line follower makes {stops} stops
  while it receives scans and corrections at 30 Hz.
- *Obstacle*: from the first scan with an obstacle to the first zero on `/cmd_vel`, {obstacles} times. The period of the
  control loop, 100 ms, does not delay the stop.
- *Delay of `after`*: from the end of `after 200 ms` to the message of the node, 200 times on overloaded cores. No time
  ended early.
- *Echo*: a message to a Python node and its answer. The other times include that much for ROS and the measurement.

{table}
A scan that flickers between free and blocked does not delay a stop, however long the period. Each topic has its own
[count of reactions](control-loop.md).
"""

FAST = """\
## Fast sensors

The line follower makes {stops} stops while it receives scans of 360 rays (best effort) and corrections, each at this
rate. Times are milliseconds.

{table}
`robosc run` handles topics with little traffic first, and at most ten messages of a topic in a row. So a stop does not
wait behind scans. Under overload, each topic drops its oldest messages beyond its [queue](configuration.md), and
services still get their turn.

`robosc run` handles about 3,000 messages a second of this robot with one core. For more, or for a model that computes
much from each message, generate a compiled node.
"""

#: Median and maximum delay of `after`, by `expiry.py`, in the order of `KINDS`.
TIMES = {"compiled-ros1": "1.5, 13.1", "compiled-ros2": "4.0, 20.2", "run-ros2": "4.8, 23.5"}

COSTS = """\
## Processor and memory

Each node drives the robot of its [scenario](simulator.md) for {seconds} s in real time. The table shows the lowest and
the highest value of the eight robots: the share of one core, the peak memory with ROS, and the mean duration of one
tick of the control loop, including the messages that it publishes.

{table}
A Python node that subscribes to the same types and does nothing takes 69 MB.
"""

ENGINE = """In a compiled node, the C of the supervisor takes {engine} microseconds of a tick on average.
"""

WATCHED = """\
## Observers

The page of [`robosc view`](view.md) or a monitor on [`/diagnostics`](ros-output.md#diagnostics) costs a node
{most} of a core (measured: {kinds}). `robosc view` and the monitor themselves run in processes of their own.
"""

LAYER = """\
## A layer beside a relay

A [supervisory layer](layer.md) and a plain relay forward {hz} velocities a second each, at the same time. The table
shows the latency from publication to receipt in milliseconds, and the processor time per velocity. The relay of a
compiled layer is a node in C++, that of `robosc run` a node in Python. Compiled nodes are optimized (`-O2`). *Direct*
is the latency without a node between.

{table}
Median latency and processor time of the layer, divided by those of the relay: {ratios}.

The layer limits the velocities, reads two of their fields for requirements, and handles ten scans of 360 rays and ten
messages of an emergency stop each second. The relay forwards the same messages.
"""


def percentiles(seconds: Sequence[float]) -> dict[str, float]:
    """Return the median, the 99th percentile (nearest rank) and the maximum, in milliseconds."""
    ordered = sorted(1000 * second for second in seconds)
    return {"median": median(ordered), "p99": ordered[math.ceil(0.99 * len(ordered)) - 1], "max": ordered[-1]}


def stored() -> Results:
    """Return the stored measurements."""
    results: Results = json.loads(STORED.read_text()) if STORED.exists() else {"machine": "two shared cores"}
    return results


def store(part: str, kind: Kind, measured: Results, **more: Any) -> None:
    """Store the measurements of a part for a kind of node, and values for the whole page; write the page."""
    results = stored() | more
    results.setdefault(part, {})[kind.key] = measured
    STORED.write_text(json.dumps(results, indent=1) + "\n")
    PAGE.write_text(page(results, PAGE.read_text()))


def page(results: Results, before: str = "") -> str:
    """Return the page of all measurements, in Markdown. Sections without measurements stay as they were `before`."""
    parts = [HEAD.format(machine=results["machine"])]
    stop, obstacle, costs, seen, layer = (
        _of(results, part) for part in ("stop", "obstacle", "costs", "watched", "layer")
    )
    if stop or obstacle:
        stops, obstacles = (
            _span(f"{measured['times']:,}" for measured in found.values()) for found in (stop, obstacle)
        )
        parts.append(REACTION.format(stops=stops, obstacles=obstacles, table=_reactions(stop, obstacle)))
    fast = _of(results, "fast")
    if fast:
        stops = _span(f"{measured['times']:,}" for rates in fast.values() for measured in rates.values())
        parts.append(FAST.format(stops=stops, table=_fast(fast)))
    if costs:
        seconds = _span(f"{measured['seconds']:.0f}" for measured in costs.values())
        parts.append(COSTS.format(seconds=seconds, table=_costs(costs)))
        parts += [ENGINE.format(engine=engine) for engine in _engine(costs)]
    if seen:
        most = max(share for measured in seen.values() for share in measured["more"].values())
        share = f"at most {100 * most:.1f} %" if most >= 0.001 else "less than 0.1 %"
        parts.append(WATCHED.format(most=share, kinds="; ".join(kind.title for kind in seen)))
    if layer:
        hz = _span(f"{measured['hz']:,}" for measured in layer.values())
        parts.append(LAYER.format(hz=hz, table=_layer(layer), ratios="; ".join(map(_ratios, layer, layer.values()))))
    old = re.split(r"(?m)^(?=## )", before)[1:]
    sections = {section.partition("\n")[0]: section.strip() + "\n" for section in [*old, *parts[1:]]}
    titles = [text.partition("\n")[0] for text in (REACTION, FAST, COSTS, WATCHED, LAYER)]
    return "\n".join([parts[0], *(sections[title] for title in titles if title in sections)])


def _of(results: Results, part: str) -> dict[Kind, Results]:
    return {kind: results[part][kind.key] for kind in KINDS if kind.key in results.get(part, {})}


def _span(values: Iterable[str]) -> str:
    return " or ".join(dict.fromkeys(values))


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _reactions(stop: Mapping[Kind, Results], obstacle: Mapping[Kind, Results]) -> str:
    head = ["node", "stop: median, p99, max.", "obstacle: median, p99, max.", "delay of `after`: median, max."]
    rows = []
    for kind in KINDS:
        measured = [found.get(kind) for found in (stop, obstacle)]
        echo = next((found["echo"] for found in measured if found), None)
        if echo:
            reactions = [_percentiles(found["reaction"]) if found else "-" for found in measured]
            rows.append([kind.title, *reactions, TIMES[kind.key], _percentiles(echo)])
    return _table([*head, "echo: median, p99, max."], rows)


def _fast(fast: Mapping[Kind, Results]) -> str:
    rows = [
        [kind.title, f"{hz} Hz", _percentiles(measured["reaction"]), _percentiles(measured["echo"])]
        for kind, rates in fast.items()
        for hz, measured in rates.items()
    ]
    return _table(["node", "each sensor", "stop: median, p99, max.", "echo: median, p99, max."], rows)


def _percentiles(found: Results) -> str:
    return ", ".join(f"{found[value]:.1f}" for value in ("median", "p99", "max"))


def _costs(costs: Mapping[Kind, Results]) -> str:
    rows = []
    for kind, measured in costs.items():
        nodes = measured["nodes"].values()
        ticks = [node["node"]["mean"] for node in nodes if "node" in node]
        rows.append(
            [
                kind.title,
                _range((100 * node["processor"] for node in nodes), ".1f", " %"),
                _range((node["resident"] for node in nodes), ".0f", " MB"),
                _range((tick / 1000 for tick in ticks), ".2f", " ms"),
            ]
        )
    return _table(["node", "processor", "memory", "tick"], rows)


def _engine(costs: Mapping[Kind, Results]) -> list[str]:
    """Return the range of the engine's mean times in a tick, in microseconds; empty without compiled nodes."""
    nodes = [node for measured in costs.values() for node in measured["nodes"].values()]
    means = [node["engine"]["mean"] for node in nodes if "engine" in node]
    return [_range(means, ".1f", "")] if means else []


def _range(values: Iterable[float], form: str, unit: str) -> str:
    ordered = sorted(values)
    low, high = (format(value, form) for value in (ordered[0], ordered[-1]))
    return f"{low}{unit}" if low == high else f"{low} to {high}{unit}"


def _layer(layer: Mapping[Kind, Results]) -> str:
    rows = []
    for kind, measured in layer.items():
        for way in ("direct", "relay", "layer"):
            values = measured[way]
            processor = f"{values['processor']:.0f} µs" if "processor" in values else ""
            rows.append([f"{kind.title}: {way}", f"{values['median']:.2f}", f"{values['p99']:.2f}", processor])
    return _table(["node", "median", "p99", "processor"], rows)


def _ratios(kind: Kind, measured: Results) -> str:
    median_ratio, processor_ratio = (
        measured["layer"][name] / measured["relay"][name] for name in ("median", "processor")
    )
    return f"{kind.title} {median_ratio:.2f} and {processor_ratio:.2f}"
