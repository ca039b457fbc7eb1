"""Measure how late a timer of a model expires over a real ROS, under the load of a sensor; print a line per node.

    python benchmarks/expiry.py [--ros 1] [--nodes compiled] [--times 200] [--hz 100] [--keep FOLDER]

The measured time is from a press of a button to the beep 200 ms after it, including two messages. `early` must be 0.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.performance_page import KINDS  # noqa: E402
from tests.ros.expiries import DURATION, PACKAGE, expiries  # noqa: E402
from tests.ros.installations import find_ros1, find_ros2  # noqa: E402
from tests.ros.running import Runner, find_rclpy, ros2_modules  # noqa: E402
from tests.ros.workspaces import ROS1_PACKAGES, ROS2_PACKAGES, Workspace, build  # noqa: E402


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ros", type=int, nargs="+", choices=[1, 2], default=[1, 2])
    parser.add_argument("--nodes", nargs="+", choices=["compiled", "run"], default=["compiled", "run"])
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--hz", type=float, default=100.0)
    parser.add_argument("--keep", type=Path, help="a folder for what is built")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        folder = options.keep.resolve() if options.keep else scratch / "built"
        for kind in KINDS:
            if kind.ros in options.ros and kind.nodes in options.nodes:
                nodes = _prepared(kind.ros, kind.nodes, folder)
                if isinstance(nodes, str):
                    print(f"{kind.title}: left out: {nodes}")
                    continue
                found = expiries(nodes, scratch / kind.key, options.times, options.hz)
                late = sorted(1000 * (seconds - DURATION) for seconds in found)
                print(
                    f"{kind.title}: {len(late)} times, median {statistics.median(late):.1f} ms late, at worst"
                    f" {late[-1]:.1f} ms; early: {sum(lateness < 0 for lateness in late)}"
                )


def _prepared(version: int, kind: str, folder: Path) -> Workspace | Runner | str:
    """Return the nodes of a kind, or the reason why there are none."""
    found = find_rclpy() if kind == "run" else {1: find_ros1, 2: find_ros2}[version]()
    if found.ros is None:
        return ", ".join(found.missing)
    if kind == "run":
        return Runner(found.ros, Path(ros2_modules(found.ros, folder / "run-ros2")))
    packages = [package for package in {1: ROS1_PACKAGES, 2: ROS2_PACKAGES}[version] if package.name == PACKAGE]
    place = folder / f"compiled-ros{version}"
    return Workspace(found.ros, place, build(found.ros, place, packages, []))


if __name__ == "__main__":
    main()
