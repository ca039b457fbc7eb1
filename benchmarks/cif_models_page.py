"""Page of the documentation with the measurements of `cif_models.py`."""

from __future__ import annotations

from math import isclose
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

Results = dict[str, Any]

HEAD = """\
# Synthesis beside CIF's tool

This page compares the time and the memory of RoboSC's synthesis with those of CIF's tool, model by model.

<!-- not run: the models are no part of this repository -->
```sh
python benchmarks/cif_models.py FOLDER --more FILE.cif
```

The command measures RoboSC and the synthesis tool of ESCET 5.0-dev (September 2024, JavaBDD 8.0.0), and writes this
page. Both tools take a model one after the other on the same machine. Compare the numbers of one row.

The first {escet} models are those that the scripts of [Eclipse ESCET](https://eclipse.dev/escet) time for synthesis.
ESCET's folder also holds `wafer_scanner_n2`, `bcs_shared_behavior` and `bcs_shared_features`, which no script times.
RoboSC does not complete the first within a minute of processor time. The other two are parts that `bcs_dynamic` and
`bcs_static` import.

The `cat_mouse_tower_*` models lie in the same folder. The `cluster_tools_*` models are chains of
[our own rendering](dcs.md). The last rows are robots of [our own families](benchmarks.md), as generated CIF. Only the
chains and robots are part of this repository.

All seconds are processor seconds; `over {seconds:.0f}` marks a command that reached the limit. In the first columns,
neither tool writes guards.

- *Synthesis*: from the variable order to the number of controlled states, the least of at most {rounds} rounds in
  one process. For CIF's tool, only its own thread counts. More rounds favor CIF's tool: Java compiles while it runs.
- *Cold*: the whole command, with all its threads.
- *Written*: the whole command, with the guards written as CIF: `robosc transform --to cif`, and CIF's tool with its
  default settings.
- *Guards*: the share of the guards in the synthesis of RoboSC.
- *Operations* and *nodes*, the most at a time: of RoboSC, the same on every run.
- *MB*: most memory of RoboSC.
"""


def page(results: Results) -> str:
    """Return the page of all measurements, in Markdown."""
    head = HEAD.format(**results)
    return "\n".join([head, _summary(results), _table(results)])


def _summary(results: Results) -> str:
    """Return the summary of the table, in sentences."""
    found = results["models"]
    escet = [model["robosc"] for model in list(found.values())[: results["escet"]] if model["robosc"]]
    both = {name: model for name, model in found.items() if model["robosc"] and model["cif"] is not None}
    timed = [model for model in both.values() if "cold" in model["cif"]]
    slower = [name for name, model in both.items() if not _faster(model, "cold")]
    names = f" ({', '.join(f'`{name}`' for name in slower)})" if slower else ""
    whole = sum(ours["cold"] for ours in escet)
    return f"""\
RoboSC completes {len(escet)} of ESCET's {results["escet"]} models, in {whole:.0f} s in total. The counts are equal for
{_agreeing(timed)} of the {len(timed)} models that both tools complete; CIF's tool counts with floating-point numbers.

Cold, RoboSC is slower than CIF's tool on {len(slower)} of these {len(both)} models{names}.
With guards, it is slower on {_listed(both, "whole")}.
Other models can differ: measure yours.
"""


def agree(ours: Results, theirs: Results) -> bool:
    """Return whether both found equally many states. CIF's tool counts with floating-point numbers."""
    return isclose(ours["states"], theirs["states"], rel_tol=1e-12)


def _agreeing(models: Iterable[Results]) -> int:
    return sum(agree(model["robosc"], model["cif"]) for model in models)


def _listed(models: Results, key: str) -> str:
    """Return the number of models on which RoboSC is slower, and their names."""
    slower = [f"`{name}`" for name, model in models.items() if not _faster(model, key)]
    return f"{len(slower)} ({', '.join(slower)})" if slower else "none of them"


def _faster(model: Results, key: str) -> bool:
    """Return whether RoboSC's command took less time than CIF's tool. Each may have reached the limit."""
    ours, theirs = model["robosc"], model["cif"]
    return key not in theirs or (key in ours and ours[key] < theirs[key])


def _table(results: Results) -> str:
    columns = "controlled states | synthesis | CIF | cold | CIF | written | CIF | guards | operations | nodes | MB"
    rows = [f"| model | {columns} |", "|---|" + "---:|" * 11]
    over = f"over {results['seconds']:.0f}"
    for name, found in results["models"].items():
        ours, cif = found["robosc"], found["cif"]
        if ours is None:
            rows.append(f"| {name} | {over} s | | | | | | | | | | |")
            continue
        warm, cold, whole = (
            "" if cif is None else f"{cif[key]:.2f}" if key in cif else over for key in ("seconds", "cold", "whole")
        )
        written = f"{ours['whole']:.1f}" if "whole" in ours else over
        guards = f"{ours['guards']:.0%}" if "guards" in ours else ""
        states = f"{ours['states']:,}" if ours["states"] < 10**15 else f"{ours['states']:.1e}".replace("e+", "·10^")
        numbers = f"{ours['operations']:,} | {ours['nodes']:,} | {ours['memory']:.0f}"
        times = f"{ours['seconds']:.2f} | {warm} | {ours['cold']:.1f} | {cold} | {written} | {whole} | {guards}"
        rows.append(f"| {name} | {states} | {times} | {numbers} |")
    return "\n".join([*rows, ""])
