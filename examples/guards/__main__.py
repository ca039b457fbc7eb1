"""The guards as a program that you can start from any folder: `python examples/guards --guard NAME`."""

import sys
from pathlib import Path

# Python runs this folder, not a package: its parent replaces it on the path.
sys.path[0] = str(Path(__file__).resolve().parents[1])

from guards.command import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
