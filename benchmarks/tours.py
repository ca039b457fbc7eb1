"""Compare the tours of `--with-tests` with the shortest possible ones; print a table of the examples.

    python benchmarks/tours.py [EXAMPLE...]

The bound is the least number of steps of a flow through the places of the control loop that shows all goals of the
tours, in as many runs. No runs have fewer steps, since they are such a flow, in whole steps. A timer may expire at any
place where it runs, as often as there are steps for it to run in or waits for another timer. In the flow a tick comes
before it; in a run it may expire before the tick of its period. If a tour is planned without exploring all places, the
bound allows parts of steps, too: this takes minutes for the sprayer. There is no bound for the warehouse robot, which
has too many places. If a tour misses goals, a line below the table reports how many of them any step shows. Needs scipy
(`pip install 'robosc[benchmarks]'`).
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import LinearConstraint, milp
from scipy.sparse import lil_matrix

import robosc
from robosc.base.ros_types import RosTypes
from robosc.language import configuration as config
from robosc.run.node_tests.plan import Plan
from robosc.run.node_tests.steps import WAIT
from robosc.run.node_tests.tour import Tour

if TYPE_CHECKING:
    from robosc.run.node_tests.steps import Place, TourStep

EXAMPLES = Path(__file__).parent.parent / "examples"
#: Seconds for each bound. In whole steps, the bound proved until then counts.
PATIENCE = 600
#: Maximum number of places for a bound.
MOST = 20_000


class TimelessPlan(Plan):
    """Plan in which time passes only in waits for a timer, and any running timer may expire first."""

    @classmethod
    def of(cls, plan: Plan) -> TimelessPlan:
        """Return the plan from the same place on."""
        made = cls(plan.model, plan.settings, plan.stimuli, plan.longest, plan.period, plan.pause)
        start = plan.places[0]
        made.place(plan._known[start].saved, pauses=start.pauses)  # noqa: SLF001 - of its own class
        return made

    @property
    def periods(self) -> list[int]:
        """Return the duration of each timer in whole periods."""
        return [timer.milliseconds // self.period for timer in self._loop.engine.executed.timers]

    def expiries(self, place: Place) -> dict[int, TourStep]:
        """Return the step that follows each running timer, as if that timer expired first."""
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
    """Tour without a step, which sees only the goals before the first one."""

    def _tour(self) -> list[TourStep]:
        super()._tour()
        return []


def bound(plan: TimelessPlan, runs: int, wanted: list[int]) -> int | None:
    """Return the least number of steps of a flow that shows all wanted goals; None if not all places are known.

    `wanted` has a bit for each goal.
    """
    if look_at_all(plan) is None:
        return None
    arcs = [arc for place in plan.places for arc in all_arcs(plan, place)]
    number = {place: row for row, place in enumerate(plan.places)}
    # A flow of each arc, then the runs that end in each place. Runs begin in the first place.
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
    """Action of a run at a place: a step, or the expiry of a timer (`up`) without a wait, which is no step."""

    start: Place
    step: TourStep
    up: int | None

    def lets_run(self, timer: int, periods: int) -> int:
        """Return the periods of a timer that may pass meanwhile; negative if the timer expires here without a wait."""
        if self.up is not None:
            return -periods if self.up == timer else 0
        return periods if self.step.stimulus == WAIT else 1


def all_arcs(plan: TimelessPlan, place: Place) -> list[Arc]:
    """Return the steps from a place, with waits for any running timer, and expiries of timers without waits."""
    steps = [step for step in plan.steps(place) if step.stimulus != WAIT or place.pauses]
    up = plan.expiries(place)
    return [
        *(Arc(place, step, None) for step in [*steps, *up.values()]),
        *(Arc(place, step, timer) for timer, step in up.items()),
    ]


def look_at_all(plan: TimelessPlan) -> int | None:
    """Return the goals that any step between the places shows, as bits; None if there are too many places.

    A place is the state, the running timers, and whether it pauses.
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
