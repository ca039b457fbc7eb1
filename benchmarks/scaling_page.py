"""The page of the documentation with what `scaling.py` has measured, and its plots."""

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

How synthesis, and the tool as a whole, grow with the model. `python benchmarks/scaling.py` measured it on {machine} and
wrote this page. `pip install -e '.[benchmarks]'` in a fresh environment is all that it needs; `--quick` is a first try.

The models are robots of any size: `python benchmarks/families.py philosophers 5` prints one. Times are seconds of the
processor, since the cores are shared; in parentheses what went by meanwhile. Each robot has a process of its own, whose
memory at its peak is given in MB, what was loaded included. A series ends at the first robot that takes more than
{limit} s.
"""

AIMS = """\
## Aims

*Synthesis* begins with the plants and requirements and ends with the guards and what is doubtful about them; *all* is
everything from the text to generated CIF, C, ROS 1 and ROS 2.
"""

FAMILIES_HEAD = """\
## Families

![Seconds over N for each family](benchmarks-families.svg)

*Reachable* are the states of the plants without requirements, *supervised* those under the supervisor. *Peak nodes* are
nodes of decision diagrams that were there at once, *operations* images and preimages of single events: unlike seconds,
both are the same on every run.

Beside it, two explicit syntheses of the same automata, state by state, with a third of the limit. One is `SupCon` of
[libFAUDES](https://fgdes.tf.fau.de/faudes) on the composed plants. There a variable is part of its automaton's states,
an event with data is one event for each value, and a requirement is an automaton that follows the plants that it speaks
of; the time to make these automata counts. The other one is the definition of synthesis, written down in Python for the
tests. All three find the same numbers of states, and those under the supervisor are what the family's formula in
[benchmarks/families.py](../benchmarks/families.py) says.
"""

GROWTH = """\
### Growth

What the four largest robots of each family say of the growth: *N^k*, or *b^N* where that fits far better.
"""

PHASES_HEAD = """\
### Phases

For the largest robot of each family that was finished. What is loaded and built once in a process is left out.
"""

TRANSFORM = """\
## The whole tool

`robosc transform --to cif,supervisor,ros1,ros2` from a cold start, of independent cells with two components each, and
the phases of the same models in a warm process. No more than {limit} s each.

![Seconds over lines for each phase](benchmarks-transform.svg)
"""


def page(results: Results) -> str:
    """The page, in Markdown, of all that was measured."""
    families = {name: results["families"][name] for name in FAMILIES if name in results["families"]}
    parts = [HEAD.format(machine=results["machine"], limit=results["limit"]), AIMS, _aims(results), FAMILIES_HEAD]
    for name, tools in families.items():
        parts += [f"### {FAMILIES[name].title[0].upper()}{FAMILIES[name].title[1:]}\n", _family(tools)]
    parts += [GROWTH, _growths(families), PHASES_HEAD, _phases(families)]
    if results["transform"]:
        parts += [TRANSFORM.format(limit=3 * results["limit"]), _transform(results["transform"])]
    return "\n".join(parts)


def _aims(results: Results) -> str:
    families, transform = results["families"], results["transform"]
    philosophers = {
        point["n"]: point for point in families.get("philosophers", {}).get("robosc", ()) if point["finished"]
    }
    rows = [
        [f"{number} philosophers: {aim}", _cost(philosophers[number])]
        for number, aim in ((20, "3 s and 200 MB"), (40, "30 s"))
        if number in philosophers
    ]
    for name in ("cells", "services"):
        many = [point for point in _finished(families, name, "robosc") if point["states"] >= 10**30]
        if many:
            rows.append([f"10^30 supervised states, {_titled(name, many[0]['n'])}: 2 s", _cost(many[0])])
    small = [point for point in transform if point["finished"] and point["lines"] <= 1000]
    if small:
        rows.append([f"`transform` of {small[-1]['lines']} lines: 1 s", _seconds(small[-1])])
    larger = [point for point in transform if point["finished"] and point["lines"] >= 500]
    if len(larger) > 1:
        exponent = linear_regression(
            [log(point["lines"]) for point in larger], [log(point["cpu"]) for point in larger]
        ).slope
        rows.append(
            [
                "`transform` up to 50,000 lines: nearly linear",
                f"lines^{exponent:.2f} from {larger[0]['lines']:,} to {larger[-1]['lines']:,} lines",
            ]
        )
    return _table(["aim", "measured"], rows, "---")


def _cost(point: Results) -> str:
    synthesis = [sum(point["phases"][phase][which] for phase in SYNTHESIS) for which in (1, 0)]
    everything = [sum(times[which] for times in point["phases"].values()) for which in (1, 0)]
    return (
        f"{_number(point['states'])} states; synthesis {synthesis[0]:.2f} s ({synthesis[1]:.2f}), "
        f"all {everything[0]:.1f} s ({everything[1]:.1f}), {point['memory']:.0f} MB"
    )


def _seconds(point: Results) -> str:
    return f"{point['cpu']:.1f} s ({point['wall']:.1f}), {point['memory']:.0f} MB"


def _finished(families: Results, name: str, tool: str) -> list[Results]:
    return [point for point in families.get(name, {}).get(tool, ()) if point["finished"]]


def _supervised(families: Results, name: str, tool: str) -> list[Results]:
    """Those whose synthesis was finished, whatever became of the rest."""
    return [point for point in families.get(name, {}).get(tool, ()) if "states" in point]


def _family(tools: Results) -> str:
    others = {tool: {point["n"]: point for point in tools.get(tool, ())} for tool in EXPLICIT}
    head = ["N", "lines", "reachable", "supervised", "peak nodes", "operations", "synthesis", "all", "MB"]
    head += [text for tool in others for text in (TOOLS[tool], "MB")]
    rows = []
    for point in tools.get("robosc", ()):
        row = [f"{point['n']}", f"{point['lines']:,}"]
        if "states" in point:
            row += [_number(point["uncontrolled"]), _number(point["states"])]
        else:
            row += ["-", "-"]
        row += [f"{point[measure]:,}" if measure in point else "-" for measure in ("peak_nodes", "operations")]
        row += [_took(point, SYNTHESIS), _took(point), f"{point['memory']:.0f}"]
        for points in others.values():
            other = points.get(point["n"])
            row += [_took(other), f"{other['memory']:.0f}"] if other else ["-", "-"]
        rows.append(row)
    return _table(head, rows)


def _took(point: Results, phases: Sequence[str] = ()) -> str:
    """Seconds of some phases, or of all; where the limit ended them, that of the process."""
    if not point["finished"] and not (phases and "states" in point):
        return f"over {point['cpu']:.0f}"
    cpu, wall = (
        sum(took[which] for phase, took in point["phases"].items() if phase in (phases or point["phases"]))
        for which in (1, 0)
    )
    return f"{cpu:.2f} ({wall:.2f})"


def _growths(families: Results) -> str:
    measures: dict[str, Callable[[Results], float]] = {
        "synthesis": _synthesis_seconds,
        "peak nodes": lambda measure: measure["peak_nodes"],
        "operations": lambda measure: measure["operations"],
    }
    rows = [
        [
            FAMILIES[name].title,
            *(growth(_supervised(families, name, "robosc"), measure) for measure in measures.values()),
            growth(_finished(families, name, "robosc"), _all_seconds),
            *(growth(_supervised(families, name, tool), _all_seconds) for tool in EXPLICIT),
        ]
        for name in families
    ]
    return _table(["family", *measures, "all", *(TOOLS[tool] for tool in EXPLICIT)], rows)


def _all_seconds(point: Results) -> float:
    return sum(took for _, took in point["phases"].values())


def _synthesis_seconds(point: Results) -> float:
    return sum(point["phases"][phase][1] for phase in SYNTHESIS)


def growth(points: Sequence[Results], measure: Callable[[Results], float]) -> str:
    """`N^k`, or `b^N` where that leaves far less unexplained, for the last four points; a dash for fewer than three."""
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


def _phases(families: Results) -> str:
    largest = {name: points[-1] for name in families if (points := _finished(families, name, "robosc"))}
    rows = [[_titled(name, point["n"]), *_each_phase(point)] for name, point in largest.items()]
    return _table(["", *(TITLES.get(phase, phase) for phase in (*PHASES, *TARGETS))], rows)


def _each_phase(point: Results) -> list[str]:
    phases = point["phases"]
    return [f"{phases[phase][1]:.2f}" if phase in phases else "-" for phase in (*PHASES, *TARGETS)]


def _transform(points: Sequence[Results]) -> str:
    head = [
        "components",
        "lines",
        "command",
        "MB",
        "written",
        *(TITLES.get(phase, phase) for phase in (*PHASES, *TARGETS)),
    ]
    return _table(
        head,
        [
            [
                f"{point['components']:,}",
                f"{point['lines']:,}",
                f"{point['cpu']:.1f} ({point['wall']:.1f})" if point["finished"] else f"over {point['cpu']:.0f}",
                f"{point['memory']:.0f}",
                f"{point['bytes'] / 1e6:.1f} MB",
                *_each_phase(point),
            ]
            for point in points
        ],
    )


def _titled(name: str, number: int) -> str:
    return FAMILIES[name].title.replace("N", str(number), 1)


def _number(value: int) -> str:
    """With commas as long as it is short, else its first digits and power of ten."""
    if value < 10**9:
        return f"{value:,}"
    power = len(str(value)) - 1
    return f"{value // 10 ** (power - 1) / 10:.1f}·10^{power}"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]], align: str = "---:") -> str:
    lines = [head, ["---", *[align] * (len(head) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def plots(results: Results) -> dict[str, str]:
    """File name to SVG; the same for the same results. Raises ImportError where matplotlib is not installed."""
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
