"""Page of the documentation with the measurements of `scaling.py`, and its plots."""

from __future__ import annotations

from io import StringIO
from math import exp, log
from statistics import correlation, linear_regression
from typing import TYPE_CHECKING, Any

from benchmarks.families import FAMILIES

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Results = dict[str, Any]

PHASES = ("parse", "link", "check", "m2m", "order", "encode", "fixpoint", "guards", "observe")
SYNTHESIS = PHASES[4:]
TARGETS = ("cif", "supervisor", "ros1", "ros2")
TITLES = {"m2m": "M2M", "cif": "CIF", "supervisor": "C", "ros1": "ROS 1", "ros2": "ROS 2"}
TOOLS = {"robosc": "RoboSC", "faudes": "libFAUDES", "definition": "by the definition"}
EXPLICIT = ("faudes", "definition")

HEAD = """\
# Benchmarks

This page shows how large a robot can be: how the time and memory of synthesis, and of the whole tool, grow with the
model. The numbers come from {machine}. Measure your computer with

<!-- not run: it takes a quarter of an hour, and writes this page -->
```sh
pip install -e '.[benchmarks]'
python benchmarks/scaling.py
```

`--quick` measures only the smallest robots. `python benchmarks/families.py philosophers 5` prints one of the robots.

All times are seconds of processor time. A process has a limit of {limit} s.
"""

FAMILIES_HEAD = """\
## Families of robots

![Seconds over N for each family](benchmarks-families.svg)

The table shows the largest robot of each family that RoboSC completes within the limit.

- *Supervised states*: the states that the robot can reach under its supervisor.
- *Synthesis*: from the plants and requirements to the guards and the findings about them.
- *All*: from the text to the generated CIF, C, ROS 1 and ROS 2.
- *MB*: the peak memory of the process.
- *Growth*: the growth of the synthesis time with N.
- *libFAUDES* and *by the definition*: the largest N that two explicit syntheses complete within a third of the limit.
  They are `SupCon` of [libFAUDES](https://fgdes.tf.fau.de/faudes) and the definition of synthesis in Python.

All three find the same numbers of states. The formulas in [families.py](../benchmarks/families.py) confirm these
numbers.
"""

TRANSFORM = """\
## The whole tool

`robosc transform --to cif,supervisor,ros1,ros2` of independent cells with two components each. *Written* is the size of
the generated files. The limit is {limit} s.

![Seconds over lines for each phase](benchmarks-transform.svg)
"""


def page(results: Results) -> str:
    """Return the page of all measurements, in Markdown."""
    families = {name: results["families"][name] for name in FAMILIES if name in results["families"]}
    parts = [HEAD.format(machine=results["machine"], limit=results["limit"]), FAMILIES_HEAD, _largest(families)]
    if results["transform"]:
        parts += [TRANSFORM.format(limit=3 * results["limit"]), _transform(results["transform"])]
    return "\n".join(parts)


def _largest(families: Results) -> str:
    """Return the largest robot of each family that was finished, by robosc and by the explicit syntheses."""
    head = ["family", "N", "lines", "supervised states", "synthesis", "all", "MB", "growth"]
    rows = []
    for name in families:
        finished = _finished(families, name, "robosc")
        if not finished:
            continue
        point = finished[-1]
        others = [_supervised(families, name, tool)[-1:] for tool in EXPLICIT]
        rows.append(
            [
                FAMILIES[name].title,
                f"{point['n']}",
                f"{point['lines']:,}",
                short_number(point["states"]),
                f"{_synthesis_seconds(point):.1f}",
                f"{_all_seconds(point):.1f}",
                f"{point['memory']:.0f}",
                growth(_supervised(families, name, "robosc"), _synthesis_seconds),
                *(f"{found[0]['n']}" if found else "-" for found in others),
            ]
        )
    return _table([*head, *(TOOLS[tool] for tool in EXPLICIT)], rows)


def _finished(families: Results, name: str, tool: str) -> list[Results]:
    return [point for point in families.get(name, {}).get(tool, ()) if point["finished"]]


def _supervised(families: Results, name: str, tool: str) -> list[Results]:
    """Return the measurements with a finished synthesis."""
    return [point for point in families.get(name, {}).get(tool, ()) if "states" in point]


def _all_seconds(point: Results) -> float:
    return sum(took for _, took in point["phases"].values())


def _synthesis_seconds(point: Results) -> float:
    return sum(point["phases"][phase][1] for phase in SYNTHESIS)


def growth(points: Sequence[Results], measure: Callable[[Results], float]) -> str:
    """Return `N^k`, or `b^N` if that fits the last four points far better; a dash for fewer than three points."""
    last = [(point["n"], measure(point)) for point in points if measure(point) > 0][-4:]
    if len(last) < 3:
        return "-"
    numbers, logarithms = [number for number, _ in last], [log(value) for _, value in last]
    logged = [log(number) for number in numbers]
    if len(set(logarithms)) == 1:
        return "N^0.0"
    power, exponential = (1 - correlation(abscissa, logarithms) ** 2 for abscissa in (logged, numbers))
    if power > 3 * exponential:
        return f"{exp(linear_regression(numbers, logarithms).slope):.2f}^N"
    return f"N^{linear_regression(logged, logarithms).slope:.1f}"


def _transform(points: Sequence[Results]) -> str:
    rows = [
        [
            f"{point['components']:,}",
            f"{point['lines']:,}",
            f"{point['cpu']:.1f}" if point["finished"] else f"over {point['cpu']:.0f}",
            f"{point['memory']:.0f}",
            f"{point['bytes'] / 1e6:.1f} MB",
        ]
        for point in points
    ]
    return _table(["components", "lines", "seconds", "MB", "written"], rows)


def short_number(value: int) -> str:
    """Return a short number with commas, and a long one as its first digits and a power of ten."""
    if value < 10**9:
        return f"{value:,}"
    power = len(str(value)) - 1
    return f"{value // 10 ** (power - 1) / 10:.1f}·10^{power}"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def plots(results: Results) -> dict[str, str]:
    """Return the plots as SVG by file name, reproducibly. Raises ImportError if matplotlib is not installed."""
    import matplotlib as mpl  # noqa: PLC0415  # it may be missing
    from matplotlib.figure import Figure  # noqa: PLC0415

    mpl.rcParams |= {"svg.hashsalt": "robosc", "svg.fonttype": "none", "font.family": "sans-serif", "font.size": 9}
    families = Figure((10, 6), layout="constrained")
    for axes, name in zip(families.subplots(2, 3).flat, FAMILIES, strict=True):
        axes.set(title=FAMILIES[name].title, xlabel="N", ylabel="s", yscale="log")
        for tool, marker in zip(TOOLS, "os^", strict=True):
            points = _supervised(results["families"], name, tool)
            seconds = [(_synthesis_seconds if tool == "robosc" else _all_seconds)(point) for point in points]
            axes.plot([point["n"] for point in points], seconds, marker=marker, markersize=4, label=TOOLS[tool])
        _ticked(axes)
    families.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    transform = Figure((7, 5), layout="constrained")
    axes = transform.subplots()
    axes.set(xlabel="lines", ylabel="s", yscale="log")
    for phase in (*PHASES, *TARGETS):
        points = [point for point in results["transform"] if phase in point["phases"]]
        seconds = [point["phases"][phase][1] for point in points]
        axes.plot(
            [point["lines"] for point in points], seconds, marker="o", markersize=3, label=TITLES.get(phase, phase)
        )
    points = [point for point in results["transform"] if point["finished"]]
    axes.plot(
        [point["lines"] for point in points],
        [point["cpu"] for point in points],
        "k--",
        label="robosc transform",
        linewidth=2,
    )
    _ticked(axes)
    transform.legend(loc="outside right upper")
    drawn = {}
    for name, figure in (("families", families), ("transform", transform)):
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
        drawn[f"benchmarks-{name}.svg"] = "".join(f"{line.rstrip()}\n" for line in text.getvalue().splitlines())
    return drawn


def _ticked(axes: Any) -> None:
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.grid(alpha=0.3)
