"""`python examples/simulator --scenario NAME`: the simulator as a program, wherever it is started."""

import sys
from pathlib import Path

# What runs is a folder, not a package: its own folder gives way to the one above it.
sys.path[0] = str(Path(__file__).resolve().parents[1])

from simulator.command import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
