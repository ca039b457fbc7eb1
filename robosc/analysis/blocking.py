"""Causes of an empty supervisor, and paths to blocking states that a supervisor prevents."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from robosc.analysis.paths import Path, TraceStep, deciding, shortest_path
from robosc.model import sct
from robosc.synthesis.decoding import Value, value
from robosc.synthesis.encoding import pick

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.analysis.system import Codes, SynthesizedSystem
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.relation import EventRelation, Move


@dataclass(frozen=True)
class BlockReason:
    """Cause of an empty supervisor.

    `event` is the event at fault: an uncontrollable event that no supervisor can prevent, or a controllable event whose
    requirement separates the robot from its marked states. It is None if the plants alone reach no marked state.
    `unmarked` are the plants that can no longer be in a marked location after the event, or at all; none if each can
    be, but never all at once. `trace` is a shortest trace from the initial state that ends with the event. `state` is
    its last state; if a requirement forbids the event, it is the state before the event. It has the location of every
    plant with several locations and the value of every variable. `codes` are those of that state. `requirements` forbid
    the event at fault there, or something after it. `violated` are the invariants that do not hold after the event, or
    at the start, or the requirements whose states are unreachable from there. `goal` is the requirement to whose states
    the trace leads, in place of the marked ones.
    """

    event: sct.Event | None
    unmarked: tuple[sct.Plant, ...]
    trace: tuple[TraceStep, ...]
    state: Mapping[str, Value]
    codes: Mapping[Element, int] = field(repr=False)
    requirements: tuple[sct.Requirement, ...] = ()
    violated: tuple[sct.StatedRequirement, ...] = ()
    goal: sct.ReachabilityRequirement | None = None


def reason_of_emptiness(system: SynthesizedSystem) -> BlockReason:
    """Return why the initial state of a system without controlled states is not controlled."""
    blocked = not (system.encoding.initial & system.solution.rounds.alive[0]).satisfiable()
    return _blocked_from_the_start(system) if blocked else _uncontrollable(system)


def _uncontrollable(system: SynthesizedSystem) -> BlockReason:
    encoding, solution = system.encoding, system.solution
    # Initial states that reach no marked state at all do not show which event is uncontrollable.
    start = pick(encoding.initial & solution.rounds.alive[0], encoding.layout.state)
    before = encoding.state(unavoidable(system, start).states[-2])
    blocked = solution.reached & ~solution.rounds.alive[0]
    first = _path(system, system.moves, encoding.initial, before)
    last = _path(system, _uncontrollable_moves(system), before, blocked)
    event = last.moves[0][0].event
    reason = _described(
        system,
        system.never_marked(last.states[-1]),
        [*system.trace(first), *system.trace(last)],
        last.states[-1],
    )
    violated = system.violated(last.states[-1])
    if violated:
        reason = replace(reason, unmarked=(), violated=violated)
        if not isinstance(violated[0], sct.ReachabilityRequirement):
            return replace(reason, event=event)
    changing = {relation.event for relation, _ in system.plant_moves}
    at_fault = [requirement for requirement in forbidden_from(system, last.states[-1]) if requirement.event in changing]
    return replace(reason, event=event, requirements=tuple(at_fault))


def _blocked_from_the_start(system: SynthesizedSystem) -> BlockReason:
    encoding = system.encoding
    path = _path_of_plants(system, encoding.all_marked)
    start = encoding.initial_codes if path is None else path.states[0]
    unmarked = system.never_marked(start)
    violated = system.violated(start)
    goal = violated[0] if violated else None
    if isinstance(goal, sct.ReachabilityRequirement):
        _, states, along, _ = system.goals[goal]
        path = _path_of_plants(system, states, along)
        unmarked = []
    else:
        goal = None
    if violated and (goal is None or path is None):
        return replace(_described(system, (), [], start), violated=violated)
    if path is None:
        return _described(system, unmarked, [], start)
    steps = system.trace(path)
    for index, ((relation, _), codes, after) in enumerate(zip(path.moves, path.states, path.states[1:], strict=False)):
        at_fault = relation.forbidding(codes, after)
        if at_fault:
            reason = _described(system, unmarked, steps[: index + 1], codes)
            return replace(reason, event=relation.event, requirements=at_fault, goal=goal)
        violated = system.violated(after)
        if violated and goal not in violated:
            reason = _described(system, (), steps[: index + 1], after)
            return replace(reason, event=relation.event, violated=violated, goal=goal)
    if goal is not None:  # The states of the goal reach no marked state.
        return replace(_described(system, (), [], start), violated=(goal,))
    raise AssertionError("the requirements forbid nothing on the way")


def _path_of_plants(system: SynthesizedSystem, goal: Diagram, along: Diagram | None = None) -> Path | None:
    """Return a shortest path of the plants from an initial state to one of these states; None if there is none.

    The path leads through states of `along` only; None: through all.
    """
    within = system.diagrams.true if along is None else along
    reached = goal & within & system.uncontrolled
    if not reached.satisfiable():  # The search would visit all states, layer by layer.
        return None
    encoding = system.encoding
    return shortest_path(encoding, system.plant_moves, encoding.initial, reached, within)


def _described(
    system: SynthesizedSystem, unmarked: Sequence[sct.Plant], steps: Sequence[TraceStep], codes: Codes
) -> BlockReason:
    """Return a reason that has the state by name and no event."""
    state: dict[str, Value] = {}
    for plant in system.model.plants:
        if len(plant.locations) > 1:
            state[plant.name] = value(plant, codes[plant])
        for variable in plant.variables:
            state[f"{plant.name}.{variable.name}"] = value(variable, codes[variable])
    return BlockReason(None, tuple(unmarked), tuple(steps), state, codes)


@dataclass(frozen=True)
class BlockingCounterexample:
    """Consequence that the supervisor prevents by holding back an event that plants and its requirements allow.

    `trace` is a shortest trace that ends with this event, from the initial state or from the state in question.
    `onwards` is a path from there under the requirements to a state that violates an invariant or reaches no marked
    state, as `unavoidable` computes it. Its last event is the uncontrollable event that the supervisor guards against.
    It is empty if no event is needed. `codes` are those of its last state. `violated` are the invariants that do not
    hold there, or the requirements whose states it cannot reach. If there are none, `unmarked` are the plants that can
    no longer be in a marked location; none if each can be, but never all at once.
    """

    trace: tuple[TraceStep, ...]
    onwards: tuple[TraceStep, ...]
    codes: Mapping[Element, int]
    unmarked: tuple[sct.Plant, ...]
    violated: tuple[sct.StatedRequirement, ...] = ()


def blocking_counterexample(system: SynthesizedSystem, event: sct.Event, way: Path) -> BlockingCounterexample:
    """Return the consequence of an event that only synthesis forbids, at the end of a path."""
    encoding, relation = system.encoding, system.relations[event]
    step = relation.step
    assert step is not None  # else the event would change nothing and could not lead to blocking
    following = step.image(system.last(way))
    # Other data of a command may lead to controlled states.
    removed = following & ~system.solution.controlled
    after = pick(removed if removed.satisfiable() else following, encoding.layout.state)
    onwards = unavoidable(system, after)
    end = onwards.states[-1]
    unmarked = [plant for plant in system.model.plants if not plant.locations[end[plant]].marked]
    trace = system.trace(Path([*way.states, after], [*way.moves, (relation, step)]))
    violated = system.violated(end)
    if violated:
        return BlockingCounterexample(trace, system.trace(onwards), end, (), violated)
    return BlockingCounterexample(
        trace,
        system.trace(onwards),
        end,
        tuple(system.never_marked(end, deciding(system.moves, unmarked))),
    )


def unavoidable(system: SynthesizedSystem, start: Codes) -> Path:
    """Return a path from a removed state to one that was removed first, driven by uncontrollable events.

    The last state violates an invariant or does not reach one of its goals, such as a marked state. Round by round,
    backwards: uncontrollable events lead from the state to one that does not reach a goal without the states that
    earlier rounds removed. Its shortest path to the goal visits one of those, and so on. The last event is therefore
    uncontrollable. The path is empty if the start itself does not reach a goal.
    """
    uncontrollable = _uncontrollable_moves(system)
    rounds, alive = system.solution.rounds.good, system.solution.rounds.alive
    index = max(number for number, good in enumerate(rounds) if system.is_in(start, good))
    whole = Path([dict(start)], [])

    def go(possible: Sequence[Move], goal: Diagram, within: Diagram) -> None:
        part = _path(system, possible, system.last(whole), goal, within)
        whole.states.extend(part.states[1:])
        whole.moves.extend(part.moves)

    go(uncontrollable, rounds[index] & ~alive[index], rounds[index])
    for earlier in reversed(range(index)):
        go(system.moves, alive[earlier] & ~rounds[earlier + 1], alive[earlier])
        go(uncontrollable, rounds[earlier] & ~alive[earlier], rounds[earlier])
    return whole


def forbidden_from(system: SynthesizedSystem, codes: Codes) -> list[sct.Requirement]:
    """Return the requirements that forbid an event after this state, in the order of the events.

    The plants enable the event in the state or in one that can follow.
    """
    onwards = system.onwards(codes)
    return [
        requirement
        for relation in system.relations.values()
        for requirement in relation.requirements
        if (onwards & relation.forbidden_by(requirement)).satisfiable()
    ]


def requirements_at_fault(relation: EventRelation, states: Diagram) -> tuple[sct.Requirement, ...]:
    """Return the requirements at fault if an event is allowed in none of these states, with any data.

    These are all requirements that each disable the event in all states. If there is none, it is a minimal set of
    requirements that together disable it.
    """
    permissions = {requirement: relation.condition_of(requirement) for requirement in relation.requirements}
    if relation.has_data:
        states &= relation.happens
    alone = [requirement for requirement, permitting in permissions.items() if not (states & permitting).satisfiable()]
    if alone:
        return tuple(alone)
    together = dict(permissions)
    for requirement in permissions:
        rest = states
        for other, permission in together.items():
            rest = rest if other is requirement else rest & permission
        if not rest.satisfiable():
            del together[requirement]
    return tuple(together)


def never_ready(relation: EventRelation, states: Diagram) -> tuple[sct.Plant, ...]:
    """Return the plants that enable an event in none of these states."""
    return tuple(plant for plant, own in relation.enabled_by.items() if not (states & own).satisfiable())


def _uncontrollable_moves(system: SynthesizedSystem) -> list[Move]:
    return [move for move in system.moves if not move[0].event.controllable]


def _path(
    system: SynthesizedSystem, moves: Sequence[Move], start: Diagram, goal: Diagram, within: Diagram | None = None
) -> Path:
    path = shortest_path(system.encoding, moves, start, goal, system.diagrams.true if within is None else within)
    assert path is not None
    return path
