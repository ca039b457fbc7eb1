"""Measure reaction times and costs of nodes over the installed ROS; write `docs/performance.md`.

    python benchmarks/reaction.py [--ros 1] [--nodes compiled] [--parts stop obstacle fast costs watched]
                                  [--stops 1000] [--obstacles 200] [--fast 200] [--seconds 300]
                                  [--rounds 9] [--keep FOLDER]

Without options: compiled nodes of ROS 1 and ROS 2, and `robosc run`, as far as they are installed. Each of the three
takes fourteen minutes, six of them for the costs; compiled nodes are built before. The measurements are stored in
`benchmarks/performance.json`: parts that are left out this time stay on the page. `--keep` names a folder for the
builds, so that the next call need not repeat them.

Compiled ROS 2 nodes need an rclcpp in AMENT_PREFIX_PATH, `run` the environment that `./run-tests` creates.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.node_costs import costs, summary  # noqa: E402
from benchmarks.performance_page import KINDS, PAGE, percentiles, store  # noqa: E402
from benchmarks.timed_packages import timed_packages  # noqa: E402
from benchmarks.watched import watched  # noqa: E402
from tests.ros.installations import find_ros1, find_ros2  # noqa: E402
from tests.ros.reactions import SENSORS_HZ, reactions  # noqa: E402
from tests.ros.running import Runner, find_rclpy, ros2_modules  # noqa: E402
from tests.ros.workspaces import Workspace, build  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Callable

#: Messages per second of each of the two sensors, in the part `fast`.
RATES = (100, 400, 1000)
INTERFACES = ROOT / "tests" / "ros" / "interfaces"


def main() -> None:
    options = _options()
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        folder = options.keep.resolve() if options.keep else scratch / "built"
        for kind in KINDS:
            if kind.ros not in options.ros or kind.nodes not in options.nodes:
                continue
            nodes = _prepared(kind.ros, kind.nodes, folder)
            if isinstance(nodes, str):
                _say(f"{kind.title} is left out: {nodes}")
                continue
            for part in options.parts:
                if part == "watched" and kind.ros == 1:
                    continue  # `robosc view` shows nodes of ROS 2
                began = time.monotonic()
                _say(f"{kind.title}: {part} ...")
                place = scratch / f"{kind.key}-{part}"
                measured = PARTS[part](nodes, place, options)
                store(part, kind, measured, machine=options.machine)
                _say(f"{kind.title}: {part} took {time.monotonic() - began:.0f} s")
    print(PAGE.read_text())


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ros", type=int, nargs="+", choices=[1, 2], default=[1, 2])
    parser.add_argument("--nodes", nargs="+", choices=["compiled", "run"], default=["compiled", "run"])
    parser.add_argument("--parts", nargs="+", choices=list(PARTS), default=list(PARTS))
    parser.add_argument("--stops", type=int, default=1000)
    parser.add_argument("--obstacles", type=int, default=200)
    parser.add_argument("--fast", type=int, default=200, help="how many stops are measured at each rate")
    parser.add_argument("--seconds", type=float, default=300, help="how long the costs are measured")
    parser.add_argument("--rounds", type=int, default=9, help="how often it is measured what a look costs")
    parser.add_argument("--keep", type=Path, help="a folder for what is built")
    parser.add_argument("--machine", default="two shared cores", help="description of the machine for the page")
    return parser.parse_args()


def _prepared(version: int, kind: str, folder: Path) -> Workspace | Runner | str:
    """Return the nodes of a kind, or the reason why there are none."""
    found = find_rclpy() if kind == "run" else {1: find_ros1, 2: find_ros2}[version]()
    if found.ros is None:
        return ", ".join(found.missing)
    place = folder / f"{kind}-ros{version}"
    if kind == "run":
        return Runner(found.ros, Path(ros2_modules(found.ros, place)))
    _say(f"building the nodes for ROS {version} ...")
    packages = timed_packages(version, place / "packages")
    said = build(found.ros, place, [], [*packages, *sorted((INTERFACES / f"ros{version}").iterdir())])
    return Workspace(found.ros, place, said)


def _stops(nodes: Workspace | Runner, folder: Path, options: argparse.Namespace) -> dict[str, Any]:
    return _reaction(nodes, folder, "stop", options.stops)


def _obstacles(nodes: Workspace | Runner, folder: Path, options: argparse.Namespace) -> dict[str, Any]:
    return _reaction(nodes, folder, "obstacle", options.obstacles)


def _fast(nodes: Workspace | Runner, folder: Path, options: argparse.Namespace) -> dict[str, Any]:
    folder.mkdir()
    return {str(hz): _reaction(nodes, folder / str(hz), "stop", options.fast, hz) for hz in RATES}


def _reaction(
    nodes: Workspace | Runner, folder: Path, reason: str, times: int, hz: float = SENSORS_HZ
) -> dict[str, Any]:
    found, echoes = reactions(nodes, folder, reason, times, hz=hz)
    return {"times": times, "reaction": percentiles(found), "echo": percentiles(echoes)}


def _costs(nodes: Workspace | Runner, folder: Path, options: argparse.Namespace) -> dict[str, Any]:
    found = {
        title: {
            "processor": cost.processor,
            "resident": cost.resident,
            "virtual": cost.virtual,
            "ticks": len(cost.node),
            "played": cost.played,
            "reached": cost.reached,
            **{name: summary(times) for name, times in (("node", cost.node), ("engine", cost.engine)) if times},
        }
        for title, cost in costs(nodes, folder, options.seconds).items()
    }
    return {"seconds": options.seconds, "nodes": found}


def _watched(nodes: Workspace | Runner, folder: Path, options: argparse.Namespace) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as scratch:
        runner = nodes if isinstance(nodes, Runner) else _prepared(2, "run", Path(scratch))
        assert isinstance(runner, Runner), runner
        return watched(nodes, runner, folder, options.rounds, 10.0)


PARTS: dict[str, Callable[[Any, Path, argparse.Namespace], dict[str, Any]]] = {
    "stop": _stops,
    "obstacle": _obstacles,
    "fast": _fast,
    "costs": _costs,
    "watched": _watched,
}


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
