"""The page of the documentation with what `cif_models.py` has measured, and its plot."""

from __future__ import annotations

from io import StringIO
from math import isclose
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

Results = dict[str, Any]

#: Models with the seconds of synthesis, and the megabytes, that they are to stay under.
_BOUNDS = (("production_cell", 0.1, None), ("cmt_n5_k3", 10, 1000), ("cmt_n10_k2", 10, 1000))

HEAD = """\
# Synthesis beside CIF's tool

`python benchmarks/cif_models.py FOLDER` measured this on {machine} and wrote this page. CIF's tool is
that of ESCET 5.0-dev (September 2024) with JavaBDD 8.0.0, on OpenJDK 17. Both took each model in the same run, one
after the other.

The first {escet} models are those that ESCET itself times for synthesis, from its repository. Then come models of cats
and mice from [CASE21_enforce_requirements](https://github.com/sbthuijsman/CASE21_enforce_requirements), and robots of
[our own families](benchmarks.md), as the CIF that is generated of them. Only the last are part of this repository.

*Synthesis* goes from the order of the variables to the number of controlled states, in a process that has done it
before: the least of {rounds} rounds, in seconds of the processor; of CIF's tool those of its own thread alone. *Cold*
is the whole command, once, in seconds of the processor, of all its threads: `robosc synthesize --counts`, and CIF's
tool with `--bdd-output=nodes --forward-reach=yes`. Neither writes guards out. No command had more than {seconds:.0f} s.
"""

NOTES = """\
CIF's tool counts with floating-point numbers: up to their precision the counts are the same. Nodes and operations
are the same on every run.
"""


def page(results: Results) -> str:
    """The page, in Markdown, of all that was measured; `note` of the results, if any, is what is to be said of it."""
    head = HEAD.format(**results)
    head += f"\n{results['note']}\n" if "note" in results else ""
    return "\n".join(
        [head, _aims(results), "![Seconds of both tools for each model](cif-models.svg)\n", _table(results)]
    )


def _aims(results: Results) -> str:
    """What was aimed at, what was measured, and whether that is it."""
    found = results["models"]
    escet = list(found.values())[: results["escet"]]
    both = [model for model in found.values() if model["robosc"] and model["cif"] is not None]
    timed = [model for model in both if "cold" in model["cif"]]
    agreeing, cold, warm = _agreeing(timed), _faster(both, "cold"), _faster(both, "seconds")
    whole = sum(model["robosc"]["cold"] for model in escet if model["robosc"])
    rows = [
        (
            "ESCET's models that are done",
            f"{sum(model['robosc'] is not None for model in escet)} of {len(escet)}",
            True,
        ),
        ("as many states as CIF's tool, where it is done", f"{agreeing} of {len(timed)}", agreeing == len(timed)),
        ("all of ESCET's models, cold: under 60 s", f"{whole:.1f} s", whole < 60),
        ("none slower than CIF's tool, cold", f"{len(both) - cold} of {len(both)} slower", cold == len(both)),
        ("two thirds faster than CIF's tool, warm", f"{warm} of {len(both)} faster", 3 * warm >= 2 * len(both)),
        *_bounds(found),
    ]
    lines = "".join(f"| {aim} | {measured} | {'yes' if holds else 'no'} |\n" for aim, measured, holds in rows)
    return f"| aim | measured | holds |\n|---|---|---|\n{lines}"


def _bounds(found: Results) -> Iterable[tuple[str, str, bool]]:
    """The aims of single models."""
    for name, seconds, megabytes in _BOUNDS:
        ours = found.get(name, {}).get("robosc")
        if ours is not None:
            memory, measured = "", f"{ours['seconds']:.2f} s"
            if megabytes:
                memory, measured = f" and {megabytes} MB", f"{measured}, {ours['memory']:.0f} MB"
            holds = ours["seconds"] < seconds and ours["memory"] < (megabytes or ours["memory"] + 1)
            yield f"`{name}`: under {seconds} s of synthesis{memory}", measured, holds


def agree(ours: Results, theirs: Results) -> bool:
    """Whether both found as many states: CIF's tool counts with floating-point numbers."""
    return isclose(ours["states"], theirs["states"], rel_tol=1e-12)


def _agreeing(models: Iterable[Results]) -> int:
    return sum(agree(model["robosc"], model["cif"]) for model in models)


def _faster(models: Iterable[Results], what: str) -> int:
    return sum(what not in model["cif"] or model["robosc"][what] < model["cif"][what] for model in models)


def _table(results: Results) -> str:
    rows = [
        "| model | controlled states | synthesis | CIF | cold | CIF | operations | most nodes | MB |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    over = f"over {results['seconds']:.0f}"
    for name, found in results["models"].items():
        ours, cif = found["robosc"], found["cif"]
        if ours is None:
            rows.append(f"| {name} | {over} s | | | | | | | |")
            continue
        warm, cold = ("" if cif is None else f"{cif[key]:.2f}" if key in cif else over for key in ("seconds", "cold"))
        states = f"{ours['states']:,}" if ours["states"] < 10**15 else f"{ours['states']:.1e}".replace("e+", "·10^")
        numbers = f"{ours['operations']:,} | {ours['nodes']:,} | {ours['memory']:.0f}"
        rows.append(f"| {name} | {states} | {ours['seconds']:.2f} | {warm} | {ours['cold']:.1f} | {cold} | {numbers} |")
    return "\n".join([*rows, "", NOTES])


def plot(results: Results) -> str:
    """The plot, as SVG: the same for the same results. Raises ImportError where matplotlib is not installed."""
    import matplotlib as mpl  # noqa: PLC0415  # it may be missing
    from matplotlib.figure import Figure  # noqa: PLC0415

    mpl.rcParams |= {"svg.hashsalt": "robosc", "svg.fonttype": "none", "font.family": "sans-serif", "font.size": 9}
    names = [name for name, found in results["models"].items() if found["robosc"]]
    figure = Figure(figsize=(9, 0.19 * len(names) + 1), layout="constrained")
    axes = figure.subplots(1, 2, sharey=True)
    for place, (axis, measure, title) in enumerate(
        zip(axes, ("seconds", "cold"), ("synthesis, warm", "the whole command"), strict=True)
    ):
        for tool, label, marker in (("robosc", "RoboSC", "o"), ("cif", "CIF", "s")):
            points = [
                (results["models"][name][tool][measure], row)
                for row, name in enumerate(names)
                if measure in (results["models"][name][tool] or {})
            ]
            axis.plot(
                [seconds for seconds, _ in points],
                [row for _, row in points],
                marker,
                markersize=4,
                label=label,
                linestyle="",
            )
        axis.set_xscale("log")
        axis.set_xlabel("s")
        axis.set_title(title)
        axis.grid(axis="y", alpha=0.3)
        if place == 0:
            axis.set_yticks(range(len(names)), names)
            axis.invert_yaxis()
            axis.legend()
    text = StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    return "".join(f"{line.rstrip()}\n" for line in text.getvalue().splitlines())
