"""Count the controlled states of one instance of `dcs_families.py`; print the results and costs as JSON.

    python benchmarks/dcs_run.py FAMILY N K SECONDS MEGABYTES

The process ends with SIGXCPU after the given seconds of processor time. Megabytes limit the decision diagrams and the
whole process. `synthesis` is the processor time from the variable order to the number of states, all processes added.
"""

from __future__ import annotations

import json
import resource
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))

from benchmarks.dcs_families import FAMILIES
from robosc.language.cif import read
from robosc.synthesis import Statistics, count


def main() -> None:
    family = FAMILIES[sys.argv[1]]
    n, k, seconds, megabytes = map(int, sys.argv[2:])
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "instance.cif"
        path.write_text(family.instance(n, k).text, encoding="utf-8")
        model = read(path).model
    assert model is not None
    statistics = Statistics()
    began = _processor_seconds()
    try:
        counts = count(model, memory=megabytes << 20, statistics=statistics)
    except MemoryError:
        print(json.dumps({"ended": "memory"}))
        return
    costs = {"operations": statistics.operations, "nodes": statistics.peak_nodes}
    costs |= {"synthesis": _processor_seconds() - began}
    print(json.dumps({"ended": "done", "states": counts.controlled_states, **costs}))


def _processor_seconds() -> float:
    """Return the processor time of this process and its ended child processes."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


if __name__ == "__main__":
    main()
