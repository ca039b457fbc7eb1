"""Compares synthesis, findings, explanations, verification and engines with their definitions on many random models.

    python benchmarks/search.py [times]

runs the tests that do so with `times` as many models as `./run-tests` does (10 unless told). The control loops of the
listings and the patterns are tried with as many times the operations, which are all that `verify` tries.
"""

import os
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).parents[1]
TESTS = (
    "synthesis",
    "analysis",
    "m2t/supervisor/test_differential.py",
    "m2m",
    "examples/test_verify.py",
    "test_patterns.py",
)


def main(times: str = "10") -> int:
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-n",
        "auto",
        "-m",
        "slow or build",
        *(f"tests/{name}" for name in TESTS),
    ]
    return subprocess.run(command, cwd=PROJECT, env={**os.environ, "ROBOSC_SEARCH": times}, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
