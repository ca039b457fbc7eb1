"""Build generated packages with sanitizers and drive them: one scenario, the faults, load and unload, the end.

python benchmarks/sanitized.py [--ros 1|2] [--sanitizer address|thread] [--packages NAME,...] [--folder FOLDER] [--page]
                               [PYTEST...]

Without options it runs all that this machine supports: ROS 1 if it is installed, ROS 2 if `rclcpp` is. The tests are
those of `tests/ros`, or those named by the further arguments, which go to pytest. Then `--packages` names the packages
that they need; only these are built. Builds and reports stay in `--folder`, if it is named. The results go into
`sanitized.json` and `docs/sanitizers.md`; `--page` writes only the latter. Ends with 1 if a sanitizer has reported an
error in generated code.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

if TYPE_CHECKING:
    from collections.abc import Iterable

HERE = Path(__file__).parent
ROOT = HERE.parent
RESULTS, PAGE = HERE / "sanitized.json", ROOT / "docs" / "sanitizers.md"
SANITIZERS = {"address": "address,undefined", "thread": "thread"}
CONTROLLERS = [f"{name}_controller" for name in ("line_follower", "scout", "courier", "porter")]
PACKAGES = [*CONTROLLERS, "managed_porter", "managed_watch", "guard_layer", "usher_layer"]
#: Rounds of load and unload in each container: four components in each.
ROUNDS = 125
TESTS = ["tests/ros/faults", "tests/ros/test_line_follower.py", "tests/ros/test_layer.py"]
TESTS += ["tests/ros/test_layer_times.py", "tests/ros/test_ros{}_node.py"]
#: Suppressed reports, and the reasons, for the page.
OPTIONS = {
    "ASAN_OPTIONS": "detect_leaks=0:new_delete_type_mismatch=0:verify_asan_link_order=0",
    "UBSAN_OPTIONS": "print_stacktrace=1",
    "TSAN_OPTIONS": "exitcode=0:second_deadlock_stack=1:history_size=4",
}
#: Libraries that take their own locks in both orders within single calls, so that no caller could change the order.
JUDGED = re.compile(r"lib(?:roscpp|rosconsole|log4cxx)\.so")
#: Logging of rclcpp in an interrupt by a signal, under a lock, while other locks are held.
INTERRUPTED = re.compile(r"rclcpp_logging_output_handler.*(?:\n *#.*)*CallUserSignalHandler")
#: Page without its numbers.
ABOUT = """# Sanitizers

Sanitizers of GCC watch generated packages on a live ROS graph. This page shows what they reported. The address and
undefined-behavior sanitizers report nothing about generated code. The thread sanitizer reports no data race in it. Its
reports about the order of locks in ROS 2 are [no faults](#orders-of-locks-in-ros-2).

<!-- not run: it builds and drives packages with ROS -->
```sh
python benchmarks/sanitized.py
```

The command builds packages with each sanitizer and drives them: a scenario, the [faults](faults.md), components that
both kinds of containers load and unload under load, and the ways to end a node. ROS itself is built without a
sanitizer, except for the run of ROS 2 and the thread sanitizer. There, the containers and the libraries of rclcpp are
built with it, too.

TABLE
## How reports are counted

A report counts for generated code if this code makes one of the accesses itself, or if it takes part in an order of
locks. All other reports count for the libraries. These reports do so whatever code called them:

- orders of locks that roscpp and its logging take
- the handler of signals in rclcpp, which logs under a lock of its own

The command does not search for leaks, or for `new-delete-type-mismatch` in `rcutils`.

The thread sanitizer does not see reference counts that a library without instrumentation decrements. It then reports
the `operator delete` of the last owner as a race, although the code is correct.

## Failed tests

A test can fail because a sanitizer costs time or memory:

- `test_flood`, ROS 1 with the address sanitizer: the process took 23.9 MB more memory, and the limit is 10 MB. The
  sanitizer keeps freed memory for a while.
- `test_components_come_and_go_under_load`, ROS 2 with the thread sanitizer: the idle multi-threaded container does not
  end at an interrupt, because the sanitizer holds back a signal while a thread waits for a lock.
- `test_silent_with_watchdog_that_stops`, ROS 2 with the thread sanitizer: the machine was overloaded, so messages came
  later than the watchdog allows. The test passes alone.

## Orders of locks in ROS 2

One of the reports is about rclcpp alone: it takes two of its locks in both orders while a node is created during the
shutdown of its context.

All others are about actions. `rclcpp_action` holds a lock while it calls back. The callback takes the lock of the
node's `CallbackGuard`, and it may send or cancel a goal, which takes the lock of `rclcpp_action` again. The callbacks
of a node are in one callback group, and an executor runs one of them at a time. They therefore never wait for each
other.

## Static analysis

clang-tidy 14 checks generated controllers and layers with [`tests/ros/.clang-tidy`](../tests/ros/.clang-tidy). Its
checks do not end on the node of `usher_layer` in ROS 2, so [the test](../tests/ros/test_clang_tidy.py) leaves this node
out. Its static analyzer cannot check the three headers of templates that only layers in ROS 2 include. Its other checks
read them.
"""
Results = dict[str, dict[str, Any]]


def drive(ros: int, sanitizer: str, packages: list[str], folder: Path, more: list[str]) -> dict[str, Any]:
    """Build and drive one kind of packages; return the tests passed and failed, and the reports by place."""
    reports = folder / f"reports-{ros}-{sanitizer}"
    reports.mkdir(parents=True, exist_ok=True)
    for old in reports.iterdir():
        old.unlink()
    flags = f"-g -O1 -fno-omit-frame-pointer -fsanitize={SANITIZERS[sanitizer]}"
    library = {"address": "libasan.so", "thread": "libtsan.so"}[sanitizer]
    asking = [shutil.which("g++") or "g++", f"-print-file-name={library}"]
    found = subprocess.run(asking, capture_output=True, text=True, check=True)
    workspace = folder / f"ros{ros}-{sanitizer}"
    environment = {
        **os.environ,
        # The sanitizer libraries loaded before Python belong to this compiler.
        "CXX": "g++",
        "CFLAGS": flags,
        "CXXFLAGS": flags,
        # Libraries of ROS and of messages may have undefined symbols that only Python provides; programs do not load
        # libraries that they do not use.
        "LDFLAGS": "-Wl,--as-needed,--allow-shlib-undefined",
        "ROBOSC_PACKAGES": " ".join(packages),
        "ROBOSC_PRELOAD": found.stdout.strip(),
        "ROBOSC_ROUNDS": str(ROUNDS),
        f"ROBOSC_ROS{ros}_WORKSPACE": str(workspace),
        **{name: f"{options}:log_path={reports / 'report'}" for name, options in OPTIONS.items()},
    }
    chosen = f"ros{ros} and not run"
    junit = folder / "junit.xml"
    command = ["setarch", "--addr-no-randomize", sys.executable, "-m", "pytest", "-q", "-k", chosen]
    tests = [] if any(argument.startswith("tests/") for argument in more) else [test.format(ros) for test in TESTS]
    subprocess.run([*command, f"--junitxml={junit}", *tests, *more], cwd=ROOT, env=environment, check=False)
    (suite,) = ElementTree.parse(junit).getroot()  # noqa: S314  # pytest's own
    failed = int(suite.get("failures", 0)) + int(suite.get("errors", 0))
    ours, others = sorted_reports(path.read_text(errors="replace") for path in sorted(reports.iterdir()))
    return {
        "date": datetime.now(UTC).date().isoformat(),
        "packages": [package for package in packages if (workspace / "src" / package).exists()],
        "passed": int(suite.get("tests", 0)) - failed - int(suite.get("skipped", 0)),
        "failed": sorted(
            f"{case.get('classname')}::{case.get('name')}"
            for case in suite
            if case.find("failure") is not None or case.find("error") is not None
        ),
        "reports": ours,
        "elsewhere": others,
    }


def sorted_reports(texts: Iterable[str]) -> tuple[dict[str, int], dict[str, int]]:
    """Return the reports on generated code, and on libraries alone, with their counts."""
    ours: Counter[str] = Counter()
    others: Counter[str] = Counter()
    for text in texts:
        for report in re.split(r"(?m)^=+$", text):
            for summary in re.findall(r"SUMMARY: (.*)|(runtime error: .*)", report):
                line = re.sub(r"0x[0-9a-f]+|/\S*/", "", "".join(summary))
                (ours if of_generated_code(report) else others)[line] += 1
    return dict(sorted(ours.items())), dict(sorted(others.items()))


def of_generated_code(report: str) -> bool:
    """Return whether generated code itself causes a report, not its callers or callees.

    Libraries that were not built with the thread sanitizer hide their atomic counters from it. The order of locks also
    depends on callers, except for libraries that were `JUDGED`, and for rclcpp when it is `INTERRUPTED`.
    """
    generated = re.compile("|".join(rf"/{package}/(?:src|include)/" for package in PACKAGES))
    orders = "lock-order-inversion" in report
    left_out = r"\s*(?:As if|Thread|Location)" if orders else r"\s*(?:As if|Thread|Mutex|Location)"
    accesses = [stanza for stanza in report.split("\n\n") if not re.match(left_out, stanza)]
    stacks = [re.findall(r"(?m)^ *#\d+ .*", stanza) for stanza in accesses]
    own = [[frame for frame in stack if not re.search(r"/usr/include/|lib[a-z]*san", frame)] for stack in stacks]
    innermost = [stack[0] for stack in own if stack]
    if orders:
        judged = INTERRUPTED.search(report) or all(JUDGED.search(frame) for frame in innermost)
        return bool(generated.search(report)) and not judged
    return any(generated.search(frame) for frame in innermost) or "runtime error" in report


def page(results: Results) -> str:
    """Return the page of the documentation."""
    lines = [
        "| | last run | packages | tests passed | failed | reports on generated code | on libraries alone |",
        "|---|---|---:|---:|---:|---:|---:|",
    ]
    for key, result in sorted(results.items()):
        ros, sanitizer = key.split("-")
        cells = [
            f"ROS {ros[-1]}, {SANITIZERS[sanitizer].replace(',', ' and ')}",
            result["date"],
            len(result["packages"]),
            result["passed"],
            len(result["failed"]),
            sum(result["reports"].values()),
            sum(result["elsewhere"].values()),
        ]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return ABOUT.replace("TABLE\n", "\n".join([*lines, "", ""]))


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--ros", type=int, choices=[1, 2])
    parser.add_argument("--sanitizer", choices=SANITIZERS)
    parser.add_argument("--packages", type=lambda names: names.split(","), default=PACKAGES)
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--page", action="store_true")
    chosen, more = parser.parse_known_args()
    results: Results = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    if not chosen.page:
        sys.path.insert(0, str(ROOT))
        from tests.ros.installations import find_ros1, find_ros2  # noqa: PLC0415  # only to measure

        there = [ros for ros, found in ((1, find_ros1()), (2, find_ros2())) if found.ros]
        with tempfile.TemporaryDirectory() as temporary:
            for ros in [chosen.ros] if chosen.ros else there:
                for sanitizer in [chosen.sanitizer] if chosen.sanitizer else SANITIZERS:
                    folder = (chosen.folder or Path(temporary)).absolute()
                    result = drive(ros, sanitizer, chosen.packages, folder, more)
                    results[f"ros{ros}-{sanitizer}"] = result
                    RESULTS.write_text(json.dumps(results, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    PAGE.write_text(page(results), encoding="utf-8")
    return 1 if any(result["reports"] for result in results.values()) else 0


if __name__ == "__main__":
    raise SystemExit(main())
