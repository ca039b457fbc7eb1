"""Measure the costs of each kind of requirement in synthesis: a ring of stations, each with one requirement.

    python benchmarks/requirement_costs.py [--stations 20 40]

Prints the table of docs/synthesis.md. Seconds are the best of three; all other numbers are the same on every run.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from time import process_time

sys.path.insert(0, str(Path(__file__).parent.parent))

import robosc
from robosc.synthesis import Statistics, Synthesis, synthesize

_STATION = """component C{i} {{
  outgoing message level{i} with type: integer(0..3)
  outgoing message door{i} with type: boolean
  service grip{i} with request: none, response: none
  incoming message go{i} with type: none
  behaviour {{
    variable level: integer(0..3)
    variable open: boolean
    on response from level{i} do level := value
    on response from door{i} do open := value
    initial marked state idle {{ on request to grip{i} goto busy }}
    state busy {{ on response from grip{i} goto done on error from grip{i} goto idle }}
    state done {{ on request to go{i} goto idle }}
  }}
}}
requirement grip{i} needs C{i}.level > 1 and !C{i}.open
"""
#: Requirement of each station `i`, beside station `j`.
KINDS = {
    "none": "",
    "`needs`": "requirement go{i} needs !C{j}.busy",
    "`never`": "requirement never C{i}.busy and C{j}.busy",
    "`after each`": "requirement go{i} after each grip{i}",
    "`at most`": "requirement at most 3 grip{i} since go{j}",
    "automaton": """requirement T{i}: automaton {{
      initial state a {{ on request to grip{i} goto b }}
      state b {{ on request to go{j} on request to grip{i} if C{j}.open on request to go{i} goto a }}
    }}""",
}


def synthesis_of(stations: int, kind: str) -> Synthesis:
    """Return the synthesis of a ring of stations."""
    parts = [(_STATION + KINDS[kind]).format(i=number, j=(number + 1) % stations) for number in range(stations)]
    robot = robosc.load(text="\n".join(["robot Ring {", *parts, "}"]))
    return synthesize(robosc.to_sct(robot), statistics=Statistics())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--stations", type=int, nargs="+", default=[20, 40])
    options = parser.parse_args()
    print("| one more for each station | stations | controlled states | s | operations | peak nodes |")
    print("|---|---:|---:|---:|---:|---:|")
    for kind in KINDS:
        for stations in options.stations:
            seconds = []
            for _ in range(3):
                began = process_time()
                found = synthesis_of(stations, kind)
                seconds.append(process_time() - began)
            print(
                f"| {kind} | {stations} | {found.controlled_states:.1e} | {min(seconds):.1f} "
                f"| {found.statistics.operations:,} | {found.statistics.peak_nodes:,} |"
            )


if __name__ == "__main__":
    main()
