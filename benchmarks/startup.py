"""Time commands from a cold start, relative to Python's import of the libraries that they use.

Prints for each command the median wall time of runs in new processes, the median of importing only the same third-party
modules, and their ratio: the part above 1 is our own code and the work itself. All modules are compiled before.

    python benchmarks/startup.py [RUNS]
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

MODEL = Path(__file__).parent.parent / "examples" / "line_follower" / "line_follower.rscd"

#: Program that runs a command and prints the third-party modules that it loaded, in that order.
LOADED = """
import sys
from robosc.tools.cli import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    assert not end.code
ours = {"robosc", "__main__", *sys.stdlib_module_names}
print(*(name for name in sys.modules if name.partition(".")[0] not in ours))
"""
#: Program that imports modules; some libraries create modules that can't be imported by name.
IMPORT = """
import sys
from importlib import import_module
for name in sys.argv[1:]:
    try:
        import_module(name)
    except ImportError:
        pass
"""


#: As installed: with compiled modules, which this variable would prevent.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def output_of(program: Sequence[str]) -> str:
    command = [sys.executable, *program]
    return subprocess.run(command, check=True, capture_output=True, text=True, env=ENVIRONMENT).stdout


def seconds(program: Sequence[str]) -> float:
    begin = time.perf_counter()
    output_of(program)
    return time.perf_counter() - begin


def main() -> None:
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    with tempfile.TemporaryDirectory() as output:
        commands = {
            "robosc check": ["check", str(MODEL)],
            "robosc transform --to cif,supervisor,ros1,ros2": [
                *("transform", str(MODEL), "--to", "cif,supervisor,ros1,ros2", "-o", output)
            ],
        }
        print(f"{'median of ' + str(runs) + ' runs':<48} {'command':>9} {'imports':>9} {'ratio':>6}")
        for name, command in commands.items():
            loaded = output_of(["-c", LOADED, *command]).splitlines()[-1].split()
            imports = ["-c", IMPORT, *loaded]
            # Alternate, so that other load of the machine slows both.
            pairs = [(seconds(["-m", "robosc", *command]), seconds(imports)) for _ in range(runs)]
            ours, theirs = (statistics.median(times) for times in zip(*pairs, strict=True))
            print(f"{name:<48} {ours * 1000:>6.0f} ms {theirs * 1000:>6.0f} ms {ours / theirs:>6.2f}")


if __name__ == "__main__":
    main()
