"""Reachability and the synthesis fixpoint, by saturation.

Saturation closes every node of the state set under the events that touch nothing above it before it moves upwards
(Ciardo, Lüttgen, Siminiceanu: Saturation: an efficient iteration strategy for symbolic state-space generation, TACAS
2001; on decision diagrams of relations: van Dijk, van de Pol: Sylvan, STTT 2017). The cost of an event depends on the
part that it touches, not on the whole set.

The synthesis algorithm is that of Ouedraogo, Kumar, Malik, Åkesson: Nonblocking and safe control of discrete-event
systems modeled as extended finite automata, T-ASE 2011, on reachable states only. Other states can be goals beside the
marked ones, as in Queiroz, Cury, Wonham: Multitasking supervisory control of discrete-event systems, Discrete Event
Dynamic Systems 2005. A goal may apply to some states only, and restrict the states and the length of the path to it.
"""

from __future__ import annotations

import sys
from collections.abc import Generator
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import groupby
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from robosc.synthesis.acceleration import Acceleration
from robosc.synthesis.relation import Goal, SymbolicStep, join_steps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.synthesis.bdd import Diagram, Diagrams
    from robosc.synthesis.encoding import Element, Encoding
    from robosc.synthesis.relation import EventRelation, Move

    #: States, their bound, and the number of the first group of steps that they are closed under.
    Part = tuple[Diagram, Diagram, int]

T = TypeVar("T")
#: Computation that its caller may pause; it returns its result.
Computation: TypeAlias = Generator[None, None, T]

_PAIR = 2
#: Maximum number of nodes of a relation with next values that costs no more than two steps without next values.
_SMALL = 40
#: Maximum size of a joined relation, relative to the sum of the sizes of its parts.
_LARGER = 8
#: Maximum number of nodes of a relation that is joined with others. Above it, following the relation costs more than
#: calling it.
_LARGE = 256
#: Level of a constant diagram: no states, or all.
_TERMINAL = sys.maxsize


@dataclass(frozen=True)
class Rounds:
    """Good states of each round of the fixpoint.

    `good` begins with all states that are reachable under the requirements and ends with the final ones. `alive` are,
    for the same round, the states that reach each of their goals within the good ones through alive states only; a
    violating state is never alive.
    """

    good: list[Diagram]
    alive: list[Diagram]


@dataclass(frozen=True)
class Search:
    """Problem of the fixpoint.

    `relations` are those of all events, `moves` the events that change something, under the requirements. `violating`
    are the forbidden states. `goals` are further goals beside the marked states.
    """

    encoding: Encoding
    relations: Sequence[EventRelation]
    moves: Sequence[Move]
    violating: Diagram
    goals: Sequence[Goal]

    @property
    def diagrams(self) -> Diagrams:
        """Decision diagrams of the encoding."""
        return self.encoding.diagrams

    @property
    def steps(self) -> list[SymbolicStep]:
        """Steps of all events."""
        return [step for _, step in self.moves]

    @property
    def uncontrollable(self) -> list[SymbolicStep]:
        """Steps of the uncontrollable events."""
        return [step for relation, step in self.moves if not relation.event.controllable]

    @property
    def all_goals(self) -> list[Goal]:
        """Goals of every state, the marked ones first."""
        return [Goal(self.diagrams.true, self.encoding.all_marked), *self.goals]


class SupervisedStates:
    """Result of the fixpoint.

    `search` is the problem. `controlled` are the states that are reachable under the supervisor; none if the supervisor
    is empty. The rounds are computed on demand: only explanations need them.
    """

    def __init__(self, search: Search, controlled: Diagram, reached: Diagram | None = None) -> None:
        """Store the controlled states, and if known the states that are reachable under the requirements."""
        self.search = search
        self.controlled = controlled
        self._reached = reached

    @cached_property
    def restricted(self) -> bool:
        """Whether synthesis removed a state that is reachable under the requirements."""
        if self._reached is not None:
            return self._reached != self.controlled
        outside = ~self.controlled
        return (self.search.encoding.initial & outside).satisfiable() or any(
            (step.image(self.controlled) & outside).satisfiable()
            for relation, step in self.search.moves
            if relation.event.controllable
        )

    @cached_property
    def reached(self) -> Diagram:
        """States that are reachable under the requirements that restrict events."""
        if self._reached is not None:
            return self._reached
        search = self.search
        return reachable(search.diagrams, search.steps, search.encoding.initial, search.diagrams.true)

    @cached_property
    def rounds(self) -> Rounds:
        """Rounds of the fixpoint."""
        return _rounds(self.search, self.reached)


class _Firing:
    """Closing of some states under a group of steps. All parts below are closed before each turn of the group."""

    __slots__ = ("idle", "part", "states", "turn")

    def __init__(self, part: Part) -> None:
        """Begin without a turn.

        `idle` counts consecutive closings below and steps that added no state.
        """
        self.part = part
        self.states = part[0]
        self.idle = self.turn = 0


class _Saturation:
    """Closure of a state set under steps, forwards or backwards, within a bounding set."""

    def __init__(self, diagrams: Diagrams, steps: Sequence[SymbolicStep], *, forwards: bool) -> None:
        self._diagrams = diagrams
        self._acceleration = Acceleration(steps, forwards=forwards)
        by_level = sorted(_merged(steps), key=lambda step: step.level)
        groups = [(level, list(group)) for level, group in groupby(by_level, key=lambda step: step.level)]
        self._levels = [level for level, _ in groups]
        self._groups = [group for _, group in groups]
        self._follow = diagrams.statistics.followed(SymbolicStep.image if forwards else SymbolicStep.preimage)

    def closure(self, states: Diagram, within: Diagram) -> Computation[Diagram]:
        """Return the least set that holds `states` and is closed under the steps within the bound.

        The bound holds `states`, too. The search is a loop with its own stack: synthesis spends its time here, and
        diagrams are deep. The caller may pause it after each firing.
        """
        levels, last, node = self._levels, len(self._levels), self._diagrams.node
        known: dict[Part, Diagram] = {}
        #: Firings and halves. A half has its level, the closed diagram of the upper half, and the part of the lower
        #: half.
        waiting: list[_Firing | tuple[Part, int, Diagram | None, Part]] = []
        part: Part = states, within, 0
        while True:
            # Descend to a part that is known to be closed or closed by definition.
            while True:
                states, within, group = part
                level = states.node_level()
                is_closed = level is None or group == last or states == within
                closed = states if is_closed else known.get(part)
                if closed is not None:
                    break
                bound = within.node_level()
                level, bound = _TERMINAL if level is None else level, _TERMINAL if bound is None else bound
                if level >= levels[group] <= bound:
                    waiting.append(_Firing(part))
                    part = states, within, group + 1
                else:
                    above, below = _halves(part, level, bound)
                    waiting.append((part, min(level, bound), None, below))
                    part = above
            # Ascend to a part that needs more closing.
            while waiting:
                upper = waiting.pop()
                if isinstance(upper, tuple):
                    own, level, high, below = upper
                    if high is None:
                        waiting.append((own, level, closed, below))
                        part = below
                        break
                    closed = node(level, high, closed)
                else:
                    own = upper.part
                    if not self._is_closed_after_turn(upper, closed):
                        yield
                        waiting.append(upper)
                        part = upper.states, own[1], own[2] + 1
                        break
                    closed = upper.states
                # A closed part stays closed, and it occurs again as a part of sets that grew elsewhere.
                known[own] = known[closed, own[1], own[2]] = closed
            else:
                return closed

    def _is_closed_after_turn(self, firing: _Firing, closed: Diagram) -> bool:
        """Fire each step of a group once at states that are closed below; return whether these are now closed."""
        _, within, group = firing.part
        here = self._groups[group]
        turns = len(here) + 1
        follow, bounded = self._follow, not within.valid()
        states = closed
        idle = firing.idle + 1 if closed == firing.states else 1
        operations = 0
        for step in here:
            if idle >= turns:
                break
            operations += 1
            followed = follow(step, states)
            further = states | (followed & within if bounded else followed) if followed.satisfiable() else states
            if further == states:
                idle += 1
            elif further == within:
                states, idle = further, turns
            else:
                states, idle = further, 1 if step.apart else 0
        self._diagrams.statistics.operations += operations
        self._diagrams.tidy()
        firing.states = states
        if idle >= turns:
            return True
        firing.turn += 1
        if self._acceleration.due(firing.turn):
            below = [step for steps in self._groups[group + 1 :] for step in steps]
            for accelerated in self._acceleration.over(here, below, firing.turn, within):
                self._diagrams.statistics.operations += 1
                self._diagrams.tidy()
                further = states | follow(accelerated, states)
                if further != states:
                    states, idle = further, 0
            firing.states = states
        firing.idle = idle
        return False


def _halves(part: Part, own: int, bound: int) -> tuple[Part, Part]:
    """Return the parts of the states for a true and for a false variable at their first level.

    The states begin at the level `own`, their bound begins at `bound`.
    """
    states, within, group = part
    high, low = (own <= bound and states.cofactors()) or (states, states)
    high_within, low_within = (bound <= own and within.cofactors()) or (within, within)
    return (high, high_within, group), (low, low_within, group)


def _merged(steps: Sequence[SymbolicStep]) -> list[SymbolicStep]:
    """Join some of the steps of each level: most images and preimages add no state.

    Only steps that change the element at that level are joined: after one of them, the others start from another place.
    Steps that leave it unchanged can mostly happen side by side. It is best to follow each of them from the result of
    the last.
    """
    merged_steps: list[SymbolicStep] = []
    by_level: dict[tuple[int, bool], list[SymbolicStep]] = {}
    for step in _merged_alike(steps):
        by_level.setdefault((step.level, step.present.node_level() == step.level), []).append(step)
    for (_, at_level), group in by_level.items():
        # Wide integers are accelerated by single events.
        merged_steps += _joined_where_it_pays(group) if at_level and not group[0].encoding.layout.wide else group
    return merged_steps


def _joined_where_it_pays(steps: Sequence[SymbolicStep]) -> Sequence[SymbolicStep]:
    """Join the steps with a small relation if one of them needs next values.

    Steps that are `apart` need no next values, but their join does: each of its images costs more than the separate
    ones.
    """
    small: list[SymbolicStep] = []
    large: list[SymbolicStep] = []
    for step in steps:
        (small if step.relation.node_count() <= _LARGE else large).append(step)
    if all(step.apart is not None for step in small):
        return steps
    return [*_as_one(small), *large]


def _as_one(steps: Sequence[SymbolicStep]) -> Sequence[SymbolicStep]:
    """Join the steps into one; each part keeps the elements that only the other parts change.

    Returns the steps unchanged if the joined relation gets large.
    """
    most = _LARGER * sum(step.relation.node_count() for step in steps)
    parts = steps
    # Join by halves to keep intermediate results small.
    while len(parts) > 1:
        parts = [reduce(join_steps, parts[start : start + _PAIR]) for start in range(0, len(parts), _PAIR)]
        parts[0].encoding.diagrams.tidy()
        if any(part.relation.node_count() > most for part in parts):
            return steps
    return parts


def _merged_alike(steps: Sequence[SymbolicStep]) -> list[SymbolicStep]:
    """Merge steps of one level that change the same elements.

    A pair of steps without next values is not merged if the result is a large relation with next values.
    """
    alike: dict[tuple[int, frozenset[Element]], list[SymbolicStep]] = {}
    for step in steps:
        alike.setdefault((step.level, frozenset(step.changed)), []).append(step)
    merged_steps = []
    for group in alike.values():
        merged = group[0]
        if len(group) > 1:
            relation = merged.encoding.diagrams.any_of(step.relation for step in group)
            merged = replace(merged, relation=relation, events=tuple(event for step in group for event in step.events))
        pays = len(group) != _PAIR or merged.apart is not None or merged.relation.node_count() <= _SMALL
        merged_steps += [merged] if pays else group
    return merged_steps


def reachable(diagrams: Diagrams, steps: Sequence[SymbolicStep], states: Diagram, within: Diagram) -> Diagram:
    """Return all states that the steps reach from `states` without leaving `within`."""
    return completed(_reaching(diagrams, steps, states, within))


def coreachable(diagrams: Diagrams, steps: Sequence[SymbolicStep], states: Diagram, within: Diagram) -> Diagram:
    """Return all states from which the steps reach `states` without leaving `within`."""
    return completed(_coreaching(diagrams, steps, states, within))


def completed(computation: Computation[T]) -> T:
    """Run a computation without a pause and return its result."""
    while True:
        try:
            next(computation)
        except StopIteration as end:
            result: T = end.value
            return result


def _reaching(
    diagrams: Diagrams, steps: Sequence[SymbolicStep], states: Diagram, within: Diagram
) -> Computation[Diagram]:
    return _Saturation(diagrams, steps, forwards=True).closure(states, within)


def _coreaching(
    diagrams: Diagrams, steps: Sequence[SymbolicStep], states: Diagram, within: Diagram
) -> Computation[Diagram]:
    return _Saturation(diagrams, steps, forwards=False).closure(states, within)


def reaching(diagrams: Diagrams, steps: Sequence[SymbolicStep], goal: Goal, within: Diagram) -> Diagram:
    """Return the states from which the steps reach a goal, by a path that the goal allows, without leaving `within`."""
    return completed(_reaching_goal(diagrams, steps, goal, within))


def _reaching_goal(
    diagrams: Diagrams, steps: Sequence[SymbolicStep], goal: Goal, within: Diagram
) -> Computation[Diagram]:
    if goal.along is not None:
        within &= goal.along
    states = goal.states & within
    if goal.bound is None:
        return (yield from _coreaching(diagrams, steps, states, within))
    latest = states
    for _ in range(goal.bound):
        diagrams.statistics.operations += len(steps)
        diagrams.tidy()
        yield
        latest = diagrams.any_of(step.preimage(latest) for step in steps) & within & ~states
        if not latest.satisfiable():
            break
        states |= latest
    return states


def _keeping_alive(search: Search, allowed: Diagram) -> Computation[Diagram]:
    """Return the largest set of allowed states in which each state reaches its goals within the set."""
    goals, unchanged = search.all_goals, 0
    while True:
        for goal in goals:
            reached = yield from _reaching_goal(search.diagrams, search.steps, goal, allowed)
            alive = reached if goal.premise.valid() else allowed & (reached | ~goal.premise)
            unchanged = unchanged + 1 if alive == allowed else 1
            allowed = alive
            if unchanged >= len(goals):
                return allowed


def _rounds(search: Search, reached: Diagram) -> Rounds:
    """Return the rounds of the fixpoint, from the states that are reachable under the requirements."""
    diagrams, initial, good = search.diagrams, search.encoding.initial, reached
    rounds = Rounds([good], [])
    while True:
        allowed = good & ~search.violating
        # If all remaining states were alive, they still are: none needs a removed state to reach a goal.
        was_alive = bool(rounds.alive) and good == rounds.alive[-1]
        rounds.alive.append(good if was_alive else completed(_keeping_alive(search, allowed)))
        blocked = good & ~rounds.alive[-1]
        if not blocked.satisfiable():
            return rounds
        good &= ~coreachable(diagrams, search.uncontrollable, blocked, good)
        rounds.good.append(good)
        if not (initial & good).satisfiable():
            return rounds


def supervise_forwards(search: Search, within: Diagram | None = None) -> Computation[SupervisedStates]:
    """Return the states of the maximally permissive, controllable, non-blocking supervisor.

    The search begins with the states that are reachable under the requirements, `within` some states that contain all
    good ones. Each round removes states from them.
    """
    diagrams, initial = search.diagrams, search.encoding.initial
    bound = diagrams.true if within is None else within
    reached = yield from _reaching(diagrams, search.steps, initial & bound, bound)
    good = yield from _good(search, reached)
    # The set of reachable states stays good: all successors of a reachable state are reachable.
    controlled = good if good == reached else (yield from _reaching(diagrams, search.steps, initial & good, good))
    return SupervisedStates(search, controlled, reached if within is None else None)


def safe_states(search: Search) -> Computation[Diagram]:
    """Return the states, reachable or not, from which uncontrollable events lead to no violation."""
    states = search.encoding.whole(domain.element for domain in search.encoding.layout.state)
    bad = states & search.violating
    return states & ~(yield from _coreaching(search.diagrams, search.uncontrollable, bad, states))


def good_states(search: Search, safe: Diagram) -> Computation[Diagram]:
    """Return the good states among the safe ones, whether they are reachable or not.

    The states of the supervisor are those that it reaches within. For chains of components, the diagrams of all good
    states are far smaller than those of the reachable ones. For many other models, they are far larger.
    """
    return _good(search, safe)


def supervise_within(search: Search, good: Diagram) -> SupervisedStates:
    """Return the states of the supervisor within the result of `good_states`."""
    return SupervisedStates(search, reachable(search.diagrams, search.steps, search.encoding.initial & good, good))


def _good(search: Search, states: Diagram) -> Computation[Diagram]:
    """Return the largest part of `states` without violations that uncontrollable events do not leave.

    Each state of it reaches each of its goals within.
    """
    diagrams, statistics = search.diagrams, search.diagrams.statistics
    good, bad, alive = states, states & search.violating, diagrams.false
    while True:
        statistics.rounds += 1
        statistics.states = search.encoding.count(good)
        if bad.satisfiable():
            good &= ~(yield from _coreaching(diagrams, search.uncontrollable, bad, good))
        # The states that were alive still are: none needs a removed state to reach a goal.
        if good == alive:
            return good
        alive = yield from _keeping_alive(search, good)
        bad = good & ~alive
        if not bad.satisfiable():
            return good
