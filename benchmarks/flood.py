"""Send 2,000 messages a second for a minute to nodes of each installed kind; print received messages and costs.

python benchmarks/flood.py [seconds]
"""

import os
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).parents[1]


def main(seconds: str = "60") -> int:
    command = [sys.executable, "-m", "pytest", "tests/ros/faults/test_flood.py", "--log-cli-level=INFO"]
    environment = {**os.environ, "ROBOSC_FLOOD_SECONDS": seconds}
    return subprocess.run(command, cwd=PROJECT, env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
