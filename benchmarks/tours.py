"""How near to the shortest the tours of `--with-tests` are: prints a table of the examples.

    python benchmarks/tours.py [EXAMPLE...]

The bound is the least number of steps of a flow through the places of the control loop that shows all that the tours
show, in as many runs: no runs have fewer, since they are such a flow, in whole steps. A time that nobody waits for may
be up at any place where it runs, as often as there are steps for it to run in or waits for another one; in the flow a
tick comes before it, in a run it may be up before the tick of its period. Where a tour is planned without a look at all
places, parts of steps are allowed, too: minutes for the sprayer. There is none for the warehouse robot, which has too
many places. Where a tour does not show all, a line below the table says how much of what is missing is seen on any
step. Needs scipy (`pip install 'robosc[benchmarks]'`).
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import LinearConstraint, milp
from scipy.sparse import lil_matrix

import robosc
from robosc import configuration as config
from robosc.node_tests.plan import Plan
from robosc.node_tests.steps import WAIT
from robosc.node_tests.tour import Tour
from robosc.ros_types import RosTypes

if TYPE_CHECKING:
    from robosc.node_tests.steps import Place, Step

EXAMPLES = Path(__file__).parent.parent / "examples"
#: Seconds for each bound: of one in whole steps what is proved until then counts.
PATIENCE = 600
#: There is no bound for more places.
MOST = 20_000


class TimelessPlan(Plan):
    """A plan for which no time passes but on the wait for one that is up, and any time that runs may be up first."""

    @classmethod
    def of(cls, plan: Plan) -> TimelessPlan:
        """The plan from the same place on."""
        made = cls(plan.model, plan.settings, plan.stimuli, plan.longest, plan.period, plan.pause)
        start = plan.places[0]
        made.place(plan._known[start].saved, pauses=start.pauses)  # noqa: SLF001 - of its own class
        return made

    @property
    def periods(self) -> list[int]:
        """How many whole periods each time takes."""
        return [timer.milliseconds // self.period for timer in self._loop.engine.executed.timers]

    def expiries(self, place: Place) -> dict[int, Step]:
        """By the time that is up, among those that run, the step that follows, whichever would be up first."""
        loop, found = self._loop, {}
        for number in sorted(place.running):
            loop.restore(self._known[place].saved)
            now, up = loop.timers.saved
            loop.timers.restore((now, {**up, number: now}))
            self._pauses, self._shown = place.pauses, 0
            loop.expire()
            found[number] = self._ended(WAIT)
        return found


class Start(Tour):
    """A tour without a step: it sees what is seen before the first one."""

    def _tour(self) -> list[Step]:
        super()._tour()
        return []


def bound(plan: TimelessPlan, runs: int, wanted: list[int]) -> int | None:
    """The least number of steps that a flow has which shows all that is wanted; None where not all places are known.

    What is wanted has a bit for each goal.
    """
    if look_at_all(plan) is None:
        return None
    arcs = [arc for place in plan.places for arc in all_arcs(plan, place)]
    number = {place: row for row, place in enumerate(plan.places)}
    # A flow of each arc, then what ends in each place. The first place is where runs begin.
    columns = len(arcs) + len(number)
    balance, starts = lil_matrix((len(number), columns)), np.zeros(len(number))
    for column, arc in enumerate(arcs):
        balance[number[arc.start], column] -= 1
        balance[number[arc.step.end], column] += 1
    for row in range(len(number)):
        balance[row, len(arcs) + row] = -1
    starts[0] = -runs
    shown, timers = lil_matrix((len(wanted), columns)), plan.periods
    meanwhile = lil_matrix((len(timers), columns))
    for column, arc in enumerate(arcs):
        shown[:, [column]] = np.array([[bool(arc.step.shows & bit)] for bit in wanted])
        for row, periods in enumerate(timers):
            meanwhile[row, column] = arc.lets_run(row, periods)
    cost = np.concatenate([[arc.up is None for arc in arcs], np.zeros(len(number))])
    constraints = [
        LinearConstraint(balance.tocsr(), starts, starts),
        LinearConstraint(shown.tocsr(), np.ones(len(wanted)), np.inf),
        *([LinearConstraint(meanwhile.tocsr(), np.zeros(len(timers)), np.inf)] if timers else []),
    ]
    integrality = np.full_like(cost, plan.is_whole, dtype=int)
    found = milp(cost, constraints=constraints, integrality=integrality, options={"time_limit": PATIENCE})
    least = found.mip_dual_bound if plan.is_whole else found.fun if found.success else None
    return None if least is None else int(np.ceil(least - 1e-6))


class Arc(NamedTuple):
    """What a run can do at a place: a step, or on the way a time is `up` that nobody waits for, which is none."""

    start: Place
    step: Step
    up: int | None

    def lets_run(self, timer: int, periods: int) -> int:
        """For how many of the periods that a time takes it may have run meanwhile; below 0: it is up by itself here."""
        if self.up is not None:
            return -periods if self.up == timer else 0
        return periods if self.step.stimulus == WAIT else 1


def all_arcs(plan: TimelessPlan, place: Place) -> list[Arc]:
    """The steps from a place, with the wait for any time that runs instead of that for the first; and what is none."""
    steps = [step for step in plan.steps(place) if step.stimulus != WAIT or place.pauses]
    up = plan.expiries(place)
    return [
        *(Arc(place, step, None) for step in [*steps, *up.values()]),
        *(Arc(place, step, timer) for timer, step in up.items()),
    ]


def look_at_all(plan: TimelessPlan) -> int | None:
    """What is shown on any step between the places of the control loop, a bit for each goal; None: there are too many.

    A place is the state, the times that run, and whether it pauses.
    """
    pending = plan.places[:1]
    seen, shown = set(pending), 0
    while pending and len(seen) <= MOST:
        for arc in all_arcs(plan, pending.pop()):
            shown |= arc.step.shows
            if arc.step.end not in seen:
                seen.add(arc.step.end)
                pending.append(arc.step.end)
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
        graph, distribution = robosc.to_rosgraph(robot), RosTypes().distributions[0]
        tour, start = Tour(graph, settings, distribution), Start(graph, settings, distribution)
        coverage = tour.coverage
        wanted = tour.plan.possible - start.coverage.seen - set(coverage.missed)
        plan = TimelessPlan.of(tour.plan)
        least = bound(plan, len(tour.traces), [tour.plan.bits[goal] for goal in wanted])
        counts = [coverage.transitions, coverage.guards(value=True), coverage.guards(value=False)]
        cells = [f"{seen} of {possible}" for seen, possible in counts]
        told = "not known" if least is None else f"{least} (+{coverage.steps / least - 1:.0%})"
        print(f"| `{name}` | {len(tour.traces)} | {coverage.steps} | {told} | {' | '.join(cells)} |", flush=True)
        if coverage.missed:
            shown = look_at_all(plan) or 0
            found = sum(bool(tour.plan.bits[goal] & shown) for goal in coverage.missed)
            told_below.append(
                f"{name}: {len(coverage.missed)} not seen, {found} of them on any step between all places"
            )
    print("", *told_below, sep="\n")


if __name__ == "__main__":
    main()
