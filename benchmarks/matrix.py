"""Runs the rows of long tables of tests that `./run-tests` leaves out: it has other rows of the same tables.

    python benchmarks/matrix.py [arguments of pytest]

They are marked `matrix`: the scenarios over the other ROS; the demands without which a second opinion objects;
reports, tours and runs of more robots, and what MISRA C says of them; what clang-tidy, which nothing installs, says of
nodes.
"""

import subprocess
import sys
from pathlib import Path

RUN_TESTS = Path(__file__).parents[1] / "run-tests"

if __name__ == "__main__":
    sys.exit(subprocess.run([RUN_TESTS, "-m", "matrix", *sys.argv[1:]], check=False).returncode)
