"""Coverage of a run of a controller: transitions taken, and guards that were true and false."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.engine import Blocked
from robosc.engine.transitions import Transitions
from robosc.model import engine as en
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.edges import edges_of
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.roles import event_name, is_goal
from robosc.synthesis.relation import reads_inputs

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.engine import ControlLoop

#: Roles of the events that the control loop evaluates when it has settled, and while it settles.
_QUEUED, _SILENT = (en.Role.cancel, en.Role.trigger), en.Role.silent


@dataclass(frozen=True)
class Goal:
    """Coverage goal: an event's guard that is true or false, or a transition that is taken (true).

    A transition `on … if …` is false if its event happens in its state and its condition does not hold. A guard may be
    false for one `cause` alone: one condition of a conjunction in its requirements, while all others hold.
    """

    of: sct.Event | sct.Edge
    value: bool = True
    cause: ex.Expression | None = None


def goals(loop: ControlLoop) -> list[Goal]:
    """Return all goals: of each transition of the text, then of the guard of each event of the controller.

    A guard that is literally `true` has no goal of being false. Later alternatives of such a choice have no goals.
    """
    result = []
    never_asked = {
        alternative.event
        for choice in loop.engine.executed.choices
        for number, alternative in enumerate(choice.alternatives)
        if any(not before.event.guard.terms for before in choice.alternatives[:number])
    }
    for plant in loop.engine.model.plants:
        if plant.kind == sct.PlantKind.behaviour:
            for edge in edges_of(plant):
                if edge.source is not None:
                    result += [Goal(edge), *([] if edge.guard is None or _rejects(edge) else [Goal(edge, value=False)])]
    events = {event_name(event): event for plant in loop.engine.model.plants for event in plant.events}
    for executed in loop.engine.executed.events:
        if executed.role in (*_QUEUED, _SILENT, en.Role.data) and executed not in never_asked:
            event = events[executed.name]
            result += [Goal(event), *([Goal(event, value=False)] if executed.guard.terms else [])]
            result += [Goal(event, value=False, cause=cause) for cause in causes(loop.engine.model, event)]
    return result


def _rejects(edge: sct.Edge) -> bool:
    """Return whether the controller rejects a goal of a client unless the transition's condition holds."""
    alternatives = [other for other in edge.eContainer().edges if other.event is edge.event]
    return is_goal(edge.event) and edge is alternatives[-1]


def causes(model: sct.SupervisoryControlModel, event: sct.Event) -> list[ex.Expression]:
    """Return the conditions on the state that the requirements on an event join by `and`; none if there is only one."""
    supervisor = model.supervisor
    required = [guard.requirement for guard in supervisor.guards if guard.event is event] if supervisor else []
    pending, conditions = [condition for condition in required if condition is not None], []
    while pending:
        condition = pending.pop()
        if isinstance(condition, ex.Conjunction):
            pending += (condition.right, condition.left)
        elif not reads_inputs(condition):
            conditions.append(condition)
    return conditions if len(conditions) > 1 else []


class Watcher:
    """Observer of the goals in one control loop: `before_event` before each event, `at_rest` after each call."""

    def __init__(self, loop: ControlLoop) -> None:
        self._engine = loop.engine
        self._transitions = Transitions(loop.engine)
        self._goals = set(goals(loop))
        self._events = {event_name(event): event for plant in loop.engine.model.plants for event in plant.events}
        executed = loop.engine.executed
        self._queued = [event.name for event in executed.events if event.role in _QUEUED]
        self._silent = [event.name for event in executed.events if event.role == _SILENT]
        self._causes = {
            name: conditions for name in self._queued if (conditions := causes(loop.engine.model, self._events[name]))
        }
        self._choices = [[alternative.event.name for alternative in choice.alternatives] for choice in executed.choices]
        self._seen_at_rest: dict[tuple[int, ...], frozenset[Goal]] = {}

    def before_event(self, event: str) -> Iterator[Goal]:
        """Yield the goals that an enabled event reaches as it happens, with the inputs that are set."""
        seen = [Goal(edge, taken) for edge, taken in self._transitions.attempts(event)]
        yield from (goal for goal in [*seen, Goal(self._events[event])] if goal in self._goals)

    def at_rest(self) -> frozenset[Goal]:
        """Return the goals reached when the control loop has settled: then it has evaluated all guards."""
        cells, _ = self._engine.saved
        if cells not in self._seen_at_rest:
            decisions = [(event, self._engine.enabled(event)) for event in (*self._queued, *self._silent)]
            for alternatives in self._choices:
                for event in alternatives:
                    decisions.append((event, self._engine.enabled(event)))
                    if decisions[-1][1]:
                        break  # later alternatives are not evaluated
            seen = [Goal(self._events[event], value) for event, value in decisions]
            self._seen_at_rest[cells] = frozenset([*seen, *self._alone()])
        return self._seen_at_rest[cells]

    def _alone(self) -> Iterator[Goal]:
        """Yield the goals of conditions that alone forbid an event for which the robot is ready."""
        for event, conditions in self._causes.items():
            if self._engine.blocked_by(event) == Blocked.REQUIREMENT:
                false = [condition for condition in conditions if not evaluate(condition, self._engine.read)]
                if len(false) == 1:
                    yield Goal(self._events[event], value=False, cause=false[0])


@dataclass(frozen=True)
class Coverage:
    """Coverage of a robot by traces: all goals, those seen, and those known to be impossible in every run."""

    goals: tuple[Goal, ...]
    seen: frozenset[Goal]
    impossible: frozenset[Goal]
    #: Number of incoming messages and waits.
    steps: int

    @property
    def missed(self) -> list[Goal]:
        """The goals that are possible but were not seen."""
        return [goal for goal in self.goals if goal not in self.seen and goal not in self.impossible]

    @property
    def transitions(self) -> tuple[int, int]:
        """The number of transitions taken, and of all possible ones."""
        return self._count(goal for goal in self.goals if isinstance(goal.of, sct.Edge) and goal.value)

    def guards(self, *, value: bool) -> tuple[int, int]:
        """Return the number of guards that had this value, and of all that can have it.

        Conditions of transitions count only if the value is false.
        """
        return self._count(
            goal for goal in self.goals if goal.value == value and (isinstance(goal.of, sct.Event) or not value)
        )

    def _count(self, goals: Iterable[Goal]) -> tuple[int, int]:
        possible = [goal for goal in goals if goal not in self.impossible]
        return sum(goal in self.seen for goal in possible), len(possible)

    def __str__(self) -> str:
        """Return the coverage, such as `12 of 12 transitions, 9 of 9 guards true, 8 of 8 false, in 23 steps`."""
        counts = [self.transitions, self.guards(value=True), self.guards(value=False)]
        taken, true, false = (f"{seen} of {possible}" for seen, possible in counts)
        return f"{taken} transitions, {true} guards true, {false} false, in {self.steps} steps"
