"""Flaws of a supervisor that a model already has: states and events that synthesis must exclude beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.analysis.paths import Layers
from robosc.analysis.wording import goal_in_words, in_words, join_with_and, name, quote_requirements, words
from robosc.model import sct
from robosc.synthesis.fixpoint import coreachable, reachable, reaching
from robosc.synthesis.relation import required_moves, steps

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.analysis.paths import TraceStep
    from robosc.analysis.system import Codes, SupervisedSystem
    from robosc.synthesis.bdd import Diagram


@dataclass(frozen=True)
class Flaw:
    """A fault that the system reaches by a shortest trace if synthesis adds nothing to its requirements.

    `requirement` is violated in the last state, or its states cannot be reached from there. One of a range forbids its
    event there, but no other requirement does. None: the last state reaches no marked state. `unmarked` are then the
    plants that are never marked again, each with its location there; none if each can be, but never all at once.
    """

    requirement: sct.StatedRequirement | None
    trace: tuple[TraceStep, ...]
    unmarked: tuple[tuple[sct.Plant, sct.Location], ...] = ()


def states_of_given_supervisor(system: SupervisedSystem) -> Diagram:
    """Return the states that the plants reach under the requirements, if synthesis adds nothing."""
    moves = required_moves(system.relations.values())
    return reachable(system.diagrams, steps(moves), system.encoding.initial, system.diagrams.true)


def flaws(system: SupervisedSystem, reached: Diagram) -> tuple[Flaw, ...]:
    """Return the flaws of the given supervisor of a model: one for each requirement, and one for the marked states.

    `reached` are the states that `states_of_given_supervisor` returns.
    """
    moves = required_moves(system.relations.values())
    layers = Layers(system.encoding, moves, system.encoding.initial, reached)
    collected = []
    for requirement, states in _faults(system, reached):
        path = layers.path_to(states) if states.satisfiable() else None
        if path is not None:
            end = path.states[-1]
            unmarked = (
                () if requirement else tuple((own, _location(own, end)) for own in system.never_marked(end, moves))
            )
            collected.append(Flaw(requirement, system.trace(path), unmarked))
    return tuple(collected)


def _faults(system: SupervisedSystem, reached: Diagram) -> Iterator[tuple[sct.StatedRequirement | None, Diagram]]:
    """Yield each requirement with the states in which it is at fault, and None with those that block."""
    diagrams, moves = system.diagrams, steps(required_moves(system.relations.values()))
    for requirement, states in system.violations.items():
        yield requirement, reached & states
    for relation in system.relations.values():
        for requirement in relation.requirements:
            if requirement.ranges and relation.event.controllable:
                others = (relation.condition_of(other) for other in relation.requirements if not other.ranges)
                leaving = diagrams.all_of(others) & ~relation.condition_of(requirement)
                yield requirement, reached & relation.allowed_by(leaving)
    for required, goal in system.goals.items():
        yield required, reached & goal.premise & ~reaching(diagrams, moves, goal, reached)
    yield None, reached & ~coreachable(diagrams, moves, system.encoding.all_marked & reached, reached)


def _location(plant: sct.Plant, codes: Codes) -> sct.Location:
    return plant.locations[codes[plant]]


def flaw_in_words(flaw: Flaw, model: sct.SupervisoryControlModel) -> str:
    """Return a flaw as a sentence, with its trace."""
    when = f"after {in_words(flaw.trace, model)}" if flaw.trace else "at the start"
    return f"{when}, {_problem(flaw)}"


def _problem(flaw: Flaw) -> str:
    requirement = flaw.requirement
    match requirement:
        case sct.Requirement(ranges=[_, *_]):
            variables = join_with_and([f"`{variable.name}`" for variable in requirement.ranges])
            return f"{words(requirement.event)} can set {variables} to a value out of range"
        case sct.Requirement():
            forbidden = words(requirement.event)
            return f"{quote_requirements([requirement])} forbids {forbidden}, which cannot be prevented"
        case sct.ReachabilityRequirement():
            return f"no {goal_in_words(requirement)} can be reached"
        case sct.StateInvariant():
            return f"{quote_requirements([requirement])} is violated"
    if not flaw.unmarked:
        return "no state with all automata marked can be reached"
    plants = (
        f"`{name(plant)}`" + (f" in `{location.name}`" if len(plant.locations) > 1 else "")
        for plant, location in flaw.unmarked
    )
    return f"{join_with_and(list(plants))} cannot get back to a marked state"
