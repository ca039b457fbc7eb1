"""Causes of blocking, and repairs, in the words of the robot model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.wording import (
    NAMED,
    forbid,
    goal_in_words,
    in_words,
    join_with_and,
    name,
    quote_requirements,
    violates,
    words,
)
from robosc.model import sct

if TYPE_CHECKING:
    from robosc.analysis.blocking import BlockingCounterexample, BlockReason


def describe_blocking(reason: BlockReason) -> str:
    """Return why there is no supervisor, as a sentence without its trace."""
    way = "the shortest way to a marked state"
    unreachable = "no marked state can be reached"
    if reason.goal is not None:
        unreachable = violates(quote_requirements([reason.goal]), [reason.goal])
        way = f"{unreachable}: the shortest way to one"
    if reason.violated:
        problem = violates(quote_requirements(reason.violated), reason.violated)
        if reason.event is None:
            return f"{problem} from the start"
        if reason.event.controllable or reason.goal is not None:
            return f"{way} needs {words(reason.event)}, after which {problem}"
        return f"{words(reason.event)} cannot be prevented, and after it {problem}"
    problem = unreachable
    if reason.event is None:
        problem += " at all"
    elif reason.event.controllable or reason.goal is not None:
        problem += f": the shortest way to one needs {words(reason.event)} where {forbid(reason.requirements, 'it')}"
    else:
        problem = f"{words(reason.event)} cannot be prevented, and after it {problem}"
    if reason.goal is not None:
        return problem
    named = [_stuck(plant, reason) for plant in reason.unmarked[:NAMED]]
    if len(reason.unmarked) > NAMED:
        named.append(f"{len(reason.unmarked) - NAMED} more")
    who = (
        f"never in a marked state: {join_with_and(named)}"
        if named
        else "each component can be marked, but never all at once"
    )
    return f"{problem}; {who}"


def _stuck(plant: sct.Plant, reason: BlockReason) -> str:
    state = reason.state.get(plant.name)
    return f"`{name(plant)}`" + (f" in `{state}`" if state is not None else "")


def counterexample_in_words(counterexample: BlockingCounterexample, model: sct.SupervisoryControlModel) -> str:
    """Return the consequence of an event that synthesis holds back, as a sentence without its full stop."""
    steps = in_words(counterexample.trace, model)
    problem = "the marked states of all components cannot be reached together any more"
    if counterexample.unmarked:
        unmarked = join_with_and([f"`{name(plant)}`" for plant in counterexample.unmarked])
        problem = f"{unmarked} cannot get back to a marked state"
    if counterexample.violated:
        # Without line numbers: the sentence is part of generated code, which should change only if the robot does.
        named = join_with_and(
            [
                f"`{requirement.text}`" if requirement.text else "a requirement"
                for requirement in counterexample.violated
            ]
        )
        problem = violates(named, counterexample.violated)
    if not counterexample.onwards:
        return f"after {steps}, {problem}"
    *onwards, last = counterexample.onwards
    further = f", and further {in_words(onwards, model)}" if onwards else ""
    return f"after {steps}{further}, {in_words([last], model)} cannot be prevented, and then {problem}"


def way_out(counterexample: BlockingCounterexample) -> str:
    """Return the change after which synthesis would allow the event."""
    if counterexample.violated:
        loosen = f"loosen the {'requirement' if len(counterexample.violated) == 1 else 'requirements'}"
        if all(isinstance(requirement, sct.Requirement) for requirement in counterexample.violated):
            return loosen
        if goals := list(filter(None, map(goal_in_words, counterexample.violated))):
            return f"give the robot a way from there to a {goals[0]}, or {loosen}"
        return f"{loosen}: add a `needs` requirement for each command, or a command that undoes the event"
    stuck = [f"`{name(plant)}`" for plant in counterexample.unmarked if plant.kind == sct.PlantKind.behaviour]
    return f"give {join_with_and(stuck) or 'the components'} a way from there to a marked state"
