"""The guards as a program that you can start from any folder: `python examples/guards --guard NAME`."""

import sys
from pathlib import Path

# Python runs this folder, not a package: the parent of `examples` replaces it on the path.
sys.path[0] = str(Path(__file__).resolve().parents[2])

from examples.guards.command import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
