"""Synthesize one CIF model several times in one process; print the results and costs as JSON.

    python benchmarks/cif_models_run.py MODEL.cif ROUNDS

Seconds are processor time, from the order of the variables to the number of states. With 0 rounds, the guards are
computed, too, and the result is their share of the seconds.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from time import process_time

sys.path.insert(0, str(Path(__file__).parent.parent))

from robosc.language.cif import read
from robosc.synthesis import Phase, Statistics, count, synthesize


def main() -> None:
    model = read(sys.argv[1]).model
    assert model is not None
    if sys.argv[2] == "0":
        costs = synthesize(model).statistics.processor_seconds
        print(json.dumps({"guards": costs.get(Phase.GUARDS, 0) / sum(costs.values())}))
        return
    seconds = []
    for _ in range(int(sys.argv[2])):
        statistics = Statistics()
        began = process_time()
        counts = count(model, statistics=statistics)
        seconds.append(process_time() - began)
    found = {"states": counts.controlled_states, "seconds": seconds}
    print(json.dumps(found | {"nodes": statistics.peak_nodes, "operations": statistics.operations}))


if __name__ == "__main__":
    main()
