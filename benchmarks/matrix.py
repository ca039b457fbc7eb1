"""Run the rows of long test tables that `./run-tests` leaves out: it has other rows of the same tables.

    python benchmarks/matrix.py [arguments of pytest]

They are marked `matrix`: the scenarios over the other ROS; the conditions without which a second opinion objects;
reports, tours and runs of more robots, and their check against MISRA C; the check of nodes with clang-tidy, which is
not installed by default.
"""

import subprocess
import sys
from pathlib import Path

RUN_TESTS = Path(__file__).parents[1] / "run-tests"

if __name__ == "__main__":
    sys.exit(subprocess.run([RUN_TESTS, "-m", "matrix", *sys.argv[1:]], check=False).returncode)
