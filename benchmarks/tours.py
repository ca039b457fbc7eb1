"""How near to the shortest the tours of `--with-tests` are: prints a table of the examples.

    python benchmarks/tours.py [EXAMPLE...]

The bound is the least number of steps of a flow through the places of the control loop that shows all that the tours
show, in as many runs: no runs have fewer, since they are such a flow, in whole steps. Where a tour is planned without
a look at all places, parts of steps are allowed, too: a minute or two for the sprayer. There is none for the warehouse
robot, which has too many places. Where a tour does not show all, a line below the table says how much of what is
missing is seen on any step. Needs scipy (`pip install 'robosc[benchmarks]'`).
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import LinearConstraint, milp
from scipy.sparse import lil_matrix

import robosc
from robosc import configuration as config
from robosc.node_tests.tour import Tour
from robosc.ros_types import RosTypes

if TYPE_CHECKING:
    from robosc.node_tests.plan import Plan

EXAMPLES = Path(__file__).parent.parent / "examples"
#: Seconds for each bound: of one in whole steps what is proved until then counts.
PATIENCE = 600
#: There is no bound for more places.
MOST = 10_000


def bound(plan: Plan, runs: int, wanted: list[int]) -> int | None:
    """The least number of steps that a flow has which shows all that is wanted; None where not all places are known.

    What is wanted has a bit for each goal.
    """
    if look_at_all(plan) is None:
        return None
    arcs = [(place, step) for place in plan.places for step in plan.steps(place)]
    number = {place: row for row, place in enumerate(plan.places)}
    # A flow of each arc, then what ends in each place. The first place is where runs begin.
    balance = lil_matrix((len(number), len(arcs) + len(number)))
    for column, (place, step) in enumerate(arcs):
        balance[number[place], column] -= 1
        balance[number[step.end], column] += 1
    for row in range(len(number)):
        balance[row, len(arcs) + row] = -1
    starts = np.zeros(len(number))
    starts[0] = -runs
    shown = lil_matrix((len(wanted), len(arcs) + len(number)))
    for column, (_, step) in enumerate(arcs):
        for row, bit in enumerate(wanted):
            if step.shows & bit:
                shown[row, column] = 1
    cost = np.concatenate([np.ones(len(arcs)), np.zeros(len(number))])
    constraints = [
        LinearConstraint(balance.tocsr(), starts, starts),
        LinearConstraint(shown.tocsr(), np.ones(len(wanted)), np.inf),
    ]
    integrality = np.full_like(cost, plan.is_whole)
    found = milp(cost, constraints=constraints, integrality=integrality, options={"time_limit": PATIENCE})
    least = found.mip_dual_bound if plan.is_whole else found.fun if found.success else None
    return None if least is None else int(np.ceil(least - 1e-6))


def look_at_all(plan: Plan) -> int | None:
    """What is shown on any step between the places of the control loop, a bit for each goal; None: there are too many.

    A place is the state, the times that run, and whether it pauses.
    """
    pending = plan.places[:1]
    seen, shown = set(pending), 0
    while pending and len(seen) <= MOST:
        for step in plan.steps(pending.pop()):
            shown |= step.shows
            if step.end not in seen:
                seen.add(step.end)
                pending.append(step.end)
    return None if pending else shown


def main() -> None:
    names = sys.argv[1:] or sorted(path.parent.name for path in EXAMPLES.glob("*/*.rscd"))
    print("| robot | runs | steps | at least | transitions | guards true | guards false |")
    print("|---|---|---|---|---|---|---|")
    told_below = []
    for name in names:
        robot = robosc.load(EXAMPLES / name / f"{name}.rscd")
        robosc.synthesize(robosc.to_sct(robot))
        file = config.find(EXAMPLES / name)
        settings = config.read(file) if file else config.Configuration()
        tour = Tour(robosc.to_rosgraph(robot), settings, RosTypes().distributions[0])
        coverage = tour.coverage
        wanted = tour.plan.possible - tour.at_start - set(coverage.missed)
        least = bound(tour.plan, len(tour.traces), [tour.plan.bits[goal] for goal in wanted])
        counts = [coverage.transitions, coverage.guards(value=True), coverage.guards(value=False)]
        cells = [f"{seen} of {possible}" for seen, possible in counts]
        told = "not known" if least is None else f"{least} (+{coverage.steps / least - 1:.0%})"
        print(f"| `{name}` | {len(tour.traces)} | {coverage.steps} | {told} | {' | '.join(cells)} |", flush=True)
        if coverage.missed:
            shown = look_at_all(tour.plan) or 0
            found = sum(bool(tour.plan.bits[goal] & shown) for goal in coverage.missed)
            told_below.append(
                f"{name}: {len(coverage.missed)} not seen, {found} of them on any step between all places"
            )
    print("", *told_below, sep="\n")


if __name__ == "__main__":
    main()
