"""Compare synthesis, verification, engines and other parts with their definitions on many random models.

    python benchmarks/search.py [times]

runs the tests with random input, and the searching tests, with `times` as many examples as `./run-tests` (default 10).
For listings, patterns and the two large robots, as many times the operations and states are tried, which are all that
`verify` tries.
"""

import os
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).parents[1]
#: Searching tests besides those with random input of hypothesis.
TESTS = (
    "synthesis",
    "analysis",
    "m2t/supervisor/test_differential.py",
    "m2m",
    "examples/test_verify.py",
    "test_patterns.py",
)


def main(times: str = "10") -> int:
    pytest = [sys.executable, "-m", "pytest", "-n", "auto"]
    searches = [
        ["-m", "hypothesis and not ros", "tests"],
        ["-m", "(slow or build) and not hypothesis", *(f"tests/{name}" for name in TESTS)],
    ]
    environment = {**os.environ, "ROBOSC_SEARCH": times}
    done = [subprocess.run([*pytest, *search], cwd=PROJECT, env=environment, check=False) for search in searches]
    return int(any(search.returncode for search in done))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
