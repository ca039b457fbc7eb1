"""Measure what a supervisory layer costs beside a plain relay over ROS 2; write it into `docs/performance.md`.

    python benchmarks/layer_cost.py [--nodes compiled] [--hz 1000] [--seconds 20] [--rounds 5] [--keep FOLDER]

Each round starts the layer of `guarded_base`, a relay of the same topics, and one sender and one receiver for both. A
third topic leads from the sender to the receiver without a node between them. All velocities are allowed, and limited
while an obstacle is near. The relay of a compiled layer is in C++, that of `robosc run` in Python. The rounds are
printed, with the average load of the machine; their measurements are stored in `benchmarks/performance.json`.

On a busy machine, start the measurement with `chrt -f 5`, so that other programs do not delay the messages.

The compiled nodes need an rclcpp in AMENT_PREFIX_PATH, `run` the environment that `./run-tests` creates. Both compiled
nodes have the flags in CXXFLAGS, by default `-O2`.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from array import array
from collections import defaultdict
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.performance_page import KINDS, percentiles, store  # noqa: E402
from tests.ros.installations import find_ros2  # noqa: E402
from tests.ros.running import Runner, find_rclpy  # noqa: E402
from tests.ros.workspaces import Package, Workspace, build, middleware  # noqa: E402

if TYPE_CHECKING:
    from tests.ros.processes import Processes

HERE = Path(__file__).parent
MODEL = HERE / "guarded_base" / "guarded_base.rscd"
SETTINGS = MODEL.parent / "controller-config.json"
LAYER, RELAY = "guarded_base_layer", "plain_relay"
#: Topics of the velocities, from the sender and to the receiver.
SENT = {"relay": f"/{RELAY}/controller/cmd_vel", "layer": f"/{LAYER}/controller/cmd_vel", "direct": "/direct"}
RECEIVED = {"relay": f"/{RELAY}/cmd_vel", "layer": "/cmd_vel", "direct": "/direct"}
#: Seconds of the start-up, before the measurement.
WARM_UP = 5.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nodes", nargs="+", choices=["compiled", "run"], default=["compiled", "run"])
    parser.add_argument("--hz", type=int, default=1000, help="velocities a second on each topic")
    parser.add_argument("--seconds", type=float, default=20.0, help="length of a round")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--keep", type=Path, help="a folder for the builds, so that the next call need not repeat them")
    options = parser.parse_args()
    os.environ.setdefault("CXXFLAGS", "-O2")
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        for kind in KINDS:
            if kind.ros == 1 or kind.nodes not in options.nodes:
                continue
            nodes = _prepared(kind.nodes, options.keep.resolve() if options.keep else scratch / "built")
            if isinstance(nodes, str):
                print(f"{kind.title} is left out: {nodes}")
                continue
            print(kind.title)
            rounds = []
            for number in range(options.rounds):
                rounds.append(_round(nodes, scratch / f"{kind.key}-{number}", options.hz, options.seconds))
                print(f"  load {os.getloadavg()[0]:.1f}: {_line(rounds[-1])}", flush=True)
            middle = _middle(rounds)
            print(f"  median: {_line(middle)}")
            store("layer", kind, middle | {"hz": options.hz, "seconds": options.seconds, "rounds": options.rounds})


def _prepared(kind: str, folder: Path) -> Workspace | Runner | str:
    """Return the nodes of a kind, or the reason why there are none."""
    found = find_rclpy() if kind == "run" else find_ros2()
    if found.ros is None:
        return ", ".join(found.missing)
    if kind == "run":
        return Runner(found.ros, folder)
    place = folder / "layer-cost"
    package = Package(LAYER, MODEL, "ros2-layer", SETTINGS)
    return Workspace(found.ros, place, build(found.ros, place, [package], [HERE / "relay"]))


def _round(nodes: Workspace | Runner, folder: Path, hz: int, seconds: float) -> dict[str, Any]:
    """Return the latencies on each way in milliseconds, and the processor time of each node for a velocity in µs."""
    out = folder / "received"
    with middleware(nodes, folder) as processes:
        script = [nodes.ros.python, HERE / "layer_traffic.py"]
        receiver = processes.start("receiver", [*script, "receive", out, *RECEIVED.values()])
        relay, layer = _nodes(nodes, processes)
        processes.start("sender", [*script, "send", str(hz), *SENT.values()])
        time.sleep(WARM_UP)
        began, before = time.monotonic(), [_processor(pid) for pid in (relay, layer)]
        time.sleep(seconds)
        ended, after = time.monotonic(), [_processor(pid) for pid in (relay, layer)]
        assert processes.stop(receiver) == 0, processes.logs()
        received = array("d", out.read_bytes())
    latencies: dict[str, list[float]] = defaultdict(list)
    for number, now, latency in zip(received[::3], received[1::3], received[2::3], strict=True):
        if began <= now <= ended:
            latencies[[*SENT][int(number)]].append(latency)
    measured: dict[str, Any] = {way: percentiles(found) | {"received": len(found)} for way, found in latencies.items()}
    assert set(latencies) == set(SENT), processes.logs()
    for way, used, start in zip(("relay", "layer"), after, before, strict=True):
        measured[way]["processor"] = 1e6 * (used - start) / len(latencies[way])
    return measured


def _nodes(nodes: Workspace | Runner, processes: Processes) -> tuple[int, int]:
    """Start the relay and the layer, and return their processes."""
    commands = {
        "relay": nodes.node(RELAY) if isinstance(nodes, Workspace) else [nodes.ros.python, HERE / "relay" / "relay.py"],
        "layer": nodes.node(LAYER)
        if isinstance(nodes, Workspace)
        else nodes.command(MODEL, layer=True, configuration=SETTINGS),
    }
    relay, layer = (processes.start(name, command).pid for name, command in commands.items())
    return relay, layer


def _processor(pid: int) -> float:
    """Return the seconds of processor time that a process has used: Linux derives the number of a clock from it."""
    return time.clock_gettime(~pid << 3 | 2)


def _middle(rounds: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the medians of the rounds."""
    return {
        way: {name: median(measured[way][name] for measured in rounds) for name in values}
        for way, values in rounds[0].items()
    }


def _line(measured: dict[str, Any]) -> str:
    parts = []
    for way, values in measured.items():
        processor = f", {values['processor']:.0f} µs" if "processor" in values else ""
        parts.append(f"{way} {values['median']:.3f} ms, p99 {values['p99']:.3f}{processor} ({values['received']:.0f})")
    relay, layer = measured["relay"], measured["layer"]
    ratios = (f"{layer[name] / relay[name]:.2f} of {name}" for name in ("median", "processor"))
    return "; ".join([*parts, ", ".join(ratios)])


if __name__ == "__main__":
    main()
