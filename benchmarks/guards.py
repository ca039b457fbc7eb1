"""Random agents behind the guards of the gallery and of the simulator: the fate of their commands, as a table.

python benchmarks/guards.py [--commands 10000] [--seed 0]
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from examples.guards.command import trial_of  # noqa: E402
from examples.guards.gallery import GALLERY  # noqa: E402
from examples.simulator.guarding import guard_scenario  # noqa: E402
from examples.simulator.scenarios import SCENARIOS  # noqa: E402


def main() -> int:
    parser = argparse.ArgumentParser(description="Random agents behind guards.")
    parser.add_argument("--commands", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    print("| guard | commands | passed | changed | blocked | stops | goals canceled | faults | seconds |")
    print("|---|---|---|---|---|---|---|---|---|")
    faults = 0
    for kind, names in ((trial_of, GALLERY), (guard_scenario, SCENARIOS)):
        for name in names:
            start = time.process_time()
            tally = kind(name, options.seed).run(options.commands)
            numbers = (
                tally.commands,
                tally.reached.total(),
                tally.changed.total(),
                tally.withheld.total(),
                tally.stops,
                tally.canceled,
                len(tally.faults),
            )
            cells = " | ".join(f"{number:,}" for number in numbers)
            print(f"| {name} | {cells} | {time.process_time() - start:.1f} |", flush=True)
            for fault in tally.faults[:3]:
                print(f"  {fault}", file=sys.stderr)
            faults += len(tally.faults)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
